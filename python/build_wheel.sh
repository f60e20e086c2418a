#!/usr/bin/env bash
# A wheel for any x86-64 Linux with builds for x86-64-v2, v3 and v4 in it, one of which is picked
# when it is imported (python/basrelief/_builds.py): python/build_wheel.sh [FOLDER]
# Needs cargo, and maturin of pip. The same commit gives the same wheel.
set -euo pipefail
cd "$(dirname "$0")"
folder=$(realpath -m "${1:-dist}")
target=$(realpath -m "${CARGO_TARGET_DIR:-../target}")
package=python/basrelief
export CARGO_PROFILE_RELEASE_STRIP=true SOURCE_DATE_EPOCH="${SOURCE_DATE_EPOCH:-315532800}"

# In their place in the package only while the wheel is made.
clean() { rm -f "$package"/_native_v*.so; }
trap clean EXIT
clean
for level in v3 v4; do
    env PYO3_BUILD_EXTENSION_MODULE=1 RUSTFLAGS="-C target-cpu=x86-64-$level" \
        CARGO_TARGET_DIR="$target/x86-64-$level" cargo build --locked --release
    cp "$target/x86-64-$level/release/lib_native.so" "$package/_native_$level.abi3.so"
done
env RUSTFLAGS="-C target-cpu=x86-64-v2" CARGO_TARGET_DIR="$target/x86-64-v2" \
    maturin build --locked --release --out "$folder"
