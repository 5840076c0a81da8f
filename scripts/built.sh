#!/usr/bin/env bash
# Builds what `cargo test --workspace` builds, with the same features, so that no check compiles a crate a second time: the
# command target/debug/hangpose, the Python module, and the programs in target/debug/examples.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo build --quiet --locked --workspace --lib --bins --tests --examples
