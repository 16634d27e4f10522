# SPDX-License-Identifier: Apache-2.0
"""Reads files written by tetwright with meshio and Gmsh, and compares points, tets, materials, surfaces and their
names.

usage: read_back.py TETWRIGHT    (Debian's python3 with meshio, h5py and numpy, and gmsh)
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

import meshio
import numpy as np

TETWRIGHT = sys.argv[1]
# Format: file, names of materials, names of surfaces (or none), as read by meshio.
FORMATS = {
    "vtu": "m.vtu",
    "vtk": "m.vtk",
    "msh22": "m.msh",
    "msh41": "m.msh",
    "msh41-binary": "m.msh",
    "medit": "m.mesh",
    "medit-binary": "m.meshb",
    "abaqus": "m.inp",
    "nastran": "m.bdf",
    "tetgen": "m.node",
    "xdmf": "m.xdmf",
}
SECOND_ORDER = {"vtu", "vtk", "msh22", "msh41", "msh41-binary", "abaqus", "nastran", "xdmf"}
# Maximum difference of coordinates: formats of solvers have few characters for them, so they are rounded.
TOLERANCE = {"abaqus": 1e-14, "nastran": 1e-9}
failures = []


def check(format_name, what, good):
    if not good:
        failures.append(f"{format_name}: {what}")
        print(f"FAILED {format_name}: {what}")


def run(*arguments):
    return subprocess.run([TETWRIGHT, *map(str, arguments)], check=False, capture_output=True, text=True)


def decoded(field):
    """Decodes names in VTK's field data: lines with a number, a tab and a name."""
    lines = bytes(np.asarray(field, dtype=np.uint8)).decode().splitlines()
    return dict(line.split("\t")[::-1] for line in lines)


def names_of(format_name, mesh):
    """Returns the names of materials and surfaces, each with its number of elements."""
    count = {}
    if format_name in ("msh22", "msh41", "msh41-binary"):
        for name, (number, dimension) in mesh.field_data.items():
            count[name] = sum(
                int(np.sum(physical == number))
                for block, physical in zip(mesh.cells, mesh.cell_data["gmsh:physical"])
                if (3 if block.type.startswith("tetra") else 2) == dimension
            )
    elif format_name in ("vtu", "vtk"):
        for field, cells in (("material_names", "material"), ("surface_names", "surface")):
            for name, number in decoded(mesh.field_data[field]).items() if field in mesh.field_data else ():
                count[name] = sum(
                    int(np.sum(values == int(number)))
                    for block, values in zip(mesh.cells, mesh.cell_data[cells])
                    if block.type.startswith("tetra" if cells == "material" else "triangle")
                )
    elif format_name == "abaqus":
        for name, sets in mesh.cell_sets.items():
            count[name] = sum(len(s) for s in sets if s is not None)
    elif format_name == "xdmf":
        for name, (number, dimension) in mesh.field_data.items():
            if dimension == 3:
                count[name] = int(np.sum(mesh.cell_data["material"][0] == number))
    return count


def tets_of(mesh):
    return np.vstack([block.data for block in mesh.cells if block.type.startswith("tetra")])


def volumes(points, tets):
    corners = points[tets[:, :4]]
    return np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6


def compare(format_name, mesh, reference, order):
    points, tets = np.asarray(mesh.points), tets_of(mesh)
    expected = tets_of(reference)
    check(format_name, "number of nodes of a tet", tets.shape[1] == (4 if order == 1 else 10))
    check(format_name, "number of tets", len(tets) == len(expected))
    corners = points[tets[:, :4]].mean(axis=1)
    wanted = reference.points[expected].mean(axis=1)
    order_of = lambda a: np.lexsort(np.round(a, 7).T)
    difference = np.abs(corners[order_of(corners)] - wanted[order_of(wanted)]).max()
    check(format_name, f"tets differ by {difference}", difference <= TOLERANCE.get(format_name, 0) + 1e-15)
    check(format_name, "negative tets", (volumes(points, tets) > 0).all())
    if order == 2:
        edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]  # meshio's order is VTK's
        halfway = np.stack([points[tets[:, [a, b]]].mean(axis=1) for a, b in edges], axis=1)
        lengths = np.stack(
            [np.linalg.norm(points[tets[:, a]] - points[tets[:, b]], axis=1) for a, b in edges], axis=1
        )
        away = np.linalg.norm(points[tets[:, 4:]] - halfway, axis=2)
        check(format_name, "midside nodes are not beside the middle of their edges", (away <= 0.251 * lengths).all())


def main():
    folder = pathlib.Path(tempfile.mkdtemp(prefix="tetwright-interop-"))
    try:
        source = folder / "source.vtu"
        run("sample", "two_materials", "-o", source)
        arguments = ["simplify", source, "--target-tets", 200, "--quiet", "--no-progress"]
        run(*arguments, "-o", folder / "reference.vtu")
        reference = meshio.read(folder / "reference.vtu")
        print("format         order  nodes  tets  names that meshio reads")
        for format_name, file in FORMATS.items():
            for order in (1, 2) if format_name in SECOND_ORDER else (1,):
                out = folder / f"{format_name}{order}" / file
                out.parent.mkdir()
                answer = run(*arguments, "-o", out, "--output-format", format_name, "--order", order)
                if answer.returncode not in (0, 1):
                    check(format_name, f"status {answer.returncode}: {answer.stderr}", False)
                    continue
                mesh = meshio.read(out)
                compare(format_name, mesh, reference, order)
                names = names_of(format_name, mesh)
                print(f"{format_name:14} {order:5} {len(mesh.points):6} {len(tets_of(mesh)):5}  {names}")
                if format_name not in ("medit", "medit-binary", "tetgen", "nastran"):
                    check(format_name, f"names {names}", {"left", "right"} <= set(names))
                    check(format_name, "no tets in a material", names["left"] > 0 and names["right"] > 0)
                if format_name == "abaqus":
                    sets = {name: len(nodes) for name, nodes in mesh.point_sets.items()}
                    check(format_name, f"node sets {sets}", set(sets) == {"left_outside", "left_right", "right_outside"})
                elif format_name in ("vtk", "msh22", "msh41", "msh41-binary"):
                    check(format_name, f"surfaces {names}", names.get("left|right", 0) > 0)
                if format_name.startswith("msh"):
                    saved_again_by_gmsh(out, format_name, names)
        outside_is_kept_by_gmsh(folder)
    finally:
        shutil.rmtree(folder)
    sys.exit(1 if failures else 0)


def saved_again_by_gmsh(file, format_name, names):
    again = file.with_name("again.msh")
    subprocess.run(["gmsh", "-save", "-format", "msh41", "-o", again, file], check=True, capture_output=True)
    check(format_name, "names after Gmsh saved it", names_of("msh41", meshio.read(again)) == names)
    back = run("simplify", again, "-o", file.with_name("back.msh"), "--target-tets", 150, "--quiet", "--no-progress")
    check(format_name, f"read again after Gmsh: {back.stderr}", back.returncode in (0, 1))


def outside_is_kept_by_gmsh(folder):
    """Checks a mesh with its outside, whose tag 0 cannot be a group number in Gmsh."""
    surface = folder / "cube.ply"
    run("sample", "cube", "-o", surface)
    mesh = folder / "outside.msh"
    run("mesh", surface, "-o", mesh, "--resolution", 8, "--keep-outside", "--output-format", "msh41", "--quiet")
    names = names_of("msh41", meshio.read(mesh))
    check("msh41", f"names with --keep-outside: {names}", "outside" in names and names["outside"] > 0)
    saved_again_by_gmsh(mesh, "msh41", names)


main()
