# SPDX-License-Identifier: MIT
"""Variables of results that are read when they are used, for xarray: grids whose instances are in one row in the
store."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from xarray.backends import BackendArray
from xarray.core import indexing

from .. import _core
from ..base.statuses import in_words
from .store_slices import read_part

if TYPE_CHECKING:
    from ..symbolic.types import Array


class StoredVariable(BackendArray):
    """A variable of a store. Pickled, it is the folder's name."""

    def __init__(self, folder: str, results: _core.Results, name: str, dtype: str, lengths: Sequence[int],
                 inner: Sequence[int]) -> None:
        self.folder, self.name, self.lengths = folder, name, tuple(lengths)
        self.in_words = name == "status"  # of which a store has numbers
        self.dtype = in_words(0).dtype if self.in_words else np.dtype(dtype)
        self.shape = (*lengths, *inner)
        self._results = results

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_results": None}

    def __getitem__(self, key: indexing.ExplicitIndexer) -> Array:
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.BASIC, self._read)

    def _read(self, key: tuple[Any, ...]) -> Array:
        if self._results is None:
            self._results = _core.open_store(self.folder)
        part = read_part(self._results, self.name, self.lengths, key)
        return in_words(part) if self.in_words else part


def lazy(folder: str, results: _core.Results, name: str, dtype: str, lengths: Sequence[int],
         inner: Sequence[int]) -> indexing.LazilyIndexedArray:
    """The data of an `xarray.Variable` that is read when it is used."""
    return indexing.LazilyIndexedArray(StoredVariable(folder, results, name, dtype, lengths, inner))
