#!/usr/bin/env bash
# Builds what users install without Rust: an archive for any Linux, and a package for Debian, both for x86-64 and in FOLDER.
# Each holds the program once for each level of x86-64, and a launcher that starts the one that fits the processor
# (cli/launcher). The same commit and compiler give the same bytes, wherever the checkout lies.
#
#     cli/package.sh [FOLDER [LEVEL...]]      default: target/package v2 v3 v4
set -euo pipefail
folder=$(realpath -m "${1:-target/package}")
levels=("${@:2}")
if [ ${#levels[@]} -eq 0 ]; then levels=(v2 v3 v4); fi
cd "$(dirname "$0")/.."
root=$PWD
case "$(rustc -vV)" in *"host: x86_64-unknown-linux-gnu"*) ;; *) echo "packages are built on x86-64 Linux alone" >&2; exit 2 ;; esac

version=$(sed -n 's/^version = "\(.*\)"$/\1/p' Cargo.toml | head -n 1)
# Files are as old as the commit.
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || echo 0)}
export SOURCE_DATE_EPOCH
name=basrelief-$version-x86_64-linux
build=$folder/build
tree=$folder/$name
rm -rf "$tree" "$folder/deb"
mkdir -p "$tree"/{bin,lib/basrelief,share/doc/basrelief,share/man/man1} "$tree/share/bash-completion/completions" \
    "$tree/share/zsh/site-functions" "$tree/share/fish/vendor_completions.d"

# Builds a package of the workspace for a level; messages name files without the folders of this machine.
build_for() {
    local cargo_home=${CARGO_HOME:-$HOME/.cargo} sysroot
    sysroot=$(rustc --print sysroot)
    env RUSTFLAGS="-C target-cpu=$1 -C strip=symbols --remap-path-prefix=$root=. --remap-path-prefix=$cargo_home=cargo \
        --remap-path-prefix=$sysroot=rust --remap-path-prefix=$build=build" \
        CARGO_TARGET_DIR="$build" cargo build --locked --release "${@:2}"
}

build_for x86-64 -p basrelief-launcher
install -m 755 "$build/release/basrelief-launcher" "$tree/bin/basrelief"
for level in "${levels[@]}"; do
    build_for "x86-64-$level" -p basrelief-cli --features viewer
    install -m 755 "$build/release/basrelief" "$tree/lib/basrelief/basrelief-$level"
done

# What the program says of itself; any level says the same.
program=$tree/lib/basrelief/basrelief-${levels[0]}
"$program" man -o "$tree/share/man/man1"
find "$tree/share/man" -name '*.1' -exec gzip -n9 {} +
"$program" completions bash >"$tree/share/bash-completion/completions/basrelief"
"$program" completions zsh >"$tree/share/zsh/site-functions/_basrelief"
"$program" completions fish >"$tree/share/fish/vendor_completions.d/basrelief.fish"
cp docs/program.md docs/layers.md CHANGELOG.md "$tree/share/doc/basrelief/"

cli/licences.sh basrelief-cli --features viewer >"$tree/share/doc/basrelief/copyright"

archive=$folder/$name.tar.gz
tar -C "$folder" --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner --mode=u+w,go-w -cf - "$name" |
    gzip -n9 >"$archive"
echo "$archive"

if ! command -v dpkg-deb >/dev/null; then echo "dpkg-deb is not installed: no package for Debian" >&2; exit; fi
deb=$folder/deb
mkdir -p "$deb/DEBIAN" "$deb/usr"
cp -a "$tree/." "$deb/usr/"
# The oldest C library that has all that the program asks for.
glibc=$(grep -aoh 'GLIBC_2\.[0-9]*' "$tree/bin/basrelief" "$tree"/lib/basrelief/* | sort -uV | tail -n 1)
cat >"$deb/DEBIAN/control" <<END
Package: basrelief
Version: $version
Architecture: amd64
Maintainer: The basrelief developers <developers@basrelief.invalid>
Depends: libc6 (>= ${glibc#GLIBC_}), libgcc-s1
Suggests: libx11-xcb1, libxcursor1, libxi6, libxkbcommon-x11-0
Section: graphics
Priority: optional
Description: draws relief-mapped surfaces on the processor
 Renders OBJ and glTF scenes with height maps into pictures, without a graphics
 processor or a display, and with the same bytes on every machine. Its filters
 leave out what the relief hides from the eye.
END
chmod -R u=rwX,go=rX "$deb"
find "$deb" -exec touch -h -d "@$SOURCE_DATE_EPOCH" {} +
dpkg-deb --root-owner-group -Zxz --build "$deb" "$folder/basrelief_${version}_amd64.deb" >/dev/null
rm -rf "$deb"
echo "$folder/basrelief_${version}_amd64.deb"
