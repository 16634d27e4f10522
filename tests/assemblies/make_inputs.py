#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes surfaces of bodies that meet, and what a mesh of them must be.

usage: make_inputs.py [--self-check] FOLDER [CASE...]

Each case is a folder with its surfaces and `case.json`: the call, the surfaces as they are meant, and the expectations.
A CASE may be a pattern such as "cubes_*"; without one all are written. Cases whose names begin with "data_" read the folder
`assemblies` in that of TETWRIGHT_DATA, and are left out where it is not set. `--self-check` verifies the surfaces and
prints the expectations, and writes nothing without a FOLDER; status 1 if a surface is not as it should be. Needs
Debian's python3 with numpy and scipy.
"""
import argparse
import fnmatch
import json
import os
import pathlib
import sys

import numpy as np

import surfaces as sf
from case import CASES
from shapes import TURNS, turn
import cases  # noqa: F401
import cases_data  # noqa: F401
import cases_garbage  # noqa: F401
import cases_sheets  # noqa: F401
import cases_walls  # noqa: F401


def chosen(patterns):
    """Returns the names of the cases that match."""
    out = []
    for pattern in patterns or ["*"]:
        found = [name for name in CASES if fnmatch.fnmatchcase(name, pattern)]
        if not found:
            sys.exit(f"make_inputs.py: there is no case {pattern}; there are {' '.join(CASES)}")
        out += [name for name in found if name not in out]
    return out


def made(name):
    make, turned = CASES[name]
    return make().moved(turn(TURNS[turned]))


def checked(name, case):
    """Prints what a case expects; returns what is wrong with its surfaces."""
    wrong = [f"{i.file}: {fault}" for i in case.inputs if i.closed for fault in sf.faults(*i.surface)]
    wrong += [f"{i.file}: a triangle has no area" for i in (*case.sheets, *case.walls) if len(i.surface[1])
              and np.linalg.norm(sf.normals(*i.surface), axis=1).min() == 0]
    wrong += [f"meant {tag}: {fault}" for tag, surface in case.bodies.items() for fault in sf.faults(*surface)]
    parts = [i for i in case.inputs if i.closed]
    print(f"{name}: status {' or '.join(map(str, case.status))}; {' '.join(i.file for i in case.inputs)} "
          f"{' '.join(case.options)}".rstrip() + (f"; {case.note}" if case.note else ""))
    if case.bodies and len(parts) == len(case.bodies):
        print("  volumes given", " ".join(f"{sf.volume(*i.surface):.6g}" for i in parts), "and meant",
              " ".join(f"{sf.volume(*surface):.6g}" for surface in case.bodies.values()))
    for key, value in case.expect.items():
        print(f"  {key}: {json.dumps(value)}")
    for text in wrong:
        print(f"  WRONG {text}")
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", nargs="?", type=pathlib.Path, metavar="FOLDER")
    parser.add_argument("cases", nargs="*", metavar="CASE")
    parser.add_argument("--self-check", action="store_true", help="verify the surfaces and print the expectations")
    a = parser.parse_args()
    if a.folder is None and not a.self_check:
        parser.error("give a folder, or --self-check")
    wrong = 0
    for name in chosen(a.cases):
        if name.startswith("data_") and not os.environ.get("TETWRIGHT_DATA"):
            print(f"{name}: left out, since TETWRIGHT_DATA is not set")
            continue
        case = made(name)
        if a.self_check:
            wrong += bool(checked(name, case))
        if a.folder is not None:
            case.write(a.folder / name, name)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
