#!/usr/bin/env bash
# Tests that only the places of embedded/panics.txt can panic, in programs that use every function of the C interface,
# on x86-64 and on a Cortex-M7, with a panic handler that keeps the places.
#   no_panic.sh [--write]      --write counts the places anew
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
source "$root/embedded/every.sh"
link_every "$root/build/embedded/every_placed" "--cfg panic_places"
"$root/embedded/panics.py" "$@" "$root/build/embedded/every_placed/x86-64" "$root/build/embedded/every_placed/cortex-m7"
