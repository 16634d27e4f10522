# SPDX-License-Identifier: Apache-2.0
"""Results of the commands."""
from __future__ import annotations

import json
import os
from typing import Any, Mapping, NamedTuple, Optional

import numpy as np

from . import _core
from ._text import file_name, plain_text


class ShortfallWarning(UserWarning):
    """There is a result, but a request was not met; the program's exit status would be 1."""


class Diagnostic(NamedTuple):
    """Information about an input or a result; diagnostic_kinds() has causes and remedies by code."""
    code: str  # the same in all versions
    severity: str  # "note" or "shortfall"
    message: str
    places: list[tuple[float, float, float]]  # only the first few
    file: Optional[str]  # file concerned; None: the result
    asked: Optional[float]
    reached: Optional[float]
    limited_by: Optional[str]


class DiagnosticKind(NamedTuple):
    """Description of a code."""
    severity: str  # "note", "shortfall", "warning" or "error"
    acceptable: bool  # accept_changes=True makes the shortfall a note
    certain: bool  # False: the result differs from an estimate; strict=True does not count the note
    title: str  # a few words
    message: str  # pattern of the line, with N, D and NAME for values; "" for errors
    cause: str
    remedy: str


def diagnostic_kinds() -> dict[str, DiagnosticKind]:
    """All codes that Diagnostic.code may have, and those of errors, in the order of the guide."""
    return {name: DiagnosticKind(*kind) for name, *kind in _core.diagnostic_kinds()}


class PartedInterface(NamedTuple):
    """An interface whose sides have points of their own, with split_interface= or cohesive=."""
    name: str  # both materials, "bone|implant", or the name of the sheet or group of faces
    sides: tuple[str, str]  # names of the faces on both sides in Interfaces.group_names
    pairs: np.ndarray  # (n, 2) int64: points of the first side with those of the second at the same position
    cohesive: bool  # TetMesh.wedges join the sides


class Interfaces:
    """The faces between two materials, and between a material and the outside, and those of sheets, which have
    the same material on both sides. Arrays are read-only."""

    def __init__(self, core: _core.Mesh):
        self._core = core

    def __len__(self) -> int:
        return len(self.triangles)

    @property
    def triangles(self) -> np.ndarray:
        """(n, 3) uint32, a view: indices into the points; the normal points out of `material`."""
        return self._core.interface_triangles

    @property
    def material(self) -> np.ndarray:
        """(n,) int32, a view: the material that the normal points out of, the smaller tag of two."""
        return self._core.interface_materials

    @property
    def patch(self) -> np.ndarray:
        """(n,) uint16, a view: the patch of its interface; creases and named patches separate patches."""
        return self._core.interface_patches

    @property
    def tets(self) -> np.ndarray:
        """(n,) uint32, a copy: the tet on the side of `material`."""
        return self._core.interface_tets()

    @property
    def group(self) -> np.ndarray:
        """(n,) int64, a copy: the number of the surface in which .msh and .vtk files list the triangle, see
        `group_names`. A patch of the input keeps its number if it has one and it is free."""
        return self._core.interface_groups()[0]

    @property
    def group_names(self) -> dict[int, str]:
        """Names of these surfaces, a copy: those of patches of the input, and "bone|skin" or "bone|outside" for
        triangles in no patch."""
        return self._core.interface_groups()[1]

    @property
    def other(self) -> np.ndarray:
        """(n,) int32, a copy: the material on the other side; 0 on the boundary, see `on_boundary`."""
        return self._core.interface_others()[0]

    @property
    def on_boundary(self) -> np.ndarray:
        """(n,) bool, a copy: True if the other side is outside."""
        return self._core.interface_others()[1]

    @property
    def on_sheet(self) -> np.ndarray:
        """(n,) bool, a copy: True for the face of a sheet, with the same material on both sides."""
        other, on_boundary = self._core.interface_others()
        return (other == self.material) & ~on_boundary


class TetMesh:
    """A tetrahedral mesh. Its arrays are read-only views, which keep the mesh alive; nothing is copied."""

    def __init__(self, core: _core.Mesh):
        self._core = core
        self._stats: Optional[dict] = None

    def __repr__(self) -> str:
        return f"<tetwright.TetMesh of {len(self.tets)} tets, {len(self.points)} points, " \
               f"{len(set(self.materials.tolist()))} materials>"

    @property
    def points(self) -> np.ndarray:
        """(n, 3) float64, units of the input."""
        return self._core.points

    @property
    def tets(self) -> np.ndarray:
        """(m, 4) uint32, indices into the points; a tet (a, b, c, d) has (b-a) x (c-a) . (d-a) > 0."""
        return self._core.tets

    @property
    def materials(self) -> np.ndarray:
        """(m,) int32, the tag of each tet's material."""
        return self._core.materials

    @property
    def material_names(self) -> dict[int, str]:
        """Names of the materials that have one, by tag."""
        return self._core.material_names

    @property
    def interfaces(self) -> Interfaces:
        """The faces between materials and on the boundary."""
        return Interfaces(self._core)

    @property
    def space(self) -> str:
        """Coordinate system of the points, such as "left-posterior-superior"; "": unknown."""
        return self._core.space

    @property
    def wedges(self) -> np.ndarray:
        """(k, 6) uint32: cohesive elements without volume between the sides of parted interfaces. Corners 0, 1, 2 are
        on the first side, their normal points to the second; corner i + 3 has the position of corner i."""
        return self._core.wedges

    @property
    def parted(self) -> list[PartedInterface]:
        """Interfaces that the command parted; empty for a mesh that was only read."""
        return [PartedInterface(*parted) for parted in self._core.parted()]

    @property
    def point_fields(self) -> dict[str, np.ndarray]:
        """Fields of the points, by name: (n,) or (n, components) float64."""
        return self._core.point_fields()

    @property
    def fields(self) -> dict[str, np.ndarray]:
        """Fields of the tets, by name: (m,) or (m, components) float64."""
        return self._core.cell_fields()

    @property
    def midside_points(self) -> Optional[np.ndarray]:
        """(k, 3) float64, the midside nodes of the edges, with order=2; else None."""
        return self._core.midside_points

    @property
    def tets10(self) -> Optional[np.ndarray]:
        """(m, 10) int64, a copy: ten-node tets in VTK's order, with order=2; else None. Indices from len(points) on
        refer to midside_points."""
        midside = self._core.midside_of_tets
        if midside is None:
            return None
        return np.hstack([self.tets.astype(np.int64), midside.astype(np.int64) + len(self.points)])

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """All findings in the inputs and all shortfalls, with their codes; empty for a mesh that was only read."""
        return [Diagnostic(d["code"], d["severity"], d["message"], [tuple(p) for p in d["places"]],
                           *(d.get(key) for key in ("file", "asked", "reached", "limited_by")))
                for d in self.stats.get("diagnostics", [])]

    @property
    def stats(self) -> dict[str, Any]:
        """Contents of --stats (data/stats.schema.json); empty for a mesh that was only read."""
        if self._stats is None:
            self._stats = json.loads(self._core.stats) if self._core.stats else {}
        return self._stats

    @property
    def notes(self) -> list[str]:
        """Findings in the input, and the changes made because of them."""
        return self._core.notes

    @property
    def shortfall(self) -> list[str]:
        """Requests that were not met; empty if all were met."""
        return self._core.shortfall

    def write(self, path: str | os.PathLike, *, output_format: str = "", boundary: str | os.PathLike = "",
              no_boundary: bool = False, parts: int = 0) -> None:
        """Writes the mesh as the program does, completely or not at all. The extension or `output_format` determines
        the format; `boundary` is a file for the boundary and interfaces as a surface; `no_boundary` leaves triangles
        out of the mesh; `parts` divides it into so many parts for parallel solvers. With order=2 tets have ten nodes,
        which the format must support. Data that the format cannot hold or changes are listed in `notes`."""
        self._core.write(file_name(path, "path"), plain_text(output_format, "output_format"),
                         file_name(boundary, "boundary"), no_boundary, parts)

    def to_meshio(self):
        """Converts to a meshio.Mesh: tets (ten-node ones with order=2) with the cell data `material`, and triangles
        with `material` and `other_material`, those on their two sides (0: outside). A triangle has the fields of the
        tet on the side of `material`. `gmsh:physical` holds the materials of tets and the numbers of the input's
        patches, 0 for triangles in no patch; `field_data` holds their names (a patch with the name of a material gets
        a suffix), so that meshio writes both as physical groups. Cohesive elements (`wedges`) are left out."""
        import meshio
        tets10 = self.tets10
        points = self.points if tets10 is None else np.vstack([self.points, self.midside_points])
        cells = [("tetra", self.tets) if tets10 is None else ("tetra10", tets10)]
        data: dict[str, list[np.ndarray]] = {"material": [self.materials]}
        if len(self.interfaces) > 0:
            cells.append(("triangle", np.ascontiguousarray(self.interfaces.triangles)))
            data["material"].append(np.array(self.interfaces.material))
            data["other_material"] = [np.zeros(len(self.tets), np.int32), self.interfaces.other]
        groups, _, patch_names = self._core.interface_groups()
        data["gmsh:physical"] = [self.materials, np.where(np.isin(groups, list(patch_names)), groups, 0)][:len(cells)]
        names = {name: np.array([tag, 3]) for tag, name in self.material_names.items()}
        for number, name in patch_names.items():
            unique, suffix = name, 2
            while unique in names:
                unique, suffix = f"{name}_{suffix}", suffix + 1
            names[unique] = np.array([number, 2])
        for name, values in self.fields.items():
            data.setdefault(name, [values, values[self.interfaces.tets]][:len(cells)])
        return meshio.Mesh(points, cells, point_data=self._core.node_fields(), cell_data=data, field_data=names)

    def to_pyvista(self):
        """Converts to a pyvista.UnstructuredGrid of the tets, with the cell data `material` and all fields."""
        import pyvista
        grid = pyvista.UnstructuredGrid({pyvista.CellType.TETRA: self.tets.astype(np.int64)}, np.array(self.points))
        grid.cell_data["material"] = self.materials
        for name, values in self.fields.items():
            grid.cell_data[name] = values
        for name, values in self.point_fields.items():
            grid.point_data[name] = values
        return grid


class CheckResult(Mapping[str, Any]):
    """Contents of `check --json` as a mapping. True if the mesh passed: it is valid and, if requested, has the
    topology of `before` and is within the tolerance."""

    def __init__(self, json_text: str, notes: list[str], passed: bool):
        self._data = json.loads(json_text)
        self.notes = notes
        self.passed = passed

    def __bool__(self) -> bool:
        return self.passed

    def __getitem__(self, key: str) -> Any:
        return self._data[key]

    def __iter__(self):
        return iter(self._data)

    def __len__(self) -> int:
        return len(self._data)

    def __repr__(self) -> str:
        return f"<tetwright.CheckResult, {'passed' if self.passed else 'not passed'}: {self._data}>"
