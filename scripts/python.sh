#!/usr/bin/env bash
# Builds the Python module, installs it in a virtual environment in build/python and runs its tests there. Quick if
# nothing changed. Arguments are passed on to pytest.
set -euo pipefail
cd "$(dirname "$0")/.."

venv=build/python
[ -x $venv/bin/python ] || python3 -m venv $venv
if ! cmp -s python/tests/requirements.txt $venv/requirements.txt; then
    $venv/bin/python -m pip install --quiet --disable-pip-version-check --requirement python/tests/requirements.txt
    cp python/tests/requirements.txt $venv/requirements.txt
fi

# The command is the oracle. The workspace as a whole has the features with which `cargo test --workspace` compiled it.
cargo build --quiet --workspace --bin hangpose
target=$(cargo metadata --format-version 1 --no-deps |
    $venv/bin/python -c 'import json, sys; print(json.load(sys.stdin)["target_directory"])')
export VIRTUAL_ENV=$PWD/$venv
if ! $venv/bin/maturin develop --profile dev --manifest-path python/Cargo.toml >$venv/maturin.log 2>&1; then
    cat $venv/maturin.log >&2
    exit 1
fi
export HANGPOSE_COMMAND=$target/debug/hangpose MYPY_CACHE_DIR=$PWD/$venv/mypy
$venv/bin/python -m pytest -q -o cache_dir="$PWD/$venv/pytest" python/tests "$@"
