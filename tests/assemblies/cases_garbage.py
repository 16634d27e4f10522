# SPDX-License-Identifier: Apache-2.0
"""Inputs that are wrong, and the exit statuses that are right for them. A crash, a hang or a status of 70 never is."""
import numpy as np

import shapes as sh
from case import Case, Input, case

MESHED = (0, 1)
REFUSED = (3, 4)  # bad input, or nothing to mesh


def cube(shift=(0, 0, 0), counts=3):
    points, triangles, _ = sh.gridded_box((0, 0, 0), (1, 1, 1), counts)
    return points + shift, triangles


def pair(second, status, **more):
    """A cube and a second body, which is at fault."""
    return Case([Input("good", cube()), Input("bad", second, closed=False)], status=status, **more)


NEXT_TO = (1, 0, 0)


@case("garbage_same_twice")
def _():
    return pair(cube(), REFUSED, note="nothing is left of the first")


@case("garbage_same_twice_other_grid")
def _():
    return pair(cube(counts=4), REFUSED, note="nothing is left of the first")


@case("garbage_inside_out")
def _():
    points, triangles = cube(NEXT_TO)
    return pair((points, triangles[:, ::-1]), MESHED + REFUSED)


@case("garbage_mixed_winding")
def _():
    points, triangles = cube(NEXT_TO)
    triangles = triangles.copy()
    triangles[::2] = triangles[::2, ::-1]
    return pair((points, triangles), MESHED + REFUSED)


@case("garbage_open_body")
def _():
    points, triangles, side = sh.gridded_box((1, 0, 0), (2, 1, 1), 3)
    return pair((points, triangles[side != 1]), MESHED + REFUSED, note="one side is missing")


@case("garbage_open_contact")
def _():
    points, triangles, side = sh.gridded_box((1, 0, 0), (2, 1, 1), 3)
    return pair((points, triangles[side != 0]), MESHED + REFUSED, note="the side at the contact is missing")


@case("garbage_plane")
def _():
    return pair(sh.grid((1, 0, 0), (0, 1, 0), (0, 0, 1), (3, 3)), REFUSED, note="a body without a volume")


@case("garbage_soup")
def _():
    points = np.random.default_rng(5).random((300, 3))
    return pair((points, np.arange(300).reshape(-1, 3)), MESHED + REFUSED, note="100 triangles at random")


@case("garbage_repeated_triangles")
def _():
    points, triangles = cube(NEXT_TO)
    return pair((points, np.vstack([triangles, triangles[:40], triangles[:20, ::-1]])), MESHED + REFUSED)


@case("garbage_far_away")
def _():
    return pair(cube((1e9, 0, 0)), MESHED + REFUSED + (5,))


@case("garbage_tiny")
def _():
    points, triangles = cube()
    return pair((np.array((1, 0.5, 0.5)) + 1e-9 * points, triangles), MESHED + REFUSED, note="smaller than any cell")


def file_at_fault(content, status=REFUSED, **more):
    return pair((np.zeros((0, 3)), np.zeros((0, 3), int)), status, raw_files={"bad.off": content.encode()}, **more)


def off(points, triangles):
    return "\n".join(["OFF", f"{len(points)} {len(triangles)} 0", *points, *("3 " + t for t in triangles)]) + "\n"


TET = ["1 0 0", "2 0 0", "1 1 0", "1 0 1"]
FACES = ["0 2 1", "0 1 3", "0 3 2", "1 2 3"]

case("garbage_nan")(lambda: file_at_fault(off(["1 0 nan"] + TET[1:], FACES)))
case("garbage_infinite")(lambda: file_at_fault(off(["1 0 inf"] + TET[1:], FACES)))
case("garbage_overflow")(lambda: file_at_fault(off(["1 0 1e308"] + TET[1:], FACES), REFUSED + (5,)))
case("garbage_index")(lambda: file_at_fault(off(TET, FACES[:3] + ["1 2 9"])))
case("garbage_no_triangles")(lambda: file_at_fault(off(TET, [])))
case("garbage_empty_file")(lambda: file_at_fault(""))
case("garbage_cut_off")(lambda: file_at_fault(off(TET, FACES)[:-12]))
case("garbage_one_point")(lambda: file_at_fault(off(["1 0 0"] * 4, FACES)))


@case("garbage_same_names")
def _():
    return Case([Input("good", cube())], options=["--material", "good=good.off"], status=(2,),
                note="two materials of one name")


def sheet(surface, status, **more):
    return Case([Input("box", cube())], sheets=[Input("sheet", surface, closed=False)], status=status, **more)


INSIDE = sh.grid((0.3, 0.3, 0.5), (0.4, 0, 0), (0, 0.4, 0), (3, 3))


@case("garbage_sheet_outside")
def _():
    return sheet((INSIDE[0] + (3, 0, 0), INSIDE[1]), (1,) + REFUSED, note="nothing of the sheet is in the box")


@case("garbage_sheet_on_wall")
def _():
    return sheet((INSIDE[0] - (0, 0, 0.5), INSIDE[1]), MESHED + REFUSED, note="the sheet lies in a side of the box")


@case("garbage_sheet_closed")
def _():
    points, triangles = cube()
    return sheet((0.3 + 0.4 * points, triangles), MESHED + REFUSED, note="the sheet is closed")


@case("garbage_sheet_twice")
def _():
    made = sheet(INSIDE, (2,) + MESHED + REFUSED, note="the sheet twice, under two names")
    made.sheets.append(Input("again", INSIDE, closed=False))
    return made


@case("garbage_sheet_half_outside")
def _():
    return sheet((INSIDE[0] + (0.5, 0, 0), INSIDE[1]), MESHED + REFUSED, note="half of the sheet is outside")
