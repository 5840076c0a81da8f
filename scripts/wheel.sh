#!/usr/bin/env bash
# Builds the wheel of the Python module for every Linux with glibc 2.28 or later and Python 3.10 or later, and its
# source distribution: build/dist/. The compiler of zig links against the symbols of that glibc, so that no container is
# needed.
set -euo pipefail
cd "$(dirname "$0")/.."

venv=build/wheel
[ -x $venv/bin/python ] || python3 -m venv $venv
if ! cmp -s scripts/wheel-requirements.txt $venv/requirements.txt; then
    $venv/bin/python -m pip install --quiet --disable-pip-version-check --requirement scripts/wheel-requirements.txt
    cp scripts/wheel-requirements.txt $venv/requirements.txt
fi
export PATH=$PWD/$venv/bin:$PATH

mkdir -p build/dist
rm -f build/dist/hangpose-*.whl build/dist/hangpose-*.tar.gz
maturin build --manifest-path python/Cargo.toml --zig --compatibility manylinux_2_28 --out build/dist
maturin sdist --manifest-path python/Cargo.toml --out build/dist

wheel=(build/dist/hangpose-*.whl)
auditwheel show "${wheel[0]}" | tee build/wheel/platform.txt
tr -s '[:space:]' ' ' <build/wheel/platform.txt |
    grep -q 'consistent with the following platform tag: "manylinux_2_\(1[0-9]\|2[0-8]\)_' ||
    { echo "wheel.sh: the wheel needs more than manylinux_2_28" >&2; exit 1; }

# A fresh environment loads the wheel and predicts.
rm -rf build/wheel-check
python3 -m venv build/wheel-check
build/wheel-check/bin/python -m pip install --quiet --disable-pip-version-check "${wheel[0]}"
build/wheel-check/bin/python -c '
import hangpose
mug, hook = hangpose.Object("samples/mug.obj"), hangpose.Supporter("samples/hook.ply")
print(hangpose.predict(mug, hook).best)
'
ls -l build/dist
