# SPDX-License-Identifier: MIT
"""Files that are there whole or not at all."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator

from .errors import Error


@contextlib.contextmanager
def replacing(path: str) -> Iterator[str]:
    """A name beside a path to write to: what is written replaces the file of that path, or is removed if it fails.
    Raises `Error` if the path cannot be written to."""
    given, path = path, os.path.realpath(path)
    folder = os.path.dirname(path)
    if not os.path.isdir(folder):
        raise Error(f"'{given}' cannot be written: there is no folder '{folder}'")
    if os.path.isdir(path):
        raise Error(f"'{given}' is a folder: give the path of a file in it")
    ending = os.path.splitext(path)[1]  # by which some packages choose a format
    temporary = f"{path}.part-{os.getpid()}{ending}"
    try:
        yield temporary
        os.replace(temporary, path)
    except OSError as error:
        raise Error(f"'{given}' cannot be written: {error.strerror or error}") from error
    finally:
        if os.path.exists(temporary):
            os.remove(temporary)
