# SPDX-License-Identifier: Apache-2.0
"""Walls of zero thickness in the file of their body."""
import numpy as np

import shapes as sh
import surfaces as sf
from case import FLAT, Case, Input, case, expectations, sheet_expectations
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
    parts = [("duct", duct), *walls.items(), *(turned.items() if doubled else [])]
    groups = [name if named else "all" for name, (_, triangles) in parts for _ in triangles]
    joined = sf.join([surface for _, surface in parts])
    points, number = sf.weld(joined[0], 1e-9)
    # A sheet of several walls has their names, or the body's.
    judged = walls if named else {"duct_sheet": sf.join(list(walls.values()))}
    expect = expectations(partition.topology(), meant, FLAT)
    expect["sheets"] = {name: sheet_expectations(surface, FLAT) for name, surface in judged.items()}
    inputs = [Input("duct", (points, number[joined[1]]), suffix, groups if named else None, closed=False)]
    patches = {"duct": sf.area(*meant[1])} if named else {}
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


@case("walls_orifice")
def _():
    """A plate across the duct with a square opening, attached all around."""
    duct = sh.gridded_box(LOW, HIGH, (11, 10, 12))[:2]
    points, triangles = sh.grid((-1.1, -1, 1.2), (2.2, 0, 0), (0, 2, 0), (11, 10))
    middle = points[triangles].mean(axis=1)
    return duct_with({"plate": (points, triangles[(np.abs(middle[:, :2]) > 0.4 + 0.101).any(axis=1)])}, ".stl", duct=duct)
