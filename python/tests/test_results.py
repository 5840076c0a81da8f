"""What the results offer: text, pickling, pages, and poses beside each other."""

from __future__ import annotations

import pickle
from typing import Any

import hangpose
import numpy as np
import pytest
from conftest import SAMPLES, same


def test_matrices_are_rigid_and_agree_with_position_and_quaternion(prediction: hangpose.Prediction) -> None:
    for pose in prediction.poses:
        again = hangpose.Placement.of((pose.release_placement.position, pose.release_placement.quaternion))
        assert np.abs(again.matrix - pose.release).max() < 1e-6
        back = hangpose.Placement.of(pose.release)
        assert np.abs(np.abs(back.quaternion @ pose.release_placement.quaternion) - 1) < 1e-6
        assert np.array_equal(pose.release[3], [0, 0, 0, 1])


def test_contacts_carry_the_weight(prediction: hangpose.Prediction) -> None:
    best = prediction.best
    assert best is not None
    pushed = sum(contact.force * np.array(contact.normal) for contact in best.contacts)
    # Without friction, which carries a part on slopes.
    assert 0.7 < pushed[2] < 1.3


def test_text(prediction: hangpose.Prediction, mug: hangpose.Object, hook: hangpose.Supporter) -> None:
    assert repr(mug) == "<Object 'mug.obj': 7104 triangles, 158 places to hang by>"
    assert repr(hook) == "<Supporter 'hook.ply': 10000 points, 12 places to hang on>"
    assert repr(prediction.best).startswith("<Pose 1: threaded, hangs with probability 99.6%, release at (")
    assert repr(hangpose.Params("paper", friction=0.6)) == "Params('paper', friction=0.6)"
    patient = {"firm_enough": 8}
    mug = hangpose.Object(SAMPLES / "mug.obj", params=patient)
    hook = hangpose.Supporter(SAMPLES / "hook.ply", params=patient)
    several = hangpose.predict(mug, hook, distinct=(0.005, 0.17))
    assert "<Pose 1: threaded" in repr(several) and "<Pose 2: threaded" in repr(several)


def test_constants_of_numpy_are_those_of_python() -> None:
    given = hangpose.Params(friction=np.float32(0.3), samples=np.int64(5000), gravity=np.array([0, 1, 0]))
    assert dict(given) == dict(hangpose.Params(friction=0.3, samples=5000, gravity=[0, 1, 0]))
    assert given["friction"] == 0.3 and len(given) == len(hangpose.Params())


def test_results_are_pickled(prediction: hangpose.Prediction) -> None:
    again = pickle.loads(pickle.dumps(prediction))
    assert same(again, prediction) and again.object is None and again.supporter is None
    assert repr(again) == repr(prediction) and again.counts == prediction.counts
    assert prediction.object is not None
    path = hangpose.plan(prediction.object, prediction.supporter, again.best)
    assert np.array_equal(pickle.loads(pickle.dumps(path)).poses, path.poses)
    assert dict(pickle.loads(pickle.dumps(hangpose.Params(friction=0.5)))) == dict(hangpose.Params(friction=0.5))
    with pytest.raises(hangpose.InvalidInput, match="predict again"):
        hangpose.view(again)
    assert again._repr_html_().startswith("<pre>")


def test_pages(prediction: hangpose.Prediction, tmp_path: Any) -> None:
    prediction.paths[1] = hangpose.plan(prediction.object, prediction.supporter, prediction.best)
    page = hangpose.view(prediction, tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text(encoding="utf-8") == page
    assert page.lstrip().lower().startswith("<!doctype html>") and "mug.obj" in page
    frame = prediction._repr_html_()
    assert frame.startswith("<iframe srcdoc=") and "<script>" not in frame
    del prediction.paths[1]


def test_objects_hang_beside_each_other(mug: hangpose.Object) -> None:
    tree = hangpose.Supporter(SAMPLES / "mug_tree.ply")
    first = hangpose.predict(mug, tree).poses[0]
    second = hangpose.predict(mug, tree, hung=[(mug, first)]).poses[0]
    as_matrix = hangpose.predict(mug, tree, hung=[(mug, first.rest)]).poses[0]
    assert np.abs(second.release - as_matrix.release).max() < 1e-3
    vertices = mug.places  # On the surface of the mug.
    there = [pose.rest[:3, :3] @ vertices.T + pose.rest[:3, 3:] for pose in (first, second)]
    assert np.linalg.norm(there[0].mean(axis=1) - there[1].mean(axis=1)) > 0.03


def test_a_way_there_and_back(prediction: hangpose.Prediction) -> None:
    there = hangpose.plan(prediction.object, prediction.supporter, prediction.best)
    back = hangpose.plan(prediction.object, prediction.supporter, prediction.best, take_off=True)
    assert prediction.best is not None
    # It ends 0.3 mm before contact; the release pose is 4 mm away.
    left = np.linalg.norm(there.poses[-1][:3, 3] - prediction.best.rest[:3, 3])
    assert 0.0001 < left < 0.001
    assert np.abs(back.poses[0] - there.poses[-1]).max() < 1e-6
    assert there.seconds[0] == 0 and (np.diff(there.seconds) > 0).all()
    assert "waypoints" in repr(there)


def test_properties(mug: hangpose.Object, hook: hangpose.Supporter) -> None:
    assert mug.mass["is_closed"] and mug.mass["volume"] > 0
    assert mug.places.shape == (158, 3) and hook.places.shape == (12, 3) and hook.guessed == 0
    assert mug.symmetries == []
    assert np.abs(mug.centre_of_mass).max() < 0.1
