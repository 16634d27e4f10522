# SPDX-License-Identifier: Apache-2.0
"""Walls of zero thickness in the file of their body, and bodies whose sides are files of their own."""
import numpy as np

import shapes as sh
import surfaces as sf
from case import FLAT, Case, Input, case, expectations, of_partition, sheet_expectations
from cases_sheets import blades
from partition import carved

LOW, HIGH = (-1.1, -1, 0), (1.1, 1, 2.4)


def duct_with(walls, suffix, doubled=False, named=True, duct=None):
    """A duct and walls in one file; `walls` is name to surface. Without named walls they are one sheet."""
    body = sh.box(LOW, HIGH)
    partition = carved([body])
    meant = {1: partition.boundary(1)}
    duct = sh.tessellated(body, 0.5) if duct is None else duct
    turned = {name: (points, triangles[:, ::-1]) for name, (points, triangles) in walls.items()}
    parts = [("hull", duct), *walls.items(), *(turned.items() if doubled else [])]
    groups = [name if named else "all" for name, (_, triangles) in parts for _ in triangles]
    joined = sf.join([surface for _, surface in parts])
    points, number = sf.weld(joined[0], 1e-9)
    # A sheet of several walls has their names, or the body's.
    judged = walls if named else {"duct_sheet": sf.join(list(walls.values()))}
    expect = expectations(partition.topology(), meant, FLAT)
    expect["sheets"] = {name: sheet_expectations(surface, FLAT) for name, surface in judged.items()}
    inputs = [Input("duct", (points, number[joined[1]]), suffix, groups if named else None, closed=False)]
    patches = {"hull": sf.area(*meant[1])} if named else {}
    return Case(inputs, expect, meant, judged_sheets=judged, patches=patches)


case("walls_floating_stl")(lambda: duct_with(blades(), ".stl"))
case("walls_floating_obj")(lambda: duct_with(blades(), ".obj"))
case("walls_floating_unnamed")(lambda: duct_with(blades(), ".off", named=False))
case("walls_doubled_stl")(lambda: duct_with(blades(), ".stl", doubled=True))
case("walls_doubled_obj")(lambda: duct_with(blades(), ".obj", doubled=True))


def fins():
    """Fins on two sides of the duct, from one grid line to another, and the duct with that grid."""
    duct = sh.gridded_box(LOW, HIGH, (11, 10, 12))[:2]
    out = {}
    for k, z in enumerate((0.4, 1.0, 1.6, 2.2)):
        side = 1 - 2 * (k % 2)
        out[f"fin{k + 1}"] = sh.grid((-0.7, -side, z), (1.4, 0, 0), (0, 1.2 * side, 0), (7, 6))
    return duct, out


def attached(suffix, **more):
    duct, out = fins()
    return duct_with(out, suffix, duct=duct, **more)


case("walls_attached_stl")(lambda: attached(".stl"))
case("walls_attached_obj")(lambda: attached(".obj"))
case("walls_attached_unnamed")(lambda: attached(".off", named=False))
case("walls_attached_doubled")(lambda: attached(".obj", doubled=True))


@case("walls_in_cells")
def _():
    """Fins in one of two cells of a file without names."""
    duct, walls = fins()
    low, high = (LOW[0], LOW[1], HIGH[2]), (HIGH[0], HIGH[1], 4)
    upper, triangles, side = sh.gridded_box(low, high, (11, 10, 8))
    partition = carved([sh.box(LOW, HIGH), sh.box(low, high)])
    points, all_triangles = sf.join([duct, (upper, triangles[side != 4]), *walls.values()])
    points, number = sf.weld(points, 1e-9)
    sheets = sf.join(list(walls.values()))
    made = of_partition(partition, [Input("duct", (points, number[all_triangles]), closed=False)], by_position=True,
                        judged_sheets={"duct_sheet": sheets})
    made.expect["sheets"] = {"duct_sheet": sheet_expectations(sheets, FLAT)}
    return made


def patches_of(points, triangles, name="p"):
    """Returns an input for each part of a surface that is connected across edges of two triangles."""
    edges = np.sort(sf.half_edges(triangles), axis=1)
    _, edge, counts = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
    owner = np.tile(np.arange(len(triangles)), 3)
    order = np.argsort(edge.ravel(), kind="stable")
    pairs = owner[order[counts[edge.ravel()[order]] == 2]].reshape(-1, 2)
    count, part = sf.components(len(triangles), pairs)
    return [Input(f"{name}{k + 1}", sf.compact(points, triangles[part == k]), closed=False) for k in range(count)]


SIDES = ("left", "right", "front", "back", "bottom", "top")


def sides_of(low, high, counts, without=None, prefix=""):
    points, triangles, side = sh.gridded_box(low, high, counts)
    return [Input(prefix + name, sf.compact(points, triangles[side == k]), closed=False)
            for k, name in enumerate(SIDES) if name != without]


def of_sides(inputs, *bodies):
    """A case of open files; the first one, like which a material may be called, is not among the judged patches."""
    partition = carved([sh.box(*body) for body in bodies])
    patches = {i.name: sf.area(*i.surface) for i in inputs[1:]}
    return of_partition(partition, inputs, by_position=True, patches=patches)


case("patches_cube")(lambda: of_sides(sides_of((0, 0, 0), (1, 1, 1), 3), ((0, 0, 0), (1, 1, 1))))
case("patches_cube_reversed")(lambda: of_sides(sides_of((0, 0, 0), (1, 1, 1), 3)[::-1], ((0, 0, 0), (1, 1, 1))))


@case("patches_cube_other_grids")
def _():
    """Each side has a grid of its own, so that borders meet without common points."""
    inputs = [sides_of((0, 0, 0), (1, 1, 1), 2 + k % 3)[k] for k in range(6)]
    return of_sides(inputs, ((0, 0, 0), (1, 1, 1)))


@case("patches_two_cubes")
def _():
    inputs = sides_of((0, 0, 0), (1, 1, 1), 3) + sides_of((1, 0, 0), (2, 1, 1), 3, "left", "second_")
    return of_sides(inputs, ((0, 0, 0), (1, 1, 1)), ((1, 0, 0), (2, 1, 1)))


@case("patches_and_body")
def _():
    """A closed body on one of the sides stays a body."""
    inputs = sides_of((0, 0, 0), (1, 1, 1), 3) + [Input("upper", sh.gridded_box((0, 0, 1), (1, 1, 2), 4)[:2])]
    partition = carved([sh.box((0, 0, 0), (1, 1, 1)), sh.box((0, 0, 1), (1, 1, 2))])
    return of_partition(partition, inputs, by_position=True)
