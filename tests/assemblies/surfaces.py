# SPDX-License-Identifier: Apache-2.0
"""Triangle surfaces as arrays: points (n, 3) and triangles (m, 3). Measuring, welding, refining, reading and writing."""
import pathlib

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree


def components(count, pairs):
    """Returns the number of components of a graph and that of each node; `pairs` has two columns."""
    if count == 0:
        return 0, np.zeros(0, int)
    pairs = np.asarray(pairs, int).reshape(-1, 2)
    return connected_components(coo_matrix((np.ones(len(pairs), np.int8), (pairs[:, 0], pairs[:, 1])),
                                           shape=(count, count)), directed=False)


def half_edges(triangles):
    return np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])


def neighbours(triangles):
    """Returns pairs of triangles that share an edge; around an edge of n triangles there are n - 1 pairs."""
    edges = np.sort(half_edges(triangles), axis=1)
    owner = np.tile(np.arange(len(triangles)), 3)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    same = (edges[order][1:] == edges[order][:-1]).all(axis=1)
    return np.column_stack([owner[order][1:][same], owner[order][:-1][same]])


def edge_counts(triangles):
    """Returns the edges, sorted ends first, and the number of triangles at each."""
    return np.unique(np.sort(half_edges(triangles), axis=1), axis=0, return_counts=True)


def euler(triangles):
    return len(np.unique(triangles)) - len(edge_counts(triangles)[0]) + len(triangles)


def pieces(triangles):
    """Returns the number of pieces that shared edges hold together, and the piece of each triangle."""
    return components(len(triangles), neighbours(triangles))


def normals(points, triangles):
    """Returns the normal of each triangle, as long as twice its area."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def area(points, triangles):
    return float(np.linalg.norm(normals(points, triangles), axis=1).sum() / 2)


def volume_and_center(points, triangles):
    """Returns the enclosed volume, positive if the normals point outwards, and the center of mass."""
    origin = points[triangles[0, 0]]
    a, b, c = (points[triangles[:, k]] - origin for k in range(3))
    volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
    total = volumes.sum()
    return float(total), origin + (volumes[:, None] * (a + b + c) / 4).sum(axis=0) / total


def volume(points, triangles):
    return volume_and_center(points, triangles)[0]


def diagonal(*surfaces):
    """Returns the diagonal of the box around all surfaces."""
    used = np.vstack([points[np.unique(triangles)] for points, triangles in surfaces])
    return float(np.linalg.norm(used.max(axis=0) - used.min(axis=0)))


def compact(points, triangles):
    """Drops the points that no triangle uses."""
    used, inverse = np.unique(triangles, return_inverse=True)
    return points[used], inverse.reshape(triangles.shape)


def join(surfaces):
    """Puts surfaces into one, without welding."""
    offsets = np.cumsum([0] + [len(points) for points, _ in surfaces])
    return (np.vstack([points for points, _ in surfaces]),
            np.vstack([triangles + offset for (_, triangles), offset in zip(surfaces, offsets)]))


def weld(points, tolerance):
    """Returns the points without those closer than the tolerance to another, and the new index of each."""
    _, group = components(len(points), cKDTree(points).query_pairs(tolerance, output_type="ndarray"))
    _, first = np.unique(group, return_index=True)
    return points[first], group


def oriented(points, triangles):
    """Winds each piece of a closed surface alike, outwards if it bounds a body from outside."""
    triangles = triangles.copy()
    edges = half_edges(triangles)
    by_edge = {}
    for k, edge in enumerate(edges.tolist()):
        by_edge.setdefault(tuple(sorted(edge)), []).append(k % len(triangles))
    seen = np.zeros(len(triangles), bool)
    for start in range(len(triangles)):
        if seen[start]:
            continue
        seen[start] = True
        piece = [start]
        for t in piece:
            a, b, c = triangles[t]
            for edge in ((a, b), (b, c), (c, a)):
                for other in by_edge[tuple(sorted(edge))]:
                    if seen[other]:
                        continue
                    p, q, r = triangles[other]
                    if edge in ((p, q), (q, r), (r, p)):
                        triangles[other] = p, r, q
                    seen[other] = True
                    piece.append(other)
        if volume(points, triangles[piece]) < 0:
            triangles[piece] = triangles[piece][:, ::-1]
    return triangles


def refined(points, triangles, longest):
    """Halves edges until none is longer than `longest`; returns also the index of the original of each triangle."""
    original = np.arange(len(triangles))
    while True:
        edges = edge_counts(triangles)[0]
        long = edges[np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1) > longest]
        if not len(long):
            return points, triangles, original
        middle = {tuple(edge): len(points) + k for k, edge in enumerate(long.tolist())}
        points = np.vstack([points, (points[long[:, 0]] + points[long[:, 1]]) / 2])
        parts, owners = [], []
        for owner, triangle in zip(original, triangles.tolist()):
            new = halved(triangle, middle)
            parts += new
            owners += [owner] * len(new)
        triangles, original = np.array(parts), np.array(owners)


def halved(triangle, middle):
    """Splits a triangle at those of its edges that have a middle."""
    marks = [middle.get(tuple(sorted((triangle[k], triangle[(k + 1) % 3])))) for k in range(3)]
    count = sum(m is not None for m in marks)
    if count == 0:
        return [triangle]
    # Turn it so that the only marked edge, or the only unmarked one, is the first.
    turn = next(k for k in range(3) if (marks[k] is not None) == (count == 1)) if count < 3 else 0
    a, b, c = (triangle[(turn + k) % 3] for k in range(3))
    ab, bc, ca = (marks[(turn + k) % 3] for k in range(3))
    if count == 1:
        return [[a, ab, c], [ab, b, c]]
    if count == 2:
        return [[c, ca, bc], [a, b, bc], [a, bc, ca]]
    return [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]


def faults(points, triangles):
    """Returns what keeps a surface from being the boundary of a body: a list of texts."""
    out = []
    if not np.isfinite(points).all():
        return ["a coordinate is not finite"]
    _, counts = edge_counts(triangles)
    if (counts != 2).any():
        out.append(f"{(counts != 2).sum()} edges do not have two triangles")
    half, counts = np.unique(half_edges(triangles), axis=0, return_counts=True)
    if (counts > 1).any():
        out.append(f"{(counts > 1).sum()} edges are wound against each other")
    if len(weld(points, 1e-9 * diagonal((points, triangles)))[0]) != len(points):
        out.append("points are repeated")
    if len(np.unique(triangles)) != len(points):
        out.append("points are not used")
    if np.linalg.norm(normals(points, triangles), axis=1).min() == 0:
        out.append("a triangle has no area")
    if not volume(points, triangles) > 0:
        out.append(f"the volume is {volume(points, triangles):.3g}")
    return out


def write(path, points, triangles, groups=None):
    """Writes .off, .ply, ASCII .stl or .obj; `groups` names the part of each triangle, in .stl and .obj."""
    path = pathlib.Path(path)
    points = np.asarray(points, float)
    names = list(groups) if groups is not None else [path.stem] * len(triangles)
    number = "%.17g %.17g %.17g"
    lines = [number % tuple(p) for p in points]
    parts = list(dict.fromkeys(names))
    of_part = {part: [t for t, name in zip(np.asarray(triangles).tolist(), names) if name == part] for part in parts}
    if path.suffix == ".off":
        text = ["OFF", f"{len(points)} {len(triangles)} 0", *lines] + ["3 %d %d %d" % tuple(t) for t in triangles]
    elif path.suffix == ".ply":
        text = ["ply", "format ascii 1.0", f"element vertex {len(points)}", "property double x", "property double y",
                "property double z", f"element face {len(triangles)}", "property list uchar int vertex_indices",
                "end_header", *lines] + ["3 %d %d %d" % tuple(t) for t in triangles]
    elif path.suffix == ".obj":
        text = ["v " + line for line in lines]
        for part in parts:
            text += [f"g {part}"] * (groups is not None)
            text += ["f %d %d %d" % tuple(k + 1 for k in t) for t in of_part[part]]
    else:
        text = []
        for part in parts:
            text.append(f"solid {part}")
            for t in of_part[part]:
                text += ["facet normal 0 0 0", "outer loop", *("vertex " + lines[k] for k in t), "endloop", "endfacet"]
            text.append(f"endsolid {part}")
    path.write_text("\n".join(text) + "\n")


def read_off(path):
    words = pathlib.Path(path).read_text().split()
    count, faces = int(words[1]), int(words[2])
    points = np.array(words[4:4 + 3 * count], float).reshape(-1, 3)
    triangles = np.array(words[4 + 3 * count:4 + 3 * count + 4 * faces], int).reshape(-1, 4)
    if (triangles[:, 0] != 3).any():
        raise ValueError(f"{path}: not all faces are triangles")
    return points, triangles[:, 1:]


def read_stl_solids(path):
    """Returns the solids of an ASCII .stl: name to a surface, its equal points welded."""
    solids = {}
    for line in pathlib.Path(path).read_text().splitlines():
        words = line.split()
        if words[:1] == ["solid"]:
            current = solids.setdefault(words[1], [])
        elif words[:1] == ["vertex"]:
            current.append([float(word) for word in words[1:4]])
    out = {}
    for name, corners in solids.items():
        points, inverse = np.unique(np.array(corners), axis=0, return_inverse=True)
        out[name] = points, inverse.reshape(-1, 3)
    return out
