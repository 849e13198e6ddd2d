# SPDX-License-Identifier: MIT
"""Parts of a study's results, whose instances are in one row where they are kept, as a grid."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from .. import _core
    from ..symbolic.types import Array


def read_part(results: _core.Results, name: str, lengths: Sequence[int], key: tuple[Any, ...]) -> Array:
    """The part of a variable that a key of slices and numbers selects, along the axes of the grid and then along the
    variable's own dimensions. Each chunk is read once."""
    flat: Array = np.zeros((), dtype=np.int64)
    for d, (length, chosen) in enumerate(zip(lengths, key)):
        indices = np.arange(length)[chosen] * math.prod(lengths[d + 1:])
        flat = np.add.outer(flat, indices) if np.ndim(indices) else flat + indices
    shape, flat = flat.shape, flat.ravel()
    inner = (slice(None), *key[len(lengths):])
    if not flat.size or (np.diff(flat) == 1).all():
        whole = results.read(name, int(flat[0]) if flat.size else 0, flat.size)[inner]
        return whole.reshape(shape + whole.shape[1:])
    chunk_of = flat // results.chunk
    order = np.argsort(chunk_of, kind="stable")
    values: Array | None = None
    for places in np.split(order, np.flatnonzero(np.diff(chunk_of[order])) + 1):
        first, last = int(flat[places].min()), int(flat[places].max())
        rows = results.read(name, first, last - first + 1)[flat[places] - first][inner]
        if values is None:
            values = np.empty((flat.size, *rows.shape[1:]), rows.dtype)
        values[places] = rows
    assert values is not None  # as there are places
    return values.reshape(shape + values.shape[1:])


def blocks(lengths: Sequence[int], most: int) -> Iterator[tuple[slice, ...]]:
    """Keys of slices that divide a grid into parts of up to `most` points, or one value of an axis."""
    if not lengths:
        yield ()
        return
    split = next((d for d in range(len(lengths)) if math.prod(lengths[d + 1:]) <= most), len(lengths) - 1)
    step = max(1, most // max(1, math.prod(lengths[split + 1:])))
    for outer in np.ndindex(*lengths[:split]):
        for first in range(0, lengths[split], step):
            yield (*(slice(i, i + 1) for i in outer), slice(first, min(first + step, lengths[split])),
                   *(slice(None) for _ in lengths[split + 1:]))
