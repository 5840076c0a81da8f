#!/usr/bin/env python3
"""Compares poses of hangpose with those of another implementation of the paper, written with Open3D and scikit-learn.

  peer.py --peer PEER.py --meshes DIR [OBJECT:SUPPORTER ...]   whether the best poses of both agree

against_peer.py compares their times.

PEER.py must define `load(object, supporter, scale, supporter_mesh)` and `predict(mesh, points, normals)`, which
returns ranked poses (dicts with a 4x4 `pose`) and timings. DIR holds meshes with a `manifest.json` that gives
`name`, `file`, `scale_to_m` and `up_axis`. Needs open3d, scikit-learn, scipy, trimesh and pillow.
"""
import argparse
import importlib.util
import itertools
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

import numpy as np
import open3d as o3d
import trimesh

o3d.utility.set_verbosity_level(o3d.utility.VerbosityLevel.Error)

TOP = 5
NEAR_M, NEAR_DEG = 0.015, 20.0
PAIRS = pathlib.Path(__file__).with_name("pairs.txt")


def hangpose(command, *arguments):
    """Returns the poses of one prediction with the `paper` profile on one thread."""
    run = [command, "predict", "--profile", "paper", "--threads", "1", "--json", "-", *map(str, arguments)]
    result = subprocess.run(run, capture_output=True, text=True)
    if result.returncode not in (0, 3):
        sys.exit(result.stderr)
    return [np.array(p["pose"]).reshape(4, 4) for p in json.loads(result.stdout)["poses"]]


def load(entry, folder):
    """Loads a mesh of the manifest, in metres with z up."""
    shape = trimesh.load(folder / entry["file"], force="mesh", process=False, skip_materials=True)
    mesh = o3d.geometry.TriangleMesh(o3d.utility.Vector3dVector(shape.vertices), o3d.utility.Vector3iVector(shape.faces))
    mesh.scale(entry["scale_to_m"], np.zeros(3))
    turns = {"-x": [[0, 0, 1], [0, 1, 0], [-1, 0, 0]], "+y": [[1, 0, 0], [0, 0, -1], [0, 1, 0]], "+z": np.eye(3)}
    mesh.rotate(np.array(turns[entry["up_axis"]], dtype=float), center=np.zeros(3))
    mesh.remove_duplicated_vertices()
    mesh.compute_triangle_normals()
    return mesh


def apart(a, b, centre):
    """Returns the distance of two poses at the object's centre in metres and their angle in degrees."""
    turn = np.degrees(np.arccos(np.clip((np.trace(a[:3, :3].T @ b[:3, :3]) - 1) / 2, -1, 1)))
    return np.linalg.norm((a - b)[:3, :3] @ centre + (a - b)[:3, 3]), turn


def do_agree(some, others, centre):
    """Returns whether any of the best poses of one run is near any of the best poses of another."""
    gaps = [apart(a, b, centre) for a, b in itertools.product(some[:TOP], others[:TOP])]
    return any(metres <= NEAR_M and degrees <= NEAR_DEG for metres, degrees in gaps)


def agree(peer, command, args):
    """Prints for each pair how often one of the best five poses of one run is near one of the best five of another."""
    folder = pathlib.Path(args.meshes)
    manifest = {entry["name"]: entry for entry in json.loads((folder / "manifest.json").read_text())}
    print(f"near: within {NEAR_M * 1000:.0f} mm at the object's centre and {NEAR_DEG:.0f} degrees; "
          f"{args.runs} runs each with different samples")
    print("pair                                                    poses  hangpose-peer  peer-peer  hangpose-hangpose")
    agreed = pairs = 0
    for pair in args.pairs:
        names = pair.split(":")
        mesh, supporter = (load(manifest[name], folder) for name in names)
        cloud = supporter.sample_points_poisson_disk(10000, use_triangle_normal=True)
        points, normals = np.asarray(cloud.points), np.asarray(cloud.normals)
        centre = mesh.get_axis_aligned_bounding_box().get_center()
        with tempfile.TemporaryDirectory() as scratch:
            object_file, supporter_file = scratch + "/object.ply", scratch + "/supporter.ply"
            o3d.io.write_triangle_mesh(object_file, mesh)
            o3d.io.write_point_cloud(supporter_file, cloud)
            files = ("--object", object_file, "--supporter", supporter_file)
            ours = [hangpose(command, *files, "--seed", seed) for seed in range(args.runs)]
        theirs = [[p["pose"] for p in peer.predict(mesh, points, normals)[0]] for _ in range(args.runs)]
        rate = lambda some: statistics.mean(do_agree(a, b, centre) for a, b in some)
        cross = rate(list(itertools.product(ours, theirs)))
        spread = [rate(list(itertools.combinations(runs, 2))) for runs in (theirs, ours)]
        has_poses = all(theirs)
        pairs += has_poses
        agreed += has_poses and cross >= 0.5
        print(f"{pair:55} {len(theirs[0]):5} {cross:14.0%} {spread[0]:10.0%} {spread[1]:18.0%}", flush=True)
    print(f"{agreed} of the {pairs} pairs with poses of the peer agree in at least half of the runs")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--peer", required=True)
    parser.add_argument("--command", default="target/release/hangpose")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--meshes", required=True)
    parser.add_argument("pairs", nargs="*", default=PAIRS.read_text().split())
    args = parser.parse_args()
    spec = importlib.util.spec_from_file_location("peer", args.peer)
    peer = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(peer)
    agree(peer, args.command, args)


if __name__ == "__main__":
    main()
