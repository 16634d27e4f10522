# SPDX-License-Identifier: Apache-2.0
"""Space as bodies divide it: labelled triangles between materials and outside, and the quantities a mesh must have.

A body is a list of convex cells whose union it is. `carved` divides space by bodies of which later ones carve earlier
ones; `conforming` takes surfaces that share their triangles where they touch. Both give a `Partition`, from which every
expected number is counted: components, Euler characteristics, areas, volumes, junction curves.
"""
import itertools

import numpy as np
from scipy.spatial import ConvexHull, cKDTree

import surfaces as sf

# All relative to the diagonal. Doubles of these sizes err by 1e-15; the smallest intended features are above 1e-4.
ON_PLANE = 1e-10
WELD = 1e-8
ASIDE = 1e-6


class Cell:
    """A convex polyhedron: the hull of points. Planes are (normal, offset), at most 0 inside."""

    def __init__(self, points):
        points = np.asarray(points, float)
        hull = ConvexHull(points)
        self.points = points[hull.vertices]
        self.low, self.high = self.points.min(axis=0), self.points.max(axis=0)
        size = np.linalg.norm(self.high - self.low)
        self.planes, self.polygons = [], []
        done = np.zeros(len(hull.equations), bool)
        for k, equation in enumerate(hull.equations):
            if done[k]:
                continue
            done |= np.abs(hull.equations - equation).max(axis=1) < 1e-9 * max(1, size)
            normal, offset = equation[:3], equation[3]
            on = self.points[np.abs(self.points @ normal + offset) < 1e-9 * size]
            self.planes.append((normal, offset))
            self.polygons.append(around(on, normal))

    def surface(self):
        """Returns the boundary as triangles."""
        return triangulated([(polygon, None) for polygon in self.polygons], WELD)[:2]

    def moved(self, move):
        return Cell(move(self.points))


def around(points, normal):
    """Sorts the corners of a convex polygon counter-clockwise about its normal."""
    center = points.mean(axis=0)
    u = points[0] - center
    v = np.cross(normal, u)
    angle = np.arctan2((points - center) @ v / np.linalg.norm(v), (points - center) @ u / np.linalg.norm(u))
    return points[np.argsort(angle)]


def split(polygon, plane, tolerance):
    """Returns the parts of a convex polygon inside and outside of a plane, None for none. On the plane is inside."""
    normal, offset = plane
    side = polygon @ normal + offset
    side[np.abs(side) <= tolerance] = 0
    if (side <= 0).all():
        return polygon, None
    if (side >= 0).all():
        return None, polygon
    parts = ([], [])
    for k, (p, s) in enumerate(zip(polygon, side)):
        q, t = polygon[(k + 1) % len(polygon)], side[(k + 1) % len(polygon)]
        if s <= 0:
            parts[0].append(p)
        if s >= 0:
            parts[1].append(p)
        if s * t < 0:
            cut = p + s / (s - t) * (q - p)
            parts[0].append(cut)
            parts[1].append(cut)
    return tuple(np.array(part) for part in parts)


def split_by_cell(polygon, cell, tolerance):
    """Divides a convex polygon into convex parts, each of them inside or outside of a cell; whole where they are apart."""
    if (polygon.min(axis=0) > cell.high + tolerance).any() or (polygon.max(axis=0) < cell.low - tolerance).any():
        return [polygon]
    out = []
    rest = polygon
    for plane in cell.planes:
        inside, outside = split(rest, plane, tolerance)
        if inside is None:
            return [polygon]
        if outside is not None:
            out.append(outside)
        rest = inside
    return out + [rest]


def triangulated(polygons, tolerance):
    """Welds labelled convex polygons and makes triangles without hanging points; returns points, triangles, labels."""
    corners = np.vstack([polygon for polygon, _ in polygons])
    points, index = sf.weld(corners, tolerance)
    points = list(points)
    tree = cKDTree(np.array(points))
    triangles, labels = [], []
    start = 0
    for polygon, label in polygons:
        loop = index[start:start + len(polygon)]
        start += len(polygon)
        ring = []
        for a, b in zip(loop, np.roll(loop, -1)):
            if a != b:
                ring += [a, *between(points, tree, a, b, tolerance)]
        if len(ring) < 3:
            continue
        if len(ring) == 3:
            new = [ring]
        else:
            points.append(polygon.mean(axis=0))
            new = [[a, b, len(points) - 1] for a, b in zip(ring, ring[1:] + ring[:1])]
        triangles += new
        labels += [label] * len(new)
    return np.array(points), np.array(triangles), labels


def between(points, tree, a, b, tolerance):
    """Returns the points on an edge, from a to b."""
    p, along = points[a], points[b] - points[a]
    length = np.linalg.norm(along)
    found = []
    for k in tree.query_ball_point(p + along / 2, length / 2):
        t = (points[k] - p) @ along / length ** 2
        if k not in (a, b) and 0 < t < 1 and np.linalg.norm(points[k] - p - t * along) < tolerance:
            found.append((t, k))
    return [k for _, k in sorted(found)]


def carved(bodies):
    """Divides space by bodies, lists of cells; a later one carves earlier ones."""
    cells = [(number, cell) for number, body in enumerate(bodies, 1) for cell in body]
    size = np.linalg.norm(np.max([c.high for _, c in cells], axis=0) - np.min([c.low for _, c in cells], axis=0))
    on, aside = ON_PLANE * size, ASIDE * size

    def material(point):
        return max((number for number, cell in cells if holds(cell, point, on)), default=0)

    polygons = []
    for k, (_, cell) in enumerate(cells):
        for (normal, _), polygon in zip(cell.planes, cell.polygons):
            parts = [polygon]
            for j, (_, other) in enumerate(cells):
                if j != k:
                    parts = [part for whole in parts for part in split_by_cell(whole, other, on)]
            for part in parts:
                center = part.mean(axis=0)
                inner, outer = material(center - aside * normal), material(center + aside * normal)
                if inner == outer or any(on_boundary(c, center, on) for _, c in cells[:k]):
                    continue
                polygons.append((part, (inner, outer)) if inner else (part[::-1], (outer, inner)))
    points, triangles, labels = triangulated(polygons, WELD * size)
    return Partition(points, triangles, np.array(labels), len(bodies))


def holds(cell, point, tolerance):
    return (point >= cell.low - tolerance).all() and (point <= cell.high + tolerance).all() and all(
        point @ normal + offset <= tolerance for normal, offset in cell.planes)


def on_boundary(cell, point, tolerance):
    return holds(cell, point, tolerance) and any(abs(point @ n + offset) <= tolerance for n, offset in cell.planes)


def conforming(bodies):
    """Divides space by closed surfaces that share their triangles where they touch; their winding does not matter."""
    points, triangles = sf.join(bodies)
    owner = np.repeat(np.arange(1, len(bodies) + 1), [len(t) for _, t in bodies])
    points, index = sf.weld(points, WELD * sf.diagonal((points, triangles)))
    triangles = index[triangles]
    for k in range(1, len(bodies) + 1):
        triangles[owner == k] = sf.oriented(points, triangles[owner == k])
    _, first, inverse, counts = np.unique(np.sort(triangles, axis=1), axis=0, return_index=True, return_inverse=True,
                                          return_counts=True)
    if counts.max() > 2:
        raise ValueError("a triangle belongs to three bodies")
    labels = np.column_stack([owner[first], np.zeros(len(first), int)])
    second = np.ones(len(triangles), bool)
    second[first] = False
    labels[inverse.reshape(-1)[second], 1] = owner[second]
    return Partition(points, triangles[first], labels, len(bodies))


class Partition:
    """Triangles that separate materials 1 to `count` and outside, 0. Each has its first label behind it, the second in
    front of it."""

    def __init__(self, points, triangles, labels, count):
        self.points, self.triangles, self.labels, self.count = points, triangles, labels, count

    def boundary(self, material):
        """Returns the closed surface of a material, normals outwards."""
        own, other = (self.labels[:, k] == material for k in (0, 1))
        return sf.compact(self.points, np.vstack([self.triangles[own], self.triangles[other][:, ::-1]]))

    def outer(self):
        """Returns the boundary of the domain."""
        return sf.compact(self.points, self.triangles[self.labels[:, 1] == 0])

    def whole(self):
        """Returns all triangles, each once: a non-manifold surface with inner walls."""
        return self.points, self.triangles

    def interface(self, a, b):
        pair = np.sort(self.labels, axis=1)
        return self.triangles[(pair[:, 0] == min(a, b)) & (pair[:, 1] == max(a, b))]

    def topology(self):
        """Returns the rows of the judge: of the domain, materials, interfaces, junction curves and touching points."""
        out = {"domain": solid(*self.outer())}
        if self.count == 1:
            return out
        for m in range(1, self.count + 1):
            out[f"material {m}"] = solid(*self.boundary(m))
        for a, b in itertools.combinations(range(self.count + 1), 2):
            found = self.interface(a, b)
            name = f"interface {b}|outside" if a == 0 else f"interface {a}|{b}"
            out[name] = None if not len(found) else {
                "components": int(sf.pieces(found)[0]), "euler": int(sf.euler(found)),
                "area": sf.area(self.points, found)}
        out["interfaces touch at points"] = {"count": touching(self.triangles)}
        out["junction curves"] = junctions(self.triangles)
        return out

    def volumes(self):
        return {m: sf.volume(*self.boundary(m)) for m in range(1, self.count + 1)}


def solid(points, triangles):
    """Returns components and Euler characteristics of the solid within a closed surface. Half of a surface's Euler
    characteristic is that of the solid, so an edge or point where it touches itself is refused."""
    if (sf.edge_counts(triangles)[1] != 2).any() or touching(triangles):
        raise ValueError("the surface of a solid touches itself")
    count, piece = sf.pieces(triangles)
    outer = sum(sf.volume(points, triangles[piece == k]) > 0 for k in range(count))
    surface = sf.euler(triangles)
    return {"components": int(outer), "euler": surface // 2, "boundary_components": int(count),
            "boundary_euler": int(surface)}


def touching(triangles):
    """Counts the fans of triangles around points beyond one for each point."""
    corner = {}
    by_edge = {}
    for t, (a, b, c) in enumerate(triangles.tolist()):
        for p, q in ((a, b), (b, c), (c, a)):
            by_edge.setdefault((min(p, q), max(p, q)), []).append(t)
        for p in (a, b, c):
            corner[t, p] = len(corner)
    pairs = [(corner[first, p], corner[t, p]) for edge, (first, *rest) in by_edge.items() for t in rest for p in edge]
    return int(sf.components(len(corner), pairs)[0] - len(np.unique(triangles)))


def junctions(triangles):
    """Returns the curves along which more than two triangles meet, None for none."""
    edges, counts = sf.edge_counts(triangles)
    edges = edges[counts > 2]
    if not len(edges):
        return None
    points, inverse = np.unique(edges, return_inverse=True)
    inverse = inverse.reshape(-1, 2)
    degree = np.bincount(inverse.ravel())
    return {"components": int(sf.components(len(points), inverse)[0]), "euler": len(points) - len(edges),
            "branch_points": int((degree != 2).sum())}


def glued(first, second, areas):
    """Returns the rows of two bodies, closed surfaces, that are glued together at a disc for each range of areas.

    Removing a disc from both surfaces and joining their rims lowers the sum of Euler characteristics by 2."""
    one, two = solid(*first), solid(*second)
    discs = len(areas)
    surface = one["boundary_euler"] + two["boundary_euler"] - 2 * discs
    out = {"domain": {"components": 1, "euler": surface // 2, "boundary_components": 1, "boundary_euler": surface},
           "material 1": one, "material 2": two,
           "interface 1|2": {"components": discs, "euler": discs,
                             "area": [sum(low for low, _ in areas), sum(high for _, high in areas)]}}
    for name, body in (("1", one), ("2", two)):
        out[f"interface {name}|outside"] = {"components": 1, "euler": body["boundary_euler"] - discs}
    out["interfaces touch at points"] = {"count": 0}
    out["junction curves"] = {"components": discs, "euler": 0, "branch_points": 0}
    return out
