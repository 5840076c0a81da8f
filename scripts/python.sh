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

# The wheel is built by maturin: scripts/wheel.sh.
scripts/built.sh
target=$(cargo metadata --format-version 1 --no-deps |
    $venv/bin/python -c 'import json, sys; print(json.load(sys.stdin)["target_directory"])')
site=$($venv/bin/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
rm -rf "$site/hangpose"
cp -r python/hangpose "$site/hangpose"
cp "$target/debug/lib_hangpose.so" "$site/hangpose/_hangpose.abi3.so"
export HANGPOSE_COMMAND=$target/debug/hangpose MYPY_CACHE_DIR=$PWD/$venv/mypy
$venv/bin/python -m pytest -q -o cache_dir="$PWD/$venv/pytest" python/tests "$@"
