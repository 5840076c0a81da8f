"""Predicts how the sample mug hangs on the sample hook, and lets it go there in MuJoCo.

Needs `pip install mujoco coacd trimesh`. Exit status: 0 it hangs, 1 it falls. With three numbers as
arguments the mug is let go so many metres beside the predicted pose.
"""

import sys
from pathlib import Path

import coacd
import hangpose
import mujoco
import numpy as np
import trimesh

SAMPLES = Path(__file__).resolve().parents[2] / "samples"
QUICK = {"threshold": 0.05, "preprocess_mode": "off", "resolution": 500, "mcts_iterations": 8, "mcts_max_depth": 2}
"""A decomposition in seconds. The sample meshes are closed, so nothing is to be prepared."""
SECONDS = 4.0
"""Time after which the object counts as hanging."""
FELL = 0.05
"""Fall of the centre of mass, metres."""
DENSITY = 500.0
"""Of the mug, kg/m³."""


def convex_parts(path: Path) -> list[trimesh.Trimesh]:
    """MuJoCo takes a mesh as its convex hull: the handle of a mug must be of several parts."""
    coacd.set_log_level("error")
    mesh = trimesh.load(path, force="mesh")
    parts = coacd.run_coacd(coacd.Mesh(mesh.vertices, mesh.faces), seed=1, **QUICK)
    return [trimesh.Trimesh(vertices, faces) for vertices, faces in parts]


def main() -> int:
    mug, hook = hangpose.Object(SAMPLES / "mug.obj"), hangpose.Supporter(SAMPLES / "hook.ply")
    pose = hangpose.predict(mug, hook).best
    if pose is None:
        print("nothing hangs")
        return 1
    print(pose)
    beside = np.array(sys.argv[1:] or (0, 0, 0), dtype=float)

    spec = mujoco.MjSpec()
    spec.option.timestep = 0.0005
    # The pose of the prediction is that of the object's frame.
    position, quaternion = pose.release_placement.position + beside, np.roll(pose.release_placement.quaternion, 1)
    body = spec.worldbody.add_body(pos=position, quat=quaternion)
    body.add_freejoint()
    for owner, path in ((body, "mug.obj"), (spec.worldbody, "hook.obj")):
        for index, part in enumerate(convex_parts(SAMPLES / path)):
            name = f"{path} {index}"
            spec.add_mesh(name=name, uservert=part.vertices.ravel(), userface=part.faces.ravel())
            owner.add_geom(
                type=mujoco.mjtGeom.mjGEOM_MESH, meshname=name, density=DENSITY, friction=[0.4, 0.005, 0.0001]
            )
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    before = data.subtree_com[0].copy()
    for _ in range(round(SECONDS / model.opt.timestep)):
        mujoco.mj_step(model, data)
    sank = before[2] - data.subtree_com[0][2]
    hangs = bool(np.isfinite(sank) and sank < FELL)
    print(
        f"after {SECONDS:.0f} s in MuJoCo it {'hangs' if hangs else 'has fallen'}; "
        f"its centre of mass sank by {1e3 * sank:.1f} mm"
    )
    return 0 if hangs else 1


if __name__ == "__main__":
    sys.exit(main())
