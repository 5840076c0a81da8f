"""Prints how often the best poses on clouds of so many points hang, and how often those do of which 95 % and more is said.

Reads rows that `tables --points N --json DIR/N.jsonl` writes. `make calibrate` runs both.
"""

import json
import sys
from pathlib import Path

SURE = 0.95


def hangs(outcome):
    return outcome["clear"] and outcome["holds"] and outcome["honest"]


def main():
    print("points, pairs, with a pose, hang, said 95 % or more, of these hang")
    for path in map(Path, sys.argv[1:]):
        with open(path) as file:
            rows = [row for row in map(json.loads, file) if row["fits"]]
        best = [row["outcomes"][0] for row in rows if row["outcomes"]]
        sure = [outcome for outcome in best if outcome["said"]["probability"] >= SURE]
        counts = [len(rows), len(best), sum(map(hangs, best)), len(sure), sum(map(hangs, sure))]
        print(f"{path.stem:>6}, " + ", ".join(map(str, counts)))


main()
