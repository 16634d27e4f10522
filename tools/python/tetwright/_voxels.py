# SPDX-License-Identifier: Apache-2.0
"""Reads arrays of voxels block by block: numpy's, and those that read or compute their values when they are asked for,
such as those of zarr, h5py and dask."""
from __future__ import annotations

import itertools
import math
from typing import Any, Iterator, Optional, Union

import numpy as np

from . import _core
from ._arrays import holds_whole_numbers, image_values, numbers, whole_numbers

# Bytes of a block, unless a chunk of the array has more.
BLOCK_BYTES = 1 << 24

Start = tuple[int, int, int]


def is_blocked_array(value: Any) -> bool:
    """Returns whether a value is an array of voxels that is no numpy array: it has a shape of three or four axes and
    a type, and parts of it can be read."""
    shape = getattr(value, "shape", None)
    return isinstance(shape, tuple) and len(shape) in (3, 4) and hasattr(value, "dtype") and \
        hasattr(value, "__getitem__") and not isinstance(value, np.ndarray)


class Voxels:
    """An array of voxels of shape (nx, ny, nz) or (nx, ny, nz, channels), named `name` in messages."""

    def __init__(self, array: Any, name: str, matrix: np.ndarray, used: "Memory"):
        self._array, self._name, self._memory = array, name, used
        self._size = tuple(int(n) for n in array.shape)
        self._place = (matrix[:3, 3].tolist(), matrix[:3, :3].tolist())

    def labels(self, what: str = "labels") -> _core.Labels:
        """Returns the voxels as labels; they must be whole numbers."""
        self._memory.take(f"the {what} of {self._name}", 4.0 * math.prod(self._size))
        filled = _core.Labels(self._name, self._shape(), *self._place)
        for start, block in self._blocks():
            filled.put(start, whole_numbers(block, self._name, what, start))
        return filled

    def image(self) -> _core.Image:
        """Returns the voxels as values of an image."""
        filled = self._fill_image(False)
        assert filled is not None
        return filled

    def labels_or_image(self) -> Union[_core.Labels, _core.Image]:
        """Returns labels if all voxels are whole numbers that labels can be, otherwise an image."""
        if len(self._shape()) != 3:
            return self.image()
        # A type of whole numbers, or floats that are labels all the same; these are read a second time.
        first = next(self._blocks(1), None)
        if first is None or numbers(first[1], self._name, "labels", "biuf").dtype.kind != "f":
            return self.labels()
        return self._fill_image(True) or self.labels()

    def _fill_image(self, unless_labels: bool) -> Optional[_core.Image]:
        """Returns the image, or None if `unless_labels` and all its values are whole."""
        size = 4.0 * math.prod(self._size)
        self._memory.take(f"the values of {self._name}", size)
        filled = _core.Image(self._name, self._shape(), *self._place)
        whole = unless_labels
        for start, block in self._blocks():
            values = numbers(block, self._name, "values of the image", "biuf")
            whole = whole and holds_whole_numbers(values)
            filled.put(start, image_values(values, self._name).reshape(*values.shape[:3], -1))
        if whole:
            self._memory.give_back(size)
            return None
        return filled

    def _shape(self) -> list[int]:
        return list(self._size[:3] if len(self._size) == 4 and self._size[3] == 1 else self._size)

    def _blocks(self, voxels: Optional[int] = None) -> Iterator[tuple[Start, Any]]:
        """Yields blocks with the index of their first voxel. With `voxels`, blocks of so many along each axis."""
        if 0 in self._size:
            return
        sides = (voxels,) * 3 if voxels else self._sides()
        for corner in itertools.product(*(range(0, n, side) for n, side in zip(self._size, sides))):
            part = self._array[tuple(slice(at, min(at + side, n))
                                     for at, side, n in zip(corner, sides, self._size))]
            if len(self._size) == 4 and len(self._shape()) == 3:
                part = part[..., 0]
            yield corner, part

    def _sides(self) -> tuple[int, ...]:
        """Returns the size of blocks along the axes: whole chunks, joined while they are small."""
        size = self._size[:3]
        sides = [min(side, n) for side, n in zip(self._chunk() or (1, 1, 1), size)]
        try:
            each = np.dtype(self._array.dtype).itemsize
        except TypeError:  # a type that is not numpy's
            each = 8
        each *= self._size[3] if len(self._size) == 4 else 1
        # Contiguous parts first: the last axis varies fastest, unless numpy says otherwise.
        order = (2, 1, 0)
        if isinstance(self._array, np.ndarray) and abs(self._array.strides[0]) < abs(self._array.strides[2]):
            order = (0, 1, 2)
        for axis in order:
            more = BLOCK_BYTES // max(1, math.prod(sides) * each)
            if more < 2:
                break
            sides[axis] = min(size[axis], sides[axis] * more)
        return tuple(sides)

    def _chunk(self) -> Optional[tuple[int, ...]]:
        """Returns the size of the array's chunks, if it has them. Those of dask may differ; the largest counts."""
        chunks = getattr(self._array, "chunks", None)
        if not isinstance(chunks, (tuple, list)) or len(chunks) != len(self._size):
            return None
        return tuple(max(1, int(max(c) if isinstance(c, (tuple, list)) else c)) for c in chunks[:3])


class Memory:
    """The memory of the arrays of a call, bytes."""

    def __init__(self, limit: float = 0):
        self._limit = limit  # gigabytes; 0: that of the machine
        self._held = 0.0

    def take(self, what: str, size: float) -> None:
        """Raises OutputError if so much more is not available."""
        _core.require_memory(what, size, self._held, self._limit)
        self._held += size

    def give_back(self, size: float) -> None:
        self._held -= size
