# SPDX-License-Identifier: MIT
"""The files of an archive of COMBINE (OMEX), or of a folder, read in memory: none is written, so that no name in an
archive leads elsewhere."""

from __future__ import annotations

import pathlib
import posixpath
from typing import NoReturn

from ...base.errors import Error
from ..xml_elements import Element, elements_of

_most_bytes = 1 << 28  # of all files of an archive, unpacked


class Files:
    """The files beside a document of SED-ML, by their paths."""

    def __init__(self, path: str | pathlib.Path) -> None:
        self.path = pathlib.Path(path)
        import zipfile
        self._archive: dict[str, bytes] | None = None
        if not self.path.is_file():
            raise Error(f"there is no file '{path}'")
        if zipfile.is_zipfile(self.path):
            self._archive = self._unpacked()

    def refuse(self, what: str) -> NoReturn:
        raise Error(f"'{self.path}': {what}")

    def _unpacked(self) -> dict[str, bytes]:
        import zipfile
        with zipfile.ZipFile(self.path) as archive:
            members = [one for one in archive.infolist() if not one.is_dir()]
            if sum(one.file_size for one in members) > _most_bytes:
                self.refuse(f"its files have more than {_most_bytes >> 20} MiB: unpack it, and read the document in it")
            found = {}
            for one in members:
                with archive.open(one) as file:  # no more than it says it has
                    found[posixpath.normpath(one.filename)] = file.read(one.file_size)
            return found

    def documents(self) -> list[str]:
        """The paths of the documents of SED-ML: the file itself, or those that the manifest of an archive names, the
        master first."""
        if self._archive is None:
            return [self.path.name]
        if "manifest.xml" not in self._archive:
            self.refuse("it has no manifest.xml, and is no archive of COMBINE")
        contents = [one for one in xml_of(self._archive["manifest.xml"], f"{self.path}: manifest.xml")
                    if "sed-ml" in one.get("format", "")]
        contents.sort(key=lambda one: one.get("master") != "true")
        return [posixpath.normpath(one.get("location", "")) for one in contents]

    def read(self, path: str, beside: str = "") -> bytes:
        """A file, by its path from the folder of the document `beside`."""
        wanted = posixpath.normpath(posixpath.join(posixpath.dirname(beside), path))
        if self._archive is None:
            if posixpath.isabs(wanted) or wanted.startswith(".."):
                self.refuse(f"the file '{path}' is not in its folder, or one below: move it there")
            file = self.path.parent / wanted
            if file.is_file():
                return file.read_bytes()
        elif wanted in self._archive:
            return self._archive[wanted]
        self.refuse(f"the file '{path}' is not there")


def xml_of(data: bytes, what: str, prefixes: dict[str, str] | None = None) -> Element:
    """The root of a document of XML, and its prefixes of namespaces."""
    def refuse(why: str, line: int) -> NoReturn:
        raise Error(f"'{what}': line {line}: {why}")

    return elements_of(data, refuse, prefixes)
