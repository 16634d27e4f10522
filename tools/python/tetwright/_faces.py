# SPDX-License-Identifier: Apache-2.0
"""Groups of faces in meshes of other libraries: given by the numbers in a field, as in files, or by named sets."""
from __future__ import annotations

import dataclasses
from typing import Any, Iterable, Iterator, Optional

import numpy as np

from . import _core
from ._text import plain_text

# Fields of faces that give groups in a tet mesh; in a surface many more names do.
GMSH_GROUPS = "gmsh:physical"
VTK_GROUPS = "surface"
FACE_GROUPS = (GMSH_GROUPS, "medit:ref", VTK_GROUPS)


@dataclasses.dataclass
class Block:
    """Cells of one kind."""
    kind: str
    cells: Any
    data: dict[str, Any]  # fields of the cells, by name
    sets: dict[str, Any] = dataclasses.field(default_factory=dict)  # members of named sets


def whole_labels(values: Any, count: int) -> Optional[np.ndarray]:
    """Returns the values as int64, or None unless they are one whole number for each cell."""
    if values is None or np.ma.is_masked(values):
        return None
    try:
        array = np.asarray(values)
    except (ValueError, TypeError):
        return None
    if array.dtype.kind not in "iu" or array.shape != (count,):
        return None
    if array.dtype.kind == "u" and (array > np.iinfo(np.int64).max).any():
        return None
    return array.astype(np.int64)


def text_labels(values: Any, count: int) -> Optional[np.ndarray]:
    """Returns the values as str, or None unless they are one text for each cell."""
    if values is None or np.ma.is_masked(values):
        return None
    try:
        array = np.asarray(values)
    except ValueError:  # rows of different lengths
        return None
    if array.shape != (count,):
        return None
    if array.dtype.kind == "S":
        return np.char.decode(array, "utf-8", "replace")
    if array.dtype.kind == "O" and all(isinstance(v, str) for v in array):
        return array.astype(str)
    return array if array.dtype.kind == "U" else None


def surface_groups(block: Block) -> tuple[Optional[str], Optional[np.ndarray], dict[int, bytes]]:
    """Returns the first field of a surface that gives the groups of its faces, the group number of each face (0:
    none), and the names of the groups."""
    count = len(block.cells)
    by_number = label_field([block], [])
    label = next((f for f, values in block.data.items() if f == by_number or text_labels(values, count) is not None),
                 None)
    if label is None or label == by_number:
        return label, None if label is None else whole_labels(block.data[label], count), {}
    texts, numbers = np.unique(text_labels(block.data[label], count), return_inverse=True)
    if len(texts) < 2:
        return label, None, {}
    first = 0 if texts[0] == "" else 1
    names = {n: plain_text(str(text), f"a name in the field '{label}'") for n, text in enumerate(texts, first)}
    names.pop(0, None)
    return label, numbers.astype(np.int64) + first, names


def label_field(faces: list[Block], tets: list[Block]) -> Optional[str]:
    """Returns the field that gives the groups of the faces: whole numbers, 0 for none; whole also in tets that have
    it."""
    def is_label(field: Any) -> bool:
        if field not in FACE_GROUPS and (tets or not _core.is_face_label(str(field).encode(errors="replace"))):
            return False
        return all(whole_labels(b.data.get(field), len(b.cells)) is not None
                   for b in faces + [t for t in tets if field in t.data])
    labels = [f for f in faces[0].data if is_label(f)] if faces else []
    return min(labels, key=lambda f: f != GMSH_GROUPS, default=None)


class Names:
    """Names of Gmsh's physical groups in meshio, by dimension and number, and other contents of its `field_data`."""

    def __init__(self, value: Any):
        self.of_groups: dict[tuple[int, int], Any] = {}
        self.others: list[Any] = []
        self.repeated: list[Any] = []
        of_gmsh = not hasattr(value, "celltypes")
        for name, data in (getattr(value, "field_data", None) or {}).items():
            array = np.asarray(data)
            if of_gmsh and array.dtype.kind in "iu" and array.size == 2:
                key = int(array.flat[1]), int(array.flat[0])
                if key in self.of_groups:  # a second name of a group
                    self.repeated.append(self.of_groups[key])
                self.of_groups[key] = name
            else:
                self.others.append(name)

    def take(self, dimension: int, numbers: Iterable[int]) -> dict[int, bytes]:
        """Removes the names of these groups and returns them by number."""
        found = {n: self.of_groups.pop((dimension, n)) for n in numbers if (dimension, n) in self.of_groups}
        return {n: plain_text(str(name), "the name of a physical group") for n, name in found.items()}


def sets_of_cells(value: Any) -> dict[Any, Any]:
    """Returns meshio's sets of cells with their members in each block. Sets that Gmsh adds only describe boundaries
    and are left out."""
    return {s: v for s, v in (getattr(value, "cell_sets", None) or {}).items() if not str(s).startswith("gmsh:")}


def members_of(block: Block, group: Any, name: str) -> np.ndarray:
    """Returns the numbers of the block's cells that are in the set."""
    values = np.asarray(block.sets[group])
    if values.dtype == bool and values.shape == (len(block.cells),):
        return np.flatnonzero(values)
    if values.dtype.kind not in "iu" or values.ndim != 1:
        raise _core.InputError(f"{name}: the set '{group}' has members of type {values.dtype} and shape "
                               f"{values.shape}; give the numbers of its cells")
    bad = (values < 0) | (values >= len(block.cells))
    if bad.any():
        raise _core.InputError(f"{name}: the set '{group}' refers to cell {values[bad][0]} of kind {block.kind}, but "
                               f"there are {len(block.cells)}, numbered from 0")
    return values.astype(np.int64)


def sets_of_faces(faces: list[Block], labels: list[np.ndarray], names: dict[int, bytes], name: str) \
        -> Iterator[tuple[int, str, list[np.ndarray]]]:
    """Yields a free number, the name and the members in each block for each set of faces. Smaller sets come first, so
    that a set of all faces does not take the faces of others."""
    members = {s: [members_of(b, s, name) if s in b.sets else np.empty(0, np.int64) for b in faces]
               for s in dict.fromkeys(s for b in faces for s in b.sets)}
    used = set(names).union(*(np.unique(of_block).tolist() for of_block in labels))
    number = 0
    for group in sorted(members, key=lambda s: sum(map(len, members[s]))):
        number += 1
        while number in used:
            number += 1
        yield number, str(group), members[group]


def are_faces(triangles: np.ndarray, tets: np.ndarray, points: int) -> np.ndarray:
    """Returns whether each triangle is a face of a tet. All indices must be in range."""
    marked = np.zeros(points, bool)
    marked[triangles] = True
    near = tets[marked[tets].sum(axis=1) >= 3]
    corners = np.sort(near[:, [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]].reshape(-1, 3), axis=1)
    known = set(map(tuple, corners.tolist()))
    return np.fromiter((tuple(t) in known for t in np.sort(triangles, axis=1).tolist()), bool, len(triangles))
