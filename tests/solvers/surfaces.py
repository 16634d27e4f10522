# SPDX-License-Identifier: Apache-2.0
"""Bodies with closed-form solutions, as OBJ files whose groups name the parts of the surface."""
import math


def beam(path, length, side):
    """Writes a beam along x with its ends as groups."""
    corners = [(x, y, z) for x in (0, length) for y in (0, side) for z in (0, side)]
    quads = {"root": [(0, 1, 3, 2)], "tip": [(4, 6, 7, 5)],
             "sides": [(0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]}
    lines = [f"v {x} {y} {z}" for x, y, z in corners]
    for name, faces in quads.items():
        lines.append(f"g {name}")
        lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")
    return path


def cylinder(path, radius, length, parts=64):
    """Writes a cylinder along z with its ends as groups; its sides are flat between `parts` edges."""
    lines, faces = [], {"bottom": [], "top": [], "side": []}
    for z in (0, length):
        for j in range(parts):
            phi = 2 * math.pi * j / parts
            lines.append(f"v {radius * math.cos(phi)!r} {radius * math.sin(phi)!r} {z}")
    for j in range(parts):
        after = (j + 1) % parts
        faces["side"].append((j + 1, after + 1, parts + after + 1, parts + j + 1))
    faces["bottom"].append(tuple(range(parts, 0, -1)))
    faces["top"].append(tuple(range(parts + 1, 2 * parts + 1)))
    for name, all_faces in faces.items():
        lines.append(f"g {name}")
        lines += ["f " + " ".join(map(str, face)) for face in all_faces]
    path.write_text("\n".join(lines) + "\n")
    return path


def spheres(path, outer, inner=None, parts=120):
    """Writes a ball, or with an inner radius a thick sphere, with its walls as groups, the inner one reversed.

    `parts` is the number of triangles from pole to pole.
    """
    lines, faces = [], {}
    for name, radius in (("outer", outer), ("inner", inner)):
        if radius is not None:
            faces[name] = wall(lines, radius, parts)
    for name, all_faces in faces.items():
        lines.append(f"g {name}")
        for face in all_faces:
            lines.append("f " + " ".join(map(str, face if name == "outer" else face[::-1])))
    path.write_text("\n".join(lines) + "\n")
    return path


def wall(lines, radius, parts):
    """Appends the points of a sphere to the lines and returns its triangles, counter-clockwise from outside."""
    faces, rings = [], []
    count = len(lines)
    around = 2 * parts
    for i in range(1, parts):
        theta = math.pi * i / parts
        rings.append([])
        for j in range(around):
            phi = math.pi * j / parts
            lines.append(f"v {radius * math.sin(theta) * math.cos(phi)!r} {radius * math.sin(theta) * math.sin(phi)!r} "
                         f"{radius * math.cos(theta)!r}")
            count += 1
            rings[-1].append(count)
    lines += [f"v 0 0 {radius}", f"v 0 0 {-radius}"]
    north, south = count + 1, count + 2
    for j in range(around):
        after = (j + 1) % around
        faces.append((north, rings[0][j], rings[0][after]))
        faces.append((south, rings[-1][after], rings[-1][j]))
        for a, b in zip(rings, rings[1:]):
            faces.append((a[j], b[j], b[after], a[after]))
    return faces
