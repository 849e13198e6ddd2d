# SPDX-License-Identifier: MIT
"""The cache of compiled models on disk: one file per key, put there whole, so that readers need no lock. Behind its
content a file has a digest, by which damage is noticed before the system loads it."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import pathlib
import shutil
import stat
import tempfile
import warnings
from dataclasses import dataclass

from .errors import Error

__all__ = ["clear", "directory", "prepare", "size_limit"]

try:
    import fcntl
except ImportError:  # no locks on this system: two processes may then compile the same model
    fcntl = None  # type: ignore[assignment]

DEFAULT_SIZE = 1 << 30  # bytes
_work = ".work."  # in names of folders where models are compiled


def directory() -> pathlib.Path:
    """The folder of the cache: $MYRIAD_CACHE_DIR, or myriad in the user's folder of caches. It may not exist yet."""
    if chosen := os.environ.get("MYRIAD_CACHE_DIR"):
        return pathlib.Path(chosen)
    caches = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return pathlib.Path(caches) / "myriad"


def size_limit() -> int:
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


def _objection(facts):
    """Why what has these facts is not trusted, or None: its code would run with all rights of the user. The program
    `myriad` has the same rules (src/program/model_cache.cpp)."""
    if facts.st_uid not in (os.geteuid(), 0):
        return f"it belongs to another user, of number {facts.st_uid}: set MYRIAD_CACHE_DIR to a folder of your own"
    if facts.st_mode & 0o022:
        return (f"others may write to it (mode {stat.S_IMODE(facts.st_mode):o}): remove it, or if nobody has put "
                "anything there, take that right away by chmod go-w")
    return None


def _make(folder):
    """Makes a folder and those that it is in, for this user alone whatever the umask is."""
    try:
        os.mkdir(folder, 0o700)
    except FileExistsError:
        pass
    except FileNotFoundError:
        if folder.parent == folder:
            raise
        _make(folder.parent)
        os.mkdir(folder, 0o700)


def _problem_of(folder):
    """Why the folder of the cache, made if need be, cannot be used, or None."""
    try:
        _make(folder)
        link = os.lstat(folder)  # somebody else's leads where that user wants
        if not stat.S_ISLNK(link.st_mode) or link.st_uid in (os.geteuid(), 0):
            link = os.stat(folder)
        if objection := _objection(link):
            warnings.warn(f"compiled models are not kept in {folder}, as {objection}", RuntimeWarning, stacklevel=2)
            return objection
        if not stat.S_ISDIR(link.st_mode):
            return "it is no folder"
    except OSError as why:
        return why.strerror
    return None if os.access(folder, os.W_OK | os.X_OK) else "it cannot be written"


_own_folder = None


def _folder_of_process():
    """Where the cache is where its folder cannot be used: a folder that lasts as long as this process."""
    global _own_folder
    if _own_folder is None:
        _own_folder = tempfile.TemporaryDirectory(prefix="myriad-")
    return pathlib.Path(_own_folder.name)


@contextlib.contextmanager
def _locked(path, wait=True):
    """Holds the lock of a key, as far as the file system has locks: without, what is made twice is equal. Gives whether
    it is held; the file is removed then, so that it must be the one which has the name."""
    if fcntl is None:
        yield False
        return
    while True:
        file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW, 0o600)
        held = False
        with contextlib.suppress(OSError):
            fcntl.flock(file, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
            held = True
        if not held:
            break
        with contextlib.suppress(FileNotFoundError):
            if os.lstat(path).st_ino == os.fstat(file).st_ino:
                break
        os.close(file)
    try:
        yield held
    finally:
        if held:
            with contextlib.suppress(OSError):
                os.unlink(path)
        os.close(file)


_digest_size = hashlib.sha256().digest_size


def _seal(path):
    """Puts the digest of a file behind its content, which the loaders of shared objects do not look at."""
    with open(path, "r+b") as file:
        file.write(hashlib.sha256(file.read()).digest())


def _is_whole(content):
    """Whether a file is as `_seal` left it."""
    return hashlib.sha256(content[:-_digest_size]).digest() == content[-_digest_size:]


@dataclass(frozen=True)
class Obtained:
    """What `obtain` loaded, whether it was in the cache, and why the cache could not be used, if that is so."""

    loaded: object
    hit: bool
    unusable: object = None


def _find(path, load):
    """What a file of the cache is loaded as, or None if it is missing, damaged, not to be trusted, or cannot be loaded.
    What is looked at is what is loaded: by the descriptor, which stays open, since the system's loader tells libraries
    apart by their names."""
    try:
        file = os.open(path, os.O_RDONLY | os.O_CLOEXEC | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return None
    loaded = None
    try:
        facts = os.fstat(file)
        if not stat.S_ISREG(facts.st_mode) or _objection(facts):
            return None
        with open(file, "rb", closefd=False) as opened:
            if not _is_whole(opened.read()):
                return None
        with contextlib.suppress(OSError):  # the time of its last use, for `_shrink`
            os.utime(file)
        opened = pathlib.Path(f"/proc/self/fd/{file}")
        with contextlib.suppress(Error):
            loaded = load(opened if opened.exists() else path)
        return loaded
    except OSError:
        return None
    finally:
        if loaded is None:
            os.close(file)


def obtain(key, make, load):
    """What `load(path)` makes of the file of a key, as `Obtained`. If there is no such file that is whole and can be
    loaded, `make(folder)` writes it, and returns its path in that folder; other processes that want the same wait for
    it. A file that cannot be loaded is not kept."""
    chosen = directory()
    problem = _problem_of(chosen)
    if problem in (None, "it cannot be written"):
        loaded = _find(chosen / f"{key}.so", load)
        if loaded is not None:
            return Obtained(loaded, True)
    if problem is None:
        try:
            return Obtained(*_obtain_in(chosen, key, make, load))
        except OSError as why:  # as where another user's files are in the way, or the disk is full
            problem = why.strerror
    return Obtained(*_obtain_in(_folder_of_process(), key, make, load), f"the cache {chosen} cannot be used: {problem}")


def _obtain_in(folder, key, make, load):
    path = folder / f"{key}.so"
    with _locked(folder / f"{key}.lock") as held:
        loaded = _find(path, load)  # made by the process that held the lock
        if loaded is not None:
            return loaded, True
        if held:
            for left in folder.glob(f"{key}{_work}*"):  # of a process that was killed
                shutil.rmtree(left, ignore_errors=True)
        with tempfile.TemporaryDirectory(prefix=key + _work, dir=folder) as workplace:
            made = pathlib.Path(make(pathlib.Path(workplace)))
            made.chmod(0o600)  # whatever the umask is
            _seal(made)
            loaded = load(made)
            os.replace(made, path)
    _shrink(folder, keep=path)
    return loaded, False


def _shrink(folder, keep):
    """Removes the files that were not used for longest, until the rest is within the limit, and what killed processes
    left."""
    limit = size_limit()
    entries = []
    for entry in os.scandir(folder):
        with contextlib.suppress(OSError):
            key, mark, _ = entry.name.partition(_work)
            if mark or entry.name.endswith(".lock"):
                with _locked(folder / f"{key.removesuffix('.lock')}.lock", wait=False) as held:
                    if held and mark:
                        shutil.rmtree(entry.path, ignore_errors=True)
            elif entry.name.endswith((".so", ".pch", ".gch")):
                facts = entry.stat(follow_symlinks=False)
                entries.append((facts.st_mtime, facts.st_size, pathlib.Path(entry.path)))
    total = sum(size for _, size, _ in entries)
    for _, size, path in sorted(entries):
        if total <= limit:
            break
        if path != keep:
            with contextlib.suppress(OSError):
                path.unlink()
            total -= size


def prepare() -> bool:
    """Has the compiler prepare the library's headers now, as after an installation or while an image of a container is
    made, so that the very first model compiles as fast as later ones. Returns False where the compiler prepares none.
    Raises `Error` if there is no compiler, or if the folder of the cache cannot be used."""
    from . import compiler  # which is above this file
    if (problem := _problem_of(directory())) is not None:
        raise Error(f"the cache {directory()} cannot be used: {problem}: set MYRIAD_CACHE_DIR to another folder")
    return compiler.prepare()


def clear() -> int:
    """Removes all compiled models from the cache; returns how many."""
    folder = directory()
    removed = 0
    if folder.is_dir():
        for path in folder.glob("*.so"):
            path.unlink(missing_ok=True)
            removed += 1
        for path in (*folder.glob("*.pch"), *folder.glob("*.gch")):  # headers for the compiler
            path.unlink(missing_ok=True)
    return removed
