"""The example for Dask gives the bytes of a single process."""

import csv
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("hangpose")
pytest.importorskip("dask.distributed")

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "python" / "examples" / "dask_batch.py"
SAMPLES = ROOT / "samples"


def run(pairs, output, workers):
    subprocess.run([sys.executable, EXAMPLE, pairs, output, "--workers", str(workers)], check=True, timeout=300)
    return Path(output).read_bytes()


def test_two_workers_write_what_one_process_writes(tmp_path):
    pairs = tmp_path / "pairs.csv"
    objects = ["mug.obj", "scissors.obj", "missing.obj"]
    supporters = ["hook.ply", "mug_tree.ply"]
    with open(pairs, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["id", "object", "supporter"])
        for number in range(200):
            # Seldom the file that is missing.
            name = objects[2] if number % 50 == 7 else objects[number % 2]
            writer.writerow([f"pair {number}", SAMPLES / name, SAMPLES / supporters[number // 2 % 2]])
    alone = run(pairs, tmp_path / "alone.csv", 0)
    assert run(pairs, tmp_path / "workers.csv", 2) == alone

    rows = list(csv.DictReader(alone.decode().splitlines()))
    ids = list(dict.fromkeys(row["id"] for row in rows))
    assert ids == [f"pair {number}" for number in range(200)]
    errors = [row for row in rows if row["error"]]
    assert len(errors) == 4 and all("missing.obj" in row["error"] for row in errors)
    hung = [row for row in rows if row["rank"] == "1"]
    assert len(hung) == 196 and all(0.5 < float(row["probability"]) <= 1 for row in hung)
    # A row of a rotation matrix is a unit vector.
    for row in hung:
        assert abs(sum(float(row[f"m0{column}"]) ** 2 for column in range(3)) - 1) < 1e-4
