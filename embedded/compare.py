#!/usr/bin/env python3
"""Compares the hashes that a program printed with the stored ones, and says which stage of which pair differs.

compare.py STORED FOUND WHO [--part]

WHO is who found them. With --part, not all of the stored pairs need be there.
"""
import pathlib
import re
import sys

STAGES = ("scan", "object", "supporter", "poses", "path")
ROW = re.compile(r"((?:(?:[0-9a-f]{8}|-) +){5})(\d+) poses  (.*)")


def read(path):
    """The hashes and the number of poses by the name of the pair."""
    rows = map(ROW.fullmatch, pathlib.Path(path).read_text().splitlines())
    return {row[3]: (row[1].split(), int(row[2])) for row in rows if row}


def main():
    stored, found, who, *options = sys.argv[1:]
    stored, found = read(stored), read(found)
    wrong = [f"{name}: not in embedded/pairs.txt" for name in found if name not in stored]
    if "--part" not in options:
        wrong += [f"{name}: was not found" for name in stored if name not in found]
    for name in stored.keys() & found.keys():
        stages = [
            f"{stage} {old} became {new}" for stage, old, new in zip(STAGES, stored[name][0], found[name][0]) if old != new
        ]
        if stages:
            wrong.append(f"{name}: {', '.join(stages)}; {stored[name][1]} poses, now {found[name][1]}")
    if wrong or not found:
        print(*sorted(wrong or ["nothing was found"]), sep="\n", file=sys.stderr)
        sys.exit(
            f"{who} finds other bits in {len(wrong)} pairs, see above. The first stage that differs is where the numbers"
            " changed. If that was meant, run embedded/same_bits.sh --write"
        )
    print(f"{who}: the stored bits for {len(found)} pairs")


if __name__ == "__main__":
    main()
