# SPDX-License-Identifier: Apache-2.0
"""Solids as lists of convex cells, and their surfaces with tessellations of choice."""
import numpy as np
from scipy.spatial import ConvexHull

import surfaces as sf
from partition import Cell, carved

AXIS = np.array([0.36, -0.48, 0.8])
TURNS = (0.0, 23.0, 71.0)  # degrees, of the three variants


def turn(angle, axis=AXIS):
    """Returns the rotation by an angle in degrees about an axis of length 1, for points in rows."""
    k = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    radians = np.radians(angle)
    matrix = np.eye(3) + np.sin(radians) * k + (1 - np.cos(radians)) * k @ k
    if angle == 0:
        return lambda points: np.asarray(points, float)
    return lambda points: np.asarray(points, float) @ matrix.T


def outline(body):
    """Returns the surface of a body, a list of cells."""
    return carved([body]).boundary(1)


def tessellated(body, longest):
    """Returns the surface of a body with edges of at most this length."""
    points, triangles, _ = sf.refined(*outline(body), longest)
    return points, triangles


def box(low, high):
    corners = np.array(np.meshgrid(*zip(low, high))).reshape(3, -1).T
    return [Cell(corners)]


def gridded_box(low, high, counts, other_diagonals=False):
    """Returns the surface of a box with so many squares along its sides, and the side of each triangle: 0 to 5 for low x,
    high x, low y, high y, low z, high z. The diagonals of one side are parallel."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    counts = np.broadcast_to(counts, 3)
    number, points, triangles, sides = {}, [], [], []

    def vertex(i):
        if tuple(i) not in number:
            number[tuple(i)] = len(points)
            points.append([high[k] if i[k] == counts[k] else low[k] + (high[k] - low[k]) * i[k] / counts[k]
                           for k in range(3)])
        return number[tuple(i)]

    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for end in range(2):
            for i in range(counts[u]):
                for j in range(counts[v]):
                    square = []
                    for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        at = [0, 0, 0]
                        at[axis], at[u], at[v] = end * counts[axis], i + du, j + dv
                        square.append(vertex(at))
                    if end == 0:
                        square = square[::-1]
                    a, b, c, d = square if not other_diagonals else square[1:] + square[:1]
                    triangles += [[a, b, c], [a, c, d]]
                    sides += [2 * axis + end] * 2
    return np.array(points), np.array(triangles), np.array(sides)


def grid(corner, u, v, counts):
    """Returns an open rectangle from a corner along u and v, as a grid."""
    corner, u, v = (np.asarray(x, float) for x in (corner, u, v))
    points = [corner + u * i / counts[0] + v * j / counts[1] for j in range(counts[1] + 1) for i in range(counts[0] + 1)]
    row = counts[0] + 1
    squares = [(j * row + i, j * row + i + 1, (j + 1) * row + i + 1, (j + 1) * row + i)
               for j in range(counts[1]) for i in range(counts[0])]
    return np.array(points), np.array([t for a, b, c, d in squares for t in ((a, b, c), (a, c, d))])


def circle(radius, facets, phase=0.0):
    angle = 2 * np.pi * (np.arange(facets) + phase) / facets
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def extruded(polygon, low, high):
    """Returns the points of a prism along z."""
    return np.vstack([np.column_stack([polygon, np.full(len(polygon), z)]) for z in (low, high)])


def cylinder(radius, facets, low, high, phase=0.0):
    return [Cell(extruded(circle(radius, facets, phase), low, high))]


def sector(radius, first, last, facets, low, high):
    """Returns a sector of a cylinder about z, between two angles in degrees less than 180 apart."""
    angle = np.radians(np.linspace(first, last, facets + 1))
    rim = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    return [Cell(extruded(np.vstack([[0, 0], rim]), low, high))]


def hollow(inner, outer, low, high):
    """Returns a prism with a hole, from two polygons with as many corners that go around together."""
    n = len(inner)
    return [Cell(extruded(np.array([inner[k], outer[k], outer[(k + 1) % n], inner[(k + 1) % n]]), low, high))
            for k in range(n)]


def square_around(polygon, half):
    """Projects a polygon from the origin onto a square."""
    return polygon * half / np.abs(polygon).max(axis=1)[:, None]


def vessel(centers, radius, facets):
    """Returns a full tube along a polyline; its rings lie in the planes that halve the angles of the polyline, so each
    part is a convex prism with flat sides."""
    centers = np.asarray(centers, float)
    along = np.diff(centers, axis=0)
    along /= np.linalg.norm(along, axis=1)[:, None]
    u = np.cross(along[0], [0.3, 0.5, 0.8])
    u /= np.linalg.norm(u)
    v = np.cross(along[0], u)
    ring = centers[0] + circle(radius, facets) @ np.array([u, v])
    cells = []
    for k, direction in enumerate(along):
        normal = direction + along[k + 1] if k + 1 < len(along) else direction
        step = ((centers[k + 1] - ring) @ normal) / (direction @ normal)
        following = ring + step[:, None] * direction
        cells.append(Cell(np.vstack([ring, following])))
        ring = following
    return cells


def bend(start, direction, toward, steps, length, angle):
    """Returns a polyline that turns by an angle in degrees towards a direction, in steps."""
    centers = [np.asarray(start, float)]
    direction, toward = np.asarray(direction, float), np.asarray(toward, float)
    for k in range(steps):
        a = np.radians(angle * k / max(1, steps - 1))
        centers.append(centers[-1] + length * (np.cos(a) * direction + np.sin(a) * toward))
    return centers


def octahedral_directions(parts):
    """Returns directions spread over the sphere, the six of the axes among them."""
    out = [(i, j, k) for i in range(-parts, parts + 1) for j in range(-parts, parts + 1) for k in range(-parts, parts + 1)
           if abs(i) + abs(j) + abs(k) == parts]
    out = np.array(out, float)
    return out / np.linalg.norm(out, axis=1)[:, None]


def ball(center, radius, parts=10):
    """Returns the surface of a ball that has points where lines along the axes through its center leave it."""
    points = np.asarray(center, float) + radius * octahedral_directions(parts)
    # The hull of points that are regularly spread may have flat quads, which qhull joggles; QJ is not wanted.
    hull = ConvexHull(points)
    triangles = hull.simplices.copy()
    wrong = np.einsum("ij,ij->i", sf.normals(points, triangles), hull.equations[:, :3]) < 0
    triangles[wrong] = triangles[wrong][:, ::-1]
    return points, triangles


def cap(rim, angle, facets, rings):
    """Returns the cap of a ball that meets the plane z = 0 at an angle in degrees, in a circle of radius `rim`."""
    radius = rim / np.sin(np.radians(angle))
    points = [[0, 0, radius - radius * np.cos(np.radians(angle))]]
    for k in range(1, rings + 1):
        a = np.radians(angle * k / rings)
        height = radius * (np.cos(a) - np.cos(np.radians(angle))) if k < rings else 0.0
        points += [[x, y, height] for x, y in circle(radius * np.sin(a), facets, 0.5 * (k % 2))]
    return [Cell(points)]


def lens(radius, half_angle, half_length, thickness, facets, rings):
    """Returns the surface of a lens on the inner wall of a cylinder about z: its outer side lies on the cylinder, its
    inner one is up to `thickness` nearer to the axis; and the triangles of its outer side."""
    rows = [np.zeros((1, 2))] + [circle(k / rings, facets, 0.5 * (k % 2)) for k in range(1, rings + 1)]
    flat = np.vstack(rows)
    start = np.cumsum([0] + [len(row) for row in rows])
    fan = [[0, 1 + k, 1 + (k + 1) % facets] for k in range(facets)]
    for r in range(1, rings):
        a, b = start[r], start[r + 1]
        for k in range(facets):
            n = (k + 1) % facets
            # A ring with phase 1/2 lies half a step ahead of the next.
            if r % 2:
                fan += [[a + k, b + k, b + n], [a + k, b + n, a + n]]
            else:
                fan += [[a + k, b + k, a + n], [a + n, b + k, b + n]]
    fan = np.array(fan)

    def wrapped(depth):
        angle = half_angle * flat[:, 0]
        return np.column_stack([(radius - depth) * np.cos(angle), (radius - depth) * np.sin(angle),
                                half_length * flat[:, 1]])

    outer = wrapped(np.zeros(len(flat)))
    inner = wrapped(thickness * (1 - (flat ** 2).sum(axis=1)))
    rim = len(flat) - facets
    twin = np.where(np.arange(len(flat)) < rim, np.arange(len(flat)) + len(flat), np.arange(len(flat)))
    points = np.vstack([outer, inner[:rim]])
    triangles = np.vstack([fan, twin[fan][:, ::-1]])
    if sf.volume(points, triangles) < 0:
        triangles = triangles[:, ::-1]
    return points, triangles, triangles[:len(fan)]


def wavy_layers(size, counts, levels, height):
    """Returns bodies between consecutive levels of `height(x, y, level)`, which share their triangles."""
    number, points = {}, []

    def vertex(i, j, level):
        if (i, j, level) not in number:
            x, y = size[0] * i / counts[0], size[1] * j / counts[1]
            number[i, j, level] = len(points)
            points.append([x, y, height(x, y, level)])
        return number[i, j, level]

    def sheet(level):
        out = []
        for i in range(counts[0]):
            for j in range(counts[1]):
                a, b, c, d = (vertex(i + p, j + q, level) for p, q in ((0, 0), (1, 0), (1, 1), (0, 1)))
                out += [[a, b, c], [a, c, d]]
        return out

    m, n = counts
    around = [(i, 0) for i in range(m)] + [(m, j) for j in range(n)] + [(m - i, n) for i in range(m)] + \
        [(0, n - j) for j in range(n)]
    bodies = []
    for level in range(levels):
        triangles = [t[::-1] for t in sheet(level)] + sheet(level + 1)
        for (i, j), (k, l) in zip(around, around[1:] + around[:1]):
            a, b, c, d = vertex(i, j, level), vertex(k, l, level), vertex(k, l, level + 1), vertex(i, j, level + 1)
            triangles += [[a, b, c], [a, c, d]]
        bodies.append(triangles)
    points = np.array(points)
    return [sf.compact(points, np.array(triangles)) for triangles in bodies]
