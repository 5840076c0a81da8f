#!/usr/bin/env python3
"""Compares a mesh that hangpose fused from depth images with that of Open3D from the same images.

  fusion.py FOLDER MESH [--voxel 0.01]

FOLDER holds *.depth.png (16 bits, millimetres), *.pose.txt (4 x 4, camera to world) and camera-intrinsics.txt (3 x 3).
MESH is from `hangpose scan` or from `cargo run --release -p host-tests --bin kinect -- ... --mesh MESH`, with the same
voxels. Prints how far the vertices of each mesh are from the surface of the other, where the images show both. Needs
open3d and numpy (requirements.txt).

The meshes cannot be equal: hangpose weighs near images more and drops flying pixels, and the poses of a recording
disagree by a voxel or two, so that other weights give another mean. Two thirds of the vertices within half a voxel, in both directions, and a median below a third of a voxel
are agreement. Another pose convention, camera model or pixel centre moves the median by a voxel or more.
"""
import argparse
import pathlib
import sys
import time

import numpy as np
import open3d as o3d
import open3d.core as o3c

MAX_DEPTH = 5.0
TRUNCATION_VOXELS = 4.0
# Least share of vertices within half a voxel, and greatest median in voxels.
LEAST_SHARE, MOST_MEDIAN = 0.65, 1 / 3


def fuse(folder, voxel):
    """The mesh of Open3D's VoxelBlockGrid."""
    intrinsics = o3c.Tensor(np.loadtxt(folder / "camera-intrinsics.txt"))
    grid = o3d.t.geometry.VoxelBlockGrid(
        ("tsdf", "weight"), (o3c.float32, o3c.float32), ((1), (1)), voxel, 8, 100_000)
    for path in sorted(folder.glob("*.depth.png")):
        pixels = np.asarray(o3d.io.read_image(str(path))).copy()
        pixels[pixels == 65535] = 0
        depth = o3d.t.geometry.Image(o3c.Tensor(pixels))
        pose = np.loadtxt(str(path).replace(".depth.png", ".pose.txt"))
        extrinsics = o3c.Tensor(np.linalg.inv(pose))
        blocks = grid.compute_unique_block_coordinates(
            depth, intrinsics, extrinsics, 1000.0, MAX_DEPTH, TRUNCATION_VOXELS)
        grid.integrate(blocks, depth, intrinsics, extrinsics, 1000.0, MAX_DEPTH, TRUNCATION_VOXELS)
    return grid.extract_triangle_mesh(weight_threshold=0.5)


def distances(of, to):
    """Distances of the vertices of one mesh from the surface of the other, in metres."""
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(to)
    return scene.compute_distance(of.vertex.positions).numpy()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("mesh", type=pathlib.Path)
    parser.add_argument("--voxel", type=float, default=0.01)
    args = parser.parse_args()
    start = time.perf_counter()
    theirs = fuse(args.folder, args.voxel)
    seconds = time.perf_counter() - start
    ours = o3d.t.io.read_triangle_mesh(str(args.mesh))
    print(f"Open3D {o3d.__version__}: {len(theirs.vertex.positions)} vertices, {seconds:.2f} s with reading")
    print(f"hangpose: {len(ours.vertex.positions)} vertices")
    fits = True
    for name, found in (("hangpose to Open3D", distances(ours, theirs)), ("Open3D to hangpose", distances(theirs, ours))):
        within = np.mean(found < args.voxel / 2)
        fits &= within >= LEAST_SHARE and np.median(found) <= MOST_MEDIAN * args.voxel
        print(f"{name}: median {1000 * np.median(found):.2f} mm, 95 % {1000 * np.percentile(found, 95):.2f} mm, "
              f"{100 * within:.1f} % within half a voxel")
    sys.exit(0 if fits else "the meshes do not agree")


if __name__ == "__main__":
    main()
