# SPDX-License-Identifier: MIT
"""The library's headers in the compiler's own form, which halves the time that a model takes to compile. They are made
once for a compiler and its flags, beside the program's own work, after its first model was compiled."""

import contextlib
import os
import pathlib
import stat
import subprocess
import tempfile
import threading

from . import cache

HEADER = "myriad/python/kernel_library.hpp"
_suffixes = {"clang++": ".pch", "g++": ".hpp.gch"}  # zig has none
_begun: set = set()


def _path(key, by):
    return cache.directory() / f"{key}{_suffixes[by.kind]}"


def _is_ours(path):
    """Whether a file is there that nobody else can have written."""
    try:
        facts = os.stat(path)
    except OSError:
        return False
    return facts.st_uid in (0, os.geteuid()) and not facts.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


def key_of(by, flags, digest):
    """The key of the headers for a compiler and its flags."""
    return cache.key_of({"headers": digest, "flags": flags, "compiler": by.identity})


def arguments(key, by):
    """What the compiler is called with to use them, or nothing where they are not made yet."""
    if by.kind not in _suffixes or not _is_ours(path := _path(key, by)):
        return []
    with contextlib.suppress(OSError):  # the time of the last use, by which the cache removes files
        os.utime(path)
    return ["-include-pch", str(path)] if by.kind == "clang++" else ["-include", str(path).removesuffix(".gch")]


def begin(key, by, flags, include):
    """Starts to make them, unless that was done. A program that ends earlier waits for it, a few seconds at most."""
    if by.kind not in _suffixes or key in _begun or _path(key, by).exists():
        return
    _begun.add(key)
    threading.Thread(target=_make, args=(_path(key, by), by, flags, include)).start()


def prepare(key, by, flags, include):
    """Makes them now, unless they are there; returns whether they are."""
    if by.kind in _suffixes and not _is_ours(_path(key, by)):
        _make(_path(key, by), by, flags, include)
    return bool(arguments(key, by))


def _make(path, by, flags, include):
    with contextlib.suppress(OSError, subprocess.SubprocessError), tempfile.TemporaryDirectory(
            prefix=path.name + ".", dir=path.parent) as workplace:
        made = pathlib.Path(workplace) / "headers"
        command = [*by.command, *(f for f in flags if f != "-shared"), f"-I{include}", "-x", "c++-header",
                   str(include / HEADER), "-o", str(made)]
        subprocess.run(command, capture_output=True, check=True, timeout=300, stdin=subprocess.DEVNULL)
        os.chmod(made, 0o600)
        os.replace(made, path)
