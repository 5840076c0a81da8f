"""Predicts how the sample mug hangs on the sample hook, and lets it go there in PyBullet.

Needs `pip install pybullet coacd trimesh`. Exit status: 0 it hangs, 1 it falls. With three numbers as
arguments the mug is let go so many metres beside the predicted pose.
"""

import sys
import tempfile
from pathlib import Path

import coacd
import hangpose
import numpy as np
import pybullet
import trimesh

SAMPLES = Path(__file__).resolve().parents[2] / "samples"
QUICK = {"threshold": 0.05, "preprocess_mode": "off", "resolution": 500, "mcts_iterations": 8, "mcts_max_depth": 2}
"""A decomposition in seconds. The sample meshes are closed, so nothing is to be prepared."""
SECONDS = 4.0
"""Time after which the object counts as hanging."""
FELL = 0.05
"""Fall of the centre of mass, metres."""
STEP = 1 / 960
MASS = 0.3
"""Of the mug, kg."""
MARGIN = 0.0002
"""Collision margin, metres: Bullet's default of 4 cm is for larger things."""


def shape(path: Path, centre: np.ndarray, folder: Path) -> int:
    """A compound of convex parts: Bullet moves no concave meshes. `centre` becomes the origin."""
    coacd.set_log_level("error")
    mesh = trimesh.load(path, force="mesh")
    parts = coacd.run_coacd(coacd.Mesh(mesh.vertices, mesh.faces), seed=1, **QUICK)
    # Of a file of several objects Bullet takes each as its convex hull.
    lines, first = [], 1
    for index, (vertices, faces) in enumerate(parts):
        lines.append(f"o {index}")
        lines += ["v {:.9f} {:.9f} {:.9f}".format(*vertex) for vertex in vertices - centre]
        lines += ["f {} {} {}".format(*face) for face in np.asarray(faces) + first]
        first += len(vertices)
    file = folder / path.name
    file.write_text("\n".join(lines) + "\n")
    return pybullet.createCollisionShape(pybullet.GEOM_MESH, fileName=str(file))


def main() -> int:
    mug, hook = hangpose.Object(SAMPLES / "mug.obj"), hangpose.Supporter(SAMPLES / "hook.ply")
    pose = hangpose.predict(mug, hook).best
    if pose is None:
        print("nothing hangs")
        return 1
    print(pose)
    beside = np.array(sys.argv[1:] or (0, 0, 0), dtype=float)

    pybullet.connect(pybullet.DIRECT)
    pybullet.setTimeStep(STEP)
    pybullet.setGravity(0, 0, -9.81)
    # Bullet places a body by its centre of mass.
    centre = mug.centre_of_mass
    at = pose.release[:3, :3] @ centre + pose.release[:3, 3] + beside
    with tempfile.TemporaryDirectory() as folder:
        still = pybullet.createMultiBody(0, shape(SAMPLES / "hook.obj", np.zeros(3), Path(folder)))
        moving = pybullet.createMultiBody(
            MASS,
            shape(SAMPLES / "mug.obj", centre, Path(folder)),
            basePosition=at,
            baseOrientation=pose.release_placement.quaternion,
        )
    for body in (still, moving):
        pybullet.changeDynamics(
            body, -1, lateralFriction=0.4, collisionMargin=MARGIN, linearDamping=0.04, angularDamping=0.04
        )
    for _ in range(round(SECONDS / STEP)):
        pybullet.stepSimulation()
    sank = at[2] - pybullet.getBasePositionAndOrientation(moving)[0][2]
    hangs = bool(np.isfinite(sank) and sank < FELL)
    print(
        f"after {SECONDS:.0f} s in PyBullet it {'hangs' if hangs else 'has fallen'}; "
        f"its centre of mass sank by {1e3 * sank:.1f} mm"
    )
    return 0 if hangs else 1


if __name__ == "__main__":
    sys.exit(main())
