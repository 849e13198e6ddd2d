# SPDX-License-Identifier: MIT
"""Packages that not every installation has."""

from __future__ import annotations

import importlib
from typing import Any

from .errors import Error


def package(name: str, user: str) -> Any:
    """The package of a name, for `user`, as "to_xarray". Raises `Error` where it is not installed."""
    found = installed(name)
    if found is None:
        raise Error(f"{user} needs the package {name}: `pip install {name}`")
    return found


def installed(name: str) -> Any:
    """The package of a name, None where it is not installed."""
    try:
        return importlib.import_module(name)
    except ImportError:
        return None
