"""Predicts how the sample mug hangs on the sample hook, and lets it go there in PyBullet.

Needs `pip install pybullet coacd trimesh`. Exit status: 0 it hangs, 1 it falls.
"""

import sys
from pathlib import Path

import coacd
import hangpose
import numpy as np
import pybullet
import trimesh

SAMPLES = Path(__file__).resolve().parents[2] / "samples"
SECONDS = 4.0
"""Time after which the object counts as hanging."""
FELL = 0.05
"""Fall of the centre of mass, metres."""
STEP = 1 / 960
MASS = 0.3
"""Of the mug, kg."""
MARGIN = 0.0002
"""Collision margin, metres: Bullet's default of 4 cm is for larger things."""


def shape(path: Path, centre: np.ndarray) -> int:
    """A compound of convex parts: Bullet moves no concave meshes. `centre` becomes the origin."""
    coacd.set_log_level("error")
    mesh = trimesh.load(path, force="mesh")
    parts = coacd.run_coacd(coacd.Mesh(mesh.vertices, mesh.faces), threshold=0.02, seed=1)
    corners = [(vertices - centre).tolist() for vertices, _ in parts]
    return pybullet.createCollisionShapeArray(shapeTypes=[pybullet.GEOM_MESH] * len(parts), vertices=corners)


def main() -> int:
    mug, hook = hangpose.Object(SAMPLES / "mug.obj"), hangpose.Supporter(SAMPLES / "hook.ply")
    pose = hangpose.predict(mug, hook).best
    if pose is None:
        print("nothing hangs")
        return 1
    print(pose)

    pybullet.connect(pybullet.DIRECT)
    pybullet.setTimeStep(STEP)
    pybullet.setGravity(0, 0, -9.81)
    # Bullet places a body by its centre of mass.
    centre = mug.centre_of_mass
    at = pose.release[:3, :3] @ centre + pose.release[:3, 3]
    still = pybullet.createMultiBody(0, shape(SAMPLES / "hook.obj", np.zeros(3)))
    moving = pybullet.createMultiBody(
        MASS, shape(SAMPLES / "mug.obj", centre), basePosition=at, baseOrientation=pose.release_placement.quaternion
    )
    for body in (still, moving):
        pybullet.changeDynamics(
            body, -1, lateralFriction=0.4, collisionMargin=MARGIN, linearDamping=0.04, angularDamping=0.04
        )
    for _ in range(round(SECONDS / STEP)):
        pybullet.stepSimulation()
    sank = at[2] - pybullet.getBasePositionAndOrientation(moving)[0][2]
    hangs = bool(np.isfinite(sank) and sank < FELL)
    print(f"after {SECONDS:.0f} s in PyBullet it {'hangs' if hangs else 'has fallen'}; its centre of mass sank by {1e3 * sank:.1f} mm")
    return 0 if hangs else 1


if __name__ == "__main__":
    sys.exit(main())
