#!/usr/bin/env bash
# A wheel for any x86-64 Linux with builds for x86-64-v2, v3 and v4 in it, one of which is picked
# when it is imported (python/basrelief/_builds.py): python/build_wheel.sh [FOLDER]
# Needs cargo, and maturin of pip. The same commit and compilers give the same wheel, wherever the
# checkout lies.
set -euo pipefail
cd "$(dirname "$0")"
root=$(realpath ..)
folder=$(realpath -m "${1:-dist}")
target=$(realpath -m "${CARGO_TARGET_DIR:-../target}")
package=python/basrelief
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || echo 315532800)}
export CARGO_PROFILE_RELEASE_STRIP=true SOURCE_DATE_EPOCH

# In their place in the package only while the wheel is made; maturin finds LICENSE by itself.
clean() { rm -f "$package"/_native_v*.so LICENSE; }
trap clean EXIT
clean
../cli/licences.sh basrelief-python >LICENSE

# A command for a level, each in a folder of its own; messages name files without this machine's folders.
build_for() {
    local level=$1 sysroot
    sysroot=$(rustc --print sysroot)
    env PYO3_BUILD_EXTENSION_MODULE=1 CARGO_TARGET_DIR="$target/x86-64-$level" \
        RUSTFLAGS="-C target-cpu=x86-64-$level --remap-path-prefix=$root=. \
        --remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=cargo --remap-path-prefix=$sysroot=rust \
        --remap-path-prefix=$target=target" "${@:2}"
}
for level in v3 v4; do
    build_for "$level" cargo build --locked --release
    cp "$target/x86-64-$level/release/lib_native.so" "$package/_native_$level.abi3.so"
done
build_for v2 maturin build --locked --release --out "$folder"
