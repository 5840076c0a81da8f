"""The example for Dask gives the bytes of a single process."""

import csv
import math
import shutil
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


def ring():
    """A ring of 30 mm in few triangles, as OBJ."""
    around, across = 24, 10
    lines = []
    for i in range(around):
        for j in range(across):
            a, b = 2 * math.pi * i / around, 2 * math.pi * j / across
            r = 0.03 + 0.003 * math.cos(b)
            lines.append(f"v {r * math.cos(a):.6f} {0.003 * math.sin(b):.6f} {r * math.sin(a):.6f}")
    for i in range(around):
        for j in range(across):
            corners = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]
            lines.append("f " + " ".join(str(k % around * across + m % across + 1) for k, m in corners))
    return "\n".join(lines) + "\n"


def test_two_workers_write_what_one_process_writes(tmp_path):
    (tmp_path / "ring.obj").write_text(ring())
    for name in ("hook.ply", "mug_tree.ply"):
        shutil.copy(SAMPLES / name, tmp_path)
    pairs = tmp_path / "pairs.csv"
    with open(pairs, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["id", "object", "supporter", "object_scale"])
        for number in range(200):
            # Seldom a file that is missing.
            name = "missing.obj" if number % 50 == 7 else "ring.obj"
            supporter = ["hook.ply", "mug_tree.ply"][number % 2]
            writer.writerow([f"pair {number}", name, supporter, 1 + number // 50 / 10])
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
    # The scale is heeded: a larger ring hangs lower.
    first, last = hung[0], next(row for row in hung if row["id"] == "pair 150")
    assert float(last["m23"]) < float(first["m23"]) - 0.005


def test_unknown_columns_are_refused(tmp_path):
    pairs = tmp_path / "pairs.csv"
    pairs.write_text("object,supporter,colour\n")
    done = subprocess.run([sys.executable, EXAMPLE, pairs, tmp_path / "out.csv"], capture_output=True, text=True)
    assert done.returncode == 1 and "the column colour is unknown" in done.stderr
