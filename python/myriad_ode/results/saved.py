# SPDX-License-Identifier: MIT
"""What lasts of a run: a header of plain values and arrays by name, which files and pickles have, and a run as
`solve` makes it from these. Results on a GPU are copied to the host, and kernels are left behind."""

from __future__ import annotations

import types
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn

import numpy as np

from .. import _core
from ..base import component_kinds as kinds
from ..base.errors import Error
from ..base.statuses import status_names
from ..models.any_model import AnyModel
from ..models.components import Components
from ..sweeps.gpu_inputs import DeviceInput
from ..sweeps.inputs import Along
from ..sweeps.sweep import Sweep
from ..symbolic.plain import from_plain, to_plain
from .quantities import counters

if TYPE_CHECKING:
    from ..symbolic.types import Array
    from .protocol import Results


class Saved(NamedTuple):
    """What lasts of a run."""

    header: dict[str, Any]
    arrays: dict[str, Array]


class SavedModel(AnyModel):
    """What results need of the model that they are of."""

    def __init__(self, facts: Mapping[str, Any], outputs: Sequence[Any], symbols: Sequence[Any]) -> None:
        names = facts["names"]
        self._set_names({kind: [str(name) for name in names[kind]] for kind in kinds.valued})
        self.events = [str(name) for name in names["event"]]
        self.name = str(facts["name"])
        self.shared_values = dict(facts["tables"])
        self.hidden = frozenset(facts["hidden"])
        self.aliases, self.units, self.time_unit = dict(facts["aliases"]), dict(facts["units"]), str(facts["time_unit"])
        self.outputs = dict(zip(facts["outputs"], outputs, strict=True))
        self.constants = dict(zip(symbols, facts["constants"], strict=True))
        self.writes_parameters = bool(facts["writes_parameters"])
        self.free = [str(name) for name in facts["free"]]


class SavedEnsemble:
    """The arrays of a saved run, as the core's ensemble has them."""

    def __init__(self, arrays: Mapping[str, Array]) -> None:
        self._arrays = arrays

    def array(self, kind: str, number: int = 0) -> Array:
        return self._arrays[_place("ensemble", kind, number)]

    def device_array(self, *_: object) -> NoReturn:
        raise Error("a run that was saved has nothing on a GPU: use run[...]")

    def stored_samples(self) -> Array:
        return self._arrays["stored_samples"]

    def samples(self, number: int, on_device: bool = False) -> Array:
        if on_device:
            self.device_array()
        return self._arrays[_place("samples", "state", number)]


class SavedReport(types.SimpleNamespace):
    """The core's report of a saved run, with its records."""

    notes: Sequence[Any] = ()  # which the header has in words

    def records(self, kind: str, number: int, on_device: bool = False) -> Array:
        if on_device:
            SavedEnsemble.device_array(self)  # type: ignore[arg-type]
        return self._arrays[_place("records", kind, number)]

    def __str__(self) -> str:
        return self._text


def _place(source: str, kind: str, number: int) -> str:
    return f"{source}.{kind}.{number}"


def _places(components: Components, recorded: Mapping[str, tuple[str, int]], records_time: bool,
            sampled: Mapping[str, int]) -> Iterator[tuple[str, str, int]]:
    """All arrays that a run has in the core: where, the kind, and the number."""
    for kind in kinds.valued:
        for number in [0] if kind in kinds.shared else range(len(components.names[kind])):
            yield "ensemble", kind, number
    for kind in ("t", "status", "phases_done", *counters):
        yield "ensemble", kind, 0
    for kind, number in recorded.values():
        yield "records", kind, number
    if records_time:
        yield "records", "time", 0
    for number in [*sampled.values(), *([-1] if sampled else [])]:
        yield "samples", "state", number


def _plain(value: Any) -> Any:
    """A fact of a report: a number, a text, a list of these, or an object that has such."""
    if isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    return {name: _plain(getattr(value, name)) for name in dir(value)
            if not name.startswith("_") and name != "notes" and not callable(getattr(value, name))}


def _object(fact: Any) -> Any:
    return types.SimpleNamespace(**{k: _object(v) for k, v in fact.items()}) if isinstance(fact, dict) else fact


def saved(run: Results) -> Saved:
    """What lasts of a run."""
    components, report = run._components, run.report
    ensemble: Any = run._ensemble
    arrays: dict[str, Array] = {}
    for source, kind, number in _places(components, run._recorded, run._records_time, run._sampled):
        arrays[_place(source, kind, number)] = np.asarray(
            ensemble.array(kind, number) if source == "ensemble" else
            run._records.records(kind, number) if source == "records" else ensemble.samples(number))
    if run._sampled:
        arrays["stored_samples"] = np.asarray(ensemble.stored_samples())
    given = {name: _input(run, name, value, arrays) for name, value in run._inputs.items()}
    arrays["t_begin"], arrays["t_end"] = map(np.asarray, run._domain)
    symbols = list(components.constants)
    expressions, tables = to_plain([*components.outputs.values(), *symbols])
    arrays.update((f"table.{number}", values) for number, values in enumerate(tables))
    model = {"name": run.description.get("model", ""), "names": {k: list(v) for k, v in components.names.items()},
             "tables": {name: float(value) for name, value in components.tables.items()},
             "hidden": sorted(components.hidden), "aliases": dict(components.aliases),
             "units": dict(components.units), "time_unit": components.time_unit, "outputs": list(components.outputs),
             "constants": [float(components.constants[symbol]) for symbol in symbols],
             "writes_parameters": components.writes_parameters, "free": components.derivatives_by}
    header = {"myriad_version": _core.version, "description": run.description, "model": model,
              "expressions": expressions, "inputs": {name: how for name, how in given.items() if how is not None},
              "sweep": None if run.sweep is None else _of_sweep(run.sweep, arrays),
              "recorded": {name: list(place) for name, place in run._recorded.items()}, "sampled": dict(run._sampled),
              "records_time": bool(run._records_time), "from_phase": int(run.from_phase),
              "report": _plain(report._report), "report_text": str(report._report), "notes": list(report.notes),
              "kernel": report.kernel, "compile_seconds": report.compile_seconds, "total_seconds": report.total_seconds}
    return Saved(header, arrays)


def _input(run: Results, name: str, value: Any, arrays: dict[str, Array]) -> str | None:
    """How an input is kept: as the ensemble has it, along an axis of the sweep, or as an array of its own. None of an
    initial state on a GPU, which may have changed there since."""
    kind, _ = run._components.place[name]
    if kind in kinds.shared or kind == "parameter" and not run._components.writes_parameters:
        return "ensemble"
    if isinstance(value, Along):
        return "sweep"
    if isinstance(value, DeviceInput):
        return None
    arrays[f"input.{name}"] = np.asarray(value)
    return "array"


def _of_sweep(sweep: Sweep, arrays: dict[str, Array]) -> dict[str, Any]:
    arrays.update((f"axis.{name}", np.asarray(values)) for name, values in sweep.axes)
    arrays.update((f"coordinate.{name}", np.asarray(values)) for name, (_, values) in sweep.coordinates.items())
    return {"axes": [name for name, _ in sweep.axes],
            "coordinates": {name: axis for name, (axis, _) in sweep.coordinates.items()},
            "constants": {name: _number(value) for name, value in sweep.constants.items()}}


def _number(value: Any) -> int | float:
    return np.asarray(value).item()


def _same_sweep(facts: Any, arrays: Mapping[str, Array]) -> Sweep:
    axes = [(str(name), arrays[f"axis.{name}"]) for name in facts["axes"]]
    coordinates = {name: (str(axis), arrays[f"coordinate.{name}"]) for name, axis in facts["coordinates"].items()}
    lengths = {name: len(values) for name, values in axes}
    if any(len(values) != lengths[axis] for axis, values in coordinates.values()):
        raise ValueError("values of the sweep have another length than their axis")
    return Sweep([(name, values) for name, values in axes], dict(coordinates), dict(facts["constants"]))


def parts_of(header: Mapping[str, Any], arrays: Mapping[str, Array]) -> dict[str, Any]:
    """What a `Run` is made of. Raises ValueError, KeyError, TypeError and the like if the parts do not fit."""
    facts = header["model"]
    tables = [arrays[f"table.{number}"] for number in range(len(header["expressions"]["tables"]))]
    expressions = from_plain(header["expressions"], tables)
    count = len(facts["outputs"])
    model = SavedModel(facts, expressions[:count], expressions[count:])
    components = Components(model)
    recorded = {str(name): (str(kind), int(number)) for name, (kind, number) in header["recorded"].items()}
    sampled = {str(name): int(number) for name, number in header["sampled"].items()}
    report = SavedReport(**{**_object(header["report"]).__dict__, "_arrays": arrays,
                            "_text": str(header["report_text"])})
    _check(report, components, arrays, list(_places(components, recorded, bool(header["records_time"]), sampled)),
           bool(sampled))
    sweep = None if header["sweep"] is None else _same_sweep(header["sweep"], arrays)
    if sweep is not None and sweep.size != report.instances:
        raise ValueError("the sweep has another number of instances")
    ensemble = SavedEnsemble(arrays)
    given: dict[str, Any] = {}
    for name, how in header["inputs"].items():
        kind, number = components.place[name]
        if how == "ensemble":
            given[name] = ensemble.array(kind)[number] if kind in kinds.shared else ensemble.array(kind, number)
        else:
            given[name] = Along(sweep, name) if how == "sweep" and sweep is not None else arrays[f"input.{name}"]
    return {"components": components, "ensemble": ensemble, "report": report,
            "kernel": types.SimpleNamespace(origin=str(header["kernel"]), seconds=float(header["compile_seconds"])),
            "sweep": sweep, "inputs": given, "domain": (arrays["t_begin"], arrays["t_end"]), "recorded": recorded,
            "sampled": sampled, "seconds": float(header["total_seconds"]),
            "record": types.SimpleNamespace(time=bool(header["records_time"]), from_phase=int(header["from_phase"])),
            "notes": [str(note) for note in header["notes"]], "describe": lambda: dict(header["description"])}


def _check(report: Any, components: Components, arrays: Mapping[str, Array], places: Sequence[tuple[str, str, int]],
           has_samples: bool) -> None:
    """Refuses arrays that are missing or have another shape than the results' sizes say."""
    if len(report.by_status) != len(status_names):
        raise ValueError("there are other statuses")
    for source, kind, number in places:
        shape = arrays[_place(source, kind, number)].shape
        first = len(components.names[kind]) if kind in kinds.shared else report.instances
        if shape[:1] != (first,) or len(shape) != (1 if source == "ensemble" else 2):
            raise ValueError(f"the array {_place(source, kind, number)} has shape {shape}")
    if has_samples and arrays["stored_samples"].shape != (report.instances,):
        raise ValueError("the numbers of samples are not those of the instances")
    codes = arrays[_place("ensemble", "status", 0)]
    if codes.dtype != np.uint8 or codes.size and codes.max() >= len(status_names):
        raise ValueError("there are unknown statuses")
    for end in ("t_begin", "t_end"):
        if arrays[end].shape not in ((), (report.instances,)):
            raise ValueError("the time domain has another number of instances")
