# SPDX-License-Identifier: Apache-2.0
"""Reads meshes in parts with Gmsh and h5py: split .msh files, .vtkhdf and .xdmf.

usage: parts_gmsh.py TETWRIGHT    (Debian's python3 with meshio, h5py and numpy, and gmsh)
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import h5py
import meshio
import numpy as np

TETWRIGHT = sys.argv[1]
PARTS = 3
OLDER_FORMAT = "Warning : Saving a partitioned mesh in a format older than 4.0"
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


def gmsh_pieces(folder, format_name, order):
    """Opens each piece in Gmsh, which must count its tets and ghosts and save it again without a warning."""
    stats = write_parts(folder, "m.msh", "--output-format", format_name, "--order", str(order))
    for part, sizes in enumerate(stats["parts"]["each"], 1):
        again = folder / "again.msh"
        answer = subprocess.run(["gmsh", "-save", "-format", "msh2", "-o", again, folder / f"m_{part}.msh"],
                                check=False, capture_output=True, text=True)
        text = (answer.stdout + answer.stderr).replace(OLDER_FORMAT, "")
        name = f"{format_name}, order {order}, piece {part}"
        check(f"{name}: Gmsh opens it{'' if answer.returncode == 0 else ': ' + text}", answer.returncode == 0)
        check(f"{name}: no warning", "Warning" not in text and "Error" not in text)
        mesh = meshio.read(again)
        kind = "tetra" if order == 1 else "tetra10"
        check(f"{name}: its {sizes['tets']} tets", len(mesh.cells_dict[kind]) == sizes["tets"])
        physical = np.unique(np.concatenate([g for block, g in zip(mesh.cells, mesh.cell_data["gmsh:physical"]) if block.type == kind]))
        check(f"{name}: materials {physical}", len(physical) > 0 and set(physical) <= {1, 2})


def all_pieces_in_gmsh(folder):
    """Merges the pieces in Gmsh into the whole mesh."""
    stats = write_parts(folder, "m.msh")
    script = folder / "merge.geo"
    script.write_text("".join(f'Merge "m_{part}.msh";\n' for part in range(1, PARTS + 1)), encoding="utf-8")
    again = folder / "merged.msh"
    # Gmsh 4.8.4 ends in a segmentation fault after it has written the mesh, also with pieces of its own.
    subprocess.run(["gmsh", "-save", "-format", "msh2", "-o", again, script], check=False, capture_output=True)
    tets = meshio.read(again).cells_dict["tetra"]
    check("Gmsh merges the pieces into the whole mesh", len({tuple(sorted(t)) for t in tets}) == len(tets) == stats["result"]["tets"])


def vtkhdf(folder):
    stats = write_parts(folder, "m.vtkhdf")
    with h5py.File(folder / "m.vtkhdf") as file:
        root = file["VTKHDF"]
        check("VTKHDF: type and version", root.attrs["Type"] == b"UnstructuredGrid" and list(root.attrs["Version"]) == [1, 0])
        check("VTKHDF: tets", list(root["NumberOfCells"]) == [p["tets"] + p["ghosts"] for p in stats["parts"]["each"]])
        check("VTKHDF: lists have one dimension", root["Offsets"].ndim == 1 and root["CellData/material"].ndim == 1)
        own = root["CellData/vtkGhostType"][:] == 0
        check("VTKHDF: each tet is owned once", sorted(root["CellData/GlobalCellId"][own]) == list(range(stats["result"]["tets"])))


def xdmf(folder):
    stats = write_parts(folder, "m.xdmf")
    parts = np.ravel(meshio.read(folder / "m.xdmf").cell_data["partition"][0])
    check("XDMF: parts are in succession", (np.diff(parts) >= 0).all())
    check("XDMF: sizes of parts", list(np.bincount(parts)) == [p["tets"] for p in stats["parts"]["each"]])


with tempfile.TemporaryDirectory(prefix="tetwright-parts-") as name:
    scratch = pathlib.Path(name)
    for format_name in ("msh41", "msh41-binary"):
        for order in (1, 2):
            gmsh_pieces(scratch, format_name, order)
    all_pieces_in_gmsh(scratch)
    vtkhdf(scratch)
    xdmf(scratch)
sys.exit(1 if failures else 0)
