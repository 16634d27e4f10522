# SPDX-License-Identifier: Apache-2.0
"""Converts keyword arguments to arguments for the program's parser."""
from __future__ import annotations

import numbers
from typing import Any, Iterable

import numpy as np

from . import _core
from ._inputs import Inputs
from ._text import file_name, plain_text


def arguments_of(command: str, names: list[bytes], options: dict[str, Any], inputs: Inputs) -> list[bytes]:
    """Returns the arguments of a command with these positional inputs. Inputs among the options are added to
    `inputs`."""
    types = _core.option_types(command)
    arguments = [command.encode()]
    for key, value in options.items():
        if key in ("help", "version"):
            raise _core.UsageError("help and version are not options here; see help(tetwright)")
        option = plain_text("--" + key.replace("_", "-"), "an option")
        kind = types.get(option.decode())
        if kind is None:
            arguments.append(option)  # the parser suggests the nearest option
        elif kind == "" and value is not None:
            arguments += [option] if _flag(key, value) else []
        elif value is not None:
            arguments += [option + b"=" + text for text in _texts(key, kind, value, inputs)]
    return arguments + [b"--", *names]


def materials_of(value: Any, key: str = "material") -> list[tuple[str, Any]]:
    """Returns names and inputs of the option `material`, `sheet` or `partition`, given as a dict, a list of pairs, or strings NAME=FILE."""
    if value is None:
        return []
    if isinstance(value, list) and all(isinstance(v, tuple) and len(v) == 2 and isinstance(v[0], str) for v in value):
        return value
    if isinstance(value, dict):
        return [(str(k), v) for k, v in value.items()]
    if isinstance(value, str):
        value = [value]
    if not isinstance(value, list) or not all(isinstance(v, str) and "=" in v for v in value):
        what = "images" if key == "values" else "surfaces"
        raise _core.UsageError(f"{key} is a {type(value).__name__}; give a dict from names to {what}")
    return [tuple(v.split("=", 1)) for v in value]  # type: ignore[misc]


def images_of(value: Any, inputs: Inputs) -> list[bytes]:
    """Returns NAME=IMAGE for each image."""
    return [_name("values", name) + b"=" + inputs.add_image(item, name)
            for name, item in materials_of(value, "values")]


def _flag(key: str, value: Any) -> bool:
    if isinstance(value, (bool, np.bool_)) or (isinstance(value, (int, np.integer)) and value in (0, 1)):
        return bool(value)
    raise _core.UsageError(f"{key} is {value!r}; give True or False")


def _texts(key: str, kind: str, value: Any, inputs: Inputs) -> Iterable[bytes]:
    """Returns the values of an option; there may be several if the option can be repeated."""
    if key == "size_field":
        return [inputs.add_sizes(value)]
    if key in ("material", "sheet", "partition"):
        return [_name(key, name) + b"=" + inputs.add(item, name, made_up=False)
                for name, item in materials_of(value, key)]
    if key == "values":
        return images_of(value, inputs)
    if key == "values_mask":
        return [inputs.add_mask(value)]
    if key == "values_statistics" and isinstance(value, (list, tuple)):
        return [b",".join(plain_text(v, key) for v in value)]
    if key in ("bins", "modulus") and isinstance(value, dict):
        return [_name(key, str(name)) + b"=" + _numbers(key, item) for name, item in value.items()]
    if key == "layer" and isinstance(value, dict):
        return [_name(key, str(name)) + b"=" + _number(key, item) for name, item in value.items()]
    if key == "iso" and isinstance(value, dict):
        return [_name(key, str(name)) + b"=" + _number(key, item) for name, item in value.items()]
    if key in ("iso", "outside_probability", "smooth"):
        return [_number(key, item) for item in (value if isinstance(value, list) else [value])]
    if key in ("labels", "protect_labels") and not isinstance(value, str):
        return [_label_ranges(key, value)]
    if key in ("spacing", "dimensions") and not isinstance(value, str):
        return [b",".join(_number(key, item) for item in (value if np.ndim(value) == 1 else [value]))]
    if key == "layer" and not isinstance(value, (str, list)):
        raise _core.UsageError(f"layer is a {type(value).__name__}; give a dict from names to thicknesses")
    if key == "select" and isinstance(value, dict):
        return [_name(key, str(name)) + b"=" + plain_text(rule, key) for name, rule in value.items()]
    if key in ("split_interface", "cohesive") and isinstance(value, tuple):
        return [b",".join(plain_text(str(name), key) for name in value)]
    if key in ("split_interface", "cohesive") and isinstance(value, list):
        return [text for item in value for text in _texts(key, kind, item, inputs)]
    if key in ("layer", "region", "cap", "surface", "select") and isinstance(value, list):
        return [_text(key, "FILE" if key == "surface" else kind, item) for item in value]
    return [_text(key, kind, value)]


def _text(key: str, kind: str, value: Any) -> bytes:
    """Formats a value of a kind, as the program's help names it."""
    if kind in ("FILE", "DIR"):
        return file_name(value, key)
    if isinstance(value, str):
        return plain_text(value, key)
    if kind in ("N", "LABEL") or "CELLS" in kind:
        return _whole_number(key, value)
    if kind in ("NUMBER", "LENGTH") or "DEGREES" in kind:
        return _number(key, value)
    return plain_text(value, key)


def _name(key: str, name: str) -> bytes:
    if "=" in name or not name:
        raise _core.UsageError(f"{key}: nothing can be called '{name}'; give a name without =")
    return plain_text(name, key)


def _real(key: str, value: Any, what: str) -> Any:
    """Converts a number, which may be numpy's, to a Python number."""
    if isinstance(value, (np.generic, np.ndarray)) and np.ndim(value) == 0:
        value = value.item()
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise _core.UsageError(f"{key} is {value!r}; give {what}")
    try:
        float(value)
    except OverflowError:
        raise _core.UsageError(f"{key} is too large; give {what}") from None
    return value


def _whole_number(key: str, value: Any) -> bytes:
    """Formats a whole number, which may be a float. For other numbers the parser reports the allowed values."""
    real = _real(key, value, "a whole number")
    whole = isinstance(real, numbers.Integral) or float(real).is_integer()
    return (str(int(real)) if whole else repr(float(real))).encode()


def _number(key: str, value: Any) -> bytes:
    if isinstance(value, str):
        return plain_text(value, key)
    real = _real(key, value, "a number")
    return (str(int(real)) if isinstance(real, numbers.Integral) else repr(float(real))).encode()


def _numbers(key: str, value: Any) -> bytes:
    """Formats a whole number, or a list of numbers, whose decimal points distinguish a list of one."""
    if isinstance(value, (list, tuple, np.ndarray)):
        return b",".join(repr(float(_real(key, item, "numbers"))).encode() for item in value)
    return _number(key, value)


def _label_ranges(key: str, value: Any) -> bytes:
    """Formats labels, pairs of the first and last of several, and names, which `protect_labels` may have."""
    if isinstance(value, np.ndarray):
        value = np.atleast_1d(value).tolist()
    items = value if isinstance(value, (list, tuple, set, range)) else [value]
    if any(isinstance(i, tuple) and len(i) != 2 for i in items):
        raise _core.UsageError(f"{key} is {value!r}; give labels, and pairs of the first and last of several")
    return b",".join(plain_text(i, key) if isinstance(i, str) and key == "protect_labels" else
                     b"-".join(_whole_number(key, end) for end in i) if isinstance(i, tuple) else
                     _whole_number(key, i) for i in items)
