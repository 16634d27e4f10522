# SPDX-License-Identifier: Apache-2.0
"""Tetrahedral meshes for simulation from scans and segmented volumes.

    import tetwright
    mesh = tetwright.prepare("scan.ply", target_tets=10_000)
    mesh.points, mesh.tets, mesh.materials      # numpy arrays
    mesh.write("scan.vtu")

The functions are the commands of the program `tetwright`, and their keyword arguments are its options: `--target-tets
9000` is `target_tets=9000`, a flag is True, a length in percent of the diagonal is the string "0.2%". Both give the
same bytes for the same inputs and options.

Inputs are file names; `(points, triangles)` and `(points, tets)` arrays; label arrays of three axes with `spacing`,
`origin` or `affine`; meshes of meshio, pyvista or trimesh, images of nibabel, or objects like these; or a `TetMesh`.
Several surfaces are given as a list, or as a dict from the names of their materials. Cells of meshes are read as in
files: polygons become triangles, curved cells are reduced to their corners, data of points and tets become fields,
one of which may be the material, volume cells other than tets are rejected, and `TetMesh.notes` lists the contents
that are left out.

A call that fails raises a subclass of `tetwright.Error` with the program's message. A request that is not met causes
a `ShortfallWarning` and is listed in `TetMesh.shortfall`; `TetMesh.diagnostics` has the codes of all notes and
shortfalls, `diagnostic_kinds()` their causes and remedies. Calls release the interpreter's lock, and Ctrl-C cancels
them. Several calls may run at the same time, each with its own `threads`.
"""
from ._commands import check, embed, improve, mesh, prepare, read, simplify, values
from ._core import (Error, InputError, InternalError, NothingToMeshError, OutputError, UsageError,
                    version as __version__)
from ._embedding import Embedding
from ._mesh import CheckResult, Diagnostic, DiagnosticKind, Interfaces, PartedInterface, ShortfallWarning, TetMesh, diagnostic_kinds

__all__ = ["prepare", "mesh", "simplify", "improve", "values", "embed", "check", "read", "TetMesh", "Interfaces", "PartedInterface", "CheckResult", "Embedding", "Diagnostic",
           "DiagnosticKind", "diagnostic_kinds", "ShortfallWarning", "Error", "UsageError", "InputError", "NothingToMeshError", "OutputError",
           "InternalError", "__version__"]
