# SPDX-License-Identifier: Apache-2.0
"""Reads meshes in parts with VTK: .pvtu and .vtkhdf.

usage: parts_vtk.py TETWRIGHT    (Debian's python3-vtk9; status 77, with the reason, where it is missing)
"""
import json
import pathlib
import subprocess
import sys
import tempfile

SKIPPED = 77  # CTest's status of a skipped test
try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader
    from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader, vtkXMLUnstructuredGridReader
except ImportError as reason:
    print(f"skipped: VTK is not installed ({reason})")
    sys.exit(SKIPPED)

TETWRIGHT = sys.argv[1]
PARTS = 3
failures = []


def check(what, good):
    print(("ok      " if good else "FAILED  ") + what)
    if not good:
        failures.append(what)


def write_parts(folder, file, *more):
    """Writes a mesh in parts and returns its statistics."""
    source = folder / "source.vtu"
    if not source.exists():
        subprocess.run([TETWRIGHT, "sample", "two_materials", "-o", source], check=True)
    answer = subprocess.run([TETWRIGHT, "improve", source, "-o", folder / file, "--parts", str(PARTS), "--max-iterations", "1",
                             "--stats", folder / "stats.json", *more], check=False, capture_output=True, text=True)
    if answer.returncode not in (0, 1):
        sys.exit(f"tetwright: {answer.stderr}")
    return json.loads((folder / "stats.json").read_text(encoding="utf-8"))


def read(reader, file):
    reader.SetFileName(str(file))
    reader.Update()
    return reader.GetOutput()


def arrays(data):
    return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays()) if data.GetArray(i)}


def check_grid(name, grid, stats, nodes):
    """Checks a grid of all pieces, with their ghosts."""
    tets, each = stats["result"]["tets"], stats["parts"]["each"]
    check(f"{name}: tets with ghosts", grid.GetNumberOfCells() == sum(p["tets"] + p["ghosts"] for p in each))
    check(f"{name}: nodes of a tet", grid.GetCell(0).GetNumberOfPoints() == nodes)
    cells, points = arrays(grid.GetCellData()), arrays(grid.GetPointData())
    own = cells["vtkGhostType"] == 0
    check(f"{name}: tets without ghosts", own.sum() == tets)
    check(f"{name}: every number once", sorted(cells["GlobalCellId"][own]) == list(range(tets)))
    own_points = points["vtkGhostType"] == 0
    check(f"{name}: every point is owned once", sorted(points["GlobalNodeId"][own_points]) == sorted(set(points["GlobalNodeId"])))
    check(f"{name}: VTK counts the ghosts", grid.GetCellGhostArray() is not None and grid.GetPointGhostArray() is not None)
    check(f"{name}: groups of faces", cells["face_groups"].shape == (grid.GetNumberOfCells(), 4) and cells["face_groups"].max() > 0)


def main(folder):
    for order, nodes in ((1, 4), (2, 10)):
        stats = write_parts(folder, "m.pvtu", "--order", str(order))
        grid = read(vtkXMLPUnstructuredGridReader(), folder / "m.pvtu")
        check_grid(f".pvtu, order {order}", grid, stats, nodes)
        for part, sizes in enumerate(stats["parts"]["each"]):
            piece = read(vtkXMLUnstructuredGridReader(), folder / f"m_{part}.vtu")
            check(f"piece {part}: VTK takes the numbers for global ids",
                  piece.GetCellData().GetGlobalIds() is not None and piece.GetPointData().GetGlobalIds() is not None)
            check(f"piece {part}: tets and ghosts", piece.GetNumberOfCells() == sizes["tets"] + sizes["ghosts"])
        stats = write_parts(folder, "m.vtkhdf", "--order", str(order))
        check_grid(f".vtkhdf, order {order}", read(vtkHDFReader(), folder / "m.vtkhdf"), stats, nodes)


with tempfile.TemporaryDirectory(prefix="tetwright-vtk-") as name:
    main(pathlib.Path(name))
sys.exit(1 if failures else 0)
