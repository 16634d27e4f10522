# SPDX-License-Identifier: Apache-2.0
"""Points carried by a tet mesh."""
from __future__ import annotations

import dataclasses
import json
from typing import Any

import numpy as np

from . import _core
from ._arrays import numbers


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Embedding:
    """Weights by which a tet mesh carries the n points of a surface. All numbers count from 0."""
    tets: np.ndarray  # (n,) int64: the tet that contains the point or is nearest to it
    nodes: np.ndarray  # (n, 4) int64: the points of this tet
    weights: np.ndarray  # (n, 4) float64: of these points; from 0 to 1, with sum 1
    distances: np.ndarray  # (n,) float64: of the point from the mesh, input units; 0 inside
    notes: list[str]  # contents of the inputs that are not kept, and points outside the mesh
    stats: dict[str, Any]  # the contents of --stats

    def __len__(self) -> int:
        return len(self.tets)

    def __repr__(self) -> str:
        found = self.stats["embedding"]
        return f"<tetwright.Embedding: {len(self)} points in {found['tets']} tets, {found['outside']} outside>"

    def carry(self, points_of_mesh: Any) -> np.ndarray:
        """Returns the points of the surface where the mesh has moved to these points. Instead of positions, shape
        (m, 3), it may be any values at the points of the mesh, shape (m,) or (m, k): displacements, temperatures."""
        values = numbers(points_of_mesh, "carry", "points_of_mesh")
        most = int(self.nodes.max(initial=-1))
        if values.ndim not in (1, 2) or len(values) <= most:
            raise _core.InputError(f"carry: points_of_mesh has the shape {values.shape}; give a row for each point of the "
                                   f"mesh, which has {most + 1} or more")
        return np.einsum("nk,nk...->n...", self.weights, values[self.nodes])


def embedding_of(arrays: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray], notes: list[str], stats: str) -> Embedding:
    """Returns what the compiled module found."""
    return Embedding(*arrays, notes, json.loads(stats))
