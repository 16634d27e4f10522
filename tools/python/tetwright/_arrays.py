# SPDX-License-Identifier: Apache-2.0
"""Turns a caller's numbers into arrays of the types that the compiled part reads; refuses what these would lose."""
from __future__ import annotations

from typing import Any

import numpy as np

from . import _core

# Doubles represent every whole number up to this one.
MAX_EXACT_WHOLE = 2**53


def numbers(values: Any, name: str, what: str, kinds: str = "iuf") -> np.ndarray:
    """An array of real numbers, of numpy's `kinds` of types; `name` is the input and `what` the part of it that
    messages name."""
    if values is None:
        raise _core.InputError(f"{name}: it has no {what}")
    if np.ma.is_masked(values):
        raise _core.InputError(f"{name}: {what} are masked at some places; give numbers there")
    try:
        array = np.asarray(values)
    except (ValueError, TypeError) as error:
        raise _core.InputError(f"{name}: {what} are no array ({error}); several surfaces are a list") from None
    if array.dtype.kind not in kinds:
        raise _core.InputError(f"{name}: {what} are of type {array.dtype}; give numbers")
    return array


def indices(values: Any, name: str, what: str) -> np.ndarray:
    """As int64, if they are whole."""
    array = numbers(values, name, what)
    if array.dtype.kind == "i":
        return array.astype(np.int64, copy=False)
    if array.dtype.kind == "u":
        bad = array > np.iinfo(np.int64).max
    else:
        with np.errstate(invalid="ignore"):
            bad = ~((np.abs(array) <= MAX_EXACT_WHOLE) & (np.floor(array) == array))
    _refuse(bad, array, name, what, "which is no number of a point")
    return array.astype(np.int64)


def whole_numbers(values: Any, name: str, what: str) -> np.ndarray:
    """As int32, if they are whole and that small."""
    array = numbers(values, name, what, "biuf")
    if array.dtype == bool:
        return array.astype(np.int32)
    limits = np.iinfo(np.int32)
    with np.errstate(invalid="ignore"):
        bad = ~((array >= limits.min) & (array <= limits.max))
        if array.dtype.kind == "f":
            bad |= np.floor(array) != array
    _refuse(bad, array, name, what, "which is not a whole number of 32 bits")
    return array.astype(np.int32)


def check_range(cells: np.ndarray, points: int, name: str, what: str) -> None:
    """Refuses cells that name a point which is not there."""
    bad = (cells < 0) | (cells >= points)
    _refuse(bad, cells, name, what, f"but there are {points} points, numbered from 0")


def _refuse(bad: np.ndarray, array: np.ndarray, name: str, what: str, why: str) -> None:
    if bad.any():
        at = tuple(int(i) for i in np.argwhere(bad)[0])
        raise _core.InputError(f"{name}: {what} hold {array[at]} at {at}, {why}")
