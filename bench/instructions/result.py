"""Gathers what embedded/pairs.c and the counters printed: instructions of each stage by processor and profile.

result.py FOLDER OUT [MISSING ...]
"""
import json
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "embedded"))
import stages

# The names of the stages in the report, and of the pairs of each profile.
STAGES = {"object": "object", "supporter": "supporter", "matching": "poses"}
PROFILES = {"paper": "mug on hook, paper", "default": "mug on hook"}


def read(text):
    """The instructions by profile and stage, and what was predicted."""
    pairs = {name: (counts, found) for name, counts, found in stages.pairs(text)}
    counts = {
        profile: {stage: pairs[name][0][printed] for stage, printed in STAGES.items()} for profile, name in PROFILES.items()
    }
    return {"counts": counts, "predicted": [pairs[name][1] for name in PROFILES.values()]}


def main():
    folder, out, *missing = sys.argv[1:]
    files = sorted(pathlib.Path(folder).glob("*.txt"))
    result = {file.stem: read(file.read_text()) for file in files}
    if len({tuple(found["predicted"]) for found in result.values()}) > 1:
        sys.exit(f"the processors predict different poses: {[found['predicted'] for found in result.values()]}")
    pathlib.Path(out).write_text(json.dumps({"processors": result, "missing": missing}))
    for name, found in result.items():
        print(name, found["counts"])
    print("\n".join(missing))


if __name__ == "__main__":
    main()
