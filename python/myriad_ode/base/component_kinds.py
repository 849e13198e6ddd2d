# SPDX-License-Identifier: MIT
"""The kinds of components that a model may have, as the core lists them."""

from __future__ import annotations

from typing import NamedTuple

from .. import _core


class Kind(NamedTuple):
    """One kind: its enumeration in C++, the model's attribute in Python, what messages call a component, whether its
    values are integers, whether they can be recorded, and whether each instance has its own."""

    name: str
    plural: str
    words: str
    integer: bool
    recorded: bool
    of_instances: bool


every: dict[str, Kind] = {facts[0]: Kind(*facts) for facts in _core.component_kinds}
valued = [kind.name for kind in every.values() if kind.name != "event"]  # those with values
recorded = [kind.name for kind in every.values() if kind.recorded]  # states and accessories, which change
accessories = [kind for kind in recorded if kind != "state"]
of_instances = [kind.name for kind in every.values() if kind.of_instances]
shared = [kind for kind in valued if kind not in of_instances]  # by all instances
