"""The module and the command of the same source give the same bits. The command prints `f32` in the shortest form that
reads back as the same number."""

from __future__ import annotations

import json
import struct
import zlib
from pathlib import Path
from typing import Any

import hangpose
import numpy as np
import pytest
from conftest import SAMPLES, Command


def single(value: Any) -> np.ndarray:
    """Numbers of the JSON as they were before they were printed."""
    return np.array(value, dtype=np.float64).astype(np.float32)


def assert_same(actual: Any, printed: Any) -> None:
    """Both are the same numbers in single precision."""
    actual = np.asarray(actual, dtype=np.float64)
    assert np.array_equal(actual.astype(np.float32), actual), "more than single precision"
    np.testing.assert_array_equal(actual.astype(np.float32).ravel(), single(printed).ravel())


def assert_same_poses(found: hangpose.Prediction, printed: dict[str, Any]) -> None:
    assert len(found.poses) == len(printed["poses"]) > 0
    for pose, expected in zip(found.poses, printed["poses"]):
        assert pose.rank == expected["rank"]
        assert_same(pose.release, expected["release_pose"])
        assert_same(pose.release_placement.position, expected["position"])
        assert_same(pose.release_placement.quaternion, expected["quaternion_xyzw"])
        assert pose.kind == expected["kind"]
        if pose.kind is None:
            assert pose.rest is pose.margin is pose.tolerance is pose.unseen is pose.probability is None
            assert_same(pose.cost, expected["cost"]["total"])
            continue
        assert pose.rest is not None and pose.cost is None
        assert_same(pose.rest, expected["rest_pose"])
        for name in ("sinking", "clearance", "probability", "robustness"):
            assert_same(getattr(pose, name), expected[name])
        for name in ("tolerance", "unseen", "margin"):
            part = vars(getattr(pose, name))
            assert part.keys() == expected[name].keys()
            for field, value in part.items():
                assert_same(value, expected[name][field])
        assert len(pose.contacts) == len(expected["contacts"]) > 0
        for contact, other in zip(pose.contacts, expected["contacts"]):
            for field, value in vars(contact).items():
                assert_same(value, other[field])
    counts = printed["stats"]["counts"]["settling"]
    assert found.counts == {name: counts[name] for name in found.counts}
    assert found.rejection is None and found.stopped is None


PAIRS = [
    ("mug.obj", "hook.ply", {}, []),
    ("mug.obj", "hook.obj", {}, []),
    ("scissors.obj", "mug_tree.ply", {"top": 3}, ["--top", 3]),
    ("mug.obj", "mug_tree.obj", {"here": (0.05, 0, 0.16), "here_radius": 0.03}, ["--here", "0.05,0,0.16,0.03"]),
    ("mug.obj", "mug_tree.ply", {"allow": "hooked", "prefer": ["balanced"]}, ["--allow", "hooked", "--prefer", "balanced"]),
    (
        "mug.obj",
        "mug_tree.ply",
        {
            "by": (0.0, 0.045, 0.05), "by_radius": 0.03, "approach": (0, 0, -1), "approach_angle": np.float32(np.pi / 4),
            "distinct": (0.05, np.float32(np.pi / 6)),
        },
        ["--by", "0,0.045,0.05,0.03", "--approach", "0,0,-1", "--approach-angle", 45, "--distinct", "0.05,30"],
    ),
]  # fmt: skip


@pytest.mark.parametrize(("thing", "holder", "options", "arguments"), PAIRS)
def test_predictions(command: Command, thing: str, holder: str, options: dict[str, Any], arguments: list[Any]) -> None:
    printed = command(
        "predict", "--object", SAMPLES / thing, "--supporter", SAMPLES / holder, "--json", "-", *arguments
    )
    found = hangpose.predict(hangpose.Object(SAMPLES / thing), hangpose.Supporter(SAMPLES / holder), **options)
    if not printed["poses"]:
        assert found.rejection is not None and not found.poses and found.best is None
        assert found.rejection.stage == printed["rejection"]["stage"]
        assert found.rejection.reason == printed["rejection"]["reason"]
        return
    assert_same_poses(found, printed)


def test_the_published_method(command: Command) -> None:
    files = ("--object", SAMPLES / "mug.obj", "--supporter", SAMPLES / "mug_tree.ply")
    printed = command("predict", *files, "--profile", "paper", "--json", "-")
    thing = hangpose.Object(SAMPLES / "mug.obj", params="paper")
    holder = hangpose.Supporter(SAMPLES / "mug_tree.ply", params="paper")
    assert_same_poses(hangpose.predict(thing, holder), printed)


def test_constants(command: Command, tmp_path: Path) -> None:
    changes = {"friction": 0.6, "clearance": 0.002, "seed": 7, "samples": 5000}
    file = tmp_path / "params.toml"
    file.write_text("".join(f"{name} = {value}\n" for name, value in changes.items()))
    files = ("--object", SAMPLES / "mug.obj", "--supporter", SAMPLES / "hook.obj", "--params", file)
    printed = command("predict", *files, "--json", "-")
    params = hangpose.Params(**changes)
    assert {**params, "gravity": list(params["gravity"])} == printed["params"]
    found = hangpose.predict(
        hangpose.Object(SAMPLES / "mug.obj", params=params), hangpose.Supporter(SAMPLES / "hook.obj", params=params)
    )
    assert_same_poses(found, printed)
    assert dict(hangpose.Params(file=file)) == dict(params)


def test_scale_axes_and_the_centre_of_mass(command: Command, mug_arrays: Any, hook_arrays: Any) -> None:
    files = ("--object", SAMPLES / "mug.obj", "--supporter", SAMPLES / "hook.ply", "--supporter-points", 5000)
    options = ("--object-scale", 0.9, "--object-up=-x", "--supporter-up", "y", "--com", "0.01,0.02,0.03")
    views = ("--viewpoint", "0.3,0.1,0.2", "--object-viewpoint", "0.3,0.2,0.1", "--gravity", "0,1,0")
    printed = command("predict", *files, *options, *views, "--json", "-")
    params = hangpose.Params(gravity=[0, 1, 0])
    thing = hangpose.Object(
        SAMPLES / "mug.obj", scale=0.9, up="-x", centre_of_mass=(0.01, 0.02, 0.03), viewpoints=[(0.3, 0.2, 0.1)],
        params=params,
    )  # fmt: skip
    holder = hangpose.Supporter(SAMPLES / "hook.ply", up="y", viewpoints=[(0.3, 0.1, 0.2)], params=params)
    found = hangpose.predict(thing, holder)
    if printed["poses"]:
        assert_same_poses(found, printed)
    else:
        assert found.rejection is not None and found.rejection.reason == printed["rejection"]["reason"]


def test_a_rejection(command: Command, tmp_path: Path) -> None:
    floor = tmp_path / "floor.xyz"
    points = [(0.01 * x, 0.01 * y, 0.0, 0.0, 0.0, -1.0) for x in range(20) for y in range(20)]
    floor.write_text("".join(" ".join(map(str, point)) + "\n" for point in points))
    printed = command("predict", "--object", SAMPLES / "mug.obj", "--supporter", floor, "--json", "-")
    found = hangpose.predict(hangpose.Object(SAMPLES / "mug.obj"), hangpose.Supporter(floor))
    assert not found.poses and found.best is None and found.rejection is not None
    assert found.rejection == hangpose.Rejection(printed["rejection"]["stage"], printed["rejection"]["reason"])


GRIPPER = hangpose.Gripper(
    parts=[hangpose.Capsule((-0.1, 0.048, 0.05), (0, 0.048, 0.05), 0.006, (0, 0.015, 0))], retreat=(-0.15, 0, 0)
)
GRIPPER_FILE = """retreat = [-0.15, 0, 0]
[[part]]
from = [-0.1, 0.048, 0.05]
to = [0, 0.048, 0.05]
radius = 0.006
opening = [0, 0.015, 0]
"""


@pytest.mark.parametrize("has_gripper", [False, True])
def test_paths(command: Command, tmp_path: Path, prediction: hangpose.Prediction, has_gripper: bool) -> None:
    gripper, start = tmp_path / "gripper.toml", SAMPLES / "mug_start.json"
    gripper.write_text(GRIPPER_FILE)
    files = ("--object", SAMPLES / "mug.obj", "--supporter", SAMPLES / "hook.ply")
    more = ("--gripper", gripper) if has_gripper else ("--start", start, "--workspace=-1,-1,-1,1,1,1")
    tried = [pose for pose in command("predict", *files, "--plan", *more, "--json", "-")["poses"] if "path" in pose]
    options: dict[str, Any] = {"gripper": GRIPPER}
    if not has_gripper:
        given = json.loads(start.read_text())
        at = (given["position"], given["quaternion_xyzw"])
        options = {"start": at, "workspace": ((-1, -1, -1), (1, 1, 1))}
    assert prediction.object is not None and prediction.supporter is not None
    *failed, reached = zip(tried, prediction.poses)
    for printed, pose in failed:
        with pytest.raises(hangpose.NoPath) as caught:
            hangpose.plan(prediction.object, prediction.supporter, pose, **options)
        assert caught.value.reason == printed["path_failure"]["reason"]
        assert str(caught.value) in printed["path_failure"]["message"]
    path = hangpose.plan(prediction.object, prediction.supporter, reached[1], **options)
    expected = reached[0]["path"]
    assert path.release == expected["release"]
    assert_same(path.clearance, expected["clearance"])
    for seconds, matrices, waypoints in (
        (path.seconds, path.poses, expected["waypoints"]),
        (path.gripper_seconds, path.gripper_poses, expected["gripper"]),
    ):
        assert_same(seconds, [waypoint["seconds"] for waypoint in waypoints])
        assert_same(matrices[:, :3, 3], [waypoint["position"] for waypoint in waypoints])
    assert (len(path.gripper_seconds) > 0) == has_gripper
    np.testing.assert_allclose(path.poses[path.release], reached[1].release, atol=1e-6)


SIZE = (120, 160)
CAMERA = np.array([[200.0, 0, 79.5], [0, 200.0, 59.5], [0, 0, 1]])
RADIUS, AWAY = 0.06, 0.4


def ball(turn: float) -> tuple[np.ndarray, np.ndarray]:
    """Depths in tenths of a millimetre of a ball around the origin, and the camera's pose."""
    v, u = np.mgrid[: SIZE[0], : SIZE[1]]
    x, y = (u - CAMERA[0, 2]) / CAMERA[0, 0], (v - CAMERA[1, 2]) / CAMERA[1, 1]
    square = x * x + y * y + 1
    root = AWAY**2 - square * (AWAY**2 - RADIUS**2)
    depth = np.where(root < 0, 0, (AWAY - np.sqrt(np.maximum(root, 0))) / square)
    pose = np.eye(4)
    pose[:3, :3] = [[np.cos(turn), 0, np.sin(turn)], [0, 1, 0], [-np.sin(turn), 0, np.cos(turn)]]
    pose[:3, 3] = pose[:3, :3] @ (0, 0, -AWAY)
    return (depth * 10_000).astype(np.uint16), pose


def write_png(path: Path, image: np.ndarray) -> None:
    """A greyscale PNG of 16 bits."""

    def chunk(name: bytes, content: bytes) -> bytes:
        return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))

    height, width = image.shape
    rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in image)
    header = struct.pack(">IIBBBBB", width, height, 16, 0, 0, 0, 0)
    parts = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + parts)


def columns(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """The numbers of the vertices of a binary PLY, and its triangles."""
    content = path.read_bytes()
    end = content.index(b"end_header\n") + len(b"end_header\n")
    header = content[:end].decode().splitlines()
    count, faces = (
        next((int(line.split()[2]) for line in header if line.startswith(f"element {name}")), 0)
        for name in ("vertex", "face")
    )
    width = sum(line.startswith("property float") for line in header)
    numbers = np.frombuffer(content, "<f4", count * width, end).reshape(count, width)
    corners = np.frombuffer(content, np.dtype([("n", "u1"), ("v", "<i4", 3)]), faces, end + numbers.nbytes)
    return numbers, corners["v"]


@pytest.mark.parametrize("mode", ["mesh", "complete", "cloud"])
def test_scans(command: Command, tmp_path: Path, mode: str) -> None:
    images, poses = zip(*(ball(turn) for turn in (0.0, 0.5, 1.0, -0.7)))
    for index, (image, pose) in enumerate(zip(images, poses)):
        write_png(tmp_path / f"{index}.png", image)
        np.savetxt(tmp_path / f"{index}.txt", pose, fmt="%.17g")
    np.savetxt(tmp_path / "camera", CAMERA, fmt="%.17g")
    out = tmp_path / "out.ply"
    options = {"mesh": [], "complete": ["--complete"], "cloud": ["--cloud"]}[mode]
    command(
        "scan", "--depth", tmp_path / "*.png", "--poses", tmp_path / "*.txt", "--camera", tmp_path / "camera",
        "--depth-scale", 0.0001, "-o", out, *options,
    )  # fmt: skip
    numbers, corners = columns(out)
    found = hangpose.scan(images, CAMERA, poses, depth_scale=0.0001, complete=mode == "complete", cloud=mode == "cloud")
    if mode == "cloud":
        np.testing.assert_array_equal(np.hstack([found["points"], found["normals"]]), numbers)
    else:
        np.testing.assert_array_equal(found["vertices"], numbers)
        np.testing.assert_array_equal(found["triangles"], corners)
        # What every camera saw is where the ball is.
        shown = found["vertices"][found["seen"] == 1]
        assert abs(np.linalg.norm(shown, axis=1) - RADIUS).max() < 0.002
    assert found["viewpoints"].shape == (4, 3)
