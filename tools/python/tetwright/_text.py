# SPDX-License-Identifier: Apache-2.0
"""Text that the compiled part takes: bytes without NUL, since that would end them there."""
from __future__ import annotations

import os
from typing import Any

from . import _core


def file_name(value: Any, what: str) -> bytes:
    """As the system knows it, which may not be UTF-8; `what` is what messages call it."""
    if not isinstance(value, (str, bytes, os.PathLike)):
        raise _core.UsageError(f"{what} is a {type(value).__name__}; give the name of a file")
    name = os.fspath(value)
    try:
        return _without_nul(os.fsencode(name), name, what)
    except UnicodeEncodeError:
        raise _core.UsageError(f"{what}: {ascii(name)} holds a part of a character; give whole ones") from None


def plain_text(value: Any, what: str) -> bytes:
    """Of a name that is not a file's, or of a word."""
    if not isinstance(value, str):
        raise _core.UsageError(f"{what} is a {type(value).__name__}; give text")
    try:
        return _without_nul(value.encode(), value, what)
    except UnicodeEncodeError:
        raise _core.UsageError(f"{what}: {ascii(value)} holds a part of a character; give whole ones") from None


def _without_nul(text: bytes, value: Any, what: str) -> bytes:
    if b"\0" in text:
        raise _core.UsageError(f"{what}: {value!r} holds a NUL character; leave it out")
    return text
