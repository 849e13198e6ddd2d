# SPDX-License-Identifier: MIT
"""Files of saved runs: NumPy's .npz, a zip archive of arrays, with a header in JSON. Nothing in one is executed when it
is read, and `numpy.load` opens them too."""

from __future__ import annotations

import json
import math
import zipfile
import zlib
from typing import Any

import numpy as np
from numpy.lib import format as npy

from .. import _core
from ..base.errors import Error
from ..base.whole_files import replacing
from .saved import Saved

_what = "a run of Myriad"
_version = 1  # of the format: a file with a higher one is not read
_header = "header.json"
#: what reading a file with something wrong in it may raise
damages = (zipfile.BadZipFile, zlib.error, EOFError, ValueError, KeyError, TypeError, AttributeError, IndexError,
            RuntimeError, OverflowError, Error)


def write(path: str, run: Saved) -> None:
    """Writes a file, which replaces one of that name when it is whole."""
    header = json.dumps({"what": _what, "format": _version, **run.header}, indent=1)
    with replacing(path) as temporary, zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as file:
        file.writestr(_header, header)
        for name, array in run.arrays.items():
            with file.open(f"{name}.npy", "w", force_zip64=True) as member:
                npy.write_array(member, array, version=(1, 0), allow_pickle=False)


def damaged(path: str, why: object) -> Error:
    """The error of a file with something wrong in it."""
    return Error(f"{path!r} is damaged or was cut off ({why}): use another copy, or integrate again")


def read(path: str) -> Saved:
    """What lasts of a run, from its file."""
    try:
        with open(path, "rb") as opened:
            is_zip = opened.read(4) == b"PK\3\4"
            if not is_zip:
                raise _no_run(path)
            opened.seek(0)
            with zipfile.ZipFile(opened) as file:
                if _header not in file.namelist():
                    raise _no_run(path)
                return _content(path, file)
    except OSError as error:
        raise Error(f"{path!r} cannot be read: {error.strerror or error}") from None
    except _NoRun as error:
        raise Error(str(error)) from None
    except damages as error:
        raise damaged(path, error) from None


class _NoRun(Exception):
    """The file is whole, but none that can be read."""


def _no_run(path: str) -> _NoRun:
    return _NoRun(f"{path!r} is no file that run.save(path) has written: my.open_study reads the store of a study, and "
                  "xarray.open_dataset netCDF")


def _content(path: str, file: zipfile.ZipFile) -> Saved:
    header = json.loads(file.read(_header))
    if not isinstance(header, dict) or header.get("what") != _what:
        raise _no_run(path)
    if header["format"] > _version:
        raise _NoRun(f"{path!r} was written by Myriad {header.get('myriad_version', '')}, whose files Myriad "
                     f"{_core.version} does not know yet: install a newer version")
    names = [name for name in file.namelist() if name != _header]
    return Saved(header, {name.removesuffix(".npy"): _array(file, name) for name in names})


def _array(file: zipfile.ZipFile, name: str) -> Any:
    """An array of numbers. Memory is taken for as many bytes as the archive has, whatever the array says it is."""
    size = file.getinfo(name).file_size
    with file.open(name) as member:
        if npy.read_magic(member) != (1, 0):
            raise ValueError(f"{name} is of another version")
        shape, by_columns, dtype = npy.read_array_header_1_0(member)
        if dtype.kind not in "biuf":
            raise ValueError(f"{name} is no array of numbers")
        if math.prod(shape) * dtype.itemsize + member.tell() != size:
            raise ValueError(f"{name} has another size than its shape says")
        content = member.read()
    array = np.frombuffer(bytearray(content), dtype)
    return array.reshape(shape[::-1]).T if by_columns else array.reshape(shape)
