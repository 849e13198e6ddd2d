# SPDX-License-Identifier: MIT
"""`solve`: checks names and shapes, fills an ensemble of the core, integrates it and hands the arrays over."""

from __future__ import annotations

import time as clock
from collections.abc import Container, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core, compiler, kinds, nvrtc, tape, time_switches
from .any_model import AnyModel
from .components import Components, by_component, unknown
from .core_options import finish_options, make_options, options_of, takes_options
from .device import DeviceInput
from .empty import EmptyEnsemble, EmptyReport
from .empty import kernel as no_kernel
from .errors import Error
from .grid import Sweep
from .inputs import Along, by_name, numbers, whole, whole_numbers
from .mass_matrix import check_method
from .methods import default, fixed_step, method_type
from .options import Options, SolveArguments
from .per_phase import prepared
from .progress import ProgressDisplay
from .run import Interrupted, Run
from .sensitivities import WithSensitivities, note, note_on, with_sensitivities
from .statements import with_event_names

if TYPE_CHECKING:
    import numpy.typing as npt
    from typing_extensions import Unpack

    from .compiler import Kernel
    from .hints import ByComponent, Precision, Progress, SomeComponents, Values
    from .methods import Control, Method


def _sweep_values(sweep: Sweep | ByComponent | None) -> dict[str, Any]:
    """The values of a sweep by name: of an object like `myriad.grid(...)`, or of a dict."""
    if sweep is None:
        return {}
    if isinstance(sweep, Sweep):
        return {**{name: Along(sweep, name) for name in sweep.coordinates}, **sweep.constants}
    if hasattr(sweep, "items"):
        return by_component(sweep, "the sweep")
    raise Error(f"the sweep is a {type(sweep).__name__}: give a dict, as in {{k: np.linspace(0, 1, 100)}}, or "
                "myriad.grid(k=..., B=...)")


def ends_of(time: tuple[Values, Values] | None) -> tuple[Values, Values]:
    """Begin and end of the time domain."""
    if time is None:
        raise Error("time is missing: give begin and end, as in time=(0, 10)")
    try:
        begin, end = time
    except (TypeError, ValueError):
        raise Error(f"time is {time!r}: give begin and end, as in time=(0, 10)") from None
    return begin, end


def refuse_missing(components: Components, given: Container[str]) -> None:
    """Refuses a call that leaves out what every instance needs."""
    for what, names, where in (
            ("initial value", components.states, "start="),
            ("value", components.of(["parameter", *kinds.shared]), "the sweep")):
        missing = [n for n in names if n not in given]
        if missing:
            hint = ", as generate= sets instances of studies alone" if set(missing) & set(components.generated) else ""
            raise Error(f"the {what} of {', '.join(map(repr, missing))} is missing: give it in {where}{hint}")


def _gather(components: Components, sweep: Sweep | ByComponent | None, start: ByComponent | None,
            time: tuple[Values, Values] | None, size: int | None) -> tuple[dict[str, Any], tuple[Any, Any], int]:
    """All inputs by name, and the number of instances."""
    given = {}
    initial = by_component(by_name(start, "start", "start={x: 1, v: 0}"), "start=")
    for source, values, allowed in (("the sweep", _sweep_values(sweep), None),
                                  ("start=", initial, kinds.recorded)):
        for name, value in values.items():
            name = components.component(name)
            kind = components.place.get(name, (None,))[0]
            if kind is None or (allowed is not None and kind not in allowed):
                known = [n for n, (k, _) in components.place.items()
                         if n not in {*components.tables, *components.hidden} and (allowed is None or k in allowed)]
                raise unknown(name, known, f"component of the model that {source} can set")
            if name in given:
                raise Error(f"'{name}' is given in the sweep and in start=: give it once")
            given[name] = numbers(value, name)
    begin, end = ends_of(time)
    domain = numbers(begin, "begin of time"), numbers(end, "end of time")
    given = {name: value for name, value in components.completed(given, domain[0]).items() if value is not None}
    refuse_missing(components, given)
    lengths = {name: len(a) for name, a in (*given.items(), ("begin of time", domain[0]), ("end of time", domain[1]))
               if a.ndim == 1}
    if size is not None:
        lengths["size"] = whole(size, "size", 1 << 62)
    if isinstance(sweep, Sweep):
        lengths["the sweep"] = sweep.size
    if len(set(lengths.values())) > 1:
        (first, n), (other, m) = next((a, b) for a in lengths.items() for b in lengths.items() if a[1] != b[1])
        raise Error(f"'{first}' has {n} values and '{other}' has {m}: give one for each instance, or single numbers; "
                    "myriad.grid(...) combines all values with all")
    return given, domain, next(iter(lengths.values()), 1)


def _names_given(components: Components, sweep: Sweep | ByComponent | None, start: ByComponent | None) -> set[str]:
    """The components that a call gives values of."""
    return {components.component(name) for values in (_sweep_values(sweep), start or {}) for name in values}


def _fill(ensemble: Any, components: Components, given: Mapping[str, Any], domain: tuple[Any, Any],
          names: Mapping[str, Sequence[str]], real: npt.DTypeLike) -> None:
    for kind in kinds.of_instances:
        for number in range(len(components.names[kind]), len(names[kind])):  # which an interpreted model does not use
            ensemble.array(kind, number)[...] = 0
    for name, array in given.items():
        kind, number = components.place[name]
        if isinstance(array, DeviceInput):
            if kind not in ("state", "parameter"):
                raise Error(f"'{name}' is on a GPU, which only states and parameters can be: copy it to the host")
            if array.dtype != real:
                raise Error(f"'{name}' on the GPU has type {array.dtype}, and the run is in {real}: convert it there, "
                            "or give precision=")
            ensemble.set_on_device(kind, number, array.address)
        elif kind in ("state", "parameter"):
            values, repeat = (array.values, array.repeat) if isinstance(array, Along) else (array, 1)
            ensemble.spread(kind, number, np.ascontiguousarray(np.atleast_1d(values), dtype=real), repeat)
        elif kind in kinds.shared:
            if array.ndim == 1:
                raise Error(f"'{name}' is shared by all instances and has {len(array)} values: give one number, or "
                            "make it a parameter")
            ensemble.array(kind)[number] = whole_numbers(array, name) if kinds.every[kind].integer else array
        else:
            array = np.asarray(array)
            ensemble.array(kind, number)[...] = whole_numbers(array, name) if kinds.every[kind].integer else array
    if any(isinstance(array, DeviceInput) for array in domain):
        raise Error("the times are on a GPU: copy them to the host")
    if domain[0].ndim == 0 and domain[1].ndim == 0:
        ensemble.set_domain(float(domain[0]), float(domain[1]))
    else:
        ensemble.array("t_begin")[...] = domain[0]
        ensemble.array("t_end")[...] = domain[1]


def _device_name(device: str, interpreted: bool | None) -> tuple[str, str | None]:
    """The name of a device as the core knows it, and why "auto" takes no GPU where there is one."""
    device = str(device)
    # first, as the driver finds no GPU in a fork
    forked = ((device == "auto" or device.startswith("cuda")) and _core.driver_version() > 0
              and not _core.may_use_gpus())
    if device == "auto":
        if forked:
            return "cpu", "a GPU was not looked for, as this process was forked from one that has done so"
        if interpreted or _core.no_gpu():
            return "cpu", None
        if nvrtc.find() is None:
            return "cpu", "the GPU was not used, as there is no NVRTC: `pip install 'myriad[cuda]'`"
        return "cuda:0", None
    if forked:
        raise Error(f"device {device!r} is not available, as this process was forked from one that has looked for "
                    "GPUs: fork before that, start processes by \"spawn\", or use \"cpu\"")
    return _core.check_device(device), None


def device_names(device: str | Sequence[str], interpreted: bool | None) -> tuple[list[str], str | None]:
    """The names of one device or of several, each once, as the core knows them, and why "auto" takes no GPU."""
    named: Sequence[Any] = device if isinstance(device, (list, tuple)) else [device]
    for one in named:
        if not isinstance(one, str):
            raise Error(f"device {one!r} is unknown: use \"auto\", \"cpu\", \"cuda\", \"cuda:1\" for the second GPU, "
                        "or a list of such names")
    found = [_device_name(d, interpreted) for d in named]
    if not found:
        raise Error("device= names no device: leave it out, or give \"cpu\"")
    return list(dict.fromkeys(name for name, _ in found)), next((why for _, why in found if why), None)


def kernel_for(device: str, model: AnyModel, components: Components, method: str, control: str | Sequence[str],
               sampled: bool, precision: str, interpreted: bool | None) -> tuple[Kernel, dict[str, list[str]]]:
    """The kernel of a model and a method for a device of the core, and the names of all components that it has."""
    check_method(model, method)
    if not device.startswith("cuda"):
        return choose_kernel(model, components, method, control, sampled, precision, interpreted)
    if interpreted:
        raise Error("a model is interpreted on the CPU alone: leave out interpreted=, or give device=\"cpu\"")
    names = components.names
    return nvrtc.kernel(*model.device_source(method, precision), method_type(method, control, sampled), precision,
                        tuple(len(names[kind]) for kind in kinds.shared), int(device.partition(":")[2]),
                        bool(components.generated),
                        lambda library: tape.give_model(library, model, components, method)), names


def choose_kernel(model: AnyModel, components: Components, method: str, control: str | Sequence[str], sampled: bool,
                  precision: str, interpreted: bool | None) -> tuple[Kernel, dict[str, list[str]]]:
    """The kernel for a model and a method, compiled or interpreted, and the names of all components that it has."""
    written = method_type(method, control, sampled)
    if interpreted or (interpreted is None and compiler.known_compiler() is None):
        why = "as asked" if interpreted else "as there is no C++ compiler"
        if precision != "double" or control:
            raise Error(f"a model is interpreted, {why}, in double precision and with the usual control alone: leave "
                        "out precision= and control=, or install a C++ compiler")
        return tape.kernel(model, components, method, why), tape.padded(components)
    return compiler.kernel(*model.source(), written, precision), components.names


def _inputs(components: Components, given: Mapping[str, Any]) -> dict[str, Any]:
    """What results tell of the inputs."""
    return {name: array for name, array in given.items() if components.place[name][0] in (
        "state", "parameter", *kinds.shared)}


@takes_options(SolveArguments)
def solve(model: AnyModel, sweep: Sweep | ByComponent | None = None, *, start: ByComponent | None = None,
          time: tuple[Values, Values] | None = None, method: Method | None = None,
          control: Control | Sequence[Control] = (),
          options: Options | None = None, tolerance_scale: Values | None = None, size: int | None = None,
          precision: Precision = "double", device: str | Sequence[str] = "auto", interpreted: bool | None = None,
          make_consistent: bool = False, progress: Progress = None, sensitivities: SomeComponents | None = None,
          sensitivity_control: bool = True, **others: Unpack[SolveArguments]) -> Run:
    """Integrates a model for all instances of a sweep, and returns a `Run`.

    model             from `myriad.model(...)`
    sweep             values by component, `{k: np.linspace(0.2, 0.3, 1000), B: 0.3}`: arrays with one value for each
                      instance, or numbers for all; or `myriad.grid(...)`, `myriad.zip(...)`
    start             initial values of states (and accessories) by component, as in the sweep
    time              begin and end of the time domain in the model's unit; each a number, or an array with one value
                      for each instance; the end may be before the begin
    options           an `Options`, for several calls; those that are given by their names, below, come before it
    record            what to keep at the end of each phase: components, as in `[x, v]`, or
                      `dict(from_phase=, states=, accessories=, time=)`; `run["t"]` (`run["time"]` if the model has
                      a t of its own) or `run[myriad.time]` are the recorded times
    samples           dense output: a number of evenly spaced times, an array of times, or `dict(states=, evenly= |
                      times= | every=, capacity=, minimum_spacing=, from_phase=)`
    method, control   as in the C++ library: one of `myriad.methods`, by default "tsitouras_5"; control is one or
                      several of `myriad.controls`, of which "tolerance_per_instance" is with `tolerance_scale=`
    rtol, atol        tolerances of the error per step: numbers, lists in the order of the states, or dicts by state
    events            changes of `direction`, `tolerance` or `stop_after` of events by name
    size              number of instances, if no array gives it
    precision         "double" or "float"
    device            "cpu", "cpu:4" (threads), "cuda", "cuda:1" (the second GPU), or "auto", the first GPU if there is
                      one, and NVRTC to compile for it, and the CPU otherwise; or a list of GPUs, which divide the
                      instances among them, with the bits that one of them has
    interpreted       True runs the model without compiling it, several times slower; None does so only where there
                      is no compiler, which the report tells
    make_consistent   True changes initial states so that they satisfy the algebraic equations of a model with a
                      singular mass matrix, by Newton's method, in directions that leave M y as it is; otherwise values
                      that do not are refused
    progress          True for a bar, or a function of the numbers of instances done and of all
    sensitivities     components that derivatives of the results are wanted by, as in `[k, x]`: initial states,
                      parameters and shared values, and `myriad.t_begin` and `myriad.t_end`, the ends of the time
                      domain; `run.sensitivity[x, k]` are then the derivatives
    sensitivity_control  whether their errors take part in choosing the steps; without, the solution is that of a call
                      without sensitivities

    Raises `myriad.Error` if something is missing or does not fit, before any work. Ctrl-C raises
    `myriad.Interrupted`, whose `run` has what is done; instances that take more than half a second longer end as
    "interrupted".

    The options:"""
    begin = clock.perf_counter()
    given_options = options_of(options, others, solve)
    if precision not in ("double", "float"):
        raise Error(f"precision is {precision!r}: give \"double\" or \"float\"")
    devices, no_gpu = device_names(device, interpreted)
    on_gpu = devices[0].startswith("cuda")
    if len(devices) > 1 and not all(d.startswith("cuda") for d in devices):
        raise Error(f"device is {device!r}, and several devices of a call must be GPUs: name GPUs alone, or use "
                    "myriad.study, which uses CPU and GPUs together")
    if not isinstance(model, AnyModel):
        raise Error(f"the model is a {type(model).__name__}: make it by myriad.model(...), as in "
                    "myriad.solve(myriad.model({x: v, v: -x}), ...)")
    chosen = default if method is None else method
    if isinstance(model, WithSensitivities) and sensitivities is None and not sensitivity_control:
        model = with_sensitivities(model.model, model.by, control=False)
    model = prepared(model) if sensitivities is None else with_sensitivities(model, sensitivities, sensitivity_control)
    components = Components(model)
    if isinstance(model, WithSensitivities):
        components.defaults = {**components.defaults, **model.start_derivatives(_names_given(components, sweep, start))}
    given, domain, count = _gather(components, sweep, start, time, size)
    if isinstance(model, WithSensitivities):
        given_options = model.options(given_options, components)
    samples = given_options.samples is not None
    method_type(chosen, control, samples)  # refuses what does not exist
    if chosen in fixed_step and given_options.step is None:
        raise Error(f"{chosen} takes fixed steps: give step=")
    core_options, recorded, sampled = make_options(components, count, given_options)
    if count == 0:
        real = np.dtype("f8" if precision == "double" else "f4")
        from_phase = core_options.record.from_phase
        return Run(components, EmptyEnsemble(components, given, real, core_options.samples.capacity),
                   EmptyReport(max(core_options.phases - from_phase, 0), real), no_kernel, sweep,
                   _inputs(components, given), recorded, sampled, clock.perf_counter() - begin, from_phase)
    kernels = [kernel_for(d, model, components, chosen, control, samples, precision, interpreted)
               for d in devices]
    kernel, names = kernels[0]
    finish_options(core_options, given_options, components, len(names["state"]), len(names["event"]))
    kind: Any = _core.Ensemble64 if precision == "double" else _core.Ensemble32
    display = ProgressDisplay(progress)
    try:
        ensemble = kind(kernel.library, names, count)
        _fill(ensemble, components, given, domain, names, np.dtype("f8" if precision == "double" else "f4"))
        if on_gpu and any(isinstance(array, DeviceInput) for array in given.values()):
            _core.wait_for_gpu(int(devices[0].partition(":")[2]))  # for what other libraries do there
        if tolerance_scale is not None:
            scale = numbers(tolerance_scale, "tolerance_scale")
            if isinstance(scale, DeviceInput):
                raise Error("'tolerance_scale' is on a GPU: copy it to the host")
            if scale.ndim and len(scale) != count:
                raise Error(f"'tolerance_scale' has {len(scale)} values for {count} instances: give one for each")
            ensemble.array("tolerance_scale")[...] = scale
        # kernels see to it after `initialise`, without which equations are not what they will be
        after_hook = model.mass_matrix is not None and bool(model.initialise)
        if make_consistent and not after_hook:
            if any(isinstance(array, DeviceInput) for array in given.values()):
                raise Error("make_consistent=True changes arrays on the host, and some are on a GPU: copy them to the "
                            "host")
            _core.make_consistent(kernel.library, ensemble)
        report, failure = _core.solve([(k.library, d) for (k, _), d in zip(kernels, devices)], ensemble,
                                      core_options, display if progress else None)
    except Error as error:
        raise with_event_names(error, components.event_names) from None
    finally:
        display.close()
    notes = [one for one in (no_gpu, time_switches.note(model, given_options), note_on(model)) if one]
    run = Run(components, ensemble, report, kernel, sweep, _inputs(components, given), recorded, sampled,
              clock.perf_counter() - begin, core_options.record.from_phase, notes)
    if isinstance(model, WithSensitivities) and (undefined := note(run)) is not None:
        run.report.notes.append(undefined)
    if failure is not None:
        if isinstance(failure, KeyboardInterrupt):
            raise Interrupted(run) from None
        raise failure
    return run
