"""Draws docs/hang.gif: the sample mug is brought to the sample hook by a gripper, let go, and stays.

Every frame is a waypoint, or between two waypoints, of the path that `hangpose predict --plan --gripper` finds.
"""

import tomllib

import numpy as np
from hangpose import ROOT, Mesh, pose_of, predict
from PIL import Image

WIDTH, HEIGHT = 560, 420
FINE = 2  # Samples of a pixel along each side.
FRAMES_PER_SECOND, SPEED = 15, 1.4  # The path is played faster than planned.
OPENING, HOLD = 0.5, 1.5  # Seconds in which the gripper opens, and that the last frame stays.
EYE = np.array([0.55, -0.75, 0.36])
MUG, HOOK, HAND = (0.85, 0.45, 0.20), (0.45, 0.50, 0.60), (0.72, 0.74, 0.78)
COLOURS = 64

# The gripper of docs/book/path.md, with its palm.
GRIPPER = """
retreat = [-0.15, 0, 0]
[[part]]
from = [-0.1, 0.048, 0.05]
to = [0, 0.048, 0.05]
radius = 0.006
opening = [0, 0.015, 0]
[[part]]
from = [-0.1, -0.048, 0.05]
to = [0, -0.048, 0.05]
radius = 0.006
opening = [0, -0.015, 0]
[[part]]
from = [-0.1, -0.048, 0.05]
to = [-0.1, 0.048, 0.05]
radius = 0.015
"""


def capsule(start, end, radius, around=20, rings=8):
    """The triangles of a capsule, facing out."""
    axis = end - start
    axis /= np.linalg.norm(axis)
    side = np.cross(axis, [0.0, 0.0, 1.0] if abs(axis[2]) < 0.9 else [1.0, 0.0, 0.0])
    side /= np.linalg.norm(side)
    other = np.cross(axis, side)
    angles = np.linspace(0, 2 * np.pi, around, endpoint=False)
    circle = np.cos(angles)[:, None] * side + np.sin(angles)[:, None] * other
    heights = np.concatenate([np.linspace(-np.pi / 2, 0, rings), np.linspace(0, np.pi / 2, rings)])
    centres = [start] * rings + [end] * rings
    grid = np.array([c + radius * (np.sin(h) * axis + np.cos(h) * circle) for c, h in zip(centres, heights, strict=True)])
    a, b = grid[:-1], grid[1:]
    a1, b1 = np.roll(a, -1, 1), np.roll(b, -1, 1)
    return np.concatenate([np.stack([a, a1, b1], 2).reshape(-1, 3, 3), np.stack([a, b1, b], 2).reshape(-1, 3, 3)])


class View:
    """An orthographic view with a depth buffer."""

    def __init__(self, low, high):
        back = EYE / np.linalg.norm(EYE)
        right = np.cross([0, 0, 1], back)
        right /= np.linalg.norm(right)
        self.axes = np.array([right, np.cross(back, right), back])
        corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
        seen = corners @ self.axes.T
        self.middle = (seen.min(0) + seen.max(0)) / 2
        extent = seen.max(0) - seen.min(0)
        self.scale = FINE * min(WIDTH / extent[0], HEIGHT / extent[1])
        self.colour = np.ones((HEIGHT * FINE, WIDTH * FINE, 3))
        self.depth = np.full((HEIGHT * FINE, WIDTH * FINE), -np.inf)

    def copy(self):
        other = object.__new__(View)
        other.__dict__ = self.__dict__ | {"colour": self.colour.copy(), "depth": self.depth.copy()}
        return other

    def draw(self, triangles, colour):
        seen = (triangles @ self.axes.T - self.middle) * self.scale
        seen[:, :, 0] += WIDTH * FINE / 2
        seen[:, :, 1] = HEIGHT * FINE / 2 - seen[:, :, 1]
        normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]) @ self.axes.T
        lengths = np.linalg.norm(normals, axis=1)
        shades = 0.35 + 0.65 * normals[:, 2] / np.maximum(lengths, 1e-20)
        lows = np.maximum(np.floor(seen[:, :, :2].min(1)), 0).astype(int)
        highs = np.minimum(np.ceil(seen[:, :, :2].max(1)) + 1, [WIDTH * FINE, HEIGHT * FINE]).astype(int)
        for index in np.flatnonzero(normals[:, 2] > 0):
            (x0, y0), (x1, y1) = lows[index], highs[index]
            if x0 >= x1 or y0 >= y1:
                continue
            (ax, ay, az), (bx, by, bz), (cx, cy, cz) = seen[index]
            whole = (by - cy) * (ax - cx) + (cx - bx) * (ay - cy)
            if whole == 0:
                continue
            x, y = np.arange(x0, x1) + 0.5, (np.arange(y0, y1) + 0.5)[:, None]
            u = ((by - cy) * (x - cx) + (cx - bx) * (y - cy)) / whole
            v = ((cy - ay) * (x - cx) + (ax - cx) * (y - cy)) / whole
            z = u * az + v * bz + (1 - u - v) * cz
            depth = self.depth[y0:y1, x0:x1]
            is_in_front = (u >= 0) & (v >= 0) & (u + v <= 1) & (z > depth)
            depth[is_in_front] = z[is_in_front]
            self.colour[y0:y1, x0:x1][is_in_front] = np.array(colour) * shades[index]

    def image(self):
        mean = self.colour.reshape(HEIGHT, FINE, WIDTH, FINE, 3).mean((1, 3))
        return Image.fromarray((255 * mean).astype(np.uint8))


def between(waypoints, seconds):
    """The pose at a time: linear in the position and, for close waypoints, in the quaternion."""
    after = next((i for i, w in enumerate(waypoints) if w["seconds"] >= seconds), len(waypoints) - 1)
    a, b = waypoints[max(after - 1, 0)], waypoints[after]
    length = b["seconds"] - a["seconds"]
    share = min(max((seconds - a["seconds"]) / length, 0), 1) if length > 0 else 1
    position = (1 - share) * np.array(a["position"]) + share * np.array(b["position"])
    qa, qb = np.array(a["quaternion_xyzw"]), np.array(b["quaternion_xyzw"])
    turned = (1 - share) * qa + share * qb * np.sign(qa @ qb)
    return pose_of(position, turned / np.linalg.norm(turned))


def main():
    gripper = ROOT / "build" / "gripper.toml"
    gripper.parent.mkdir(exist_ok=True)
    gripper.write_text(GRIPPER)
    found = predict("mug.obj", "hook.ply", "--plan", "--start", "samples/mug_start.json", "--gripper", str(gripper))
    path = next(pose["path"] for pose in found["poses"] if pose.get("path"))
    mug, hook = Mesh("mug.obj"), Mesh("hook.obj")
    parts = tomllib.loads(GRIPPER)["part"]
    rest, end = path["waypoints"][-1]["seconds"], path["gripper"][-1]["seconds"]

    def hand(pose, share):
        for part in parts:
            shift = share * np.array(part.get("opening", [0, 0, 0]))
            start, stop = (np.array(part[name], float) + shift for name in ("from", "to"))
            yield capsule(start, stop, part["radius"]) @ pose[:3, :3].T + pose[:3, 3]

    first = mug.at(pose_of(path["waypoints"][0]["position"], path["waypoints"][0]["quaternion_xyzw"]))
    last = mug.at(pose_of(path["waypoints"][-1]["position"], path["waypoints"][-1]["quaternion_xyzw"]))
    all_ = np.concatenate([first.reshape(-1, 3), last.reshape(-1, 3), hook.vertices])
    empty = View(all_.min(0), all_.max(0) + [0.02, 0, 0.04])
    empty.draw(hook.vertices[hook.triangles], HOOK)

    # The path stands still while the gripper opens.
    times = np.arange(0, (end + OPENING * SPEED) / SPEED, 1 / FRAMES_PER_SECOND) * SPEED
    frames = []
    for time in times:
        opened = min(max((time - rest) / (OPENING * SPEED), 0), 1)
        time = time if time <= rest else max(rest, time - OPENING * SPEED)
        view = empty.copy()
        held = between(path["waypoints"], min(time, rest))
        view.draw(mug.at(held), MUG)
        pose = held if time <= rest else between(path["gripper"], time)
        for triangles in hand(pose, opened):
            view.draw(triangles, HAND)
        frames.append(view.image())
    palette = frames[len(frames) // 2].quantize(COLOURS)
    frames = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    each = round(1000 / FRAMES_PER_SECOND)
    durations = [each] * (len(frames) - 1) + [round(1000 * HOLD)]
    out = ROOT / "docs" / "hang.gif"
    frames[0].save(out, save_all=True, append_images=frames[1:], duration=durations, loop=0, optimize=True)
    print(f"{out.relative_to(ROOT)}: {len(frames)} frames, {out.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
