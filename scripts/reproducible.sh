#!/usr/bin/env bash
# Builds libhangpose.a twice from copies in different folders, with different homes of cargo's build products, and fails if
# the two differ in a byte. The paths of the folders are taken out, as scripts/dist.sh does.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

build() {
    local copy=$folder/$1
    mkdir -p "$copy"
    # What is committed or would be, as it is now.
    (cd "$root" && git ls-files --cached --others --exclude-standard -z | xargs -0 cp --parents --target-directory "$copy")
    env -u CARGO_TARGET_DIR \
        RUSTFLAGS="--remap-path-prefix=$copy=hangpose --remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=cargo" \
        sh -c 'cmake -S "$0" -B "$0/build/link" -DHANGPOSE_CARGO_DIR="$0/target" >"$0/log" && cmake --build "$0/build/link" --target hangpose_static >>"$0/log" 2>&1' "$copy" ||
        { cat "$copy/log" >&2; exit 1; }
    sha256sum <"$copy/build/link/libhangpose.a"
}

first=$(build here)
second=$(build a/much/longer/path/somewhere/else)
if [ "$first" != "$second" ]; then
    echo "reproducible: libhangpose.a differs between two folders: ${first%% *} and ${second%% *}" >&2
    exit 1
fi
echo "reproducible: libhangpose.a is ${first%% *} from both folders"
