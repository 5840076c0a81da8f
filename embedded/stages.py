#!/usr/bin/env python3
"""Prints the instructions of each stage that embedded/pairs.c marked, and tests how much of the stack it used.

stages.py RESULT MOST_STACK
"""
import pathlib
import re
import sys

STAGES = ("scan", "object", "supporter", "poses", "path")


def pairs(text):
    """The name of each pair, its instructions by stage, and what was found."""
    marks, name = [], ""
    for line in text.splitlines():
        if mark := re.fullmatch(r"mark (\d+) (\d+)", line):
            marks.append((int(mark[1]), int(mark[2])))
        elif row := re.fullmatch(r".* poses  (.*)", line):
            name = row[1]
        elif line.startswith("    "):
            if [which for which, _ in marks] != list(range(len(marks))):
                raise ValueError(f"{name}: marks are missing:\n{text}")
            counts = [late - early for (_, early), (_, late) in zip(marks, marks[1:])]
            yield name, dict(zip(STAGES, counts)), line.strip()
            marks = []


def main():
    path, most_stack = sys.argv[1:]
    text = pathlib.Path(path).read_text()
    for name, counts, found in pairs(text):
        millions = ", ".join(f"{stage} {count / 1e6:.0f}" for stage, count in counts.items() if count > 1e5)
        print(f"    {name}: {found}; millions of instructions: {millions}")
    memory, stack = (int(re.search(rf"most {what} (\d+) bytes", text)[1]) for what in ("memory", "stack"))
    print(f"    at most {memory} bytes of memory for input, models and work, {stack} of stack")
    if stack > int(most_stack):
        sys.exit(f"embedded: the stack took {stack} bytes, more than {most_stack}")


if __name__ == "__main__":
    main()
