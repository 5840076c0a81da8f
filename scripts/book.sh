#!/usr/bin/env bash
# Builds the book in build/book and checks it and the README: scripts/book/check.py says what is checked.
#   --figures   draws the figures of docs/figures that are made by scripts/book/figures.py
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"

tools=build/book-tools
if ! cmp -s docs/book/requirements.txt "$tools/requirements.txt"; then
    rm -rf "$tools"
    python3 -m venv "$tools"
    "$tools/bin/python" -m pip install --quiet --disable-pip-version-check --requirement docs/book/requirements.txt
    cp docs/book/requirements.txt "$tools/"
fi
export PATH=$root/$tools/bin:$PATH MPLBACKEND=svg

if [ -z "${HANGPOSE:-}" ]; then
    scripts/built.sh
    HANGPOSE=${CARGO_TARGET_DIR:-$root/target}/debug/hangpose
fi
export HANGPOSE

if [ "${1:-}" = --figures ]; then
    exec python scripts/book/figures.py
fi

python scripts/book/figures.py --check &
figures=$!
python scripts/book/check.py &
check=$!
copy=$(mktemp -d)
trap 'rm -rf "$copy"; kill "$figures" "$check" 2>/dev/null || true' EXIT

# The pages link to source files of the repository: these are copied beside them.
rm -rf build/book
log=$(mdbook build docs --dest-dir "$root/build/book/docs" 2>&1) || { echo "$log" >&2; exit 1; }
if grep -E "WARN|ERROR" <<<"$log"; then
    echo "book: mdbook has complaints" >&2
    exit 1
fi
{ grep -rhoE '\]\((\.\./)+[^)#: ]+' docs/*.md docs/book/*.md || true; } | sed -E 's/\]\((\.\.\/)+//' | sort -u |
    while read -r path; do
        test -e "$path" || continue
        git ls-files --cached --others --exclude-standard -- "$path" | xargs cp --parents -t build/book
    done

# linkchecker gives up the rights of root, and may not be allowed to read here.
cp -r build/book "$copy/"
chmod -R a+rX "$copy"
printf '[AnchorCheck]\n[filtering]\ninternlinks=^file:\nignorewarnings=file-missing-slash\n' >"$copy/config"
linkchecker --config "$copy/config" --no-status --recursion-level=-1 "$copy/book/docs/index.html" >"$copy/links" 2>&1 ||
    { cat "$copy/links" >&2; exit 1; }
wait "$check"
wait "$figures"
echo "book: build/book/docs/index.html, all links lead somewhere"
