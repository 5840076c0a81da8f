#!/usr/bin/env bash
# Packages the crates as cargo would publish them, and checks what the packages contain. Builds nothing; with --verify
# each crate is built from its package.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
fail() { echo "packages: $*" >&2; exit 1; }

crates="hangpose-core hangpose-ffi hangpose"
verify=--no-verify
if [ "${1:-}" = --verify ]; then verify=; fi
log=$(mktemp)
trap 'rm -f "$log"' EXIT
cargo package --locked --offline --allow-dirty $verify $(printf -- '-p %s ' $crates) >"$log" 2>&1 || {
    cat "$log" >&2
    fail "cargo package failed"
}
# No address of the project is known, so the manifests name none, and tests are left out on purpose. Nothing else may be
# missing.
if grep '^warning' "$log" | grep -vE 'manifest has no documentation, homepage or repository|ignoring test' >&2; then
    fail "cargo package warns, see above"
fi

version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)
for crate in $crates; do
    package=${CARGO_TARGET_DIR:-target}/package/$crate-$version.crate
    files=$(tar -tzf "$package" | sed "s|^$crate-$version/||" | sort)
    for needed in Cargo.toml Cargo.lock LICENSE-APACHE LICENSE-MIT README.md; do
        grep -qx "$needed" <<<"$files" || fail "$crate: $needed is not in the package"
    done
    other=$(grep -vxE 'Cargo\.(toml|toml\.orig|lock)|LICENSE-(APACHE|MIT)|README\.md|\.cargo_vcs_info\.json|(src|benches|examples)/.*\.(rs|txt)|src/view/page\.html' \
        <<<"$files" || true)
    [ -z "$other" ] || fail "$crate: the package has files that nobody needs:" $other
    # What is in a folder of the crate but not in its package would be missing where it is built.
    folder=${crate#hangpose-}
    [ "$folder" != hangpose ] || folder=host
    missing=$(comm -13 <(echo "$files") <(cd "$folder" && find src -type f | sort))
    [ -z "$missing" ] || fail "$crate: files are not in the package:" $missing
    echo "packages: $crate $version: $(wc -l <<<"$files") files, $(stat -c %s "$package") bytes"
done
