# SPDX-License-Identifier: Apache-2.0
"""Parted interfaces in use: ties and contact in CalculiX, and a cohesive layer that is peeled.

usage: parted.py TETWRIGHT    (Debian's calculix-ccx and python3-numpy)

Two blocks, one on the other. *TIE between the two sides gives the displacements of the mesh with shared points. Pressed
together over a *CONTACT PAIR of linear stiffness, they shorten as the closed form says; pulled apart, they separate.
CalculiX has no cohesive elements, so the exported wedges are assembled here: the opening of a layer that is peeled off
by an eccentric force is linear, as of a rigid plate on an elastic foundation.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np

tetwright = pathlib.Path(sys.argv[1]).resolve()
SKIPPED = 77  # CTest's status of a skipped test
LENGTH, WIDTH, HEIGHT = 2.0, 1.0, 1.0  # of each block
YOUNG = {"lower": 100.0, "upper": 250.0}
failures = []


def check(what, good):
    print(("ok      " if good else "FAILED  ") + what)
    if not good:
        failures.append(what)


def block(path, below, above):
    corners = [(x, y, z) for x in (0, LENGTH) for y in (0, WIDTH) for z in (below, above)]
    quads = {"bottom": [(0, 2, 6, 4)], "top": [(1, 5, 7, 3)],
             "sides": [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6)]}
    lines = [f"v {x} {y} {z}" for x, y, z in corners]
    for name, faces in quads.items():
        lines.append(f"g {path.stem}_{name}")
        lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")
    return path


def prepare(folder, name, *more):
    answer = subprocess.run([str(tetwright), "prepare", "lower.obj", "upper.obj", "-o", f"{name}.inp", "--target-tets", "1500",
                             "--quiet", "--no-progress", *more], cwd=folder, check=False, capture_output=True, text=True)
    if answer.returncode != 0:
        sys.exit(f"tetwright: {answer.stderr}")
    return Deck(folder / f"{name}.inp")


class Deck:
    """Nodes, elements by set, and sets of nodes of an input file."""

    def __init__(self, path):
        self.path, self.nodes, self.elements, self.sets = path, {}, {}, {}
        into = None
        for line in path.read_text().splitlines():
            if line.startswith("**"):
                continue
            if line.startswith("*"):
                key, *parameters = [word.strip() for word in line.split(",")]
                named = dict(p.split("=") for p in parameters if "=" in p)
                into = {"*NODE": self.nodes, "*ELEMENT": self.elements.setdefault(named.get("ELSET"), []),
                        "*NSET": self.sets.setdefault(named.get("NSET"), [])}.get(key)
            elif into is self.nodes:
                number, *place = line.split(",")
                self.nodes[int(number)] = np.array([float(x) for x in place])
            elif isinstance(into, list) and into is not self.elements.get(None):
                numbers = [int(word) for word in line.split(",") if word.strip()]
                if any(into is elements for elements in self.elements.values()):
                    into.append(numbers[1:])
                else:
                    into.extend(numbers)


def solve(folder, name, deck):
    """Runs the deck and returns the displacements by node."""
    (folder / f"{name}.inp").write_text(deck)
    answer = subprocess.run(["ccx", name], cwd=folder, check=False, capture_output=True, text=True, timeout=300)
    if answer.returncode != 0 or "*ERROR" in answer.stdout:
        sys.exit(f"ccx {name}: {answer.stdout[-2000:]}")
    rows = {}
    for line in (folder / f"{name}.dat").read_text().splitlines():
        words = line.split()
        if len(words) == 4 and words[0].isdigit():
            rows[int(words[0])] = np.array([float(w) for w in words[1:]])
    return rows


def materials(poisson):
    return "".join(f"*MATERIAL, NAME=m{name}\n*ELASTIC\n{young}, {poisson}\n*SOLID SECTION, ELSET={name}, MATERIAL=m{name}\n"
                   for name, young in YOUNG.items())


def names_in(deck):
    """The names of both sides: the sets whose names begin with those of both materials."""
    sides = sorted(name for name in deck.sets if name and name.upper().startswith("LOWER_UPPER_"))
    return sides


def tie(folder):
    whole, parted = prepare(folder, "whole"), prepare(folder, "parted", "--split-interface", "lower,upper")
    sides = names_in(parted)
    check(f"both sides are sets of nodes ({', '.join(sides)})", len(sides) == 2)
    pairs = [line.split(",") for line in (folder / "parted_pairs.csv").read_text().splitlines()[1:]]
    check("the table has all points of both sides",
          [sorted(int(p[k]) for p in pairs) for k in (1, 2)] == [sorted(parted.sets[s]) for s in sides])
    check("the points of a pair coincide",
          all((parted.nodes[int(a)] == parted.nodes[int(b)]).all() and a != b for _, a, b in pairs))
    load = ("*STEP\n*STATIC\n*CLOAD\n{0}, 1, 0.3\n{0}, 3, -0.2\n*NODE PRINT, NSET=upper_top\nU\n*NODE PRINT, NSET=every_node\nU\n"
            "*END STEP\n")
    displacements = {}
    for deck, constraint in ((whole, ""), (parted, f"*TIE, NAME=t, POSITION TOLERANCE=1e-6\n{sides[1]}, {sides[0]}\n")):
        corner = next(n for n, p in deck.nodes.items() if (p == [LENGTH, WIDTH, 2 * HEIGHT]).all())
        loads = "*NSET, NSET=every_node\n" + "".join(f"{n}\n" for n in whole.nodes)
        displacements[deck] = solve(
            folder, "tie", f"*INCLUDE, INPUT={deck.path.name}\n{materials(0.3)}{loads}{constraint}*BOUNDARY\nlower_bottom, 1, 3\n" +
            load.format(corner))
    size = max(np.abs(u).max() for u in displacements[whole].values())
    # Points keep their numbers, and copies come after them.
    difference = max(np.abs(displacements[parted][n] - u).max() for n, u in displacements[whole].items())
    print(f"tie: largest difference {difference / size:.1e} of the largest displacement")
    check("*TIE gives the displacements of the shared mesh to 1e-6", len(displacements[whole]) == len(whole.nodes) and
          difference < 1e-6 * size)
    return parted, sides


def contact(folder, deck, sides):
    pressure, stiffness = 1.0, 1e4
    pair = (f"*SURFACE INTERACTION, NAME=i\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{stiffness}\n"
            f"*CONTACT PAIR, INTERACTION=i, TYPE=SURFACE TO SURFACE\n{sides[1]}, {sides[0]}\n")
    corner = {axis: min(deck.sets["upper_top"], key=lambda n: deck.nodes[n][:2] @ weights)
              for axis, weights in (("a", np.array([1.0, 1.0])), ("b", np.array([-1.0, 1.0])))}
    head = (f"*INCLUDE, INPUT={deck.path.name}\n{materials(0.0)}{pair}*BOUNDARY\nlower_bottom, 1, 3\n"
            f"{corner['a']}, 1, 2\n{corner['b']}, 2, 2\n")
    step = "*STEP\n*STATIC\n{}*NODE PRINT, NSET=upper_top\nU\n*END STEP\n"
    u = solve(folder, "contact", head + step.format(f"*DLOAD\n{faces_load(deck, 'upper_top', pressure)}"))
    reached = -np.mean([u[n][2] for n in deck.sets["upper_top"]])
    wanted = pressure * HEIGHT * sum(1 / young for young in YOUNG.values()) + pressure / stiffness
    print(f"contact: the top sinks by {reached:.6g} of {wanted:.6g} ({100 * (reached / wanted - 1):+.4f} %)")
    check("a contact pair in compression is within 0.1 % of the closed form", abs(reached / wanted - 1) < 1e-3)
    # The top is moved up: nothing holds it back, and the lower block stays.
    u = solve(folder, "apart", head + "*BOUNDARY\nupper_top, 1, 2\n" +
              step.format("*BOUNDARY\nupper_top, 3, 3, 0.01\n").replace("NSET=upper_top", f"NSET={sides[0]}"))
    largest = max(np.abs(u[n]).max() for n in deck.sets[sides[0]])
    check(f"pulled apart, the lower block stays ({largest:.1e})", largest < 1e-5)


def faces_load(deck, surface, pressure):
    """Lines of *DLOAD for the faces of a surface."""
    lines, inside = [], False
    for line in deck.path.read_text().splitlines():
        if line.startswith("*"):
            inside = line.startswith(f"*SURFACE, NAME={surface},")
        elif inside:
            element, side = line.split(",")
            lines.append(f"{element.strip()}, P{side.strip()[1]}, {pressure}\n")
    return "".join(lines)


def stiffness_of_tets(deck, moduli):
    """Stiffness of linear tets, Poisson's ratio 0.3, for all nodes."""
    rows, columns, values = [], [], []
    for name, young in moduli.items():
        c = young / (1.3 * 0.4) * np.array([[.7, .3, .3, 0, 0, 0], [.3, .7, .3, 0, 0, 0], [.3, .3, .7, 0, 0, 0],
                                            [0, 0, 0, .2, 0, 0], [0, 0, 0, 0, .2, 0], [0, 0, 0, 0, 0, .2]])
        for tet in deck.elements[name]:
            edges = np.array([np.append(1, deck.nodes[n]) for n in tet])
            gradient = np.linalg.inv(edges)[1:]  # (3, 4)
            b = np.zeros((6, 12))
            for k in range(4):
                x, y, z = gradient[:, k]
                b[:, 3 * k:3 * k + 3] = [[x, 0, 0], [0, y, 0], [0, 0, z], [y, x, 0], [0, z, y], [z, 0, x]]
            ids = [3 * (n - 1) + a for n in tet for a in range(3)]
            k = b.T @ c @ b * abs(np.linalg.det(edges)) / 6
            rows += np.repeat(ids, 12).tolist()
            columns += ids * 12
            values += k.ravel().tolist()
    return rows, columns, values


def peel(folder):
    deck = prepare(folder, "cohesive", "--cohesive", "lower,upper")
    layers = [name for name, elements in deck.elements.items() if name and len(elements[0]) == 6]
    check(f"the wedges have a set of their own ({layers})", len(layers) == 1)
    wedges = deck.elements[layers[0]]
    area = 0.0
    spring, size = 50.0, 3 * len(deck.nodes)
    # Stiff blocks: the layer alone gives way.
    rows, columns, values = stiffness_of_tets(deck, {"lower": 1e9, "upper": 1e9})
    for wedge in wedges:
        a, b, c = (deck.nodes[n] for n in wedge[:3])
        normal = np.cross(b - a, c - a)
        area += np.linalg.norm(normal) / 2
        check_up = normal[2] > 0 and all((deck.nodes[wedge[k]] == deck.nodes[wedge[k + 3]]).all() for k in range(3))
        if not check_up:
            failures.append("a wedge does not lead from the lower side to the upper one")
        # The integral of the product of two linear functions over a triangle, for openings in each direction.
        mass = spring * np.linalg.norm(normal) / 24 * (np.ones((3, 3)) + np.eye(3))
        for i in range(6):
            for j in range(6):
                for axis in range(3):
                    rows.append(3 * (wedge[i] - 1) + axis)
                    columns.append(3 * (wedge[j] - 1) + axis)
                    values.append((1 if (i < 3) == (j < 3) else -1) * mass[i % 3, j % 3])
    check(f"the wedges cover the interface ({area:.12g})", abs(area - LENGTH * WIDTH) < 1e-12)
    matrix = np.zeros((size, size))
    np.add.at(matrix, (rows, columns), values)
    fixed = {3 * (n - 1) + a for n in deck.sets["lower_bottom"] for a in range(3)}
    free = np.array([i for i in range(size) if i not in fixed])
    force = np.zeros(size)
    corners = [next(n for n, p in deck.nodes.items() if (p == [LENGTH, y, 2 * HEIGHT]).all()) for y in (0, WIDTH)]
    total = 1.0
    for n in corners:
        force[3 * (n - 1) + 2] = total / len(corners)  # peels at the end x = LENGTH
    u = np.zeros(size)
    u[free] = np.linalg.solve(matrix[np.ix_(free, free)], force[free])
    u = u.reshape(-1, 3)
    worst = 0.0
    inertia = WIDTH * LENGTH**3 / 12
    at_end = total / (spring * area) + total * (LENGTH / 2)**2 / (spring * inertia)
    for wedge in wedges:
        for k in range(3):
            opening = u[wedge[k + 3] - 1, 2] - u[wedge[k] - 1, 2]
            x = deck.nodes[wedge[k]][0] - LENGTH / 2
            wanted = total / (spring * area) + total * LENGTH / 2 * x / (spring * inertia)
            worst = max(worst, abs(opening - wanted))
    print(f"peel: openings are within {worst / at_end:.1e} of the largest of the closed form")
    check("the opening of the peeled layer is that of the closed form to 1e-4", worst < 1e-4 * at_end)


has_calculix = shutil.which("ccx") is not None
with tempfile.TemporaryDirectory() as name:
    here = pathlib.Path(name)
    block(here / "lower.obj", 0, HEIGHT)
    block(here / "upper.obj", HEIGHT, 2 * HEIGHT)
    if has_calculix:
        contact(here, *tie(here))
    peel(here)
if failures:
    sys.exit(f"{len(failures)} failed: {failures}")
if not has_calculix:
    print("skipped: ties and contact, since CalculiX (ccx) is not installed; the cohesive layer was tested")
    sys.exit(SKIPPED)
