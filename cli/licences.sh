#!/usr/bin/env bash
# The licences of a package of the workspace, and of every crate that is linked into it, with their texts:
#     cli/licences.sh PACKAGE [OPTION OF CARGO TREE...]
set -euo pipefail
cd "$(dirname "$0")/.."
cat LICENSE-MIT LICENSE-APACHE
crates=$(cargo tree --locked -p "$1" "${@:2}" -e normal --prefix none --no-dedupe -f '{p}|{l}' |
    sed 's/ (proc-macro)//; s/ (.*)|/|/; /^$/d' | sort -u)
while IFS='|' read -r package licence; do
    printf '\n==== %s: %s ====\n' "$package" "$licence"
    manifest=$(find "${CARGO_HOME:-$HOME/.cargo}/registry/src" -mindepth 2 -maxdepth 2 -name "${package/ v/-}" -print -quit)
    [ -n "$manifest" ] || continue
    while read -r file; do cat "$file"; done < <(find "$manifest" -maxdepth 1 -type f -iname '*licen[cs]e*' | sort)
done <<<"$crates"
