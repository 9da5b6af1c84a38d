#!/usr/bin/env python3
"""Writes the large scenes of docs/performance.md:

    bench/make_large_scenes.py FOLDER

triangles.pbrt: a hilly ground of 10 million triangles (a binary PLY file of 190 MB) under the sun.
instances.pbrt: 100,000 instances of a ball of 10,000 triangles, each turned and scaled in a way of its own.
"""
import array
import math
import pathlib
import random
import sys

HEAD = """LookAt {look}
Camera "perspective" "float fov" 40
Film "image" "integer xresolution" 640 "integer yresolution" 360 "string filename" "{name}.exr"
Sampler "sobol" "integer pixelsamples" 4
Integrator "path" "integer maxdepth" 5
WorldBegin
LightSource "distant" "point from" [1 2 3] "point to" [0 0 0] "rgb L" [3 3 3]
LightSource "infinite" "rgb L" [0.3 0.4 0.5]
Material "matte" "rgb Kd" [0.5 0.5 0.5]
"""


def write_ply(path, vertices, triangles):
    """`vertices`: x y z x y z ...; `triangles`: indices, three each."""
    count = len(triangles) // 3
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices) // 3}\nproperty float x\n"
              f"property float y\nproperty float z\nelement face {count}\n"
              "property list uchar int vertex_indices\nend_header\n")
    raw, faces = triangles.tobytes(), bytearray(13 * count)
    for i in range(13):
        faces[i::13] = b"\3" * count if i == 0 else raw[i - 1::12]
    with open(path, "wb") as file:
        file.write(header.encode())
        file.write(vertices.tobytes())
        file.write(faces)


def grid(rows, columns, point):
    """A surface of 2 * rows * columns triangles; `point(u, v)` is (x, y, z)."""
    vertices, triangles = array.array("f"), array.array("i")
    for row in range(rows + 1):
        for column in range(columns + 1):
            vertices.extend(point(column / columns, row / rows))
    for row in range(rows):
        for column in range(columns):
            a = row * (columns + 1) + column
            b = a + columns + 1
            triangles.extend((a, a + 1, b + 1, a, b + 1, b))
    return vertices, triangles


def hill(u, v):
    x, y = 20 * u - 10, 20 * v - 10
    return x, y, 0.5 * math.sin(x) * math.cos(1.3 * y) + 0.02 * math.sin(37 * x + 5 * math.sin(31 * y))


def ball(u, v):
    phi, theta = 2 * math.pi * u, math.pi * v
    r = 1 + 0.05 * math.sin(8 * phi) * math.sin(6 * theta)
    return r * math.sin(theta) * math.cos(phi), r * math.sin(theta) * math.sin(phi), r * math.cos(theta)


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    write_ply(folder / "ground.ply", *grid(2000, 2500, hill))
    (folder / "triangles.pbrt").write_text(
        HEAD.format(look="0 -12 5  0 0 0  0 0 1", name="triangles") +
        'Shape "plymesh" "string filename" "ground.ply"\nWorldEnd\n')
    write_ply(folder / "ball.ply", *grid(50, 100, ball))
    numbers = random.Random(1)
    with open(folder / "instances.pbrt", "w", encoding="ascii") as file:
        file.write(HEAD.format(look="0 -70 40  0 0 0  0 0 1", name="instances"))
        file.write('ObjectBegin "ball"\nShape "plymesh" "string filename" "ball.ply"\nObjectEnd\n')
        for _ in range(100_000):
            x, y, z = (numbers.uniform(-30, 30) for _ in range(3))
            file.write(f"AttributeBegin Translate {x:.4f} {y:.4f} {z:.4f} Rotate {numbers.uniform(0, 360):.2f} 1 2 3 "
                       f"Scale {numbers.uniform(0.1, 0.4):.3f} 0.2 0.2 ObjectInstance \"ball\" AttributeEnd\n")
        file.write("WorldEnd\n")


main()
