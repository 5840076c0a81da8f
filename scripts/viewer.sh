#!/usr/bin/env bash
# Checks that host/src/view/page.html is what viewer/ builds, and tests the page in Chromium:
# scripts/viewer.sh [page.html ...], where the pages are some that hangpose wrote. Pictures go to build/view.
set -euo pipefail
cd "$(dirname "$0")/../viewer"

pages=()
for page in "$@"; do
    pages+=("$(cd "$OLDPWD" && realpath "$page")")
done

# What is installed says by this file which lock it is from.
installed=node_modules/.from-lock
if ! cmp -s package-lock.json "$installed"; then
    npm ci --silent --no-audit --no-fund --ignore-scripts
    cp package-lock.json "$installed"
fi
npm run --silent check

log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! HANGPOSE_PAGES=$(IFS=:; echo "${pages[*]:-}") npm run --silent test >"$log" 2>&1; then
    cat "$log" >&2
    exit 1
fi
grep -E '(tests|pass|fail|duration_ms) [0-9.]+$' "$log" | tail -4
echo "The page holds: host/src/view/page.html ($(wc -c <../host/src/view/page.html) bytes); pictures in build/view"
