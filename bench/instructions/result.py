"""Gathers what predict.c and the counters printed: instructions of each stage by processor and profile.

result.py FOLDER OUT [MISSING ...]
"""
import json
import pathlib
import re
import sys

STAGES = ("object", "supporter", "matching")
PROFILES = ("paper", "default")


def read(text):
    """The instructions by profile and stage, and what was predicted."""
    marks = [tuple(map(int, mark)) for mark in re.findall(r"mark (\d+) (\d+)", text)]
    counts = {}
    for index, profile in enumerate(PROFILES):
        four = marks[4 * index : 4 * index + 4]
        if [stage for stage, _ in four] != [0, 1, 2, 3]:
            raise ValueError(f"marks are missing:\n{text}")
        counts[profile] = {stage: four[k + 1][1] - four[k][1] for k, stage in enumerate(STAGES)}
    return {"counts": counts, "predicted": re.findall(r"profile .*", text)}


def main():
    folder, out, *missing = sys.argv[1:]
    files = sorted(pathlib.Path(folder).glob("*.txt"))
    result = {file.stem: read(file.read_text()) for file in files}
    poses = {tuple(line.split(", best")[1].rsplit(",", 1)[0] for line in found["predicted"]) for found in result.values()}
    if len(poses) > 1:
        sys.exit(f"the processors predict different poses: {poses}")
    pathlib.Path(out).write_text(json.dumps({"processors": result, "missing": missing}))
    for name, found in result.items():
        print(name, found["counts"])
    print("\n".join(missing))


if __name__ == "__main__":
    main()
