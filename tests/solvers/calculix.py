# SPDX-License-Identifier: Apache-2.0
"""Runs CalculiX on tetwright's meshes and compares with closed-form solutions.

usage: calculix.py TETWRIGHT [--quick]    (Debian's calculix-ccx and python3-numpy; --quick: the coarser meshes)

A cantilever under its own weight, its first bending mode, and a thick sphere under internal pressure, with linear and
ten-node tets, on meshes of two sizes; the errors must decrease with the size. A cylinder whose modulus follows from the
gray values of an image.
"""
import argparse
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np

from surfaces import beam, cylinder, spheres

parser = argparse.ArgumentParser()
parser.add_argument("tetwright")
parser.add_argument("--quick", action="store_true")
options = parser.parse_args()
options.tetwright = pathlib.Path(options.tetwright).resolve()

SKIPPED = 77  # CTest's status of a skipped test
if not shutil.which("ccx"):
    print("skipped: CalculiX (ccx) is not installed")
    sys.exit(SKIPPED)

failures = []


def check(what, good):
    print(("ok      " if good else "FAILED  ") + what)
    if not good:
        failures.append(what)


def run(*command, folder):
    answer = subprocess.run([str(c) for c in command], cwd=folder, check=False, capture_output=True, text=True)
    return answer


def prepare(folder, surface, name, tets, order, *more):
    out = folder / f"{name}.inp"
    answer = run(options.tetwright, "prepare", surface, "-o", out, "--target-tets", tets, "--order", order, "--quiet",
                 "--no-progress", *more, folder=folder)
    if answer.returncode not in (0, 1):
        sys.exit(f"tetwright: {answer.stderr}")
    return out


def solve(folder, name, deck):
    """Runs the deck and returns the displacements of the nodes (static) or the frequencies."""
    (folder / f"{name}.inp").write_text(deck)
    answer = run("ccx", name, folder=folder)
    if answer.returncode != 0 or "*ERROR" in answer.stdout:
        sys.exit(f"ccx {name}: {answer.stdout[-2000:]}")
    return (folder / f"{name}.dat").read_text()


def table(text, columns):
    """Returns the rows of numbers in a .dat file."""
    rows = []
    for line in text.splitlines():
        words = line.split()
        try:
            if len(words) == columns:
                rows.append([float(w) for w in words])
        except ValueError:
            continue
    return np.array(rows)


def nodes_of(file):
    nodes = {}
    for line in file.read_text().split("*NODE\n")[1].splitlines():
        if line.startswith("*"):
            break
        number, *place = line.split(",")
        nodes[int(number)] = np.array([float(x) for x in place])
    return nodes


def cantilever(folder):
    length, side, young, density, gravity = 10.0, 1.0, 1000.0, 1e-3, 1.0
    area, inertia, shear = side**2, side**4 / 12, young / 2  # Poisson's ratio 0, so that the root can be clamped
    weight = density * area * gravity
    # Timoshenko: bending, and shear with the coefficient 5/6 of a square.
    sag = weight * length**4 / (8 * young * inertia) + weight * length**2 / (2 * 5 / 6 * shear * area)
    frequency = 1.875104**2 / (2 * math.pi) * math.sqrt(young * inertia / (density * area * length**4))
    surface = beam(folder / "beam.obj", length, side)
    material = f"*MATERIAL, NAME=m\n*ELASTIC\n{young}, 0.\n*DENSITY\n{density}\n*SOLID SECTION, ELSET=beam, MATERIAL=m\n"
    errors = {}
    for order in (1, 2):
        for tets in (600, 4000) if options.quick else (600, 4000, 30000):
            mesh = prepare(folder, surface, f"beam_{order}_{tets}", tets, order)
            head = f"*INCLUDE, INPUT={mesh.name}\n{material}*BOUNDARY\nroot, 1, 3\n"
            static = solve(folder, "static", head + "*STEP\n*STATIC\n*DLOAD\nbeam, GRAV, "
                           f"{gravity}, 0., 0., -1.\n*NODE PRINT, NSET=tip\nU\n*END STEP\n")
            reached = -table(static, 4)[:, 3].mean()
            modal = solve(folder, "modal", head + "*STEP\n*FREQUENCY\n1\n*NODE FILE\nU\n*END STEP\n")
            first = float(re.search(r"^ +1 +\S+ +\S+ +(\S+)", modal, re.M)[1])
            errors[order, tets] = abs(reached / sag - 1), abs(first / frequency - 1)
            print(f"cantilever order {order}, {tets} tets: sag {reached:.5g} of {sag:.5g} "
                  f"({100 * (reached / sag - 1):+.2f} %), frequency {first:.5g} of {frequency:.5g} "
                  f"({100 * (first / frequency - 1):+.2f} %)")
    sizes = sorted({tets for _, tets in errors})
    check("cantilever: ten-node tets are within 1.5 % of the closed forms", max(max(errors[2, t]) for t in sizes) < 0.015)
    for k, what in enumerate(("sag", "frequency")):
        check(f"cantilever, {what}: linear tets converge", errors[1, sizes[-1]][k] < 0.6 * errors[1, sizes[0]][k])
        check(f"cantilever, {what}: ten-node tets are far better than linear ones",
              errors[2, sizes[0]][k] < 0.2 * errors[1, sizes[0]][k])


def pressurised_sphere(folder):
    inner, outer, young, poisson, pressure = 1.0, 2.0, 1000.0, 0.3, 10.0
    # Lame (Timoshenko & Goodier, Theory of Elasticity, section 142): radial displacement at r.
    scale = pressure * inner**3 / (young * (outer**3 - inner**3))
    radial = lambda r: scale * ((1 - 2 * poisson) * r + (1 + poisson) * outer**3 / (2 * r**2))
    surface = spheres(folder / "ball.obj", outer, inner)
    errors = {}
    for order in (1, 2):
        for tets in (2000, 8000) if options.quick else (2000, 12000, 60000):
            mesh = prepare(folder, surface, f"ball_{order}_{tets}", tets, order)
            nodes = nodes_of(mesh)
            # Three nodes constrain the six rigid motions; the pressure is balanced, so that they carry no load.
            far = max(nodes, key=lambda n: nodes[n][0])
            side = max(nodes, key=lambda n: nodes[n][1])
            top = max(nodes, key=lambda n: nodes[n][2])
            text = solve(folder, "pressure",
                         f"*INCLUDE, INPUT={mesh.name}\n*MATERIAL, NAME=m\n*ELASTIC\n{young}, {poisson}\n"
                         f"*SOLID SECTION, ELSET=ball, MATERIAL=m\n*BOUNDARY\n{far}, 2, 3\n{side}, 1\n{side}, 3\n{top}, 1, 2\n"
                         f"*STEP\n*STATIC\n*DSLOAD\ninner, P, {pressure}\n*NODE PRINT, NSET=outer\nU\n"
                         "*NODE PRINT, NSET=inner\nU\n*END STEP\n")
            rows = table(text, 4)
            places = np.array([nodes[int(n)] for n in rows[:, 0]])
            # Remaining rigid motions are removed before radial displacements are compared.
            design = np.zeros((3 * len(rows), 6))
            for axis in range(3):
                design[axis::3, axis] = 1
                turn = np.cross(np.eye(3)[axis], places)
                design[:, 3 + axis] = turn.ravel()
            unit = places / np.linalg.norm(places, axis=1)[:, None]
            wanted = unit * np.array([radial(r) for r in np.linalg.norm(places, axis=1)])[:, None]
            difference = (rows[:, 1:] - wanted).ravel()
            difference -= design @ np.linalg.lstsq(design, difference, rcond=None)[0]
            errors[order, tets] = np.sqrt((difference**2).mean() / (wanted**2).mean())
            print(f"pressurised sphere order {order}, {tets} tets: displacements within {100 * errors[order, tets]:.2f} % (rms)")
    sizes = sorted({tets for _, tets in errors})
    check("sphere: ten-node tets are within 1 % of the closed form", errors[2, sizes[-1]] < 0.01)
    check("sphere: linear tets converge", errors[1, sizes[-1]] < 0.6 * errors[1, sizes[0]])
    # Displacements converge with the square of the size for linear tets and with the cube for ten-node tets; the
    # rates are lower with only one or two tets across the wall.
    for order, least in ((1, 1.2 if options.quick else 1.5), (2, 2.0 if options.quick else 2.3)):
        coarse, fine = sizes[-2:]
        rate = math.log(errors[order, coarse] / errors[order, fine]) / math.log((fine / coarse) ** (1 / 3))
        check(f"sphere: order {order} converges at a rate of {least} or more: {rate:.2f}", rate >= least)


def gray_cylinder(folder):
    """A cylinder whose gray values rise along its axis, each slice a spring in series with the others."""
    radius, length, spacing = 4.0, 24.0, 0.5
    gray = lambda z: 200 + 50 * z  # along the axis
    factor, exponent, scale, offset = 6850.0, 1.49, 0.001, 0.05
    modulus = lambda z: factor * (scale * gray(z) + offset) ** exponent
    size = [int(2 * (radius + 1) / spacing), int(2 * (radius + 1) / spacing), int((length + 2) / spacing)]
    origin = np.array([-radius - 1, -radius - 1, -1]) + spacing / 2
    z, y, x = np.meshgrid(*(origin[a] + spacing * np.arange(size[a]) for a in (2, 1, 0)), indexing="ij")
    inside = x**2 + y**2 <= radius**2
    # Air around it, which must not make the skin softer.
    values = np.where(inside, gray(z), -1000).astype("<f4")
    for file, data, kind in (("gray", values, "float"), ("mask", inside.astype("u1"), "uint8")):
        header = f"NRRD0004\ntype: {kind}\ndimension: 3\nsizes: {size[0]} {size[1]} {size[2]}\nencoding: raw\n" \
                 f"endian: little\nspace dimension: 3\nspace directions: ({spacing},0,0) (0,{spacing},0) (0,0,{spacing})\n" \
                 f"space origin: ({origin[0]},{origin[1]},{origin[2]})\n\n"
        (folder / f"{file}.nrrd").write_bytes(header.encode() + data.tobytes())
    surface = cylinder(folder / "cylinder.obj", radius, length)
    parts = 64
    area = parts / 2 * math.sin(2 * math.pi / parts) * radius**2
    heights = np.linspace(0, length, 100_001)
    stiffness = area / np.trapezoid(1 / modulus(heights), heights) if hasattr(np, "trapezoid") else \
        area / np.trapz(1 / modulus(heights), heights)
    for order in (1, 2):
        mesh = prepare(folder, surface, f"cylinder_{order}", 6000, order, "--values", "density=gray.nrrd", "--values-mask",
                       "mask.nrrd", "--bins", "density=24", "--modulus", f"density={factor},{exponent},{scale},{offset}")
        nodes = nodes_of(mesh)
        middle = min((n for n in nodes if abs(nodes[n][2]) < 1e-6), key=lambda n: np.linalg.norm(nodes[n][:2]))
        edge = max((n for n in nodes if abs(nodes[n][2]) < 1e-6), key=lambda n: nodes[n][0])
        text = solve(folder, "axial", f"*INCLUDE, INPUT={mesh.name}\n*BOUNDARY\nbottom, 3\n{middle}, 1, 2\n{edge}, 2\n"
                     "top, 3, 3, -0.01\n*STEP\n*STATIC\n*NODE PRINT, NSET=bottom, TOTALS=ONLY\nRF\n*END STEP\n")
        reached = abs(float(text.split()[-1])) / 0.01
        print(f"gray cylinder order {order}: axial stiffness {reached:.6g} of {stiffness:.6g} "
              f"({100 * (reached / stiffness - 1):+.2f} %)")
        check(f"gray cylinder, order {order}: the stiffness is within 2 % of springs in series",
              abs(reached / stiffness - 1) < 0.02)


with tempfile.TemporaryDirectory(prefix="tetwright-calculix-") as name:
    cantilever(pathlib.Path(name))
    pressurised_sphere(pathlib.Path(name))
    gray_cylinder(pathlib.Path(name))
sys.exit(1 if failures else 0)
