# SPDX-License-Identifier: MIT
"""The cache of compiled models on disk: one file per key, put there whole, so that readers need no lock. Behind its
content a file has a digest, by which damage is noticed before the system loads it."""

import contextlib
import hashlib
import json
import os
import pathlib
import tempfile
from dataclasses import dataclass

from .errors import Error

try:
    import fcntl
except ImportError:  # no locks on this system: two processes may then compile the same model
    fcntl = None

DEFAULT_SIZE = 1 << 30  # bytes


def directory():
    """The folder of the cache: $MYRIAD_CACHE_DIR, or myriad in the user's folder of caches. It may not exist yet."""
    if chosen := os.environ.get("MYRIAD_CACHE_DIR"):
        return pathlib.Path(chosen)
    caches = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return pathlib.Path(caches) / "myriad"


def size_limit():
    """The bytes that the cache may hold: $MYRIAD_CACHE_SIZE, or 1 GiB."""
    text = os.environ.get("MYRIAD_CACHE_SIZE")
    if text is None:
        return DEFAULT_SIZE
    try:
        return int(text)
    except ValueError:
        raise Error(f"MYRIAD_CACHE_SIZE is {text!r}: give a number of bytes, such as {DEFAULT_SIZE}") from None


def key_of(parts):
    """The key of what is made from `parts`, a dict that JSON can hold."""
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()[:32]


def _usable(folder):
    """The folder, made if need be, or None where nothing can be written."""
    try:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    except OSError:
        return None
    return folder if os.access(folder, os.W_OK | os.X_OK) else None


_own_folder = None


def _folder_of_process():
    """Where the cache is where its folder cannot be used: a folder that lasts as long as this process."""
    global _own_folder
    if _own_folder is None:
        _own_folder = tempfile.TemporaryDirectory(prefix="myriad-")
    return pathlib.Path(_own_folder.name)


@contextlib.contextmanager
def _locked(path):
    """Holds the lock of a key, as far as the file system has locks: without, what is made twice is equal."""
    if fcntl is None:
        yield
        return
    try:
        file = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)  # NFS locks only what can be written
    except PermissionError:  # another user's, of which reading suffices elsewhere
        file = os.open(path, os.O_RDONLY)
    try:
        with contextlib.suppress(OSError):
            fcntl.flock(file, fcntl.LOCK_EX)
        yield
    finally:
        os.close(file)


_digest_size = hashlib.sha256().digest_size


def _seal(path):
    """Puts the digest of a file behind its content, which the loaders of shared objects do not look at."""
    with open(path, "r+b") as file:
        file.write(hashlib.sha256(file.read()).digest())


def _is_whole(path):
    """Whether a file is as `_seal` left it."""
    try:
        content = path.read_bytes()
    except OSError:
        return False
    return hashlib.sha256(content[:-_digest_size]).digest() == content[-_digest_size:]


@dataclass(frozen=True)
class Obtained:
    """What `obtain` loaded, whether it was in the cache, and the folder that could not be used for it, if any."""

    loaded: object
    hit: bool
    unusable: object = None


def _find(path, load):
    """What a file of the cache is loaded as, or None if it is missing, damaged, or cannot be loaded."""
    if not _is_whole(path):
        return None
    with contextlib.suppress(OSError):  # the time of its last use, for `_shrink`
        os.utime(path)
    try:
        return load(path)
    except Error:
        return None


def obtain(key, make, load):
    """What `load(path)` makes of the file of a key, as `Obtained`. If there is no such file that is whole and can be
    loaded, `make(folder)` writes it, and returns its path in that folder; other processes that want the same wait for
    it. A file that cannot be loaded is not kept."""
    chosen = directory()
    loaded = _find(chosen / f"{key}.so", load)
    if loaded is not None:
        return Obtained(loaded, True)
    folder = _usable(chosen)
    if folder is not None:
        with contextlib.suppress(OSError):  # as where another user's files are in the way, or the disk is full
            return Obtained(*_obtain_in(folder, key, make, load))
    return Obtained(*_obtain_in(_folder_of_process(), key, make, load), chosen)


def _obtain_in(folder, key, make, load):
    path = folder / f"{key}.so"
    with _locked(folder / f"{key}.lock"):
        loaded = _find(path, load)  # made by the process that held the lock
        if loaded is not None:
            return loaded, True
        with tempfile.TemporaryDirectory(prefix=f"{key}.", dir=folder) as workplace:
            made = pathlib.Path(make(pathlib.Path(workplace)))
            _seal(made)
            loaded = load(made)
            os.replace(made, path)
    _shrink(folder, keep=path)
    return loaded, False


def _shrink(folder, keep):
    """Removes the files that were not used for longest, until the rest is within the limit."""
    limit = size_limit()
    entries = []
    for entry in os.scandir(folder):
        with contextlib.suppress(OSError):
            if entry.name.endswith((".so", ".pch", ".gch")):
                facts = entry.stat()
                entries.append((facts.st_mtime, facts.st_size, pathlib.Path(entry.path)))
    total = sum(size for _, size, _ in entries)
    for _, size, path in sorted(entries):
        if total <= limit:
            break
        if path != keep:
            for doomed in (path, path.with_suffix(".lock")):
                with contextlib.suppress(OSError):
                    doomed.unlink()
            total -= size


def clear():
    """Removes all compiled models from the cache; returns how many."""
    folder = directory()
    removed = 0
    if folder.is_dir():
        for path in folder.glob("*.so"):
            path.unlink(missing_ok=True)
            path.with_suffix(".lock").unlink(missing_ok=True)
            removed += 1
        for path in (*folder.glob("*.pch"), *folder.glob("*.gch")):  # headers for the compiler
            path.unlink(missing_ok=True)
    return removed
