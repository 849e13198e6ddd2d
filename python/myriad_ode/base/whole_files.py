# SPDX-License-Identifier: MIT
"""Files that are there whole or not at all."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator


@contextlib.contextmanager
def replacing(path: str) -> Iterator[str]:
    """A name beside a path to write to: what is written replaces the file of that path, or is removed if it fails."""
    path = os.path.realpath(path)
    ending = os.path.splitext(path)[1]  # by which some packages choose a format
    temporary = f"{path}.part-{os.getpid()}{ending}"
    try:
        yield temporary
        os.replace(temporary, path)
    finally:
        if os.path.exists(temporary):
            os.remove(temporary)
