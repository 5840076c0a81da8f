"""What the tests share: the samples, and the command as the oracle."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path
from typing import Any, Callable

import hangpose
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
SAMPLES = ROOT / "samples"

Command = Callable[..., Any]


@pytest.fixture(scope="session")
def command() -> Command:
    """Runs the command of the same source and returns its JSON."""
    program = os.environ.get("HANGPOSE_COMMAND", "hangpose")

    def run(*arguments: object) -> Any:
        done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, cwd=ROOT)
        assert done.returncode in (0, 3), done.stderr
        return json.loads(done.stdout) if done.stdout.startswith("{") else done.stdout

    return run


@pytest.fixture(scope="session")
def mug() -> hangpose.Object:
    return hangpose.Object(SAMPLES / "mug.obj")


@pytest.fixture(scope="session")
def hook() -> hangpose.Supporter:
    return hangpose.Supporter(SAMPLES / "hook.ply")


@pytest.fixture(scope="session")
def prediction(mug: hangpose.Object, hook: hangpose.Supporter) -> hangpose.Prediction:
    return hangpose.predict(mug, hook)


@pytest.fixture(scope="session")
def mug_arrays() -> tuple[np.ndarray, np.ndarray]:
    """Vertices and triangles of the sample mug, read without hangpose."""
    lines = [line.split() for line in (SAMPLES / "mug.obj").read_text().splitlines()]
    vertices = np.array([line[1:4] for line in lines if line[:1] == ["v"]], dtype=np.float32)
    faces = [[corner.split("/")[0] for corner in line[1:]] for line in lines if line[:1] == ["f"]]
    return vertices, np.array(faces, dtype=np.uint32) - 1


@pytest.fixture(scope="session")
def hook_arrays() -> tuple[np.ndarray, np.ndarray]:
    """Points and normals of the sample hook, read without hangpose."""
    content = (SAMPLES / "hook.ply").read_bytes()
    end = content.index(b"end_header\n") + len(b"end_header\n")
    numbers = np.frombuffer(content[end:], dtype="<f4").reshape(-1, 6)
    return numbers[:, :3].copy(), numbers[:, 3:].copy()


def same(left: hangpose.Prediction, right: hangpose.Prediction) -> bool:
    """Whether two predictions have the same poses, bit by bit."""
    return len(left.poses) == len(right.poses) > 0 and all(
        np.array_equal(a.release, b.release) and np.array_equal(a.rest, b.rest) and a.margin == b.margin
        for a, b in zip(left.poses, right.poses)
    )
