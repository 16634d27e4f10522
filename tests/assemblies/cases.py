# SPDX-License-Identifier: Apache-2.0
"""Solids that share faces, cross, touch or nearly fit."""
import dataclasses
import re

import numpy as np

import shapes as sh
import surfaces as sf
from case import FLAT, STRIP, ROUND, Case, Input, around, case, expectations, of_partition
from partition import Cell, carved, conforming, glued, split

# Share of the diagonal up to which outside between two bodies that touch in a point may be closed.
CLOSED_GAP = 0.025


def two_cubes(first, second, shift=0.0):
    """Two unit cubes that share the face x = 1; the second is shifted along x by a share of the diagonal."""
    partition = carved([sh.box((0, 0, 0), (1, 1, 1)), sh.box((1, 0, 0), (2, 1, 1))])
    size = sf.diagonal((partition.points, partition.triangles))
    points, triangles = second
    points = points + [1 + shift * size, 0, 0]
    # Either cube may give way by the whole gap, which is a larger share of a cube's diagonal than of both.
    tolerance = dataclasses.replace(FLAT, crease=max(FLAT.crease, 1.5 * abs(shift)))
    return of_partition(partition, [Input("first", first), Input("second", (points, triangles))], tolerance)


def cube(counts, other_diagonals=False):
    return sh.gridded_box((0, 0, 0), (1, 1, 1), counts, other_diagonals)[:2]


@case("cubes_conforming", turned=True)
def _():
    return two_cubes(cube(4), cube(4))


@case("cubes_other_diagonals", turned=True)
def _():
    return two_cubes(cube(4), cube(4, True))


@case("cubes_other_grids", turned=True)
def _():
    return two_cubes(cube(3), cube((4, 5, 7), True))


@case("cubes_coarse_and_fine", turned=True)
def _():
    return two_cubes(cube(1), cube(9, True))


@case("cube_on_large_cube", turned=True)
def _():
    low, high = np.array((1, 0.27, 0.31)), np.array((1.4, 0.67, 0.71))
    partition = carved([sh.box((0, 0, 0), (1, 1, 1)), sh.box(low, high)])
    return of_partition(partition, [Input("large", cube(3)), Input("small", sh.gridded_box(low, high, 2)[:2])])


@case("cubes_sharing_edge", turned=True)
def _():
    low, high = np.array((1, 0.6, 0.31)), np.array((1.4, 1, 0.71))  # the sides y = 1 are flush
    partition = carved([sh.box((0, 0, 0), (1, 1, 1)), sh.box(low, high)])
    return of_partition(partition, [Input("large", cube(3)), Input("small", sh.gridded_box(low, high, 4)[:2])])


@case("cubes_touching_at_edge", turned=True)
def _():
    first, second = sh.box((0, 0, 0), (1, 1, 1)), sh.box((1, 1, 0), (2, 2, 1))
    bodies = {1: sh.outline(first), 2: sh.outline(second)}
    # A valid mesh has no edge with four boundary triangles: the cubes are joined over a strip a few cells wide.
    topology = carved([first, sh.box((1, 0, 0), (2, 1, 1))]).topology()
    for row in topology.values():
        if row is not None:
            row.pop("area", None)
    inputs = [Input("first", cube(3)), Input("second", sh.gridded_box((1, 1, 0), (2, 2, 1), 4)[:2])]
    expected = expectations(topology, bodies, STRIP)
    for row in expected["bodies"].values():
        row["corners_missed"] = [0, 2]
    return Case(inputs, expected, bodies)


for gap in (1e-6, 5e-6):
    for word, sign in (("gap", 1), ("overlap", -1)):
        case(f"cubes_{word}_{gap:.0e}".replace("e-0", "e-"), turned=True)(
            lambda shift=sign * gap: two_cubes(cube(4), cube((4, 5, 3), True), shift))


@case("crossing_boxes")
def _():
    first, second = sh.box((0, 0, 0), (1, 1, 1)), sh.box((0.55, 0.47, 0.42), (1.5, 1.4, 1.3))
    second = [c.moved(sh.turn(12)) for c in second]
    return of_partition(carved([first, second]),
                        [Input("first", cube(3)), Input("second", sh.tessellated(second, 0.4), ".ply")])


@case("crossing_bars")
def _():
    first, second = sh.box((0, 0, 0), (2, 1, 1)), sh.box((0.7, -0.6, 0.22), (1.3, 1.7, 0.78))
    second = [c.moved(sh.turn(7)) for c in second]
    return of_partition(carved([first, second]), [Input("first", sh.gridded_box((0, 0, 0), (2, 1, 1), (4, 3, 3))[:2]),
                                                  Input("second", sh.tessellated(second, 0.4), ".stl")])


@case("cylinder_through_plate")
def _():
    plate, pin = sh.box((-1, -1, -0.2), (1, 1, 0.2)), sh.cylinder(0.4, 40, -0.9, 0.8)
    return of_partition(carved([plate, pin]), [Input("plate", sh.tessellated(plate, 0.5)),
                                               Input("pin", sh.tessellated(pin, 0.2))], ROUND)


def vessel_case(centers, low, high):
    block, tube = sh.box(low, high), sh.vessel(centers, 0.16, 28)
    return of_partition(carved([block, tube]), [Input("block", sh.tessellated(block, 0.5)),
                                                Input("vessel", sh.tessellated(tube, 0.1))], ROUND)


@case("vessel_into_box")
def _():
    return vessel_case(sh.bend((-0.8, 0.5, 0.5), (1, 0, 0), (0, 0.8, 0.6), 8, 0.22, 60), (0, 0, 0), (1.2, 1.4, 1.3))


@case("vessel_through_box")
def _():
    return vessel_case(sh.bend((-0.7, 0.5, 0.5), (1, 0, 0), (0, 0.8, 0.6), 12, 0.25, 55), (0, 0, 0), (1.2, 1.3, 1.2))


@case("rings")
def _():
    rings = [sh.hollow(sh.circle(0.6, 40), sh.circle(1, 40), low, high) for low, high in ((0, 0.5), (0.5, 0.9), (0.9, 1.5))]
    return of_partition(carved(rings), [Input(f"ring{k}", sh.tessellated(ring, longest))
                                        for k, (ring, longest) in enumerate(zip(rings, (0.2, 0.2, 0.13)), 1)], ROUND)


def layers():
    return sh.wavy_layers((10, 8), (20, 16), 5, lambda x, y, level: 0.8 * level + 0.1 * np.sin(
        0.9 * x + 1.3 * level) * (1 + 0.1 * level) + 0.09 * np.cos(0.7 * y - 2 * level))


@case("layers_five_files")
def _():
    bodies = layers()
    return of_partition(conforming(bodies), [Input(f"layer{k}", body) for k, body in enumerate(bodies, 1)], ROUND)


@case("layers_one_file")
def _():
    partition = conforming(layers())
    return of_partition(partition, [Input("layers", partition.whole(), closed=False)], ROUND, by_position=True)


def sectors(number):
    per_sector = max(4, round(36 / number))
    bodies = [sh.sector(1, 360 * k / number, 360 * (k + 1) / number, per_sector, 0, 1.2) for k in range(number)]
    return of_partition(carved(bodies), [Input(f"sector{k}", sh.tessellated(body, 0.3 if k % 2 else 0.22))
                                         for k, body in enumerate(bodies, 1)], ROUND)


for number_of_sectors in range(3, 9):
    case(f"sectors_{number_of_sectors}")(lambda number=number_of_sectors: sectors(number))


@case("walls_that_cross")
def _():
    crossing, cells = np.array((0.9, 1.1)), [np.array([(0, 0), (2, 0), (2, 2), (0, 2)], float)]
    for angle in np.radians((20, 97)):
        normal = np.array((-np.sin(angle), np.cos(angle)))
        cells = [part for cell in cells for part in split(cell, (normal, -normal @ crossing), 1e-9) if part is not None]
    partition = carved([[Cell(sh.extruded(cell, 0, 1))] for cell in cells])
    points, triangles, _ = sf.refined(*partition.whole(), 0.4)
    return of_partition(partition, [Input("walls", (points, triangles), closed=False)], by_position=True)


def blocks(corners, center):
    """Boxes of a cut cube of side 2, one for each corner."""
    size = np.array((2, 2, 2 if len(corners) == 8 else 1))
    bodies = [[np.where(c, center, 0), np.where(c, size, center)] for c in corners]
    partition = carved([sh.box(*b) for b in bodies])
    return of_partition(partition, [Input(f"block{k}", sh.gridded_box(*b, 2 + k % 3, bool(k % 2))[:2])
                                    for k, b in enumerate(bodies, 1)])


@case("four_boxes_at_edge", turned=True)
def _():
    # Along z there is only one box: its lower end is 0 and its upper one the "center".
    return blocks([(i, j, 0) for i in (0, 1) for j in (0, 1)], np.array((0.9, 1.2, 1)))


@case("eight_boxes_at_point", turned=True)
def _():
    return blocks([(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)], np.array((0.9, 1.2, 1.05)))


def touching(first, second, radii, contacts, flat_first):
    """Two bodies that touch in points where the surfaces have these radii. The gap between them is r^2 / 2 times the sum
    of curvatures at a distance r. It may be closed up to CLOSED_GAP, in discs of the area pi r^2, by either body."""
    bodies = {1: first.surface, 2: second.surface}
    gap = CLOSED_GAP * sf.diagonal(first.surface, second.surface)
    curvature = sum(1 / r for r in radii)
    disc, filling = 2 * np.pi * gap / curvature, contacts * np.pi * gap ** 2 / curvature
    expect = expectations(glued(*bodies.values(), [(0, disc)] * contacts), bodies, ROUND)
    for tag, surface in bodies.items():
        own = FLAT if tag == 1 and flat_first else ROUND
        volume, distance = sf.volume(*surface), own.distance + gap / sf.diagonal(surface)
        low, high = 1 - own.volume, 1 + own.volume + filling / volume
        expect["volume"][str(tag)] = [low * volume, high * volume]
        expect["bodies"][str(tag)] = {
            "volume_ratio": [low, high], "crease_p99_rel": [0, own.crease], "corners_missed": 0,
            "mesh_to_surface_rel": [0, distance], "surface_to_mesh_rel": [0, distance]}
    return Case([first, second], expect, bodies, note="a point contact becomes one disc for each point")


@case("ball_on_plate")
def _():
    return touching(Input("plate", sh.gridded_box((-1.5, -1.3, -0.4), (1.5, 1.3, 0), (5, 5, 2))[:2]),
                    Input("ball", sh.ball((0.1, 0.05, 0.8), 0.8)), [0.8, np.inf], 1, True)


@case("balls_touching")
def _():
    return touching(Input("large", sh.ball((0, 0, 0), 1)), Input("small", sh.ball((1.7, 0, 0), 0.7, 8)), [1, 0.7], 1, False)


@case("ball_in_tray")
def _():
    low, high, wall = np.array((0, 0, 0)), np.array((1.8, 1.6, 0.9)), 0.2
    tray = [*sh.box(low, (high[0], high[1], wall)),
            *sh.box((0, 0, wall), (wall, high[1], high[2])), *sh.box((high[0] - wall, 0, wall), high),
            *sh.box((wall, 0, wall), (high[0] - wall, wall, high[2])),
            *sh.box((wall, high[1] - wall, wall), (high[0] - wall, high[1], high[2]))]
    radius = 0.5
    return touching(Input("tray", sh.tessellated(tray, 0.4)), Input("ball", sh.ball([wall + radius] * 3, radius, 8)),
                    [radius, np.inf], 3, True)


for contact_angle in (28, 15):
    def glued_cap(angle=contact_angle):
        block, top = sh.box((-1, -1, -0.7), (1, 1, 0)), sh.cap(0.6, angle, 48, 8)
        return of_partition(carved([block, top]), [Input("block", sh.tessellated(block, 0.5)),
                                                   Input("cap", sh.tessellated(top, 0.12))], ROUND)
    case(f"cap_{contact_angle}")(glued_cap)


def radial(polygon, angle):
    """Returns the distance from the origin at which a ray meets a convex polygon around it."""
    direction = np.array((np.cos(angle), np.sin(angle)))
    a, edge = polygon, np.roll(polygon, -1, axis=0) - polygon
    normal = np.column_stack([edge[:, 1], -edge[:, 0]])
    facing = normal @ direction
    return ((normal * a).sum(axis=1)[facing > 1e-12] / facing[facing > 1e-12]).min()


def pin_in_hole(hole_facets, pin_phase):
    """A pin of 24 facets in a hole of the same nominal radius. The hole gets the pin's facets in what is meant; the
    tolerance is half more than the largest distance between the two."""
    radius, half = 0.5, 1.0
    hole, pin = sh.circle(radius, hole_facets), sh.circle(radius, 24, pin_phase)
    block = sh.hollow(hole, sh.square_around(hole, half), -0.4, 0.4)
    stick = [Cell(sh.extruded(pin, -0.8, 0.7))]
    misfit = max(abs(radial(hole, a) - radial(pin, a)) for a in np.linspace(0, 2 * np.pi, 5000))
    partition = carved([sh.box((-half, -half, -0.4), (half, half, 0.4)), stick])
    return of_partition(partition, [Input("block", sh.tessellated(block, 0.35)),
                                    Input("pin", sh.tessellated(stick, 0.15))],
                        ROUND, options=["--contact-tolerance", f"{1.5 * misfit:.6f}"],
                        note=f"facets differ by up to {misfit:.6f}")


@case("pin_24_in_32")
def _():
    return pin_in_hole(32, 0)


@case("pin_24_turned")
def _():
    return pin_in_hole(24, 3 * 24 / 360)  # 3 degrees, in steps between facets


@case("plaque")
def _():
    facets, radius = 48, 1.0
    artery = sh.tessellated(sh.hollow(sh.circle(radius, facets), sh.circle(1.25, facets), -1.5, 1.5), 0.25)
    points, triangles, side = sh.lens(radius, 0.6, 0.8, 0.15, 40, 8)
    fine, _, _ = sf.refined(points, side, 0.02)
    sagitta = max(radius * (1 - np.cos(np.pi / facets)), radius - np.linalg.norm(fine[np.unique(side), :2], axis=1).min(),
                  radius - np.linalg.norm(fine[:, :2], axis=1)[len(points):].min())
    contact = sf.area(points, side)
    bodies = {1: artery, 2: (points, triangles)}
    expect = expectations(glued(*bodies.values(), [around(contact, ROUND.area)]), bodies, ROUND)
    # Either body may give way by the misfit in the contact.
    slack = ROUND.volume + sagitta * contact / sf.volume(*bodies[2])
    expect["volume"]["2"] = around(sf.volume(*bodies[2]), slack)
    expect["bodies"]["2"]["volume_ratio"] = around(1, slack)
    return Case([Input("artery", artery), Input("plaque", bodies[2])], expect, bodies,
                options=["--contact-tolerance", f"{1.5 * sagitta:.6f}"], note=f"facets differ by up to {sagitta:.6f}")


HEATER = {"bottomAir": ((0, 0, 0), (4, 1, 1), (8, 2, 3)), "left": ((0, 1, 0), (1.2, 1.5, 1), (3, 1, 2)),
          "heater": ((1.2, 1, 0), (2.8, 1.5, 1), (4, 2, 3)), "right": ((2.8, 1, 0), (4, 1.5, 1), (3, 2, 4)),
          "topAir": ((0, 1.5, 0), (4, 2.6, 1), (7, 3, 2))}
# Sides in the order of `gridded_box`.
HEATER_SIDES = {"bottomAir": ("inlet", "outlet", "wall", "shared", "wall", "wall"),
                "left": ("wall", "shared", "shared", "shared", "wall", "wall"),
                "heater": ("shared", "shared", "shared", "shared", "wall", "wall"),
                "right": ("shared", "wall", "shared", "shared", "wall", "wall"),
                "topAir": ("inlet", "outlet", "shared", "wall", "wall", "wall")}


@case("heater")
def _():
    inputs, patches = [], {}
    for name, (low, high, counts) in HEATER.items():
        points, triangles, side = sh.gridded_box(low, high, counts)
        groups = [HEATER_SIDES[name][k] for k in side]
        inputs.append(Input(name, (points, triangles), ".obj", groups))
        for group in sorted(set(groups) - {"shared"}):
            patches[f"{name}:{group}"] = sf.area(points, triangles[np.array(groups) == group])
    names, bodies = list(HEATER), [sh.box(low, high) for low, high, _ in HEATER.values()]
    partition = carved(bodies)
    for key, row in partition.topology().items():
        if (pair := re.fullmatch(r"interface (\d+)\|(\d+)", key)) and row is not None:
            first, second = (names[int(tag) - 1] for tag in pair.groups())
            patches[f"{first}:shared+{second}:shared"] = row["area"]
    return of_partition(partition, inputs, patches=patches)
