# SPDX-License-Identifier: Apache-2.0
"""Text for the compiled module: bytes without NUL, which would end the text there."""
from __future__ import annotations

import os
from typing import Any

from . import _core


def file_name(value: Any, what: str) -> bytes:
    """Returns a file name in the system's encoding, which may not be UTF-8. Messages refer to it as `what`."""
    if not isinstance(value, (str, bytes, os.PathLike)):
        raise _core.UsageError(f"{what} is a {type(value).__name__}; give the name of a file")
    name = os.fspath(value)
    try:
        return _without_nul(os.fsencode(name), name, what)
    except UnicodeEncodeError:
        raise _core.UsageError(f"{what}: {ascii(name)} holds an incomplete character; give complete ones") from None


def plain_text(value: Any, what: str) -> bytes:
    """Encodes a word, or a name other than a file's."""
    if not isinstance(value, str):
        raise _core.UsageError(f"{what} is a {type(value).__name__}; give text")
    try:
        return _without_nul(value.encode(), value, what)
    except UnicodeEncodeError:
        raise _core.UsageError(f"{what}: {ascii(value)} holds an incomplete character; give complete ones") from None


def _without_nul(text: bytes, value: Any, what: str) -> bytes:
    if b"\0" in text:
        raise _core.UsageError(f"{what}: {value!r} holds a NUL character; leave it out")
    return text
