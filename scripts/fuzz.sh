#!/usr/bin/env bash
# Runs the fuzz targets in fuzz/ under libFuzzer and AddressSanitizer, for so many seconds in all:
# `scripts/fuzz.sh SECONDS [TARGET...]`. What is found of new ways through the library stays in build/fuzz, for the next run,
# and the last lines count all runs there: seconds of a processor, executions, and edges of the program that were covered.
# An input that breaks a promise ends the run; the last lines say where it is and how to keep it as a test.
set -euo pipefail
cd "$(dirname "$0")/.."
targets=(files models images calls)
folder=$PWD/build/fuzz

# `scripts/fuzz.sh --keep` writes fuzz/corpus anew: of what build/fuzz has learned the inputs that took new ways last,
# each up to 400 bytes, the last 100 for each target.
if [ "${1:-}" = --keep ]; then
    for target in "${targets[@]}"; do
        rm -rf "fuzz/corpus/$target"
        mkdir -p "fuzz/corpus/$target"
        find "$folder/corpus/$target" -type f -size -401c -printf '%T@ %s %p\n' | sort -n | tail -n 100 |
            while read -r _ _ file; do cp "$file" "fuzz/corpus/$target/"; done
    done
    exit
fi
seconds=${1:-60}
[ $# -le 1 ] || targets=("${@:2}")
export PATH=$PWD/build/tools/bin:$PATH

# AddressSanitizer is not yet stable in rustc. Link-time optimisation would take as long as the run.
export RUSTC_BOOTSTRAP=1 CARGO_PROFILE_RELEASE_LTO=off CARGO_PROFILE_RELEASE_CODEGEN_UNITS=16
target_dir=${CARGO_TARGET_DIR:-$PWD/target}/fuzz
cargo fuzz build --fuzz-dir fuzz --features libfuzzer --target-dir "$target_dir"
programs=$(echo "$target_dir"/*/release)
env -u RUSTC_BOOTSTRAP cargo run --quiet -p fuzz --example seeds -- "$folder/seeds"

# The C++ of meshoptimizer defines the same constants in two of its files, which does no harm.
export ASAN_OPTIONS=detect_odr_violation=0
for target in "${targets[@]}"; do
    mkdir -p "$folder/corpus/$target" "$folder/found"
    options=(-max_total_time=$((seconds / ${#targets[@]})) -max_len=4096 -len_control=20 -timeout=30 -rss_limit_mb=2048
        -malloc_limit_mb=256 -print_final_stats=1 -artifact_prefix="$folder/found/$target-")
    [ ! -e "fuzz/dictionaries/$target.dict" ] || options+=(-dict="fuzz/dictionaries/$target.dict")
    log=$folder/$target.log
    # Run in a shell of its own, so that its last line, of `times`, is that of the target alone.
    passed=yes
    (
        "$programs/$target" "${options[@]}" "$folder/corpus/$target" "$folder/seeds/$target" || touch "$log.failed"
        times
    ) >"$log" 2>&1
    rm "$log.failed" 2>/dev/null && passed=no
    runs=$(grep -aoE 'number_of_executed_units: *[0-9]+' "$log" | tail -n 1 | grep -oE '[0-9]+$' || echo 0)
    covered=$(grep -aoE 'cov: [0-9]+' "$log" | tail -n 1 | grep -oE '[0-9]+' || echo 0)
    used=$(tail -n 1 "$log" | sed 's/[ms]/ /g' | awk '{ print int(60 * $1 + $2) }')
    printf '%s\t%s\t%s\t%s\n' "$target" "$used" "$runs" "$covered" >>"$folder/runs.tsv"
    if [ $passed = no ]; then
        grep -aE -A 12 'panicked|ERROR: ' "$log" >&2 || tail -n 40 "$log" >&2
        found=$(grep -aoE 'Test unit written to .*' "$log" | tail -n 1 | sed 's/Test unit written to //')
        echo "fuzz: target $target breaks a promise with the input ${found:-that $log shows}" >&2
        echo "fuzz: make it smaller by: ASAN_OPTIONS=$ASAN_OPTIONS $programs/$target -minimize_crash=1 -runs=100000 $found" >&2
        echo "fuzz: keep it in fuzz/found/$target, where \`cargo test -p fuzz\` runs it, and mend what it found" >&2
        exit 1
    fi
    echo "fuzz: $target: $runs executions, $covered edges covered, $used seconds of a processor"
done
awk -F '\t' '
    { seconds[$1] += $2; runs[$1] += $3; if ($4 > edges[$1]) edges[$1] = $4; all += $2 }
    END {
        for (target in runs)
            printf "fuzz: all runs of %s: %d executions, %d edges covered, %.2f hours of a processor\n", target, runs[target], edges[target], seconds[target] / 3600
        printf "fuzz: all runs: %.2f hours of a processor\n", all / 3600
    }' "$folder/runs.tsv"
