# SPDX-License-Identifier: Apache-2.0
"""Reads Exodus files with VTK's reader, which has Sandia's library of Exodus, and compares them with the mesh as .vtu
and, for surfaces, with --boundary.

usage: exodus_vtk.py TETWRIGHT    (Debian's python3-vtk9; status 77, with the reason, where it is missing or tetwright
lacks netCDF)
"""
import pathlib
import subprocess
import sys
import tempfile

SKIPPED = 77  # CTest's status of a skipped test
try:
    import numpy as np
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOExodus import vtkExodusIIReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader
except ImportError as reason:
    print(f"skipped: VTK is not installed ({reason})")
    sys.exit(SKIPPED)

TETWRIGHT = sys.argv[1]
MATERIALS = {"3": "left lung", "7": "12"}  # names by tag, and what the file has
WRITTEN = ["left_lung", "n12"]
# Corners of VTK's tets in the order of the edges of their midside nodes.
EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
failures = []


def check(what, good):
    print(("ok      " if good else "FAILED  ") + what)
    if not good:
        failures.append(what)


def run(*arguments):
    answer = subprocess.run([TETWRIGHT, *map(str, arguments)], check=False, capture_output=True, text=True)
    if answer.returncode not in (0, 1):
        sys.exit(f"tetwright: {answer.stderr}")


def write_source(folder):
    """Two stacked boxes of tets with a named patch, and fields of points and tets, as MSH 2.2."""
    points, tets, tags, values = [], [], [], []
    n = 3
    number = lambda x, y, z: 1 + x + (n + 1) * (y + (n + 1) * z)
    for z in range(2 * n + 1):
        for y in range(n + 1):
            for x in range(n + 1):
                points.append((x, y, z / 3))
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    for z in range(2 * n):
        for y in range(n):
            for x in range(n):
                c = [number(x + i, y + j, z + k) for i, j, k in corners]
                for a, b in ((1, 2), (2, 3), (3, 7), (7, 4), (4, 5), (5, 1)):
                    tets.append((c[0], c[a], c[b], c[6]))
                    tags.append(3 if z < n else 7)
    patch = []
    for y in range(n):
        for x in range(n):
            a, b, c, d = (number(x + i, y + j, 2 * n) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)))
            patch += [(a, b, c), (a, c, d)]
    with open(folder / "source.msh", "w", encoding="utf-8") as out:
        out.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n3 3 \"left lung\"\n3 7 \"12\"\n2 9 \"lid\"\n$EndPhysicalNames\n")
        out.write(f"$Nodes\n{len(points)}\n" + "".join(f"{i + 1} {x} {y} {z!r}\n" for i, (x, y, z) in enumerate(points)) + "$EndNodes\n")
        out.write(f"$Elements\n{len(tets) + len(patch)}\n")
        for i, tet in enumerate(tets):
            out.write(f"{i + 1} 4 2 {tags[i]} {tags[i]} {tet[0]} {tet[1]} {tet[2]} {tet[3]}\n")
        for i, face in enumerate(patch):
            out.write(f"{len(tets) + i + 1} 2 2 9 9 {face[0]} {face[1]} {face[2]}\n")
        out.write("$EndElements\n$NodeData\n1\n\"heat\"\n1\n0\n3\n0\n1\n" + f"{len(points)}\n")
        out.write("".join(f"{i + 1} {x + 10 * y + 100 * z!r}\n" for i, (x, y, z) in enumerate(points)) + "$EndNodeData\n")
        out.write(f"$ElementData\n1\n\"load\"\n1\n0\n3\n0\n1\n{len(tets)}\n" + "".join(f"{i + 1} {i / 2}\n" for i in range(len(tets))) + "$EndElementData\n")


def read(reader, file):
    reader.SetFileName(str(file))
    reader.Update()
    return reader.GetOutput()


def blocks_of(output, kind):
    """Grids of a kind of the reader's output by name: 0 element blocks, 4 side sets, 7 node sets."""
    group = output.GetBlock(kind)
    grids = {}
    for i in range(group.GetNumberOfBlocks() if group else 0):
        if group.GetBlock(i) is not None:
            grids[group.GetMetaData(i).Get(group.NAME())] = group.GetBlock(i)
    return grids


def all_on(reader):
    """Turns on every object and array, and their names."""
    reader.UpdateInformation()
    for kind in (reader.ELEM_BLOCK, reader.SIDE_SET, reader.NODE_SET):
        for i in range(reader.GetNumberOfObjects(kind)):
            reader.SetObjectStatus(kind, i, 1)
        for i in range(reader.GetNumberOfObjectArrays(kind)):
            reader.SetObjectArrayStatus(kind, reader.GetObjectArrayName(kind, i), 1)
    reader.SetAllArrayStatus(reader.NODAL, 1)
    reader.GenerateGlobalElementIdArrayOn()
    reader.GenerateGlobalNodeIdArrayOn()


def cells(grid):
    """Points of each cell, as rows of coordinates in single precision, to which VTK's reader of Exodus rounds."""
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(np.float32)
    return [points[[grid.GetCell(c).GetPointId(i) for i in range(grid.GetCell(c).GetNumberOfPoints())]] for c in range(grid.GetNumberOfCells())]


def unordered(faces):
    return sorted(tuple(sorted(map(tuple, face[:3]))) for face in faces)


def names_in(reader, kind):
    return [reader.GetObjectName(kind, i) for i in range(reader.GetNumberOfObjects(kind))]


def check_file(folder, file, order):
    name = f"{file.name}, order {order}"
    grid = read(vtkXMLUnstructuredGridReader(), folder / f"same{order}.vtu")
    tets = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4 if order == 1 else 10)
    is_tet = [i for i in range(grid.GetNumberOfCells()) if grid.GetCell(i).GetNumberOfPoints() in (4, 10)]
    check(f"{name}: the reference has tets alone", len(is_tet) == grid.GetNumberOfCells())
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(np.float32)
    tags = vtk_to_numpy(grid.GetCellData().GetArray("material"))
    heat = vtk_to_numpy(grid.GetPointData().GetArray("heat"))
    load = vtk_to_numpy(grid.GetCellData().GetArray("load"))

    reader = vtkExodusIIReader()
    reader.SetFileName(str(file))
    all_on(reader)
    reader.Update()
    output = reader.GetOutput()
    check(f"{name}: title", reader.GetTitle().startswith("Tetrahedral mesh"))
    check(f"{name}: steps", reader.GetNumberOfTimeSteps() == 1 and tuple(reader.GetTimeStepRange()) == (0, 0))
    check(f"{name}: names of blocks {names_in(reader, reader.ELEM_BLOCK)}", [n.split(" ")[0] for n in names_in(reader, reader.ELEM_BLOCK)] == WRITTEN)
    check(f"{name}: numbers of blocks", [reader.GetObjectId(reader.ELEM_BLOCK, i) for i in range(2)] == [3, 7])
    for block, tag in zip(blocks_of(output, 0).values(), (3, 7)):
        ids = vtk_to_numpy(block.GetCellData().GetArray("GlobalElementId")) - 1
        check(f"{name}: elements of block {tag}", list(ids) == list(np.flatnonzero(tags == tag)))
        got, expected = cells(block), [points[tets[i]] for i in ids]
        check(f"{name}: nodes of block {tag}", all(np.array_equal(a, b) for a, b in zip(got, expected)))
        check(f"{name}: element variable of block {tag}", np.array_equal(vtk_to_numpy(block.GetCellData().GetArray("load")), load[ids]))
        nodes = vtk_to_numpy(block.GetPointData().GetArray("GlobalNodeId")) - 1
        check(f"{name}: nodal variable of block {tag}", np.array_equal(vtk_to_numpy(block.GetPointData().GetArray("heat")), heat[nodes]))
        if order == 2:
            away = max(np.abs(cell[4:] - [(cell[a] + cell[b]) / 2 for a, b in EDGES]).max() for cell in got)
            check(f"{name}: midside nodes of block {tag} are halfway", away < 1e-6)

    surface = read(vtkXMLPolyDataReader(), folder / "boundary.vtp")
    groups = vtk_to_numpy(surface.GetCellData().GetArray("surface"))
    named = {}
    for line in bytes(vtk_to_numpy(surface.GetFieldData().GetArray("surface_names")).astype(np.uint8)).decode().splitlines():
        number, text = line.split("\t")
        named[text.replace(" ", "_").replace("12", "n12") if text != "lid" else text] = int(number)
    sides = dict(zip((n.split(" ")[0] for n in names_in(reader, reader.SIDE_SET)), blocks_of(output, 4).values()))
    points_of = dict(zip((n.split(" ")[0] for n in names_in(reader, reader.NODE_SET)), blocks_of(output, 7).values()))
    check(f"{name}: side sets {sorted(sides)}", set(sides) == set(named) and "lid" in sides and "left_lung|n12" in sides)
    check(f"{name}: node sets have their names", set(points_of) == set(sides))
    faces = cells(surface)
    for group, number in named.items():
        wanted = unordered(f for f, g in zip(faces, groups) if g == number)
        got = cells(sides[group])
        check(f"{name}: {len(got)} faces of {group}", len(wanted) > 0 and unordered(got) == wanted)
        corners = {tuple(p) for face in got for p in face}
        check(f"{name}: nodes of {group}", {tuple(p) for p in vtk_to_numpy(points_of[group].GetPoints().GetData())} == corners)
        inside = [tuple(np.cross(f[1] - f[0], f[2] - f[0])) for f in got]
        if group in ("lid", "left_lung|n12"):
            check(f"{name}: {group} looks out of the first block and up", all(normal[2] > 0 for normal in inside))


def main(folder):
    write_source(folder)
    same = ["--max-iterations", "1", "--feature-angle", "off"]
    for order, file in ((1, "m.exo"), (2, "m.e"), (1, "m.ex2")):
        call = ["improve", folder / "source.msh", "--order", order, "--only-below", "0", *same]
        answer = subprocess.run([TETWRIGHT, *map(str, call), "-o", str(folder / file)], check=False, capture_output=True, text=True)
        if "built without the netCDF library" in answer.stderr:
            print("skipped: tetwright was built without netCDF")
            sys.exit(SKIPPED)
        run(*call, "-o", folder / f"same{order}.vtu", "--boundary", folder / "boundary.vtp")
        check_file(folder, folder / file, order)
        first = (folder / file).read_bytes()
        run(*call, "-o", folder / file, "--threads", 1)
        check(f"{file}: equal bytes again", (folder / file).read_bytes() == first)


with tempfile.TemporaryDirectory(prefix="tetwright-exodus-") as name:
    main(pathlib.Path(name))
sys.exit(1 if failures else 0)
