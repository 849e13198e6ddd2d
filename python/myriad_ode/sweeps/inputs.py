# SPDX-License-Identifier: MIT
"""Numbers, arrays and dicts as users give them: checked, and as the core takes them."""

from __future__ import annotations

import functools
import os
from collections.abc import Collection, Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error, refuse_masked
from ..models.components import unknown
from ..symbolic.functions import draws
from ..symbolic.node import Node, walk
from ..symbolic.numbers import as_numbers
from .gpu_inputs import DeviceInput, is_on_gpu

if TYPE_CHECKING:
    import numpy.typing as npt

    from ..symbolic.types import Array, ByComponent, Path
    from .sweep import Sweep


class Along:
    """Values of a grid along one of its axes, as an array of one value per instance that is not made until needed."""

    ndim = 1

    def __init__(self, sweep: Sweep, name: str) -> None:
        self._sweep, self._name = sweep, name
        self.axis, self.given = sweep.coordinates[name]  #: the name of the axis, and the values as they were given

    @functools.cached_property
    def values_and_repeat(self) -> tuple[Array, int]:
        """As `Sweep.along`."""
        return self._sweep.along(self._name)

    def __len__(self) -> int:
        return self._sweep.size

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> Array:
        values = self._sweep.values(self._name)
        return values.astype(dtype or values.dtype, copy=False)


def _instead_of(value: Any, name: str) -> str:
    """What to give instead of something that is no number."""
    if isinstance(value, Node) and any(node.op in draws for node in walk([value])):
        return f"it to a study, in the dict of its sweep, as in my.study(model, {{{name}: {value!r}}}, draws=100)"
    return "a number, or an array with one number per instance"


def numbers(value: Any, name: str) -> Any:
    """A number, or an array of one dimension, of real numbers; arrays on a GPU stay there."""
    if isinstance(value, Along):
        return value
    if is_on_gpu(value):
        return DeviceInput(value, name)
    refuse_masked(value, f"'{name}'")
    array = as_numbers(value)
    if array.dtype.kind == "c":
        raise Error(f"'{name}' is complex: a model is real, so give real and imaginary parts as two components")
    if array.dtype.kind not in "biuf":
        raise Error(f"'{name}' is {value!r}: give {_instead_of(value, name)}")
    if array.ndim > 1:
        raise Error(f"'{name}' has {array.ndim} dimensions: give one number per instance, in one dimension; "
                    "my.grid(...) makes a sweep over several axes")
    return array


def whole_numbers(array: Array, name: str) -> Array:
    """The values of an integer component: whole numbers of 32 bits."""
    least, largest = -(1 << 31), (1 << 31) - 1
    values = array.astype(float)
    wrong = np.flatnonzero((array != np.floor(array)) | ~((values >= least) & (values <= largest)))
    if wrong.size:
        raise Error(f"'{name}' is an integer and has the value {array.flat[wrong[0]]}: give whole numbers between "
                    f"{least} and {largest}")
    return array.astype(np.int32)


_largest = (1 << 31) - 1


def whole(value: Any, name: str, largest: int = _largest, within: str = "") -> int:
    """A whole number. One beyond `largest` is refused with the range of its option, `within`, if that is narrower."""
    try:
        is_whole = not isinstance(value, (bool, np.bool_, str)) and float(value).is_integer()
    except (TypeError, ValueError, OverflowError):
        is_whole = False
    if not is_whole:
        raise Error(f"{name} is {value!r}: give a whole number")
    if not -largest <= value <= largest:
        raise Error(f"{name} is {value}: give a number {'in ' + within if within else f'up to {largest}'}")
    return int(value)


def real(value: Any, name: str) -> float:
    try:
        if not isinstance(value, (bool, np.bool_, str, bytes, bytearray)):
            return float(value)
    except (TypeError, ValueError, OverflowError):
        pass
    raise Error(f"{name} is {value!r}: give a number")


def text(value: object, name: str) -> str:
    """A text as the core takes it, of characters alone: half of a pair of UTF-16 is none."""
    made = str(value)
    try:
        made.encode()
    except UnicodeEncodeError as why:
        raise Error(f"{name} has {made[why.start]!a}, which is no character: give a text in Unicode") from None
    return made


def path_text(path: Path) -> str:
    """A path as the core takes it: a text of characters, so that messages can name it."""
    try:
        text = os.fsdecode(path)
    except TypeError:
        raise Error(f"the path is {path!r}: give a text, or a pathlib.Path") from None
    if not text:
        raise Error("the path is empty: name a folder or a file, such as \"results\"")
    try:
        text.encode()
    except UnicodeEncodeError:
        raise Error(f"the path {text!r} has bytes that are no characters of UTF-8: give another path") from None
    return text


def by_name(value: ByComponent | None, name: str, example: str) -> ByComponent:
    """The dict that an option is."""
    if value is not None and not hasattr(value, "items"):
        raise Error(f"{name} is {value!r}: give a dict by name, as in {example}")
    return value or {}


def only(options: Iterable[str], known: Collection[str], what: str) -> None:
    for name in options:
        if name not in known:
            raise unknown(name, list(known), f"choice of {what}")
