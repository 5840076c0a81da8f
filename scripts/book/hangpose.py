"""The program `hangpose`, its results on the samples, and the shapes of the samples, for the figures of the book."""

import json
import os
import subprocess
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ["HANGPOSE"]


def _json(arguments):
    run = subprocess.run([PROGRAM, *arguments], cwd=ROOT, capture_output=True, text=True, check=False)
    if run.returncode not in (0, 3):
        raise SystemExit(f"figures: hangpose {' '.join(arguments)}: {run.stderr}")
    return json.loads(run.stdout)


@cache
def _with(arguments, params):
    """The result of a command whose parameters differ from the profile's by `params`, lines of TOML."""
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
        file.write(params)
        file.flush()
        return _json([*arguments, "--params", file.name])


def inspect(sample, *options, params=""):
    return _with(("inspect", f"samples/{sample}", "--json", *options), params)


def predict(item, supporter, *options, params=""):
    files = ("--object", f"samples/{item}", "--supporter", f"samples/{supporter}")
    return _with(("predict", *files, "--json", "-", *options), params)


class Mesh:
    """A triangle mesh of `samples/`."""

    def __init__(self, sample):
        lines = [line.split() for line in (ROOT / "samples" / sample).read_text().splitlines()]
        self.vertices = np.array([line[1:4] for line in lines if line[:1] == ["v"]], float)
        corners = [[corner.split("/")[0] for corner in line[1:4]] for line in lines if line[:1] == ["f"]]
        self.triangles = np.array(corners, int) - 1

    def at(self, pose):
        """The corners of the triangles at a pose, a 4 x 4 matrix."""
        pose = np.asarray(pose, float).reshape(4, 4)
        return (self.vertices @ pose[:3, :3].T + pose[:3, 3])[self.triangles]


def section(corners, axis, height):
    """The segments in which triangles cut the plane where the coordinate `axis` is `height`, without it."""
    others = [i for i in range(3) if i != axis]
    above = corners[:, :, axis] > height
    segments = []
    for triangle, is_above in zip(corners, above, strict=True):
        if is_above.all() or not is_above.any():
            continue
        ends = []
        for i, j in ((0, 1), (1, 2), (2, 0)):
            if is_above[i] != is_above[j]:
                share = (height - triangle[i, axis]) / (triangle[j, axis] - triangle[i, axis])
                ends.append((triangle[i] + share * (triangle[j] - triangle[i]))[others])
        segments.append(ends)
    return np.array(segments)


def outline(corners, eye):
    """The edges at which the surface turns away from an eye in this direction: pairs of points in space."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    faces = normals @ np.asarray(eye, float) > 0
    sides = {}
    for triangle, is_towards in zip(np.round(corners, 7), faces, strict=True):
        for i, j in ((0, 1), (1, 2), (2, 0)):
            edge = tuple(sorted((tuple(triangle[i]), tuple(triangle[j]))))
            sides.setdefault(edge, []).append(bool(is_towards))
    return np.array([edge for edge, seen in sides.items() if len(set(seen)) == 2])


def pose_of(position, quaternion_xyzw):
    x, y, z, w = quaternion_xyzw
    pose = np.eye(4)
    pose[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    pose[:3, 3] = position
    return pose
