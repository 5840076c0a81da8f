#!/usr/bin/env bash
# Checks what the workspace is made of: licences, sources and advisories of the dependencies, that they build without a
# network, and with the oldest Rust that is promised. Writes a bill of materials (CycloneDX) of the command and of the library
# to build/sbom.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
export PATH=$root/build/tools/bin:$PATH
say() { echo "supply: $*"; }
fail() { echo "supply: $*" >&2; exit 1; }

# ---- licences, bans, sources, advisories
cargo deny --locked --log-level error check licenses bans sources
say "licences, bans and sources of the dependencies are as deny.toml says"
if cargo deny --locked --log-level error fetch db >/dev/null 2>&1; then
    cargo deny --locked --log-level error check --disable-fetch advisories
    say "no dependency has an advisory"
else
    say "advisories were NOT checked: their database (github.com/RustSec/advisory-db) cannot be reached from here"
fi

# ---- bill of materials
rm -rf build/sbom
mkdir -p build/sbom
cargo cyclonedx --quiet --format json --spec-version 1.5 --all --target x86_64-unknown-linux-gnu --override-filename sbom
mv host/sbom.json build/sbom/hangpose.cdx.json
mv ffi/sbom.json build/sbom/hangpose-ffi.cdx.json
find . -name sbom.json -not -path './build/*' -not -path './target/*' -delete
python3 - build/sbom/*.json <<'END'
import json, sys
for path in sys.argv[1:]:
    components = json.load(open(path))["components"]
    lacking = [c["name"] for c in components if not c.get("licenses") or not c.get("purl")]
    if lacking or not components:
        sys.exit(f"supply: {path}: components without a licence or a name: {lacking}")
    print(f"supply: {path} lists {len(components)} components, each with its licence")
END

# ---- without a network, from vendored sources and an empty home of cargo
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/source/.cargo" "$folder/home"
git ls-files --cached --others --exclude-standard -z | xargs -0 cp --parents --target-directory "$folder/source"
cargo vendor --locked --versioned-dirs "$folder/source/vendor" 2>"$folder/log" >"$folder/source/.cargo/config.toml" ||
    { cat "$folder/log" >&2; exit 1; }
cut_off=()
unshare --net --map-root-user true 2>/dev/null && cut_off=(unshare --net --map-root-user)
# `set -e` does not hold on the left of ||.
(
    cd "$folder/source" &&
    export CARGO_HOME=$folder/home CARGO_TARGET_DIR=$folder/target &&
    "${cut_off[@]}" cargo rustc --quiet --frozen --release -p hangpose-ffi --features archive --crate-type staticlib &&
    "${cut_off[@]}" cargo check --quiet --frozen --workspace --all-targets
) || fail "the workspace does not build from vendored sources without a network"
say "the workspace builds from vendored sources${cut_off[*]:+, with all networks taken away}"

# ---- the oldest Rust
oldest=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)
if command -v rustup >/dev/null && rustup run "$oldest" rustc --version >/dev/null 2>&1; then
    CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$root/target}/msrv rustup run "$oldest" cargo check --quiet --locked --workspace ||
        fail "the workspace does not build with Rust $oldest, which Cargo.toml promises"
    say "the workspace builds with Rust $oldest"
else
    say "Rust $oldest was NOT tried: rustup cannot install it here"
fi
