"""Arrays of every type and layout, meshes and clouds of other libraries, and what is wrong with them."""

from __future__ import annotations

import pickle
from types import SimpleNamespace
from typing import Any, Callable

import hangpose
import numpy as np
import pytest
from conftest import SAMPLES, same

Arrays = tuple[np.ndarray, np.ndarray]


def strided(array: np.ndarray) -> np.ndarray:
    """The same numbers, not contiguous."""
    wide = np.zeros((2 * len(array), array.shape[1] + 2), dtype=array.dtype)
    wide[::2, 1:-1] = array
    return wide[::2, 1:-1]


LAYOUTS: dict[str, Callable[[np.ndarray], Any]] = {
    "as it is": lambda array: array,
    "wider": lambda array: array.astype(np.float64 if array.dtype.kind == "f" else np.int64),
    "int32": lambda array: array if array.dtype.kind == "f" else array.astype(np.int32),
    "fortran": np.asfortranarray,
    "strided": strided,
    "reversed twice": lambda array: np.ascontiguousarray(array[::-1])[::-1],
    "big-endian": lambda array: array.astype(array.dtype.newbyteorder(">")),
    "read-only": lambda array: pickle.loads(pickle.dumps(array)).view(),
    "list": lambda array: array.tolist(),
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_layouts(prediction: hangpose.Prediction, mug_arrays: Arrays, hook_arrays: Arrays, layout: str) -> None:
    change = LAYOUTS[layout]
    given = [change(array) for array in (*mug_arrays, *hook_arrays)]
    before = [np.array(array) for array in given]
    for array in given:
        if layout == "read-only":
            array.flags.writeable = False
    thing, holder = hangpose.Object(*given[:2]), hangpose.Supporter(*given[2:])
    assert same(hangpose.predict(thing, holder), prediction)
    assert all(np.array_equal(array, old) for array, old in zip(given, before))


def test_what_is_done_to_an_array_later_does_not_matter(mug_arrays: Arrays, hook: hangpose.Supporter) -> None:
    vertices, triangles = (array.copy() for array in mug_arrays)
    thing = hangpose.Object(vertices, triangles)
    first = hangpose.predict(thing, hook)
    vertices[:], triangles[:] = 0, 0
    assert same(hangpose.predict(thing, hook), first)
    assert hangpose.view(first).startswith("<!doctype html>")


def test_trimesh(prediction: hangpose.Prediction, hook: hangpose.Supporter, hook_arrays: Arrays) -> None:
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.load(SAMPLES / "mug.obj", process=False)
    assert same(hangpose.predict(hangpose.Object(mesh), hook), prediction)
    of_file = hangpose.predict(hangpose.Object(SAMPLES / "mug.obj"), hangpose.Supporter(SAMPLES / "hook.obj"))
    sampled = hangpose.Supporter(trimesh.load(SAMPLES / "hook.obj", process=False))
    assert same(hangpose.predict(hangpose.Object(mesh), sampled), of_file)
    cloud = hangpose.Supporter(trimesh.PointCloud(hook_arrays[0]))
    assert same(
        hangpose.predict(hangpose.Object(mesh), cloud),
        hangpose.predict(hangpose.Object(mesh), hangpose.Supporter(hook_arrays[0])),
    )
    with pytest.raises(hangpose.InvalidInput, match="Scene"):
        hangpose.Object(trimesh.Scene(mesh))


class Vectors:
    """As Open3D's lists of vectors: a sequence that NumPy converts."""

    def __init__(self, array: np.ndarray) -> None:
        self.array = array

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        return np.array(self.array, dtype=dtype)

    def __len__(self) -> int:
        return len(self.array)


def open3d_stand_in(mug: Arrays, hook: Arrays) -> tuple[Any, Any, Any]:
    """A mesh, a cloud, and the cloud without normals with the attributes of Open3D's, in its types."""
    vertices, triangles = mug
    points, normals = hook
    none = Vectors(np.empty((0, 3)))
    mesh = SimpleNamespace(
        vertices=Vectors(vertices.astype(np.float64)), triangles=Vectors(triangles.astype(np.int32)),
        vertex_normals=none, triangle_normals=none,
    )  # fmt: skip
    positions = Vectors(points.astype(np.float64))
    cloud = SimpleNamespace(points=positions, normals=Vectors(normals.astype(np.float64)), colors=none)
    return mesh, cloud, SimpleNamespace(points=positions, normals=none, colors=none)


def open3d_itself(mug: Arrays, hook: Arrays) -> tuple[Any, Any, Any]:
    o3d = pytest.importorskip("open3d")
    vectors = o3d.utility.Vector3dVector
    mesh = o3d.geometry.TriangleMesh(vectors(mug[0].astype(float)), o3d.utility.Vector3iVector(mug[1].astype(np.int32)))
    cloud, bare = (o3d.geometry.PointCloud(vectors(hook[0].astype(float))) for _ in range(2))
    cloud.normals = vectors(hook[1].astype(float))
    return mesh, cloud, bare


@pytest.mark.parametrize("make", [open3d_stand_in, open3d_itself])
def test_open3d(prediction: hangpose.Prediction, mug_arrays: Arrays, hook_arrays: Arrays, make: Any) -> None:
    mesh, cloud, bare = make(mug_arrays, hook_arrays)
    thing = hangpose.Object(mesh)
    assert same(hangpose.predict(thing, hangpose.Supporter(cloud)), prediction)
    without_normals = hangpose.predict(thing, hangpose.Supporter(hook_arrays[0]))
    assert same(hangpose.predict(thing, hangpose.Supporter(bare)), without_normals)
    # A mesh as a supporter is sampled.
    assert "5000 points" in repr(hangpose.Supporter(mesh, samples=5000))


def test_a_map(prediction: hangpose.Prediction, mug: hangpose.Object, hook_arrays: Arrays) -> None:
    """Coordinates that single precision cannot hold: the poses are those at the origin, moved."""
    points, normals = hook_arrays
    away = np.array([431_000.0, 5_411_000.0, 250.0])
    low = np.floor((points.astype(np.float64) + away).min(axis=0))
    local = hangpose.predict(mug, hangpose.Supporter(points - (low - away).astype(np.float32), normals))
    there = hangpose.Supporter(points.astype(np.float64) + away, normals, viewpoints=[away + (0.5, 0, 0.2)])
    assert np.array_equal(there.origin, low)
    found = hangpose.predict(mug, there, here=away + hook_arrays[0].max(axis=0), here_radius=0.5)
    assert found.poses and local.poses
    best = found.poses[0]
    assert np.abs(best.release[:3, 3] - away).max() < 0.2
    assert np.abs(np.array(best.contacts[0].position) - away).max() < 0.1
    path = hangpose.plan(mug, there, best)
    assert np.abs(path.poses[path.release] - best.release).max() < 1e-5
    with pytest.raises(hangpose.NoPath) as caught:
        hangpose.plan(mug, there, best, start=(away + points.mean(axis=0), (0, 0, 0, 1)))
    assert np.abs(np.array(caught.value.collision["at"]) - away).max() < 0.2
    assert f"{caught.value.collision['at'][1]:.3f}" in str(caught.value)


SQUARE = np.array([[0, 0, 0], [0.1, 0, 0], [0.1, 0.1, 0], [0, 0.1, 0]], dtype=np.float32)
HALVES = np.array([[0, 1, 2], [0, 2, 3]])
NORMALS = np.tile([0.0, 0.0, 1.0], (4, 1))


def changed(array: np.ndarray, at: Any, value: Any) -> np.ndarray:
    array = array.astype(np.float64) if isinstance(value, float) else array.copy()
    array[at] = value
    return array


Make = Callable[[], Any]
MESSAGES: list[tuple[Make, str, Any, Any, Any, str]] = [
    (lambda: hangpose.Object(changed(SQUARE, (2, 1), np.nan), HALVES), "vertices", 2, None, (-1e6, 1e6), "vertex 2 is at"),
    (lambda: hangpose.Object(changed(SQUARE, (1, 0), 1e300), HALVES), "vertices", 1, np.inf, (-1e6, 1e6), "vertex 1 is at"),
    (lambda: hangpose.Object(SQUARE, changed(HALVES, (1, 2), 4)), "triangles", 1, 4, (0, 3), "triangle 1 names vertex 4"),
    (lambda: hangpose.Object(SQUARE, changed(HALVES, (1, 0), -1)), "triangles", 1, None, None, "triangles\\[1\\]"),
    (lambda: hangpose.Object(SQUARE, HALVES[:0]), "triangles", None, None, None, "has no triangles"),
    (lambda: hangpose.Object(SQUARE, [[0, 1, 1]]), "triangles", None, None, None, "degenerate"),
    (lambda: hangpose.Object(SQUARE, HALVES.astype(float)), "triangles", None, None, None, "give integers"),
    (lambda: hangpose.Object(SQUARE[:, :2], HALVES), "vertices", None, None, None, "shape \\(4, 2\\)"),
    (lambda: hangpose.Object(SQUARE[0], HALVES), "vertices", None, None, None, "shape \\(3,\\)"),
    (lambda: hangpose.Object(SQUARE, HALVES[None]), "triangles", None, None, None, "shape"),
    (lambda: hangpose.Object(SQUARE.astype(complex), HALVES), "vertices", None, None, None, "complex128"),
    (lambda: hangpose.Object([["a", "b", "c"]], HALVES), "vertices", None, None, None, "give numbers"),
    (lambda: hangpose.Object([[0, 1, 2], [3]], HALVES), "vertices", None, None, None, "no array of numbers"),
    (lambda: hangpose.Object(SQUARE), "mesh", None, None, None, "ndarray"),
    (lambda: hangpose.Object(None), "mesh", None, None, None, "NoneType"),
    (lambda: hangpose.Object(SQUARE, HALVES, up="up"), "up", None, None, None, "give x, y, z"),
    (lambda: hangpose.Object(SQUARE, HALVES, scale=0), "scale", None, 0, None, "positive"),
    (lambda: hangpose.Object(SQUARE, HALVES, viewpoints=[[0, 0, np.inf]]), "viewpoints", 0, np.inf, (-1e6, 1e6), "viewpoint 0"),
    (lambda: hangpose.Object(SQUARE, HALVES, params={"friction": 3.0}), "friction", None, 3, (0, 2), "friction = 3 is outside"),
    (lambda: hangpose.Object(SQUARE, HALVES, params={"frictio": 1}), "params", None, None, None, "unknown field `frictio`"),
    (lambda: hangpose.Object(SQUARE, HALVES, params="best"), "profile", None, None, None, "default"),
    (lambda: hangpose.Object(SQUARE, HALVES, centre_of_mass=(0, 0)), "centre_of_mass", None, None, None, "3 numbers"),
    (lambda: hangpose.Supporter(SQUARE[:0]), "points", None, None, None, "no points"),
    (lambda: hangpose.Supporter(SQUARE, NORMALS[1:]), "normals", None, 3, (4, 4), "4 points and 3 normals"),
    (lambda: hangpose.Supporter(SQUARE, changed(NORMALS, 3, np.nan)), "normals", 3, None, (-1e6, 1e6), "normal of point 3"),
    (lambda: hangpose.Supporter(SQUARE, region=((1, 1, 1), (0, 0, 0))), "region", None, None, None, "region"),
    (lambda: hangpose.Supporter(np.zeros((1_000_001, 3))), "points", None, 1_000_001, (1, 1_000_000), "downsample"),
    (lambda: hangpose.Supporter(SQUARE, triangles=HALVES, samples=10**12), "samples", None, 10**12, (100, 500_000), "samples"),
    (lambda: hangpose.Supporter(7), "cloud", None, None, None, "int"),
]  # fmt: skip


@pytest.mark.parametrize("case", range(len(MESSAGES)))
def test_messages(case: int) -> None:
    make, field, index, value, limits, text = MESSAGES[case]
    with pytest.raises(hangpose.InvalidInput, match=text) as caught:
        make()
    error = caught.value
    assert isinstance(error, (hangpose.HangposeError, ValueError))
    assert (error.field, error.index) == (field, index)
    assert error.value == value
    assert (error.minimum, error.maximum) == (limits or (None, None))
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again), vars(again)) == (type(error), str(error), vars(error))


REQUESTS: list[tuple[dict[str, Any], str, Any, str]] = [
    ({"top": 0}, "top", None, "1 to 10000"),
    ({"top": 10**9}, "top", None, "1 to 10000"),
    ({"allow": []}, "allow", None, "no kind of pose is allowed"),
    ({"allow": "thread"}, "allow", None, "threaded, hooked"),
    ({"here": (0, 0, np.nan)}, "here", None, "region of the supporter"),
    ({"here": (0, 0, 0), "here_radius": -1.0}, "here", None, "negative radius"),
    ({"by_box": ((1, 0, 0), (0, 1, 1))}, "by", None, "is empty"),
    ({"approach": (0, 0, 0)}, "approach", None, "direction that is not zero"),
    ({"scene": [[0, 0, 0], [0, 1e7, 0]]}, "scene", 1, "point 1 of the scene"),
    ({"distinct": (-1.0, 0.0)}, "distinct", None, "0 to 10 metres"),
    ({"hung": [(1, 2)]}, "hung", 0, "Object and a pose"),
]


@pytest.mark.parametrize(("request_", "field", "index", "text"), REQUESTS)
def test_requests(
    mug: hangpose.Object, hook: hangpose.Supporter, request_: dict[str, Any], field: str, index: Any, text: str
) -> None:
    with pytest.raises(hangpose.InvalidInput, match=text) as caught:
        hangpose.predict(mug, hook, **request_)
    assert (caught.value.field, caught.value.index) == (field, index)


PLANS: list[tuple[dict[str, Any], str, Any, str]] = [
    ({"clearance": 0.5}, "clearance", None, "above 0 and at most 0.1"),
    ({"samples": 0}, "samples", None, "must be 1 to"),
    ({"workspace": ((0, 0, 0), (0, 1, 1))}, "workspace", None, "lower corner"),
    ({"start": np.diag([1, 1, -1, 1])}, "start", None, "rotation"),
    ({"start": ((0, 0, 1), (0, 0, 0, 2))}, "start", None, "unit quaternion"),
    ({"gripper": hangpose.Gripper([])}, "gripper.parts", None, "no parts"),
    (
        {"gripper": hangpose.Gripper([hangpose.Capsule((0, 0, 0), (1, 0, 0), -0.1)])},
        "gripper.parts", 0, "part 0 of the gripper",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("options", "field", "index", "text"), PLANS)
def test_plans(prediction: hangpose.Prediction, options: dict[str, Any], field: str, index: Any, text: str) -> None:
    with pytest.raises(hangpose.InvalidInput, match=text) as caught:
        hangpose.plan(prediction.object, prediction.supporter, prediction.best, **options)
    assert (caught.value.field, caught.value.index) == (field, index)


def test_no_path_says_what_collides(prediction: hangpose.Prediction) -> None:
    assert prediction.best is not None
    with pytest.raises(hangpose.NoPath, match="start is in collision") as caught:
        hangpose.plan(prediction.object, prediction.supporter, prediction.best, start=((0.04, 0, -0.04), (0, 0, 0, 1)))
    error = caught.value
    assert error.reason == "start_in_collision" and error.collision["obstacle"] == "supporter"
    assert error.collision["distance"] < 0 and len(error.collision["at"]) == 3
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.reason, again.collision) == (str(error), error.reason, error.collision)


def test_different_params_are_refused(mug: hangpose.Object) -> None:
    other = hangpose.Supporter(SAMPLES / "hook.ply", params={"friction": 0.5})
    with pytest.raises(hangpose.InvalidInput, match="different params"):
        hangpose.predict(mug, other)


def test_files_that_cannot_be_read(tmp_path: Any) -> None:
    with pytest.raises(hangpose.UnreadableFile, match="no such file; check the path"):
        hangpose.Object(tmp_path / "none.obj")
    cut = tmp_path / "cut.ply"
    cut.write_bytes((SAMPLES / "hook.ply").read_bytes()[:1000])
    with pytest.raises(hangpose.UnreadableFile, match="cut off") as caught:
        hangpose.Supporter(str(cut))
    assert isinstance(caught.value, OSError) and caught.value.field == "path"
    constants = tmp_path / "params.toml"
    for text, message in [
        ("friction = 0.5\nfrictio = 0.5\n", "line 2"),
        ("friction =", "line 1"),
        (None, "cannot be read"),
    ]:
        constants.unlink(missing_ok=True)
        if text is not None:
            constants.write_text(text)
        with pytest.raises(hangpose.UnreadableFile, match=message):
            hangpose.Params(file=constants)
    constants.write_text("friction = 7\n")
    with pytest.raises(hangpose.InvalidInput, match="friction = 7 is outside its range"):
        hangpose.Params(file=constants)
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)


def test_wrong_units_are_warned_of(mug_arrays: Arrays, hook_arrays: Arrays) -> None:
    vertices, triangles = mug_arrays
    with pytest.warns(UserWarning, match="the object is 114 m large.*millimetres, pass scale=0.001"):
        hangpose.Object(vertices * 1000, triangles)
    with pytest.warns(UserWarning, match="the supporter is 99 m large"):
        hangpose.Supporter(hook_arrays[0] * 1000)


CAMERA = [[200, 0, 79.5], [0, 200, 59.5], [0, 0, 1]]


def test_depth_images_that_cannot_be_used() -> None:
    image, none, pose = np.full((120, 160), 400, np.uint16), np.zeros((120, 160), np.uint16), np.eye(4)
    for images, poses, options, field, index, text in [
        ([], [], {}, "depths", None, "no images"),
        ([image, none], [pose, pose], {}, "depths", 1, "no pixel has a depth"),
        ([image], [pose, pose], {}, "poses", None, "one pose for each"),
        ([image], [np.diag([1, 1, -1, 1])], {}, "poses", 0, "mirrors"),
        ([image], [2 * pose], {}, "poses", 0, "last row"),
        ([image], [pose[:3]], {}, "poses", 0, "4 x 4"),
        ([image.astype(np.int32)], [pose], {}, "depths", 0, "int32"),
        ([image[None]], [pose], {}, "depths", 0, "height, width"),
        ([image], [pose], {"masks": [np.zeros((2, 2))]}, "masks", 0, "not the size"),
        ([image], [pose], {"crop": ((5, 5, 5), (6, 6, 6))}, "crop", None, "no image shows"),
        ([image], [pose], {"cloud": True, "complete": True}, "complete", None, "leave out cloud"),
    ]:
        with pytest.raises(hangpose.InvalidInput, match=text) as caught:
            hangpose.scan(images, CAMERA, poses, **options)
        assert (caught.value.field, caught.value.index) == (field, index), text
    with pytest.raises(hangpose.InvalidInput, match="principal point"):
        hangpose.scan([image], [[200, 0, 799], [0, 200, 59], [0, 0, 1]])


def test_depths_in_metres_are_as_good_as_in_units() -> None:
    row, column = np.mgrid[:120, :160]
    metres = 0.4 + 0.0005 * np.abs(column - 80) + 0.0003 * row
    units = hangpose.scan([np.round(metres * 10_000).astype(np.uint16)], CAMERA, depth_scale=0.0001, cloud=True)
    floats = hangpose.scan([np.where(column == 5, np.nan, metres)], CAMERA, cloud=True)
    assert abs(len(units["points"]) - len(floats["points"])) < 200
    depth = 0.4 + 0.0005 * np.abs(200 * floats["points"][:, 0] / floats["points"][:, 2] - 0.5)
    depth += 0.0003 * (200 * floats["points"][:, 1] / floats["points"][:, 2] + 59.5)
    assert np.abs(floats["points"][:, 2] - depth).max() < 0.0005


def test_a_scanned_object_has_the_cameras_as_viewpoints() -> None:
    row, column = np.mgrid[:120, :160]
    image = np.where((abs(row - 60) < 25) & (abs(column - 80) < 25), 400, 0).astype(np.uint16)
    found = hangpose.scan([image], CAMERA, complete=True)
    thing = hangpose.Object(found["vertices"], found["triangles"], viewpoints=found["viewpoints"])
    assert thing.mass["is_closed"] and np.array_equal(found["viewpoints"], [[0, 0, 0]])
    assert 0 < found["seen"].mean() < 1
