# SPDX-License-Identifier: MIT
"""Parts of a study's results, whose instances are in one row where they are kept, as a grid."""

import math

import numpy as np


def read_part(results, name, lengths, key):
    """The part of a variable that a key of slices and numbers selects, along the axes of the grid and then along the
    variable's own dimensions. Each chunk is read once."""
    flat = np.zeros((), dtype=np.int64)
    for d, (length, chosen) in enumerate(zip(lengths, key)):
        indices = np.arange(length)[chosen] * math.prod(lengths[d + 1:])
        flat = np.add.outer(flat, indices) if np.ndim(indices) else flat + indices
    shape, flat = flat.shape, flat.ravel()
    inner = (slice(None), *key[len(lengths):])
    if not flat.size or (np.diff(flat) == 1).all():
        values = results.read(name, int(flat[0]) if flat.size else 0, flat.size)[inner]
        return values.reshape(shape + values.shape[1:])
    chunk_of = flat // results.chunk
    order = np.argsort(chunk_of, kind="stable")
    values = None
    for places in np.split(order, np.flatnonzero(np.diff(chunk_of[order])) + 1):
        first, last = int(flat[places].min()), int(flat[places].max())
        rows = results.read(name, first, last - first + 1)[flat[places] - first][inner]
        if values is None:
            values = np.empty((flat.size, *rows.shape[1:]), rows.dtype)
        values[places] = rows
    return values.reshape(shape + values.shape[1:])


def blocks(lengths, most):
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
