# SPDX-License-Identifier: MIT
"""Outputs of a model in a study: accessories, which the end of each phase sets, so that a study keeps, records and
reduces them as all others."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Collection, Sequence
from typing import Any

import numpy as np

from ..base import component_kinds as kinds
from ..models.any_model import AnyModel, names_of
from ..models.components import listed, name_of
from ..models.recorded import RecordedModel
from ..models.recorded_check import check_recorded
from ..results.quantities import called
from ..solving.options import Options
from ..symbolic import symbols as sym
from ..symbolic.folding import constant
from ..symbolic.node import symbols_of
from ..symbolic.rewrite import replaced
from .reduce import Reduction


def with_outputs(model: AnyModel, keep: Any, options: Options, reductions: Sequence[Reduction]) -> tuple[AnyModel,
                                                                                                        Options]:
    """The model with its outputs as accessories, those that a study names, and those that follow from what it records,
    as in a run; or all, if nothing says what is kept. And the options, which record them too."""
    if not model.outputs:
        return model, options
    given: Any = options.record
    record = dict(given) if hasattr(given, "items") else {"states": given or ()}
    recorded = [name_of(one) for key in ("states", "accessories") for one in listed(record.get(key, ()))]
    known = {model.aliases.get(name, name) for name in recorded}
    along = [name for name, of in model.outputs.items() if _follows(of, known, bool(record.get("time")))]
    if along:
        others = [*listed(record.get("accessories", ())), *(name for name in along if name not in recorded)]
        options = dataclasses.replace(options, record={**record, "accessories": others})
    named = {*recorded, *along, *(name.removesuffix("_end") for one in reductions for name in one.variables)}
    end = keep.get("end", ()) if hasattr(keep, "items") else keep
    if end is not None:
        named |= {name_of(one) for one in listed(end) if one is not sym.time}
    elif not (named or record.get("time") or options.samples is not None):
        named = {*model.outputs}
    return _as_accessories(model, [name for name in model.outputs if name in named]), options


def _follows(expression: Any, recorded: Collection[str], with_time: bool) -> bool:
    """Whether a run knows an output at recorded phases: what it follows from is recorded."""
    symbols = {*symbols_of([expression])}
    changing = {s.value[1] for s in symbols if s.value[0] in kinds.recorded}
    needs_time = sym.time in symbols
    return (bool(changing) or needs_time) and changing <= {*recorded} and (with_time or not needs_time)


def _as_accessories(model: AnyModel, chosen: Collection[str]) -> AnyModel:
    """The model in which these of its outputs are accessories, NaN where no phase has ended."""
    if not isinstance(model, RecordedModel) or not chosen:
        return model
    made = model.changeable()
    known = {symbol: constant(value) for symbol, value in model.constants.items()}
    values = dict(zip(chosen, replaced([model.outputs[name] for name in chosen], known)))
    results = called(names_of(model), chosen)
    taken = [model.name, *model.component_names, *model.aliases]
    targets = {}
    for name in sorted(chosen, key=lambda one: not one.isidentifier()):
        legal = re.sub("[^A-Za-z0-9]+", "_", name).strip("_") or "output"
        taken.append(sym.free_name(legal if legal[0].isalpha() else f"x_{legal}", taken))
        targets[name] = sym.symbol("accessory", taken[-1])
    made.outputs = {name: value for name, value in model.outputs.items() if name not in values}
    made.aliases = {**model.aliases, **{name: target.value[1] for name, target in targets.items()}}
    made.called = {target.value[1]: results[name] for name, target in targets.items()}
    made.units = {**model.units, **{t.value[1]: model.units[n] for n, t in targets.items() if n in model.units}}
    made.initialise = [*model.initialise, *((target, constant(np.nan)) for target in targets.values())]
    made.finalise = [*model.finalise, *((targets[name], value) for name, value in values.items())]
    made._accessory_targets = [*model._accessory_targets, *targets.values()]
    made._collect(list(made.equations))
    check_recorded(made)
    return made
