# SPDX-License-Identifier: Apache-2.0
"""Converts a caller's inputs to those that the compiled module reads: arrays with names, or names of files."""
from __future__ import annotations

import os
from typing import Any, Iterable, Optional

import numpy as np

from . import _core
from ._arrays import indices, numbers, whole_numbers
from ._cells import Cells, cells_of, field_items, note_large_integers, size_field
from ._mesh import TetMesh
from ._text import file_name, plain_text
from ._voxels import Memory, Voxels, is_blocked_array

# Names of point data that give edge lengths.
SIZE_FIELDS = ("size", "sizing", "edge_length", "h")


def is_file(value: Any) -> bool:
    """Returns whether the value is the name of a file."""
    return isinstance(value, (str, bytes, os.PathLike))


class Inputs:
    """Collects the inputs of one call. Each has a unique name: that of its file, or a generated or given one."""

    def __init__(self, spacing: Any = None, origin: Any = None, affine: Any = None, memory_limit: Any = None):
        self.core = _core.Inputs()
        # A limit that makes no sense is refused with the other options.
        limited = isinstance(memory_limit, (int, float)) and memory_limit > 0
        self._memory = Memory(float(memory_limit) if limited else 0)
        self._placement = (spacing, origin, affine)
        self._placement_used = False
        self._taken: set[bytes] = set()
        self._objects: set[bytes] = set()
        self._files: set[bytes] = set()

    def reserve(self, names: Iterable[str]) -> None:
        """Prevents names given by the caller from being generated for other inputs."""
        self._taken.update(n.encode(errors="replace") for n in names)

    def add(self, value: Any, name: str, made_up: bool = True) -> bytes:
        """Adds an input and returns its name in the call: the name of a file, or else `name`. If that is generated
        and taken, it gets a suffix."""
        if is_file(value):
            file = file_name(value, name)
            self._files.add(file)
            return file
        key = self._unique(name) if made_up else self._given(name)
        self._objects.add(key)
        if isinstance(value, TetMesh):
            self.core.add_own_mesh(key, value._core)
        elif _holds_voxels(value):
            voxels = self._placed_voxels(value, name).labels_or_image()
            (self.core.add_volume if isinstance(voxels, _core.Labels) else self.core.add_image)(key, voxels)
        else:
            self._add_cells(key, name, cells_of(value, name))
        return key

    def add_sizes(self, value: Any) -> bytes:
        """Adds edge lengths by location and returns their name: a file, (points, tets, lengths) or (points, triangles,
        lengths), or a mesh of meshio or pyvista whose points have lengths."""
        name = "size_field"
        if is_file(value):
            return file_name(value, name)
        if isinstance(value, (tuple, list)) and len(value) == 3 and not any(is_file(v) for v in value):
            points = numbers(value[0], name, "points")
            cells, lengths = indices(value[1], name, "cells"), numbers(value[2], name, "lengths")
        else:
            made = cells_of(value, name)
            points, cells = made.points, made.triangles if made.tets is None else made.tets
            found = size_field(made, SIZE_FIELDS)
            if found is None:
                raise _core.InputError(f"{name}: its points have no field {', '.join(SIZE_FIELDS)}; give "
                                       "(points, tets, lengths)")
            lengths = found
        if cells.ndim != 2 or cells.shape[1] not in (3, 4):
            raise _core.InputError(f"{name}: cells have the shape {cells.shape}; give tets (m, 4) or triangles (m, 3)")
        self.core.add_sizes(name.encode(), points, cells, lengths)
        return name.encode()

    def spacing_of_files(self) -> Any:
        """Returns the spacing if it is that of a volume in a file, as there is no array of voxels; else None."""
        spacing, origin, affine = self._placement
        if self._placement_used or not self._files or origin is not None or affine is not None:
            return None
        self._placement_used = spacing is not None
        return spacing

    def add_image(self, value: Any, name: str) -> bytes:
        """Adds an image and returns its name: a file, an array of values of three axes (of numpy, zarr, h5py, dask or
        alike), or an image of nibabel."""
        if is_file(value):
            return file_name(value, name)
        key = self._unique("image " + name)
        voxels = self._placed_voxels(value, name)
        self._objects.add(key)
        self.core.add_values_image(key, voxels.image())
        return key

    def add_mask(self, value: Any) -> bytes:
        """Adds a mask likewise; the text "labels" stays as it is."""
        if is_file(value):
            return file_name(value, "values_mask")
        key = self._unique("values_mask")
        voxels = self._placed_voxels(value, "values_mask")
        self._objects.add(key)
        self.core.add_mask(key, voxels.labels())
        return key

    def finish(self) -> None:
        """Rejects positions of voxels if there are no voxels, and files that have the name of an array."""
        if any(p is not None for p in self._placement) and not self._placement_used:
            raise _core.UsageError("spacing, origin and affine are for arrays of voxels, and no input is one")
        for name in sorted(self._files & self._objects):
            raise _core.UsageError(f"'{os.fsdecode(name)}' is the name of a file and of an array; call the array "
                                   "something else")

    def _unique(self, name: str) -> bytes:
        unique, number = name, 2
        while unique.encode() in self._objects | self._taken:
            unique, number = f"{name}_{number}", number + 1
        return unique.encode()

    def _given(self, name: str) -> bytes:
        key = plain_text(name, "the name of an input")
        # The parser interprets - as a stream, and [a,b] as two arguments.
        if key in (b"", b"-") or (key.startswith(b"[") and key.endswith(b"]")):
            raise _core.UsageError(f"an input cannot be called '{name}'; give it another name")
        if key in self._objects:
            raise _core.UsageError(f"two inputs are called '{name}'; give each a name of its own")
        return key

    def _add_cells(self, key: bytes, name: str, cells: Cells) -> None:
        if cells.tets is None:
            cells.drop_names("fields of points", cells.point_fields)
            self.core.add_surface(key, cells.points, cells.grouped_triangles(), cells.dropped)
            return
        note_large_integers(cells)
        tags = None if cells.materials is None else whole_numbers(cells.materials, name, "materials")
        self.core.add_mesh(key, cells.points, cells.tets, tags, cells.names, field_items(cells.point_fields),
                           field_items(cells.cell_fields), cells.dropped, cells.grouped_triangles())

    def _placed_voxels(self, value: Any, name: str) -> Voxels:
        """Returns an array of voxels at its position."""
        if hasattr(value, "affine") and hasattr(value, "dataobj"):  # nibabel
            return Voxels(np.asanyarray(value.dataobj), name, self._matrix(value.affine), self._memory)
        if isinstance(value, np.ndarray) or is_blocked_array(value):
            return Voxels(value, name, self._matrix(None), self._memory)
        raise _core.UsageError(f"{name} is a {type(value).__name__}; give a file, an array, or an image of nibabel")

    def _matrix(self, own_affine: Optional[np.ndarray]) -> np.ndarray:
        """Returns the matrix that maps indices of voxels to positions."""
        spacing, origin, affine = self._placement
        self._placement_used = True
        if affine is not None and (spacing is not None or origin is not None):
            raise _core.UsageError("affine includes spacing and origin; give either affine or these")
        matrix = np.eye(4)
        if affine is not None or (own_affine is not None and spacing is None and origin is None):
            matrix = _placed("affine", affine if affine is not None else own_affine)
            if matrix.shape != (4, 4):
                raise _core.UsageError(f"affine has the shape {matrix.shape}; give a matrix of (4, 4)")
        else:
            matrix[:3, :3] = np.diag(_three("spacing", 1 if spacing is None else spacing))
            matrix[:3, 3] = _three("origin", 0 if origin is None else origin)
        return matrix


def _holds_voxels(value: Any) -> bool:
    return (isinstance(value, np.ndarray) and value.ndim in (3, 4)) or \
        (hasattr(value, "affine") and hasattr(value, "dataobj")) or is_blocked_array(value)


def _placed(option: str, value: Any) -> np.ndarray:
    try:
        return np.asarray(value, float)
    except (ValueError, TypeError):
        raise _core.UsageError(f"{option} is not an array of numbers, but {value!r}") from None


def _three(option: str, value: Any) -> np.ndarray:
    array = _placed(option, value)
    if array.shape not in ((), (1,), (3,)):
        raise _core.UsageError(f"{option} has the shape {array.shape}; give one number, or one for each of three axes")
    return np.broadcast_to(array, 3)
