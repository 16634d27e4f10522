# SPDX-License-Identifier: Apache-2.0
"""Tetrahedral meshes for simulation from scans and segmented volumes.

    import tetwright
    mesh = tetwright.prepare("scan.ply", target_tets=10_000)
    mesh.points, mesh.tets, mesh.materials      # numpy arrays
    mesh.write("scan.vtu")

The functions are the commands of the program `tetwright`, their keyword arguments its options: `--target-tets 9000` is
`target_tets=9000`, a flag is True, a length in percent of the diagonal is the string "0.2%". With the same inputs and
options both give the same bytes.

Inputs are file names; `(points, triangles)` and `(points, tets)` arrays; label arrays of three axes with `spacing`,
`origin` or `affine`; meshes of meshio, pyvista or trimesh and images of nibabel, or what looks like them; a `TetMesh`.
Several surfaces are a list, or a dict from the names of their materials. Cells of meshes are read as those of files
are: polygons become triangles, curved cells are taken by their corners, numbers of points and tets are fields of which
one may be the material, other volumes than tets are refused, and what is left out is in `TetMesh.notes`.

What ends a call early is an exception, a subclass of `tetwright.Error` with the program's message. What falls short of
what was asked is a `ShortfallWarning` and in `TetMesh.shortfall`; `TetMesh.diagnostics` has the codes of all notes and
shortfalls, and `diagnostic_kinds()` their causes and remedies. Calls release the interpreter's lock, and Ctrl-C cancels them. Several may run at a time, each with its own
`threads`.
"""
from ._commands import check, improve, mesh, prepare, read, simplify
from ._core import (Error, InputError, InternalError, NothingToMeshError, OutputError, UsageError,
                    version as __version__)
from ._mesh import CheckResult, Diagnostic, DiagnosticKind, Interfaces, ShortfallWarning, TetMesh, diagnostic_kinds

__all__ = ["prepare", "mesh", "simplify", "improve", "check", "read", "TetMesh", "Interfaces", "CheckResult", "Diagnostic",
           "DiagnosticKind", "diagnostic_kinds", "ShortfallWarning", "Error", "UsageError", "InputError", "NothingToMeshError", "OutputError",
           "InternalError", "__version__"]
