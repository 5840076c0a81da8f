"""Writes a mesh (OBJ) and a cloud (binary PLY of floats x y z nx ny nz) as the plain arrays that predict.c reads.

input.py OBJECT SUPPORTER OUT
"""
import pathlib
import struct
import sys

mesh, cloud, out = map(pathlib.Path, sys.argv[1:])
vertices, triangles = [], []
for line in mesh.read_text().splitlines():
    kind, *rest = line.split() or [""]
    if kind == "v":
        vertices.append([float(x) for x in rest[:3]])
    elif kind == "f":
        corners = [int(word.split("/")[0]) - 1 for word in rest]
        triangles += [[corners[0], corners[k], corners[k + 1]] for k in range(1, len(corners) - 1)]
header, body = cloud.read_bytes().split(b"end_header\n", 1)
count = int(header.split(b"element vertex ")[1].split()[0])
points = list(struct.iter_unpack("<6f", body[: 24 * count]))
with out.open("wb") as file:
    file.write(struct.pack("<3I", len(vertices), len(triangles), count))
    file.write(b"".join(struct.pack("<3f", *vertex) for vertex in vertices))
    file.write(b"".join(struct.pack("<3I", *triangle) for triangle in triangles))
    file.write(b"".join(struct.pack("<3f", *point[:3]) for point in points))
    file.write(b"".join(struct.pack("<3f", *point[3:]) for point in points))
