# SPDX-License-Identifier: Apache-2.0
"""Sheets of zero thickness inside of bodies."""
import numpy as np

import shapes as sh
import surfaces as sf
from case import FLAT, Case, Input, case, expectations, sheet_expectations
from partition import carved, triangulated


def in_box(sheets, judged, low=(0, 0, 0), high=(2, 1.5, 1)):
    """A box with sheets, and which surfaces are judged under which names."""
    body = sh.box(low, high)
    partition = carved([body])
    bodies = {1: partition.boundary(1)}
    expect = expectations(partition.topology(), bodies, FLAT)
    expect["sheets"] = {name: sheet_expectations(surface, FLAT) for name, surface in judged.items()}
    return Case([Input("box", sh.tessellated(body, 0.5))], expect, bodies, sheets=sheets, judged_sheets=judged)


def open_sheet(name, surface, suffix=".off", groups=None):
    return Input(name, surface, suffix, groups, closed=False)


BAFFLE = sh.grid((0.5, 0.3, 0.3), (0.9, 0.4, 0), (0, 0, 0.45), (6, 4))


@case("baffle", turned=True)
def _():
    return in_box([open_sheet("baffle", BAFFLE)], {"baffle": BAFFLE})


def crossing():
    """Two rectangles that cross along z."""
    return (sh.grid((0.4, 0.5, 0.3), (1.2, 0.4, 0), (0, 0, 0.4), (5, 3)),
            sh.grid((0.85, 0.25, 0.2), (0.2, 0.95, 0), (0, 0, 0.6), (4, 3)))


@case("baffles_crossing_files")
def _():
    first, second = crossing()
    return in_box([open_sheet("first", first), open_sheet("second", second)], {"first": first, "second": second})


@case("baffles_crossing_one_file")
def _():
    middle, along, across = np.array((1, 0.75)), np.array((0.6, 0.2)), np.array((-0.15, 0.5))
    low, high = 0.3, 0.7
    polygons = []
    for end in (along, -along, across, -across):
        corners = [np.append(p, z) for p, z in ((middle, low), (middle + end, low), (middle + end, high), (middle, high))]
        polygons.append((np.array(corners), 0))
    points, triangles, _ = sf.refined(*triangulated(polygons, 1e-9)[:2], 0.2)
    return in_box([open_sheet("cross", (points, triangles))], {"cross": (points, triangles)})


@case("baffle_wall_to_wall", turned=True)
def _():
    wall = sh.grid((0.7, 0, 0), (0.5, 1.5, 0), (0, 0, 1), (7, 5))
    return in_box([open_sheet("wall", wall)], {"wall": wall})


def blades():
    """Twelve flat blades around the axis of a duct, at 30 degrees to it; name to surface."""
    out = {}
    for k in range(12):
        a = np.radians(30 * k + 4)
        radial, tangent, axis = (np.cos(a), np.sin(a), 0), np.array((-np.sin(a), np.cos(a), 0)), np.array((0, 0, 1))
        chord = 0.5 * (np.cos(np.radians(30)) * axis + np.sin(np.radians(30)) * tangent)
        corner = 0.35 * np.array(radial) - chord / 2 + (0, 0, 1.2)
        out[f"blade{k + 1:02}"] = sh.grid(corner, 0.5 * np.array(radial), chord, (3, 3))
    return out


def fan(suffix):
    parts = blades()
    groups = [name for name, (_, triangles) in parts.items() for _ in triangles]
    return in_box([open_sheet("fan", sf.join(list(parts.values())), suffix, groups)], parts, (-1.1, -1, 0), (1.1, 1, 2.4))


case("blades_obj")(lambda: fan(".obj"))
case("blades_stl")(lambda: fan(".stl"))
