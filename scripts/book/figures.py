"""Draws the figures of the book that show results of the program on the samples, and the meaning of the parameters.

figures.py           writes docs/figures/how_*.svg and docs/figures/params_*.svg
figures.py --check   fails if one of them would change
"""

import io
import sys
from concurrent.futures import ThreadPoolExecutor

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from hangpose import ROOT, Mesh, inspect, outline, pose_of, predict, section
from matplotlib.patches import Arc, Circle, Wedge

FOLDER = ROOT / "docs" / "figures"
MUG, HOOK, POINT, GOOD, BAD, GREY = "#c8662b", "#5b6678", "#1f4e8c", "#2a8a4a", "#b3261e", "#9aa3ad"
MM = 1000
STYLE = {
    "svg.fonttype": "none",
    "svg.hashsalt": "hangpose",
    "font.family": "sans-serif",
    "font.size": 8,
    "axes.titlesize": 8.5,
    "axes.linewidth": 0.6,
    "lines.linewidth": 1.2,
}


def picture(panels, columns=None, width=2.4, height=2.2):
    """A figure with one plot for each panel, a function that draws on it."""
    columns = columns or len(panels)
    rows = -(-len(panels) // columns)
    figure, axes = plt.subplots(
        rows, columns, figsize=(width * columns, height * rows), layout="constrained", squeeze=False
    )
    for axis, draw in zip(axes.flat, panels, strict=False):
        draw(axis)
    for axis in axes.flat[len(panels) :]:
        axis.axis("off")
    file = io.StringIO()
    figure.savefig(file, format="svg", metadata={"Date": None, "Creator": None}, facecolor="white")
    plt.close(figure)
    return "\n".join(line.rstrip() for line in file.getvalue().splitlines()) + "\n"


def lines(axis, segments, colour, width=1.0, alpha=1.0):
    # One line with gaps is a smaller file than a line for each segment.
    ends = np.asarray(segments, float)
    gaps = np.full((len(ends), 1, 2), np.nan)
    axis.plot(*np.concatenate([ends, gaps], axis=1).reshape(-1, 2).T, color=colour, lw=width, alpha=alpha)


def scene(axis, title, low, high):
    """A plot without frame that shows a rectangle, all of it to scale."""
    axis.set(title=title, xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    axis.axis("off")


def arrow(axis, start, end, colour, width=1.2):
    axis.annotate(
        "", end, start, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": width, "shrinkA": 0, "shrinkB": 0}
    )


def note(axis, at, text, colour="black", **options):
    axis.text(*at, text, color=colour, fontsize=7, **({"ha": "center", "va": "center"} | options))


# ---- how it works


def candidates():
    mug, hook = Mesh("mug.obj"), Mesh("hook.obj")
    on_mug, on_hook = inspect("mug.obj"), inspect("hook.ply")

    def object_(axis):
        lines(axis, section(mug.vertices[mug.triangles], 1, 0.0) * MM, MUG, 1.4)
        near = [c for c in on_mug["contacts"] if abs(c["position"][1]) < 0.006]
        x, z = np.array([[c["position"][0], c["position"][2]] for c in near]).T * MM
        axis.scatter(x, z, 14, POINT, zorder=3)
        cx, _, cz = np.array(on_mug["centre_of_mass"]) * MM
        axis.plot(cx, cz, "+", color=BAD, ms=9, mew=1.6)
        note(axis, (cx, cz - 7), "centre of mass", BAD)
        scene(axis, "object: contact candidates near the plane", (-45, -5), (80, 100))

    def supporter(axis):
        lines(axis, section(hook.vertices[hook.triangles], 1, 0.0005) * MM, HOOK, 1.4)
        x, z = np.array([[c["position"][0], c["position"][2]] for c in on_hook["contacts"]]).T * MM
        axis.scatter(x, z, 14, POINT, zorder=3)
        scene(axis, "supporter: all contact candidates", (-15, -50), (110, 55))

    return picture([object_, supporter], width=3)


def release():
    mug, hook = Mesh("mug.obj"), Mesh("hook.obj")
    best = predict("mug.obj", "hook.ply", "--top", "1")["poses"][0]
    at = best["contacts"][0]["position"]

    def panel(pose, title, low, high):
        def draw(axis):
            lines(axis, section(hook.vertices[hook.triangles], 0, at[0]) * MM, HOOK, 1.4)
            lines(axis, section(mug.at(best[pose]), 0, at[0]) * MM, MUG, 1.4)
            if pose == "rest_pose":
                axis.plot(at[1] * MM, at[2] * MM, "o", color=BAD, ms=4, zorder=3)
            scene(axis, title, low, high)

        return draw

    wide, near = ((-45, -115), (75, 20)), ((-9, -7), (9, 13))
    mm = f"{best['clearance'] * MM:.1f} mm"
    return picture([
        panel("release_pose", "release, across the peg", *wide),
        panel("release_pose", f"release: {mm} of clearance", *near),
        panel("rest_pose", f"rest: sunk by {best['sinking'] * MM:.1f} mm", *near),
    ])  # fmt: skip


def margin():
    def draw(supporter, title):
        best = predict("mug.obj", supporter, "--top", "1")["poses"][0]

        def panel(axis):
            tilts = np.degrees(best["margin"]["tilts"])
            for i, tilt in enumerate(tilts):
                axis.add_patch(
                    Wedge((0, 0), tilt, 45 * i - 20, 45 * i + 20, color=GOOD if tilt > 68 else POINT, alpha=0.8)
                )
                at = np.array([np.cos(np.pi / 4 * i), np.sin(np.pi / 4 * i)]) * (tilt + 10)
                note(axis, at, f"{tilt:.0f}°")
            for radius in (21.8, 68.8):
                axis.add_patch(Circle((0, 0), radius, fill=False, color=GREY, lw=0.7, ls="--"))
            scene(axis, title, (-88, -88), (88, 88))

        return panel

    return picture(
        [draw("hook.ply", "mug on the hook"), draw("mug_tree.obj", "mug on the mug tree")], width=2.6, height=2.7
    )


def path():
    mug, hook = Mesh("mug.obj"), Mesh("hook.obj")
    found = predict("mug.obj", "hook.ply", "--plan", "--start", "samples/mug_start.json")
    waypoints = found["poses"][0]["path"]["waypoints"]
    poses = [pose_of(w["position"], w["quaternion_xyzw"]) for w in waypoints]
    centre = np.append(inspect("mug.obj")["centre_of_mass"], 1)

    def draw(axis):
        lines(axis, outline(hook.vertices[hook.triangles], (0, -1, 1e-3))[:, :, [0, 2]] * MM, HOOK, 0.9)
        for index in (0, 9, 17, 25, 33):
            lines(axis, outline(mug.at(poses[index]), (0, -1, 1e-3))[:, :, [0, 2]] * MM, MUG, 0.5, 0.45)
        lines(axis, outline(mug.at(poses[-1]), (0, -1, 1e-3))[:, :, [0, 2]] * MM, MUG, 1.1)
        way = np.array([pose @ centre for pose in poses])[:, [0, 2]] * MM
        axis.plot(*way.T, "-", color=POINT, lw=1)
        axis.plot(*way[0], "o", color=POINT, ms=3)
        scene(axis, f"{len(poses)} waypoints, {waypoints[-1]['seconds']:.1f} s", (-20, -175), (285, 65))

    return picture([draw], width=5, height=4.2)


# ---- the parameters: what they mean


def ring(axis, at, outer, inner, colour=MUG):
    axis.add_patch(Circle(at, outer, fill=False, color=colour, lw=1.3))
    axis.add_patch(Circle(at, inner, fill=False, color=colour, lw=1.3))


def circle(radius, degrees, at=(0, 0)):
    degrees = np.radians(degrees)
    return np.array([at[0] + radius * np.cos(degrees), at[1] + radius * np.sin(degrees)])


def object_sites():
    def cone(axis):
        axis.add_patch(Arc((0, 0), 16, 16, theta1=20, theta2=160, color=MUG, lw=1.3))
        centre = (0, -7)
        axis.plot(*centre, "+", color=BAD, ms=9, mew=1.6)
        note(axis, (0, -9), "centre of mass", BAD)
        for degrees in (30, 50, 70, 90, 110, 130, 150):
            at = circle(8, degrees)
            inwards, down = -at / 8, (np.array(centre) - at) / np.linalg.norm(np.array(centre) - at)
            is_contact = inwards @ down > 0.9
            arrow(axis, at, at + 3 * inwards, GOOD if is_contact else GREY)
        at = circle(8, 90)
        axis.add_patch(Wedge(at, 5, 270 - 37, 270 + 37, color=GOOD, alpha=0.15))
        scene(axis, "object_contact_cosine: normals in the cone", (-11, -11), (11, 10))

    def clusters(axis):
        draw = np.random.default_rng(3)
        for at, count, is_kept in (((-5, 3), 40, True), ((5, 2), 28, True), ((0, -6), 7, False)):
            x, y = (draw.normal(size=(count, 2)) * 1.1 + at).T
            axis.scatter(x, y, 4, GOOD if is_kept else GREY)
            axis.add_patch(Circle(at, 3.4, fill=False, color=POINT, lw=0.9, ls="--"))
            note(axis, (at[0], at[1] - 4.6), f"{count} points" + ("" if is_kept else ": dropped"))
        arrow(axis, (-5, 3), (-5 + 3.4, 3), POINT)
        note(axis, (-3.2, 7.3), "cluster_bandwidth", POINT)
        scene(axis, "min_cluster_points", (-11, -12), (11, 9))

    def free_space(axis):
        axis.add_patch(Arc((0, 0), 16, 16, theta1=0, theta2=180, color=MUG, lw=1.3))
        axis.add_patch(Arc((0, -9), 16, 6, theta1=0, theta2=180, color=MUG, lw=1.3))
        ys = np.linspace(8, -6, 10)
        axis.plot(0 * ys, ys, ".", color="black", ms=4)
        axis.add_patch(Circle((0, ys[5]), 6.1, color=POINT, alpha=0.15))
        axis.plot(0, ys[5], "o", color=POINT, ms=4)
        arrow(axis, (0, ys[5]), (6.1, ys[5]), POINT)
        note(axis, (9.3, ys[5] - 1.6), "free-space\nradius", POINT)
        note(axis, (0, 9.5), "contact point")
        note(axis, (-7, 4), "free_space_steps", ha="right", va="center")
        scene(axis, "largest radius ≥ min_free_space_radius", (-17, -10), (14, 11))

    def rays(axis):
        gap = (200, 250)
        for radius in (10, 8):
            axis.add_patch(Arc((0, 0), 2 * radius, 2 * radius, theta1=gap[1] - 360, theta2=gap[0], color=MUG, lw=1.3))
        for degrees in np.arange(3.6, 360, 14.4):
            hits = not gap[0] < degrees < gap[1]
            colour = BAD if not hits else (GOOD if degrees < 180 else POINT)
            lines(axis, [[(0, 0), circle(8 if hits else 11, degrees)]], colour, 0.7)
        note(axis, (0, 11.4), "above: min_encircled_above", GOOD)
        note(axis, (0, -11.6), "below: min_encircled_below", POINT)
        scene(axis, "rays_per_direction", (-13, -13), (13, 13))

    def directions(axis):
        ring(axis, (0, 0), 10, 8)
        for degrees in np.arange(0, 180, 15):
            arrow(axis, -circle(5, degrees), circle(5, degrees), GREY, 0.6)
        arrow(axis, -circle(7.4, 30), circle(7.4, 30), GOOD, 1.6)
        scene(axis, "object_directions, seen from above", (-12, -12), (12, 12))

    def similar(axis):
        for at, radius, degrees, colour in (((-6, 0), 5, 20, POINT), ((6, 0), 4.6, 32, GREY)):
            axis.add_patch(Circle(at, radius, color=colour, alpha=0.25))
            arrow(axis, np.array(at) - circle(4, degrees), np.array(at) + circle(4, degrees), colour)
        note(axis, (0, 7.5), "radii closer than similar_radius and")
        note(axis, (0, -7.5), "directions closer than similar_direction:\none site")
        scene(axis, "similar sites", (-13, -11), (13, 9))

    return picture([cone, clusters, free_space, directions, rays, similar], 3, 2.6, 2.3)


def supporter_sites():
    def facing_up(axis):
        axis.add_patch(Circle((0, 0), 7, fill=False, color=HOOK, lw=1.3))
        for degrees in range(0, 360, 20):
            is_up = np.sin(np.radians(degrees)) > 0.8
            arrow(axis, circle(7, degrees), circle(10, degrees), GOOD if is_up else GREY)
        axis.add_patch(Wedge((0, 0), 7, 90 - 37, 90 + 37, color=GOOD, alpha=0.15))
        scene(axis, "supporter_contact_cosine", (-12, -12), (12, 12))

    def slices(axis):
        axis.add_patch(plt.Rectangle((-12, -3), 24, 6, fill=False, color=HOOK, lw=1.3))
        for degrees in np.arange(0, 180, 30):
            lines(axis, [[-circle(9, degrees), circle(9, degrees)]], GREY, 0.6)
        lines(axis, [[(0, -9), (0, 9)]], GOOD, 1.6)
        arrow(axis, (0, 0), (8, 0), GOOD)
        note(axis, (5, -7.5), "the smallest section wins", GOOD)
        scene(axis, "supporter_directions, from above", (-13, -11), (13, 11))

    def slice_(axis):
        draw = np.random.default_rng(5)
        x, y = draw.uniform(-10, 10, 150), draw.uniform(-6, 6, 150)
        inside = abs(x) < 2
        axis.scatter(x, y, 4, np.where(inside, GOOD, GREY))
        axis.axvspan(-2, 2, color=GOOD, alpha=0.12)
        arrow(axis, (0, -7.4), (2, -7.4), POINT)
        note(axis, (0, -9.2), "slice_half_thickness", POINT)
        scene(axis, "points of a slice", (-11, -11), (11, 8))

    def link(axis):
        for at, count, colour in (((-4, 0), 14, GOOD), ((7, 0), 10, GREY)):
            x, y = circle(3, np.linspace(0, 360, count, endpoint=False), at)
            axis.plot(x, y, ".", color=colour, ms=5)
        arrow(axis, (-1, 0), (4, 0), BAD)
        note(axis, (1.5, -5.5), "farther than slice_link_distance:\nanother piece", BAD)
        scene(axis, "pieces of a section", (-11, -9), (12, 7))

    return picture([facing_up, slices, slice_, link], 2, 2.6, 2.3)


def matching():
    def fit(axis):
        ring(axis, (0, 0), 10, 8)
        axis.add_patch(Circle((0, 0), 8, color=POINT, alpha=0.12))
        axis.add_patch(Circle((0, 4.6), 3, fill=False, color=HOOK, lw=1.3))
        note(axis, (0, 4.6), "r_s", HOOK)
        arrow(axis, (0, 0), circle(8, -40), POINT)
        note(axis, (0.5, -4), "r_h", POINT)
        scene(axis, "r_h ≥ radius_ratio × r_s", (-12, -12), (12, 12))

    def collision(axis):
        axis.add_patch(Wedge((0, 0), 10, 0, 180, width=2, color=MUG, alpha=0.3))
        x, y = circle(4, np.linspace(0, 360, 30), (0, 6))
        inside = (x**2 + y**2 > 64) & (x**2 + y**2 < 100)
        axis.scatter(x, y, 7, np.where(inside, BAD, HOOK))
        note(axis, (0, -2.5), f"{inside.sum()} of {len(x)} points inside")
        scene(axis, "max_collision, collision_weight", (-12, -5), (12, 12))

    def boundary(axis):
        axis.plot([0, 20], [0, 0], color=HOOK, lw=4, solid_capstyle="butt")
        axis.plot(13, 0, "o", color=POINT)
        arrow(axis, (13, 2), (0, 2), POINT)
        arrow(axis, (13, 2), (20, 2), POINT)
        note(axis, (6, 3.6), "d1", POINT)
        note(axis, (16.5, 3.6), "d2", POINT)
        note(axis, (10, -3.5), "S_b = max(d1, d2) / (d1 + d2)")
        scene(axis, "boundary_weight", (-2, -6), (22, 6))

    def area(axis):
        counts = [80, 60, 25]
        axis.bar(range(3), counts, color=[GOOD, POINT, GREY])
        for i, count in enumerate(counts):
            note(axis, (i, count + 5), f"S_a = {1 - count / 80:.2f}")
        axis.set(title="contact_area_weight", xticks=range(3), xticklabels=["site 1", "site 2", "site 3"], ylim=(0, 95))
        axis.set_ylabel("contact points")

    return picture([fit, collision, boundary, area], 2, 2.6, 2.2)


# ---- the parameters: what they change on the samples


POOL = ThreadPoolExecutor(2)


def curve(name, values, measure, quantity, default, log=False):
    """A plot of a quantity of a result over a parameter, with its default value marked."""
    measured = [POOL.submit(measure, f"{name} = {value}") for value in values]

    def draw(axis):
        axis.axvline(default, color=GREY, lw=0.8, ls="--")
        axis.plot(values, [each.result() for each in measured], "o-", color=POINT, ms=3)
        if log:
            axis.set_xscale("log")
        axis.set(title=name, ylabel=quantity, ylim=(0, None))
        axis.tick_params(labelsize=6.5, width=0.5, length=2)
        axis.minorticks_off()

    return draw


def published():
    def of_mug(count):
        return lambda params: inspect("mug.obj", "--profile", "paper", params=params)["counts"][count]

    def of_tree(params):
        return inspect("mug_tree.ply", "--profile", "paper", params=params)["counts"]["contact_points"]

    def radius(params):
        sites = inspect("mug_tree.ply", "--profile", "paper", params=params)["sites"]
        return np.median([site["support_radius"] for site in sites]) * MM if sites else 0

    def matched(count):
        def measure(params):
            found = predict("mug.obj", "hook.ply", "--profile", "paper", params=params)
            return found["stats"]["counts"]["matching"][count]

        return measure

    def collision_of_best(params):
        found = predict("mug.obj", "mug_tree.ply", "--profile", "paper", params=params)
        return found["poses"][0]["cost"]["collision"]

    mm = "median support radius, mm"
    return picture([
        curve("samples", [1000, 3000, 10000], of_mug("clusters"), "clusters", 10000, True),
        curve("object_contact_cosine", [0, 0.6, 0.8, 0.9, 0.99], of_mug("contact_points"), "contact points", 0.8),
        curve("cluster_bandwidth", [0.03, 0.06, 0.1, 0.2], of_mug("clusters"), "clusters", 0.06),
        curve("min_cluster_points", [0, 20, 40, 60], of_mug("clusters"), "clusters", 20),
        curve("free_space_steps", [2, 3, 10], of_mug("with_free_space"), "sites with room", 10),
        curve("min_free_space_radius", [0.002, 0.03, 0.035], of_mug("with_free_space"), "sites with room", 0.002),
        curve("object_directions", [1, 5, 50], of_mug("sites"), "sites", 50),
        curve("rays_per_direction", [3, 10, 50], of_mug("sites"), "sites", 50),
        curve("min_encircled_below", [0.5, 0.7, 1], of_mug("encircled"), "encircled sites", 0.5),
        curve("similar_radius", [0, 0.01, 0.1], of_mug("sites"), "sites", 0.1),
        curve("similar_direction", [0, 0.5, 0.9, 0.99], of_mug("sites"), "sites", 0.9),
        curve("supporter_contact_cosine", [0, 0.8, 0.95, 1], of_tree, "contact points", 0.8),
        curve("supporter_directions", [1, 3, 20], radius, mm, 20),
        curve("slice_half_thickness", [0.001, 0.002, 0.004], radius, mm, 0.002),
        curve("slice_link_distance", [0.001, 0.006, 0.01], radius, mm, 0.006),
        curve("radius_ratio", [0, 0.5, 1], matched("fitting"), "pairs that fit", 1),
        curve("max_collision", [0, 0.01, 0.05, 1], matched("clear"), "clear poses", 1),
        curve("collision_weight", [0.001, 0.01, 1], collision_of_best, "points inside at the best", 1, True),
    ], 4, 2.1, 1.7)  # fmt: skip


def own():
    def best(quantity, supporter="hook.ply"):
        def measure(params):
            poses = predict("mug.obj", supporter, params=params)["poses"]
            return quantity(poses[0]) if poses else 0

        return measure

    def released(supporter):
        return lambda params: predict("mug.obj", supporter, params=params)["stats"]["counts"]["settling"]["released"]

    def count(params):
        return len(predict("mug.obj", "mug_tree.obj", params=params)["poses"])

    def count_tight(params):
        return len(
            predict("mug.obj", "hook.ply", params=f"{params}\nclearance = 0.0005\nsettle_attempts = 20")["poses"]
        )

    def memory(params):
        return predict("mug.obj", "hook.ply", params=params)["stats"]["memory_bytes"]["object"] / 1e6

    least_tilt = best(lambda pose: np.degrees(min(pose["margin"]["tilts"])), "mug_tree.obj")

    def tilt(params):
        return least_tilt(f"{params}\nsettle_attempts = 4")

    tolerance = best(lambda pose: pose["tolerance"]["position"] * MM)
    sinking = best(lambda pose: pose["sinking"] * MM)
    return picture([
        curve("friction", [0, 0.1, 0.4, 0.8], tilt, "least tilt, degrees", 0.4),
        curve("clearance", [0.001, 0.004, 0.008], tolerance, "tolerance, mm", 0.001),
        curve("time_step", [0.001, 0.004], sinking, "sinking, mm", 0.004),
        curve("settle_time", [0.1, 0.5, 3], released("mug_tree.obj"), "releases needed", 3),
        curve("rest_speed", [0.0001, 0.005, 0.1], released("hook.ply"), "releases needed", 0.005, True),
        curve("voxels", [1e5, 4e5, 1e6], lambda p: memory(p.replace(".0", "")), "memory, MB", 4e5),
        curve("settle_attempts", [8, 48, 192], count, "poses", 192, True),
        curve("firm_enough", [1, 2, 4], count, "poses", 2),
        curve("min_probability", [0, 0.3, 0.7], count_tight, "poses, clearance 0.5 mm", 0.3),
    ], 3, 2.4, 1.7)  # fmt: skip


FIGURES = {
    "how_candidates": candidates,
    "how_release": release,
    "how_margin": margin,
    "how_path": path,
    "params_object": object_sites,
    "params_supporter": supporter_sites,
    "params_matching": matching,
    "params_published": published,
    "params_default": own,
}


def main():
    is_check = sys.argv[1:] == ["--check"]
    stale = []
    with mpl.rc_context(STYLE):
        for name, draw in FIGURES.items():
            file, drawn = FOLDER / f"{name}.svg", draw()
            if is_check and (not file.exists() or file.read_text() != drawn):
                stale.append(f"docs/figures/{name}.svg")
            elif not is_check:
                file.write_text(drawn)
    if stale:
        raise SystemExit(
            f"figures: {', '.join(stale)}: not what the program draws; run scripts/book.sh --figures and commit"
        )


if __name__ == "__main__":
    main()
