#!/usr/bin/env bash
# Runs the fuzz targets in fuzz/ under libFuzzer and AddressSanitizer, for so many seconds in all: `scripts/fuzz.sh SECONDS`.
# What is found of new ways through the library stays in build/fuzz, for the next run. An input that breaks a promise ends
# the run; the last lines say where it is and how to keep it as a test.
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
export PATH=$PWD/build/tools/bin:$PATH

# AddressSanitizer is not yet stable in rustc. Link-time optimisation would take as long as the run.
export RUSTC_BOOTSTRAP=1 CARGO_PROFILE_RELEASE_LTO=off CARGO_PROFILE_RELEASE_CODEGEN_UNITS=16
target_dir=${CARGO_TARGET_DIR:-$PWD/target}/fuzz
cargo fuzz build --fuzz-dir fuzz --features libfuzzer --target-dir "$target_dir"
programs=$(echo "$target_dir"/*/release)
env -u RUSTC_BOOTSTRAP cargo run --quiet -p fuzz --example seeds -- "$folder/seeds"

# The C++ of meshoptimizer defines the same constants in two of its files, which does no harm.
export ASAN_OPTIONS=detect_odr_violation=0
summary=()
for target in "${targets[@]}"; do
    mkdir -p "$folder/corpus/$target" "$folder/found"
    options=(-max_total_time=$((seconds / ${#targets[@]})) -max_len=4096 -len_control=20 -timeout=30 -rss_limit_mb=2048
        -malloc_limit_mb=256 -print_final_stats=1 -artifact_prefix="$folder/found/$target-")
    [ ! -e "fuzz/dictionaries/$target.dict" ] || options+=(-dict="fuzz/dictionaries/$target.dict")
    log=$folder/$target.log
    if ! "$programs/$target" "${options[@]}" "$folder/corpus/$target" "$folder/seeds/$target" >"$log" 2>&1; then
        grep -aE -A 12 'panicked|ERROR: ' "$log" >&2 || tail -n 40 "$log" >&2
        found=$(grep -aoE 'Test unit written to .*' "$log" | tail -n 1 | sed 's/Test unit written to //')
        echo "fuzz: target $target breaks a promise with the input ${found:-that $log shows}" >&2
        echo "fuzz: make it smaller by: ASAN_OPTIONS=$ASAN_OPTIONS $programs/$target -minimize_crash=1 -runs=100000 $found" >&2
        echo "fuzz: keep it in fuzz/found/$target, where \`cargo test -p fuzz\` runs it, and mend what it found" >&2
        exit 1
    fi
    runs=$(grep -a 'stat::number_of_executed_units' "$log" | grep -oE '[0-9]+')
    covered=$(grep -aoE 'cov: [0-9]+ ft: [0-9]+' "$log" | tail -n 1)
    summary+=("$target: $runs executions, $covered")
done
printf 'fuzz: %s\n' "${summary[@]}"
