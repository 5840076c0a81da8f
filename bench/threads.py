#!/usr/bin/env python3
"""Times single predictions and a table of pairs with one thread and with two.

  threads.py --command HANGPOSE --out FILE [--runs 3] FOLDER

FOLDER holds `pairs.json`, as `speed export` writes it. The runs of one and two threads take turns.
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import time


def run(command):
    result = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
    if result.returncode not in (0, 3):
        sys.exit(result.stderr)
    return result.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--command", required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("folder", type=pathlib.Path)
    args = parser.parse_args()
    pairs = json.loads((args.folder / "pairs.json").read_text())
    single = {"1": [], "2": []}
    for pair in pairs:
        best = {"1": float("inf"), "2": float("inf")}
        for _ in range(args.runs):
            for threads in best:
                text = run([args.command, "predict", "--object", args.folder / pair["object"], "--supporter",
                            args.folder / pair["supporter"], "--threads", threads, "--json", "-"])
                seconds = json.loads(text)["stats"]["seconds"]
                best[threads] = min(best[threads], seconds["total"] - seconds["read"])
        for threads, seconds in best.items():
            single[threads].append(seconds)
    batch = {"1": [], "2": []}
    with tempfile.TemporaryDirectory() as scratch:
        rows = [[str((args.folder / pair[kind]).resolve()) for kind in ("object", "supporter")] for pair in pairs]
        table = pathlib.Path(scratch) / "pairs.csv"
        with table.open("w", newline="") as file:
            csv.writer(file).writerows([["object", "supporter"], *rows])
        results = set()
        for _ in range(args.runs):
            for jobs in batch:
                out = pathlib.Path(scratch) / f"{jobs}.csv"
                start = time.perf_counter()
                run([args.command, "batch", table, "--output", out, "--jobs", jobs])
                batch[jobs].append(time.perf_counter() - start)
                results.add(out.read_bytes())
        if len(results) != 1:
            sys.exit("the result of a table depends on the number of threads")
    args.out.write_text(json.dumps({"single": single, "batch": batch, "pairs": len(pairs)}))
    print(f"one prediction {sum(single['1']) / sum(single['2']):.2f} times as fast, "
          f"a table {min(batch['1']) / min(batch['2']):.2f}")


if __name__ == "__main__":
    main()
