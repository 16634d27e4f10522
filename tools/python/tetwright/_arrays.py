# SPDX-License-Identifier: Apache-2.0
"""Converts a caller's numbers to arrays of the types that the compiled module reads; rejects values these cannot
hold."""
from __future__ import annotations

from typing import Any

import numpy as np

from . import _core

# Doubles represent every whole number up to this one exactly.
MAX_EXACT_WHOLE = 2**53


def numbers(values: Any, name: str, what: str, kinds: str = "iuf") -> np.ndarray:
    """Returns an array of real numbers whose type is one of numpy's `kinds`. Messages name the input, `name`, and the
    part of it, `what`."""
    if values is None:
        raise _core.InputError(f"{name}: it has no {what}")
    if np.ma.is_masked(values):
        raise _core.InputError(f"{name}: {what} are masked in part; give numbers there")
    try:
        array = np.asarray(values)
    except (ValueError, TypeError) as error:
        raise _core.InputError(f"{name}: {what} are not an array ({error}); several surfaces are a list") from None
    if array.dtype.kind not in kinds:
        raise _core.InputError(f"{name}: {what} are of type {array.dtype}; give numbers")
    return array


def indices(values: Any, name: str, what: str) -> np.ndarray:
    """Returns the values as int64; they must be whole."""
    array = numbers(values, name, what)
    if array.dtype.kind == "i":
        return array.astype(np.int64, copy=False)
    if array.dtype.kind == "u":
        bad = array > np.iinfo(np.int64).max
    else:
        with np.errstate(invalid="ignore"):
            bad = ~((np.abs(array) <= MAX_EXACT_WHOLE) & (np.floor(array) == array))
    _refuse(bad, array, name, what, "which is not the number of a point")
    return array.astype(np.int64)


def whole_numbers(values: Any, name: str, what: str, start: tuple[int, ...] = ()) -> np.ndarray:
    """Returns the values as int32; they must be whole and within its range. `start` is the index of the first one, if
    they are a part of an array."""
    array = numbers(values, name, what, "biuf")
    if array.dtype == bool:
        return array.astype(np.int32)
    limits = np.iinfo(np.int32)
    with np.errstate(invalid="ignore"):
        bad = ~((array >= limits.min) & (array <= limits.max))
        if array.dtype.kind == "f":
            bad |= np.floor(array) != array
    _refuse(bad, array, name, what, "which is not a whole number of 32 bits", start)
    return array.astype(np.int32)


def holds_whole_numbers(array: np.ndarray) -> bool:
    """Returns whether an array is one of labels: its type is that of whole numbers, or its floats are labels all the
    same."""
    if array.dtype.kind != "f":
        return True
    limits = np.iinfo(np.int32)
    with np.errstate(invalid="ignore"):
        return bool(((array >= limits.min) & (array <= limits.max) & (np.floor(array) == array)).all())


def image_values(values: Any, name: str) -> np.ndarray:
    """Returns the values of an image as floats of 32 bits; those beyond their range become infinite."""
    with np.errstate(over="ignore"):
        return numbers(values, name, "values of the image", "biuf").astype(np.float32)


def check_range(cells: np.ndarray, points: int, name: str, what: str) -> None:
    """Rejects cells that refer to a point which does not exist."""
    bad = (cells < 0) | (cells >= points)
    _refuse(bad, cells, name, what, f"but there are {points} points, numbered from 0")


def _refuse(bad: np.ndarray, array: np.ndarray, name: str, what: str, why: str, start: tuple[int, ...] = ()) -> None:
    if bad.any():
        at = tuple(int(i) for i in np.argwhere(bad)[0])
        whole = tuple(i + (start[axis] if start else 0) for axis, i in enumerate(at))
        raise _core.InputError(f"{name}: {what} hold {array[at]} at {whole}, {why}")
