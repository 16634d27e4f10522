"""Turns what a caller has into what the compiled part reads: arrays by name, or names of files."""
from __future__ import annotations

import os
import tempfile
from typing import Any, Optional, Sequence

import numpy as np

from . import _core
from ._mesh import TetMesh

# VTK's numbers of cell types.
VTK_TRIANGLE, VTK_TETRA = 5, 10
# Cell data that tell materials, as the program reads them from files.
MATERIAL_FIELDS = ("material", "medit:ref", "gmsh:physical", "MaterialID", "attribute")
# Point data that tell edge lengths.
SIZE_FIELDS = ("size", "sizing", "edge_length", "h")


class Inputs:
    """Collects the inputs of one call. Each gets a name, that of a file or one of its own."""

    def __init__(self, spacing: Any = None, origin: Any = None, affine: Any = None):
        self.core = _core.Inputs()
        self._placement = (spacing, origin, affine)
        self._placement_used = False
        self._folder: Optional[tempfile.TemporaryDirectory[str]] = None

    def add(self, value: Any, name: str) -> str:
        """The name that stands for `value` in the call."""
        if isinstance(value, (str, os.PathLike)):
            return os.fspath(value)
        if isinstance(value, TetMesh):
            self.core.add_own_mesh(name, value._core)
        elif isinstance(value, np.ndarray) and value.ndim == 3:
            self._add_volume(name, value, None)
        elif hasattr(value, "affine") and hasattr(value, "dataobj"):  # nibabel
            self._add_volume(name, np.asanyarray(value.dataobj), value.affine)
        else:
            self._add_cells(name, *_cells_of(value, name))
        return name

    def add_sizes(self, value: Any) -> str:
        """The name of a file with edge lengths by place: (points, tets, lengths) or (points, triangles, lengths), or a
        mesh of meshio or pyvista whose points have them."""
        if isinstance(value, (str, os.PathLike)):
            return os.fspath(value)
        if isinstance(value, (tuple, list)) and len(value) == 3:
            points, cells, lengths = (np.asarray(v) for v in value)
        else:
            points, triangles, tets, _, _ = _cells_of(value, "size_field")
            cells = np.asarray(triangles if tets is None else tets)
            fields = getattr(value, "point_data", {})
            name = next((f for f in SIZE_FIELDS if f in fields), None)
            if name is None:
                raise _core.InputError(f"size_field: its points have no field {', '.join(SIZE_FIELDS)}; give "
                                       "(points, tets, lengths)")
            points, lengths = np.asarray(points), np.asarray(fields[name])
        if self._folder is None:
            self._folder = tempfile.TemporaryDirectory(prefix="tetwright-")
        path = os.path.join(self._folder.name, "size_field.vtk")
        _write_sizes(path, points, cells, lengths)
        return path

    def finish(self) -> None:
        """Refuses what says where voxels are if there are none."""
        if any(p is not None for p in self._placement) and not self._placement_used:
            raise _core.UsageError("spacing, origin and affine are for arrays of labels, and no input is one")

    def _add_cells(self, name: str, points: Any, triangles: Any, tets: Any, materials: Any,
                   names: dict[int, str]) -> None:
        if tets is not None:
            tags = None if materials is None else _whole_numbers(materials, name, "materials")
            self.core.add_mesh(name, points, tets, tags, names)
        else:
            self.core.add_surface(name, points, triangles)

    def _add_volume(self, name: str, labels: np.ndarray, own_affine: Optional[np.ndarray]) -> None:
        spacing, origin, affine = self._placement
        self._placement_used = True
        if affine is not None and (spacing is not None or origin is not None):
            raise _core.UsageError("affine says what spacing and origin do; give it, or these")
        matrix = np.eye(4)
        if affine is not None or (own_affine is not None and spacing is None and origin is None):
            matrix = np.asarray(affine if affine is not None else own_affine, float)
            if matrix.shape != (4, 4):
                raise _core.UsageError(f"affine has the shape {matrix.shape}; give a matrix of (4, 4)")
        else:
            matrix[:3, :3] = np.diag(np.broadcast_to(np.asarray(1 if spacing is None else spacing, float), 3))
            matrix[:3, 3] = 0 if origin is None else origin
        labels = np.asarray(labels)
        if labels.ndim == 4 and labels.shape[3] == 1:
            labels = labels[..., 0]
        self.core.add_volume(name, _whole_numbers(labels, name, "labels"), matrix[:3, 3].tolist(),
                             matrix[:3, :3].tolist())


def _write_sizes(path: str, points: np.ndarray, cells: np.ndarray, lengths: np.ndarray) -> None:
    """As the field "size" of the points in a binary file of legacy VTK."""
    if points.ndim != 2 or points.shape[1] != 3:
        raise _core.InputError(f"size_field: points have the shape {points.shape}; give (n, 3)")
    if cells.ndim != 2 or cells.shape[1] not in (3, 4):
        raise _core.InputError(f"size_field: cells have the shape {cells.shape}; give tets (m, 4) or triangles (m, 3)")
    if lengths.shape != (len(points),):
        raise _core.InputError(f"size_field: lengths have the shape {lengths.shape}; give one for each of the "
                               f"{len(points)} points")
    if cells.size and (cells.min() < 0 or cells.max() >= len(points)):
        raise _core.InputError(f"size_field: a cell names point {cells.max()}, and there are {len(points)}")
    corners = cells.shape[1]
    rows = np.column_stack([np.full(len(cells), corners), cells]).astype(">i4")
    kind = VTK_TRIANGLE if corners == 3 else VTK_TETRA
    with open(path, "wb") as file:
        file.write(b"# vtk DataFile Version 3.0\nedge lengths\nBINARY\nDATASET UNSTRUCTURED_GRID\n")
        file.write(b"POINTS %d double\n" % len(points) + points.astype(">f8").tobytes())
        file.write(b"\nCELLS %d %d\n" % (len(cells), rows.size) + rows.tobytes())
        file.write(b"\nCELL_TYPES %d\n" % len(cells) + np.full(len(cells), kind, ">i4").tobytes())
        file.write(b"\nPOINT_DATA %d\nSCALARS size double 1\nLOOKUP_TABLE default\n" % len(points))
        file.write(lengths.astype(">f8").tobytes() + b"\n")


def _whole_numbers(values: Any, name: str, what: str) -> np.ndarray:
    """As int32, if they are whole and that small."""
    values = np.asarray(values)
    if values.dtype == bool:
        return values.astype(np.int32)
    if not np.issubdtype(values.dtype, np.number) or np.iscomplexobj(values):
        raise _core.InputError(f"{name}: {what} are of type {values.dtype}; give whole numbers")
    limits = np.iinfo(np.int32)
    with np.errstate(invalid="ignore"):
        bad = ~((values >= limits.min) & (values <= limits.max) & (np.floor(values) == values))
    if bad.any():
        at = tuple(int(i) for i in np.argwhere(bad)[0])
        raise _core.InputError(f"{name}: {what} hold {values[at]} at {at}, which is not a whole number of 32 bits")
    return values.astype(np.int32)


def _cells_of(value: Any, name: str) -> tuple[Any, Any, Any, Any, dict[int, str]]:
    """Points, triangles or tets, materials and their names."""
    if isinstance(value, (tuple, list)) and 2 <= len(value) <= 3:
        points, cells = np.asarray(value[0]), np.asarray(value[1])
        if cells.ndim == 2 and cells.shape[1] == 4:
            return points, None, cells, value[2] if len(value) == 3 else None, {}
        if len(value) == 3:
            raise _core.InputError(f"{name}: the second of three arrays has the shape {cells.shape}; with materials "
                                   "give (points, tets, materials)")
        return points, cells, None, None, {}
    if hasattr(value, "vertices") and hasattr(value, "faces"):  # trimesh
        return value.vertices, value.faces, None, None, {}
    points = getattr(value, "points", None)
    if points is not None and hasattr(value, "cells_dict"):  # meshio, and pyvista's unstructured grids
        return _of_cell_types(value, name, points)
    if points is not None and hasattr(value, "faces"):  # pyvista's surfaces
        return points, _triangles_of_faces(np.asarray(value.faces), name), None, None, {}
    raise _core.InputError(f"{name} is a {type(value).__name__}; give a file name, (points, triangles), (points, tets), "
                           "an array of labels, or a mesh of meshio, pyvista or trimesh")


def _of_cell_types(value: Any, name: str, points: Any) -> tuple[Any, Any, Any, Any, dict[int, str]]:
    cells = value.cells_dict
    tets = next((cells[k] for k in ("tetra", VTK_TETRA) if k in cells), None)
    triangles = next((cells[k] for k in ("triangle", VTK_TRIANGLE) if k in cells), None)
    if tets is None:
        if triangles is None:
            raise _core.InputError(f"{name} has cells of {', '.join(map(str, cells)) or 'no kind'}; give triangles or "
                                   "tets")
        return points, triangles, None, None, {}
    materials = None
    by_type = getattr(value, "cell_data_dict", None)
    if by_type is not None:  # meshio
        materials = next((by_type[f]["tetra"] for f in MATERIAL_FIELDS if "tetra" in by_type.get(f, {})), None)
    elif getattr(value, "n_cells", None) == len(tets):  # pyvista
        materials = next((value.cell_data[f] for f in MATERIAL_FIELDS if f in value.cell_data), None)
    names = {}
    for group, data in (getattr(value, "field_data", None) or {}).items():
        data = np.atleast_1d(data)
        if data.size == 2 and data[1] == 3:  # Gmsh's physical volumes in meshio
            names[int(data[0])] = str(group)
    return points, None, tets, materials, names


def _triangles_of_faces(faces: np.ndarray, name: str) -> np.ndarray:
    """Of VTK's list: each face's number of points, then these. Polygons become fans, as from files."""
    if faces.ndim == 2:
        return faces
    triangles: list[Sequence[int]] = []
    if faces.size % 4 == 0 and (faces[::4] == 3).all():
        return faces.reshape(-1, 4)[:, 1:]
    at = 0
    while at < faces.size:
        count = int(faces[at])
        corners = faces[at + 1:at + 1 + count]
        if count < 3 or len(corners) < count:
            raise _core.InputError(f"{name}: a face at {at} has {count} points; give polygons of 3 or more")
        triangles.extend((corners[0], corners[k], corners[k + 1]) for k in range(1, count - 1))
        at += 1 + count
    return np.asarray(triangles).reshape(-1, 3)
