# SPDX-License-Identifier: Apache-2.0
"""Improves meshes with a coarse skin and a random interior, as no mesher makes them.

usage: random_interiors.py [--help]    (Debian's python3 with python3-numpy and python3-scipy)

A tet from the centre to each triangle of a surface, then tets divided at random points in them until there are enough:
three of ten steps divide any tet, the others the largest of twelve. The skin stays as coarse as it is. Prints the fraction of
tets below 0.1 sr before and after `tetwright improve --free-count`.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

import numpy as np
from scipy.spatial import ConvexHull

ROOT = pathlib.Path(__file__).resolve().parents[2]
ANY_TET = 0.3
CHOICE = 12


def spread_directions(count):
    """Unit vectors on a spiral, each for an equal area of the sphere."""
    i = np.arange(count) + 0.5
    polar, turn = np.arccos(1 - 2 * i / count), np.pi * (1 + 5 ** 0.5) * i
    return np.stack([np.cos(turn) * np.sin(polar), np.sin(turn) * np.sin(polar), np.cos(polar)], 1)


def caltrop():
    """Six thin arms of square section, with needles along them."""
    half, length = 0.15, 1.0
    cube = np.array([[x, y, z] for x in (-half, half) for y in (-half, half) for z in (-half, half)])
    points, triangles = list(cube), []
    for axis in range(3):
        for sign in (-1, 1):
            b, c = (axis + 1) % 3, (axis + 2) % 3
            face = sorted((i for i in range(8) if cube[i][axis] * sign > 0),
                          key=lambda i, b=b, c=c, sign=sign: np.arctan2(cube[i][c], cube[i][b]) * sign)
            end = []
            for i in face:
                tip = 0.9 * cube[i]
                tip[axis] = sign * length
                end.append(len(points))
                points.append(tip)
            for k in range(4):
                low, high, top, other = face[k], face[(k + 1) % 4], end[(k + 1) % 4], end[k]
                triangles += [(low, high, top), (low, top, other)]
            triangles += [(end[0], end[1], end[2]), (end[0], end[2], end[3])]
    return np.array(points), triangles


def needles():
    """A ball of few latitudes and many meridians."""
    meridians, latitudes = 60, 5
    points, triangles = [(0, 0, 1), (0, 0, -1)], []
    for i in range(1, latitudes):
        polar = np.pi * i / latitudes
        for j in range(meridians):
            turn = 2 * np.pi * j / meridians
            points.append((np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)))

    def number(i, j):
        return 2 + (i - 1) * meridians + j % meridians

    for j in range(meridians):
        triangles += [(0, number(1, j), number(1, j + 1)), (1, number(latitudes - 1, j + 1), number(latitudes - 1, j))]
        for i in range(1, latitudes - 1):
            triangles += [(number(i, j), number(i + 1, j), number(i + 1, j + 1)),
                          (number(i, j), number(i + 1, j + 1), number(i, j + 1))]
    return np.array(points, float), triangles


def plate():
    """A flat ellipsoid."""
    directions = spread_directions(400)
    return directions * np.array([1, 1, 0.08]), ConvexHull(directions).simplices


def star():
    """A body with five bulges."""
    directions = spread_directions(1500)
    turn = np.arctan2(directions[:, 1], directions[:, 0])
    radius = 0.45 + 0.35 * np.cos(5 * turn) * np.hypot(directions[:, 0], directions[:, 1]) + 0.1 * directions[:, 2] ** 2
    return directions * radius[:, None], ConvexHull(directions).simplices


def cube():
    """A cube of four squares along each edge."""
    grid = np.linspace(-1, 1, 5)
    points = np.unique([np.roll([side, a, b], axis) for axis in range(3) for side in (-1, 1) for a in grid for b in grid],
                       axis=0)
    return points, ConvexHull(points / np.linalg.norm(points, axis=1)[:, None]).simplices


KINDS = {"caltrop": caltrop, "needles": needles, "plate": plate, "star": star, "cube": cube}


def random_interior(kind, count, seed):
    """Points and tets of a body that is star-shaped around the origin."""
    rng = np.random.default_rng(seed)
    skin, triangles = KINDS[kind]()
    points = [*skin, rng.normal(size=3) * 1e-3]
    centre = len(skin)

    def volume(tet):
        a, b, c, d = (points[i] for i in tet)
        return np.dot(np.cross(b - a, c - a), d - a)

    tets = [[centre, *t] for t in triangles]
    tets = [t if volume(t) > 0 else [t[0], t[2], t[1], t[3]] for t in tets]
    volumes = [volume(t) for t in tets]
    while len(tets) < count:
        chosen = rng.integers(len(tets)) if rng.random() < ANY_TET else max(rng.integers(len(tets), size=CHOICE),
                                                                          key=lambda i: volumes[i])
        tet = tets[chosen]
        points.append(sum(w * points[i] for w, i in zip(rng.dirichlet([1.5] * 4), tet)))
        parts = [[*tet[:j], len(points) - 1, *tet[j + 1:]] for j in range(4)]
        tets[chosen], volumes[chosen] = parts[0], volume(parts[0])
        tets += parts[1:]
        volumes += [volume(p) for p in parts[1:]]
    return points, tets


def write_medit(points, tets, file):
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(points))]
    lines += ["%.17g %.17g %.17g 0" % tuple(p) for p in points]
    lines += ["Tetrahedra", str(len(tets))]
    lines += ["%d %d %d %d 1" % tuple(i + 1 for i in t) for t in tets]
    file.write_text("\n".join([*lines, "End", ""]), encoding="ascii")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--counts", default="2500,15000", help="tets, with commas between them; default: %(default)s")
    parser.add_argument("--kinds", default=",".join(KINDS), help="default: %(default)s")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--write", type=pathlib.Path, help="only write the meshes to this folder")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/tetwright")
    line = parser.parse_args()
    if not line.write:
        print("| kind | tets | below 0.1 sr | tets after | below 0.1 sr | smallest, sr | seconds |\n"
              "| --- | --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for kind in line.kinds.split(","):
            for count in map(int, line.counts.split(",")):
                mesh = (line.write or pathlib.Path(folder)) / f"{kind}{count}.mesh"
                write_medit(*random_interior(kind, count, line.seed), mesh)
                if line.write:
                    continue
                stats = pathlib.Path(folder) / "stats.json"
                subprocess.run([line.program, "improve", mesh, "-o", pathlib.Path(folder) / "out.mesh", "--free-count",
                                "--threads", str(line.threads), "--stats", stats], check=False, capture_output=True)
                run = json.loads(stats.read_text(encoding="utf-8"))
                before, after = run["dense"], run["result"]
                print(f"| {kind} | {before['tets']} | {before['percent_below_threshold']:.3g} % | {after['tets']} | "
                      f"{after['percent_below_threshold']:.3g} % | {after['min_solid_angle']:.3f} | "
                      f"{run['seconds']['total']:.1f} |", flush=True)


if __name__ == "__main__":
    main()
