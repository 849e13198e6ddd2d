# SPDX-License-Identifier: MIT
"""Gradients by a discrete adjoint: the transposed derivative of each recorded step, from the last to the first, at a
cost that hardly depends on the number of components that they are by."""

from __future__ import annotations

import copy
import ctypes
import functools
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from ..base.statuses import status_names
from ..codegen.adjoint_writer import adjoint_source, no_adjoint
from ..codegen.model import Model
from ..kernels import compiled_files, compiler, nvrtc
from ..kernels.devices import device_names
from ..models import delays, state_jumps
from ..models.components import Components
from ..models.event import Event, Stop
from ..models.methods import default
from ..models.noise import refuse_derivatives
from ..models.triggers_as_events import with_events
from ..solving.gather import ends_of
from ..sweeps.inputs import numbers, real
from ..symbolic import symbols as sym
from ..symbolic.expression import constant
from ..symbolic.node import symbols_of, text, walk
from ..symbolic.rewrite import substituted
from .forward import Forward

if TYPE_CHECKING:
    from ..models.any_model import AnyModel
    from ..results.run import Run
    from ..symbolic.node import Node
    from ..symbolic.types import Array

# Most bytes of records of a group of instances that are integrated at a time; a single instance may have more. On a
# CPU, for each thread, about what its part of the caches holds: with 64 MiB a gradient for 20 reactions took a tenth to
# a fifth more. On a GPU what gives all its threads work.
_most_bytes, _most_bytes_on_gpu = 1 << 23, 1 << 30


class Adjoint:
    """The quantities `of` as a function of the components `free`, and derivatives of losses that depend on them. Values
    of `free` are in rows, one for each instance; `samples` are a number of times or times, without which the quantities
    are those at the end; `options` are those of `solve`."""

    def __init__(self, model: AnyModel, free: Sequence[str], of: Sequence[Any], sweep: Mapping[str, Any],
                 start: Mapping[str, Any], options: Mapping[str, Any], samples: Any = None) -> None:
        self.model = _checked(model, free)
        self._actions = _actions(self.model)
        recorded, self._counters = _counting(self.model, self._actions)
        self._components = components = Components(model)
        self.free, self.of = list(free), list(of)
        options = _checked_options(options)
        for name in components.of(("state", "accessory")):
            if name not in self.free and components.follows(name, self.free, {*sweep, *start, *self.free}):
                raise no_adjoint(f"the initial value of '{name}' follows from components that derivatives are by")
        self.method = options.get("method") or default
        self._states = [sym.symbol("state", name) for name in components.states]
        self._wrt = [name for name in self.free if name not in components.states]  # chosen parameters
        self._times = _times(samples, options["time"])
        self._capacity, self._threads = 256, 1  # records of an instance, and threads, at first
        device = options["device"]
        self._gpu = int(device.partition(":")[2]) if device.startswith("cuda") else None
        self._most_on_gpu = _most_bytes_on_gpu
        self._place = [components.states.index(name) if name in components.states else
                       len(components.states) + self._wrt.index(name) for name in self.free]
        self._quantities = [self._quantity(one) for one in self.of]
        self._forward = Forward(recorded, self.free, sweep, {**start, **dict.fromkeys(self._counters, 0.0)}, {
            key: self._with_counters(value) if key in ("rtol", "atol") else value for key, value in options.items()})

    def _quantity(self, name: Any) -> Node:
        """A result as an expression of states, parameters and time."""
        components = self._components
        if name is sym.time or name not in [*components.states, *components.outputs]:
            raise no_adjoint(f"a result is {'the time of the end' if name is sym.time else repr(name)}, and states and "
                          "outputs alone have one")
        if name not in components.states:
            return substituted(components.outputs[name], components.constants)
        return sym.symbol("state", name)

    # The kernel

    def _source(self) -> str:
        """The file that is compiled."""
        return adjoint_source(self.model, self._wrt, self._quantities, self._actions, self.method,
                              "adjoint_library.hpp" if self._gpu is None else "device_adjoint.cuh")

    @functools.cached_property
    def _kernel(self) -> Any:
        if self._gpu is not None:
            return nvrtc.single_kernel(self._source(), "myriad_adjoint", self._gpu)
        by, source = compiler.compiler(), self._source()
        loaded = compiled_files.functions(by, source, lambda folder: compiler._compile(by, source, folder))
        function = loaded.myriad_adjoint
        function.argtypes, function.restype = [ctypes.c_void_p, ctypes.c_int64, ctypes.c_int64], None
        return function

    # What it computes

    def gradient(self, rows: Array, weights_of: Callable[[slice, Array], Array]) -> tuple[Array, Array, Array]:
        """The quantities at the times, [instance, time, quantity], derivatives of a loss by the components, [instance,
        component], and the statuses. `weights_of(part, values)` gives the derivatives of the loss by the values of a
        part of the instances. Instances that failed have NaN. They are integrated in groups whose records fit
        into 8 MiB for each thread, or 1 GiB of a GPU."""
        count, at = len(rows), self._times
        values = np.full((count, 1 if at is None else len(at), len(self.of)), np.nan)
        gradient = np.full((count, len(self.free)), np.nan)
        status = np.zeros(count, np.int32)
        first = 0
        while first < count:
            most = self._threads * _most_bytes if self._gpu is None else self._most_on_gpu
            group = max(1, most // (8 * (len(self._forward.states) + 1) * self._capacity))
            part = slice(first, min(count, first + group))
            run = self._record(rows[part])
            if self._gpu is not None and group > 1 and not run.device.has_samples():  # they took too much of its memory
                self._most_on_gpu //= 2
                del run  # and with it its memory, before the next one
                continue
            stored, kept = run.stored_samples, self._capacity
            longest = max(int(stored.max()), int(run.accepted_steps.max())) + 1
            self._capacity, self._threads = longest + longest // 8, run.report.threads  # for what follows
            if (stored >= kept).any():  # maybe not all steps were kept
                continue
            done = run.status_codes == status_names.index("success")
            self._check_actions(run, done)
            call = (_Call(run, at, self._components, self._counters) if self._gpu is None else
                    _CallOnGpu(run, at, self._components, self._counters, self._gpu))
            values[part] = call.values(self._kernel, len(self.of))
            values[part][~done] = np.nan
            weights = np.ascontiguousarray(weights_of(part, values[part]), float)
            found = call.gradient(self._kernel, np.where(done[:, None, None], weights, 0.0),
                                  len(self._states) + len(self._wrt))
            found[~(np.isfinite(found).all(axis=1) & done)] = np.nan
            gradient[part], status[part] = found[:, self._place], run.status_codes
            first = part.stop
            del run, call
        return values, gradient, status

    def _record(self, rows: Array) -> Run:
        """The run of some rows, with all steps as samples."""
        return self._forward.run(self._forward.of_rows(rows), samples={"every": 1, "capacity": self._capacity})

    def _check_actions(self, run: Run, done: Array) -> None:
        """Refuses actions at one time in instances that are done, unless all are of stops, in their order, and each
        acts once."""
        if not self._counters:
            return
        counts = np.stack([np.pad(run.samples[name], ((0, 0), (0, 1)), constant_values=np.nan)
                           for name in self._counters])
        ends = np.broadcast_to(run.stored_samples, counts.shape[:2])[..., None]
        np.put_along_axis(counts, ends, np.stack([run.states[name] for name in self._counters])[..., None], axis=2)
        acted = np.nan_to_num(np.diff(counts, axis=2))[:, done]
        of_events = acted[[isinstance(one, Event) for one in self._actions]].sum(axis=0)
        if (acted > 1).any() or ((of_events > 0) & (acted.sum(axis=0) > 1)).any():
            raise no_adjoint("an instance has several actions at one time, of an event and others, or of one stop")

    def _with_counters(self, tolerance: Any) -> Any:
        """Tolerances in the order of states, also of those that count actions."""
        if not self._counters or hasattr(tolerance, "items") or np.size(tolerance) == 1:
            return tolerance
        return [*np.asarray(tolerance, float), *[1.0] * len(self._counters)]


def _checked(model: AnyModel, by: Sequence[str]) -> Model:
    """The model. Refuses one that has no adjoint."""
    if not isinstance(model, Model):
        raise no_adjoint("the model is not traced from Python, but written in C++ or made of another")
    refuse_derivatives(model, "derivatives")
    delays.refuse(model, "derivatives")
    if model.mass_matrix is not None:
        raise no_adjoint("the model has a mass matrix")
    if model.located_switches:
        raise no_adjoint("its switches are located, by modes that the equations read")
    if model.triggers or model.queue is not None:
        by_events = with_events(model)
        if by_events is None:
            raise no_adjoint("the model has triggers that wait or have several comparisons")
        model = by_events
    switches = model.switches
    if any(target not in switches.at_start for target, _ in (*model.initialise, *model.after_step, *model.finalise)):
        raise no_adjoint("the model has hooks or accessories")
    if any(s.value[0] in ("accessory", "integer_accessory") and s not in switches.at_start
           for s in symbols_of(model.rhs)):
        raise no_adjoint("the equations read accessories")
    components = Components(model)
    if any(s.value[1] in by or components.follows(s.value[1], by, by) for s in switches.needed):
        raise no_adjoint("the equations jump at times that depend on components that derivatives are by")
    acting = _actions(model)
    for one in (*model.events, *model.stops):
        is_event = isinstance(one, Event)
        what = f"the {'event' if is_event else 'stop'} '{one.name}'"
        if isinstance(one, Event) and one.stop_after:
            raise no_adjoint(f"{what} ends phases")
        for target, value in one.do:
            if target in switches.at_start:
                continue
            if target in switches.needed:
                raise no_adjoint(f"{what} changes when the equations jump")
            if target.value[0] != "state":
                raise no_adjoint(f"{what} assigns {target.value[1]}, and no state")
            for symbol in symbols_of([value]):
                if symbol.value[0] not in ("state", "parameter", "shared", "shared_integer") and symbol is not sym.time:
                    raise no_adjoint(f"the action of {what} reads {symbol.value[1]}")
        if one in acting and isinstance(one, Stop) and any(s.value[1] in by for s in symbols_of(one.values)):
            raise no_adjoint(f"the time of {what} depends on components that derivatives are by")
        # where the slope jumps, that before an event is not known from its state
        if one in acting and is_event and (jump := next(filter(_may_jump, walk(model.rhs)), None)) is not None:
            raise no_adjoint(f"{what} acts, and the equations have `{text(jump)}`, which may jump there")
    state_jumps.refuse(model, "adjoint")
    return model


def _actions(model: Model) -> list[Any]:
    """The events and stops that change the state."""
    return [one for one in (*model.events, *model.stops) if any(
        target not in model.switches.at_start for target, _ in one.do)]


def _may_jump(node: Node) -> bool:
    """Whether an operation may jump along the solution."""
    jumping = ("select", "copysign", "floor", "rint", "fmod", "floor_mod", "floor_divide", "find_interval")
    decisive = node.args[:1] if node.op == "select" else node.args[1:] if node.op == "copysign" else [node]
    return node.op in jumping and any(s.value[0] == "state" or s is sym.time for s in symbols_of(decisive))


def _counting(model: Model, actions: Sequence[Event | Stop]) -> tuple[Model, list[str]]:
    """The model with a state for each action, which counts how often it acted, and their names. So the samples tell
    where actions were."""
    if not actions:
        return model, []
    taken = [*model.component_names, *model.outputs, *model.aliases]
    counters: dict[int, Any] = {}
    for one in actions:
        taken.append(sym.free_name(f"acted_{len(counters) + 1}", taken))
        counters[id(one)] = sym.symbol("state", taken[-1])
    names = [counter.value[1] for counter in counters.values()]

    def counted(one: Any) -> Any:
        made = copy.copy(one)
        if id(one) in counters:
            made.do = [*one.do, (counters[id(one)], counters[id(one)] + 1)]
        return made

    made = model.changeable()
    made.units_of_states = None
    made.rhs, made.states = [*model.rhs, *[constant(0.0)] * len(names)], [*model.states, *names]
    made.events, made.stops = [counted(e) for e in model.events], [counted(s) for s in model.stops]
    made._collect([sym.symbol("state", name) for name in made.states])
    return made, names


def _checked_options(options: Mapping[str, Any]) -> dict[str, Any]:
    """Options of `solve` that records of all steps are made with. Refuses those that an adjoint cannot have."""
    made = {key: value for key, value in options.items() if key not in ("samples", "sensitivity_control")}
    known = made.get("options")
    for name, usual in (("phases", 1), ("events", None), ("carry_on", False), ("phase_length", 0),
                        ("tolerance_scale", None)):
        given = made.get(name, usual if known is None else getattr(known, name, usual))
        if given != usual and given is not None:
            raise no_adjoint(f"{name}= is {given!r}")
    if made.get("precision", "double") != "double":
        raise no_adjoint("it is in double precision alone")
    if made.get("interpreted"):
        raise no_adjoint("the model is interpreted")
    if (device := made.get("device", "auto")) == "auto":
        device = "cpu"
    names, _ = device_names(device, None)
    if len(names) > 1:
        raise no_adjoint(f"device= names several devices, {', '.join(names)}")
    made["device"] = names[0]
    begin, end = ends_of(made.get("time"))
    if any(np.ndim(numbers(one, "time")) for one in (begin, end)):
        raise no_adjoint("the instances have time domains of their own")
    return made


def _times(samples: Any, domain: Any) -> Array | None:
    """The times of samples."""
    begin, end = (real(one, "time") for one in ends_of(domain))
    if samples is None:
        return None
    times = np.linspace(begin, end, int(samples)) if np.ndim(samples) == 0 else np.array(samples, float)
    sign = 1 if begin <= end else -1
    if times.ndim != 1 or not (np.diff(sign * times) > 0).all() or not (
            (sign * begin <= sign * times) & (sign * times <= sign * end)).all():
        raise no_adjoint("times of samples are out of order, differ between instances, or lie outside the time domain")
    return times


class _Call:
    """`adjoint_call` of adjoint_pack.hpp for a run of which all steps are recorded."""

    class _Arguments(ctypes.Structure):
        _fields_ = [("size", ctypes.c_int64), *((name, ctypes.c_void_p) for name in (
            "stored", "time", "state", "acted", "acted_in_all", "parameter", "shared", "shared_integer",
            "sample_time")),
            ("samples", ctypes.c_int64), ("values", ctypes.c_void_p), ("weights", ctypes.c_void_p),
            ("gradient", ctypes.c_void_p)]

    def __init__(self, run: Run, times: Array | None, components: Components, counters: Sequence[str]) -> None:
        ensemble = run._ensemble
        self._size, self._samples, self._threads = run.size, 1 if times is None else len(times), run.report.threads
        self._kept: list[Any] = [run]  # what addresses are of

        def all_of(kind: str) -> list[int]:
            return [self._address(run._last_values([kind])[name]) for name in components.names[kind]]

        def shared(kind: str, type: Any) -> Array:
            return np.array([ensemble.array(kind)[run._components.place[name][1]] for name in components.names[kind]],
                            type)

        self._arguments = self._Arguments(
            size=run.size, stored=self._address(np.ascontiguousarray(run.stored_samples, np.int32)),
            time=self._records(run, None), state=self._table([self._records(run, name) for name in components.states]),
            acted=self._table([self._records(run, name) for name in counters]),
            acted_in_all=self._table([self._address(run.states[name]) for name in counters]),
            parameter=self._table(all_of("parameter")), shared=self._address(shared("shared", float)),
            shared_integer=self._address(shared("shared_integer", np.int32)),
            sample_time=None if times is None else self._address(times), samples=self._samples)

    def _address(self, array: Array) -> int:
        """Of the values of an array, where the kernel reads them."""
        self._kept.append(array)
        return array.ctypes.data

    def _table(self, addresses: Sequence[int]) -> int:
        return self._address(np.array([*addresses, 0], np.uintp))

    def _records(self, run: Run, name: str | None) -> int:
        """The address of the records of a state, or of time."""
        return self._address(run._ensemble.samples(-1) if name is None else run.samples[name])

    def _run(self, kernel: Any, found: Array, result: str) -> Array:
        """Computes a result. Divides the instances among threads, by whole packs."""
        setattr(self._arguments, result, found.ctypes.data)
        part = max(64, -(-self._size // (4 * self._threads)) // 64 * 64)
        address = ctypes.addressof(self._arguments)
        parts = [(address, first, min(first + part, self._size)) for first in range(0, self._size, part)]
        if len(parts) == 1 or self._threads == 1:
            kernel(address, 0, self._size)
            return found
        with ThreadPoolExecutor(self._threads) as pool:
            for _ in pool.map(lambda one: kernel(*one), parts):
                pass
        return found

    def values(self, kernel: Any, quantities: int) -> Array:
        """The quantities at the times."""
        return self._run(kernel, np.full((self._size, self._samples, quantities), np.nan), "values")

    def gradient(self, kernel: Any, weights: Array, components: int) -> Array:
        """The derivatives of a loss that has these derivatives by the values."""
        self._arguments.values, self._arguments.weights = None, self._address(np.ascontiguousarray(weights))
        return self._run(kernel, np.full((self._size, components), np.nan), "gradient")


class _CallOnGpu(_Call):
    """The same for a run whose records are on a GPU. What else the kernel reads is copied there."""

    def __init__(self, run: Run, times: Array | None, components: Components, counters: Sequence[str],
                 gpu: int) -> None:
        self._gpu = gpu
        super().__init__(run, times, components, counters)

    def _address(self, array: Array) -> int:
        array = np.ascontiguousarray(array)
        memory = _core.GpuMemory(self._gpu, max(array.nbytes, 8))
        memory.write(0, array)
        self._kept.append(memory)
        return memory.address

    def _records(self, run: Run, name: str | None) -> int:
        return run.device.samples(name).address

    def _run(self, kernel: Any, found: Array, result: str) -> Array:
        setattr(self._arguments, result, self._address(found))
        kernel.run(bytes(self._arguments), self._size)
        self._kept.pop().read(0, found)
        return found
