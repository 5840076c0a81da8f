#!/usr/bin/env python3
"""Single queries of Open3D, with Embree, and time steps of MuJoCo, beside those that criterion measures.

  primitives.py --data FOLDER --bench PROGRAM --criterion FOLDER --out FILE [--rounds 2]

FOLDER is what `speed primitives` wrote: a mesh, queries and hangpose's answers. For each kind of query the program
PROGRAM, which is host-tests/src/bin/primitives.rs, and Open3D take turns; the answers of Open3D are compared with
hangpose's. Needs open3d, mujoco, numpy and scipy; what is missing is left out.
"""
import argparse
import json
import os
import pathlib
import subprocess
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")

# Largest difference of a distance in single precision, m.
TOLERANCE = 2e-6
GROUPS = ("any_hit", "closest_hit", "closest_point", "signed_distance", "nearest", "eight_nearest", "poisson_disk", "fuse",
          "isosurface", "contact_step")


def timed(call, seconds=1.0, least=5):
    """The times of calls within about `seconds`, after one that does not count."""
    call()
    times, start = [], time.perf_counter()
    while len(times) < least or time.perf_counter() - start < seconds:
        before = time.perf_counter()
        call()
        times.append(time.perf_counter() - before)
    return times


def floats(folder, name, width):
    import numpy as np
    return np.fromfile(folder / f"{name}.f32", dtype="<f4").reshape(-1, width)


class Open3d:
    """The queries that Open3D has."""

    def __init__(self, folder, about):
        import numpy as np
        import open3d as o3d
        self.np, self.o3d, self.folder, self.about = np, o3d, folder, about
        o3d.utility.set_verbosity_level(o3d.utility.VerbosityLevel.Error)
        self.mesh = o3d.io.read_triangle_mesh(str(folder / "mesh.ply"))
        self.scene = o3d.t.geometry.RaycastingScene(nthreads=1)
        self.scene.add_triangles(o3d.t.geometry.TriangleMesh.from_legacy(self.mesh))
        tensor = lambda name, width: o3d.core.Tensor(floats(folder, name, width))
        self.rays, self.points = tensor("rays", 6), tensor("points", 3)
        self.hits, self.signed = floats(folder, "hits", 1)[:, 0], floats(folder, "signed", 1)[:, 0]
        self.cloud = o3d.core.Tensor(floats(folder, "cloud", 3))
        self.near = o3d.core.Tensor(floats(folder, "near_cloud", 3))
        self.tree = o3d.core.nns.NearestNeighborSearch(self.cloud)
        self.tree.knn_index()
        pixels = np.fromfile(folder / "depths.u16", dtype="<u2").reshape(about["height"], about["width"])
        self.depth = o3d.t.geometry.Image(o3d.core.Tensor(pixels.copy()))
        focal, width, height = about["focal"], about["width"], about["height"]
        matrix = [[focal, 0, (width - 1) / 2], [0, focal, (height - 1) / 2], [0, 0, 1]]
        self.camera = o3d.core.Tensor(np.array(matrix))
        self.grid = None

    def close(self, apart, what):
        worst = float(self.np.max(apart))
        assert worst < TOLERANCE, f"{what}: hangpose and Open3D differ by {worst}"

    def same(self, ours, theirs):
        """Share of rays in percent with the same answer: one that grazes an edge may miss it in one library."""
        share = float(self.np.mean(ours == theirs))
        assert share > 0.999, f"only {share} of the rays have the same answer"
        return 100 * share

    def any_hit(self):
        cast = lambda: self.scene.test_occlusions(self.rays, nthreads=1)
        same = self.same(self.np.isfinite(self.hits), cast().numpy())
        return {"embree": timed(cast)}, {"same_hits_percent": same}

    def closest_hit(self):
        cast = lambda: self.scene.cast_rays(self.rays, nthreads=1)
        found = cast()["t_hit"].numpy()
        both = self.np.isfinite(found) & self.np.isfinite(self.hits)
        apart = self.np.abs(found[both] - self.hits[both])
        self.same(self.np.isfinite(self.hits), self.np.isfinite(found))
        self.close(self.np.sort(apart)[: int(0.999 * len(apart))], "closest hits")
        return {"embree": timed(cast)}, {"hits": int(both.sum())}

    def closest_point(self):
        ask = lambda: self.scene.compute_closest_points(self.points, nthreads=1)
        found = self.np.linalg.norm(ask()["points"].numpy() - self.points.numpy(), axis=1)
        self.close(self.np.abs(found - self.np.abs(self.signed)), "closest points")
        return {"embree": timed(ask)}, {}

    def signed_distance(self):
        ask = lambda: self.scene.compute_signed_distance(self.points, nthreads=1, nsamples=1)
        found = ask().numpy()
        self.close(self.np.abs(self.np.abs(found) - self.np.abs(self.signed)), "distances")
        return {"embree": timed(ask)}, {"same_side_percent": 100 * float(self.np.mean((found < 0) == (self.signed < 0)))}

    def neighbours(self, count, column):
        # Open3D's search has no number of threads; main() runs this process on one core.
        ask = lambda: self.tree.knn_search(self.near, count)
        _, squares = ask()
        found = self.np.sqrt(squares.numpy().reshape(len(self.near), count)[:, -1])
        self.close(self.np.abs(found - floats(self.folder, "neighbours", 2)[:, column]), f"{count} neighbours")
        return {"open3d": timed(ask)}, {}

    def nearest(self):
        return self.neighbours(1, 0)

    def eight_nearest(self):
        return self.neighbours(8, 1)

    def poisson_disk(self):
        sample = lambda: self.mesh.sample_points_poisson_disk(self.about["samples"])
        from scipy.spatial import cKDTree
        def spread(points):
            """The median distance of a point to its nearest, and the least, mm."""
            gaps = 1000 * cKDTree(points).query(points, k=2)[0][:, 1]
            return [float(self.np.median(gaps)), float(gaps.min())]
        theirs = spread(self.np.asarray(sample().points))
        return {"open3d": timed(sample, least=3)}, {
            "spread_mm": {"hangpose": spread(floats(self.folder, "samples", 3)), "open3d": theirs}}

    def fused(self):
        core, about = self.o3d.core, self.about
        grid = self.o3d.t.geometry.VoxelBlockGrid(
            ("tsdf", "weight"), (core.float32, core.float32), ((1), (1)), about["voxel"], 8, 20_000)
        scale, far, truncation = 1 / about["scale"], 5.0, 4.0
        pose = core.Tensor(self.np.eye(4))
        blocks = grid.compute_unique_block_coordinates(self.depth, self.camera, pose, scale, far, truncation)
        grid.integrate(blocks, self.depth, self.camera, pose, scale, far, truncation)
        self.grid = grid

    def fuse(self):
        return {"open3d": timed(self.fused)}, {}

    def isosurface(self):
        self.fused()
        extract = lambda: self.grid.extract_triangle_mesh(weight_threshold=0.5)
        vertices = extract().vertex.positions.numpy()
        centre = self.np.array([0, 0, self.about["centre"]])
        off = self.np.abs(self.np.linalg.norm(vertices - centre, axis=1) - self.about["radius"])
        return {"open3d": timed(extract)}, {"vertices": len(vertices), "median_off_mm": 1000 * float(self.np.median(off))}


def mujoco_step(scene):
    """Times of 100 steps of MuJoCo with the same parts, mass properties, time step and rest pose."""
    import mujoco
    import numpy as np
    text = lambda numbers: " ".join(f"{x:.9g}" for x in numbers)
    assets = []

    def geoms(parts):
        lines = []
        for part in parts:
            if "hull" in part:
                if np.linalg.matrix_rank(np.subtract(part["hull"], part["hull"][0]), tol=1e-6) < 3:
                    # MuJoCo has no flat hulls. The ends of a round part are such.
                    continue
                name = f"hull{len(assets)}"
                assets.append(f'<mesh name="{name}" vertex="{text(np.ravel(part["hull"]))}"/>')
                # MuJoCo moves a mesh to its centre of mass and principal axes, and places it there again.
                lines.append(f'<geom type="mesh" mesh="{name}"/>')
            elif "radius" in part:
                ends = text([*part["from"], *part["to"]])
                lines.append(f'<geom type="capsule" fromto="{ends}" size="{part["radius"]:.9g}"/>')
            else:
                axes = text(np.ravel(part["axes"])[:6])
                lines.append(f'<geom type="box" pos="{text(part["centre"])}" xyaxes="{axes}" size="{text(part["half_extents"])}"/>')
        return "".join(lines)

    frame, rest = scene["frame"], scene["rest"]
    supporter, body = geoms(scene["supporter"]), geoms(scene["object"])
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><option timestep="{scene['time_step']}" gravity="0 0 -9.81"/>
<default><geom friction="{scene['friction']} 0.0001 0.0001" condim="3"/></default><asset>{''.join(assets)}</asset>
<worldbody>{supporter}<body pos="{text(rest['position'])}" quat="{text(rest['quaternion'])}"><freejoint/>
<inertial pos="{text(frame['position'])}" quat="{text(frame['quaternion'])}" mass="{scene['mass']}"
 diaginertia="{text(scene['inertia'])}"/>{body}</body></worldbody></mujoco>""")
    data = mujoco.MjData(model)
    start = data.qpos[:3].copy()
    mujoco.mj_step(model, data, nstep=int(0.5 / scene["time_step"]))
    drift = float(np.linalg.norm(data.qpos[:3] - start))
    contacts = data.ncon
    return timed(lambda: mujoco.mj_step(model, data, nstep=100)), {
        "contacts": contacts, "drift": drift, "version": mujoco.__version__}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=pathlib.Path, required=True)
    parser.add_argument("--bench", required=True)
    parser.add_argument("--criterion", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--rounds", type=int, default=2)
    args = parser.parse_args()
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    about = json.loads((args.data / "about.json").read_text())
    scene = json.loads((args.data / "scene.json").read_text())
    result = {"about": about, "steps": scene["steps"], "time_step": scene["time_step"], "pair": scene["pair"],
              "drift_in_bullet": scene["drift_in_bullet"], "groups": {}, "notes": {}, "missing": []}
    try:
        library = Open3d(args.data, about)
        result["open3d"] = library.o3d.__version__
    except ImportError:
        library = None
        result["missing"].append("Open3D")
    # Seconds for all queries of a kind: of ours, and of steps of the engines, for one.
    per = {"poisson_disk": 1, "fuse": 1, "isosurface": 1}
    for group in GROUPS:
        times = {}
        for _ in range(args.rounds):
            environment = os.environ | {"CRITERION_HOME": str(args.criterion)}
            subprocess.run([args.bench, "--bench", f"^{group}/"], check=True, stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL, env=environment)
            for sample in sorted((args.criterion / group).glob("*/new/sample.json")):
                found = json.loads(sample.read_text())
                one = [t / n / 1e9 for t, n in zip(found["times"], found["iters"])]
                times.setdefault(sample.parts[-3].replace("_", " "), []).extend(one)
            theirs, note = {}, {}
            if library and hasattr(library, group):
                theirs, note = getattr(library, group)()
            if group == "contact_step":
                try:
                    steps, note = mujoco_step(scene)
                    theirs = {"mujoco": steps}
                except ImportError:
                    if "MuJoCo" not in result["missing"]:
                        result["missing"].append("MuJoCo")
            for name, values in theirs.items():
                times.setdefault(name, []).extend(values)
            result["notes"][group] = note
        if group == "contact_step":
            divide = {name: 100 for name in times} | {"hangpose": scene["steps"]}
        else:
            divide = {name: per.get(group, about["queries"]) for name in times}
        result["groups"][group] = {name: [t / divide[name] for t in values] for name, values in times.items()}
        medians = {name: f"{1e9 * sorted(values)[len(values) // 2]:.0f}" for name, values in result["groups"][group].items()}
        print(f"{group}, ns: {medians} {result['notes'][group]}", flush=True)
    args.out.write_text(json.dumps(result))


if __name__ == "__main__":
    main()
