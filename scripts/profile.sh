#!/usr/bin/env bash
# `make profile`: where the time of predictions goes. Writes build/profile.svg, a flame graph, and build/profile.txt, the
# functions by their own time. Options go to `speed`, for example --profile default --pairs 44 --triangles 20000.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
command -v perf >/dev/null || {
    echo "profile: perf was not found: install it, for example Debian's linux-perf" >&2
    exit 1
}
inferno=$root/build/tools/bin
[ -x "$inferno/inferno-flamegraph" ] || {
    echo "profile: inferno was not found: run scripts/setup.sh profile" >&2
    exit 1
}
options=("$@")
[ $# -gt 0 ] || options=(--profile default --pairs 22 --triangles 20000 --runs 1)
# Frame pointers make the stacks that perf records complete and small.
target_dir=${CARGO_TARGET_DIR:-$root/target}/profile
RUSTFLAGS="-C force-frame-pointers=yes" cargo build --profile profiling -p host-tests --bin speed --target-dir "$target_dir"
mkdir -p build
data=$(mktemp)
trap 'rm -f "$data"' EXIT
# The clock of the processor's time, since virtual machines have no counters of cycles.
perf record --event cpu-clock --freq 997 --call-graph fp --output "$data" -- "$target_dir/profiling/speed" "${options[@]}" || {
    echo "profile: perf could not record; as another user than root, set kernel.perf_event_paranoid to 2 or less" >&2
    exit 1
}
# Only what is measured: not the generation of shapes and clouds.
perf script --input "$data" 2>/dev/null | "$inferno/inferno-collapse-perf" | { grep 'performance::stages::measure' || true; } |
    sed -E 's/^.*performance::stages::measure[^;]*;//' >build/profile.folded
[ -s build/profile.folded ] || {
    echo "profile: perf recorded no predictions" >&2
    exit 1
}
"$inferno/inferno-flamegraph" --title "hangpose: ${options[*]}" build/profile.folded >build/profile.svg
awk '{ count = $NF; sub(/ [0-9]+$/, ""); n = split($0, frames, ";"); own[frames[n]] += count; all += count }
    END { for (frame in own) printf "%6.2f %%  %s\n", 100 * own[frame] / all, frame }' build/profile.folded |
    sort -rn >build/profile.txt
head -12 build/profile.txt || true
echo "profile: build/profile.svg, build/profile.txt"
