"""Where and how to hang an object that a robot has never seen.

>>> import hangpose
>>> mug, hook = hangpose.Object("samples/mug.obj"), hangpose.Supporter("samples/hook.ply")
>>> print(hangpose.predict(mug, hook).best)
<Pose 1: threaded, hangs with probability 99.6%, release at (0.0408, -0.0345, -0.0738) m>

Lengths are in metres. A pose maps object coordinates to supporter coordinates, in which z is up.
"""

from ._hangpose import __version__
from ._params import Params
from ._poses import Contact, Margin, Path, Placement, Pose, Rejection, Tolerance, Unseen
from ._predict import Capsule, Gripper, plan, predict
from ._prediction import Prediction, view
from ._scan import scan
from ._shapes import Object, Supporter
from .errors import Cancelled, HangposeError, InvalidInput, NoPath, UnreadableFile

__all__ = [
    "Cancelled",
    "Capsule",
    "Contact",
    "Gripper",
    "HangposeError",
    "InvalidInput",
    "Margin",
    "NoPath",
    "Object",
    "Params",
    "Path",
    "Placement",
    "Pose",
    "Prediction",
    "Rejection",
    "Supporter",
    "Tolerance",
    "Unseen",
    "UnreadableFile",
    "__version__",
    "plan",
    "predict",
    "scan",
    "view",
]
