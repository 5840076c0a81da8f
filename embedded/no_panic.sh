#!/usr/bin/env bash
# Tests that only the functions of embedded/panics.txt can panic, in a program that uses every function of the C
# interface, on x86-64 and on a Cortex-M7.
#   no_panic.sh [--write]      --write counts the places anew
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
source "$root/embedded/every.sh"
"$root/embedded/panics.py" "$@" "$every_x86_64" objdump addr2line "$every_m7" arm-none-eabi-objdump arm-none-eabi-addr2line
