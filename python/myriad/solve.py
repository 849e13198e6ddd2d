# SPDX-License-Identifier: MIT
"""`solve`: checks names and shapes, fills an ensemble of the core, integrates it and hands the arrays over."""

import inspect
import itertools
import math
import time as clock

import numpy as np

from . import _core, compiler, nvrtc, tape
from .components import Components, by_component, unknown
from .device import DeviceInput, is_on_gpu
from .empty import EmptyEnsemble, EmptyReport, kernel as no_kernel
from .errors import Error, refuse_masked, refuse_options, with_event_names
from .grid import Sweep, as_numbers
from .methods import default, fixed_step, method_type
from .run import Interrupted, Run

_directions = {"falling": -1, "either": 0, "rising": 1, "none": 2}
_default_event_tolerance = 0.0  # as close as t and the state resolve
_schedules = {"automatic": 0, "in_order": 1, "dynamic": 2, "by_cost": 3}


class _Along:
    """Values of a grid along one of its axes, as an array of one value per instance that is not made until needed."""

    ndim = 1

    def __init__(self, sweep, name):
        self._sweep, self._name = sweep, name
        self.values, self.repeat = sweep.along(name)
        self.dtype = self.values.dtype

    def __len__(self):
        return self._sweep.size

    def __array__(self, dtype=None, copy=None):
        return self._sweep.values(self._name).astype(dtype or self.dtype, copy=False)


def _numbers(value, name):
    """A number, or an array of one dimension, of real numbers; arrays on a GPU stay there."""
    if isinstance(value, _Along):
        return value
    if is_on_gpu(value):
        return DeviceInput(value, name)
    refuse_masked(value, f"'{name}'")
    array = as_numbers(value)
    if array.dtype.kind == "c":
        raise Error(f"'{name}' is complex: a model is real, so give real and imaginary parts as two components")
    if array.dtype.kind not in "biuf":
        raise Error(f"'{name}' is {value!r}: give a number, or an array with one number per instance")
    if array.ndim > 1:
        raise Error(f"'{name}' has {array.ndim} dimensions: give one number per instance, in one dimension; "
                    "myriad.grid(...) makes a sweep over several axes")
    return array


def _whole_numbers(array, name):
    """The values of an integer component: whole numbers of 32 bits."""
    least, largest = -(1 << 31), (1 << 31) - 1
    values = array.astype(float)
    wrong = np.flatnonzero((array != np.floor(array)) | ~((values >= least) & (values <= largest)))
    if wrong.size:
        raise Error(f"'{name}' is an integer and has the value {array.flat[wrong[0]]}: give whole numbers between "
                    f"{least} and {largest}")
    return array.astype(np.int32)


def _sweep_values(sweep):
    """The values of a sweep by name: of an object like `myriad.grid(...)`, or of a dict."""
    if sweep is None:
        return {}
    if isinstance(sweep, Sweep):
        return {**{name: _Along(sweep, name) for name in sweep.coordinates}, **sweep.constants}
    if hasattr(sweep, "items"):
        return by_component(sweep, "the sweep")
    raise Error(f"the sweep is a {type(sweep).__name__}: give a dict, as in {{k: np.linspace(0, 1, 100)}}, or "
                "myriad.grid(k=..., B=...)")


def ends_of(time):
    """Begin and end of the time domain."""
    if time is None:
        raise Error("time is missing: give begin and end, as in time=(0, 10)")
    try:
        begin, end = time
    except (TypeError, ValueError):
        raise Error(f"time is {time!r}: give begin and end, as in time=(0, 10)") from None
    return begin, end


def refuse_missing(components, given):
    """Refuses a call that leaves out what every instance needs."""
    for what, names, where in (
            ("initial value", components.states, "start="),
            ("value", components.parameters + components.shared + components.shared_integers, "the sweep")):
        missing = [n for n in names if n not in given]
        if missing:
            hint = ", as generate= sets instances of studies alone" if set(missing) & set(components.generated) else ""
            raise Error(f"the {what} of {', '.join(map(repr, missing))} is missing: give it in {where}{hint}")


def _gather(components, sweep, start, time, size):
    """All inputs by name, and the number of instances."""
    given = {}
    initial = by_component(_by_name(start, "start", "start={x: 1, v: 0}"), "start=")
    for source, values, kinds in (("the sweep", _sweep_values(sweep), None),
                                  ("start=", initial, ("state", "accessory", "integer_accessory"))):
        for name, value in values.items():
            kind = components.place.get(name, (None,))[0]
            if kind is None or (kinds is not None and kind not in kinds):
                known = [n for n, (k, _) in components.place.items()
                         if n not in components.tables and (kinds is None or k in kinds)]
                raise unknown(name, known, f"component of the model that {source} can set")
            if name in given:
                raise Error(f"'{name}' is given in the sweep and in start=: give it once")
            given[name] = _numbers(value, name)
    given = {**{name: np.asarray(value) for name, value in components.defaults.items()}, **given}
    refuse_missing(components, given)
    begin, end = ends_of(time)
    domain = _numbers(begin, "begin of time"), _numbers(end, "end of time")
    lengths = {name: len(a) for name, a in (*given.items(), ("begin of time", domain[0]), ("end of time", domain[1]))
               if a.ndim == 1}
    if size is not None:
        lengths["size"] = _whole(size, "size", 1 << 62)
    if isinstance(sweep, Sweep):
        lengths["the sweep"] = sweep.size
    if len(set(lengths.values())) > 1:
        (first, n), (other, m) = next(((a, b) for a in lengths.items() for b in lengths.items() if a[1] != b[1]))
        raise Error(f"'{first}' has {n} values and '{other}' has {m}: give one for each instance, or single numbers; "
                    "myriad.grid(...) combines all values with all")
    return given, domain, next(iter(lengths.values()), 1)


def _fill(ensemble, components, given, domain, names, real):
    for kind, known, all_names in (("state", components.states, names[0]),
                                   ("parameter", components.parameters, names[1]),
                                   ("accessory", components.accessories, names[4])):
        for number in range(len(known), len(all_names)):  # which an interpreted model does not use
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
            values, repeat = (array.values, array.repeat) if isinstance(array, _Along) else (array, 1)
            ensemble.spread(kind, number, np.ascontiguousarray(np.atleast_1d(values), dtype=real), repeat)
        elif kind in ("shared", "shared_integer"):
            if array.ndim == 1:
                raise Error(f"'{name}' is shared by all instances and has {len(array)} values: give one number, or "
                            "make it a parameter")
            ensemble.array(kind)[number] = _whole_numbers(array, name) if kind == "shared_integer" else array
        else:
            array = np.asarray(array)
            ensemble.array(kind, number)[...] = _whole_numbers(array, name) if kind == "integer_accessory" else array
    if any(isinstance(array, DeviceInput) for array in domain):
        raise Error("the times are on a GPU: copy them to the host")
    if domain[0].ndim == 0 and domain[1].ndim == 0:
        ensemble.set_domain(float(domain[0]), float(domain[1]))
    else:
        ensemble.array("t_begin")[...] = domain[0]
        ensemble.array("t_end")[...] = domain[1]


def _per_state(value, components, name, count):
    """One tolerance for all states, one for each in their order, or a dict by state; those that it leaves out get the
    default. For `count` states, of which those beyond the model's are not used."""
    if hasattr(value, "items"):
        values = [1e-8] * len(components.states)
        for state, tolerance in by_component(value, name).items():
            if state not in components.states:
                raise unknown(state, components.states, "state of the model")
            values[components.states.index(state)] = _real(tolerance, f"{name} of '{state}'")
    else:
        values = [float(v) for v in np.atleast_1d(_numbers(value, name))]
    if len(values) not in (1, len(components.states)):
        raise Error(f"{name} has {len(values)} values, but the model has {len(components.states)} state components: "
                    "give one value for all, or one for each")
    return values + [1.0] * (count - len(components.states)) if len(values) == len(components.states) > 1 else values


_largest = (1 << 31) - 1


def _whole(value, name, largest=_largest):
    try:
        is_whole = not isinstance(value, (bool, np.bool_, str)) and float(value).is_integer()
    except (TypeError, ValueError, OverflowError):
        is_whole = False
    if not is_whole:
        raise Error(f"{name} is {value!r}: give a whole number")
    if not -largest <= value <= largest:
        raise Error(f"{name} is {value}: give a number up to {largest}")
    return int(value)


def _real(value, name):
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise Error(f"{name} is {value!r}: give a number") from None


def _by_name(value, name, example):
    """The dict that an option is."""
    if value is not None and not hasattr(value, "items"):
        raise Error(f"{name} is {value!r}: give a dict by name, as in {example}")
    return value or {}


def _only(options, known, what):
    for name in options:
        if name not in known:
            raise unknown(name, list(known), f"choice of {what}")


_record_choices = ("from_phase", "states", "accessories", "time")
_sample_choices = ("states", "capacity", "evenly", "times", "every", "minimum_spacing", "from_phase")


def _set_records(options, record, components):
    """What of records is asked for: the names of recorded components with kind and number."""
    if record is None:
        return {}
    record = dict(record) if hasattr(record, "items") else {"states": record}
    _only(record, _record_choices, "record=")
    kinds = ("state", "accessory", "integer_accessory")
    named = components.numbers(record.get("states", ()), "record=", kinds)
    others = components.numbers(record.get("accessories", ()), "record=", kinds)
    state, real, integer = (a + b for a, b in zip(named, others))
    with_time = bool(record.get("time", False))
    options.record(_whole(record.get("from_phase", 0), "record from_phase"), state, real, integer, with_time)
    places = {components.states[c]: ("state", c) for c in state}
    places.update((components.accessories[c], ("accessory", c)) for c in real)
    places.update((components.integer_accessories[c], ("integer_accessory", c)) for c in integer)
    if with_time:
        names = itertools.chain(("t", "time"), (f"time_{i}" for i in itertools.count(1)))
        places[next(n for n in names if n not in components.place)] = ("time", 0)
    return places


def _set_samples(options, samples, components, phases, phase_length, size):
    """What of dense output is asked for: the names of sampled states with their numbers."""
    if samples is None:
        return {}
    if not hasattr(samples, "items"):
        samples = {"evenly": samples} if np.ndim(samples) == 0 else {"times": samples}
    _only(samples, _sample_choices, "samples=")
    states, = components.numbers(samples.get("states", components.states), "samples=", ("state",))
    evenly = _whole(samples.get("evenly", 0), "samples evenly")
    every = _whole(samples.get("every", 0), "samples every")
    from_phase = _whole(samples.get("from_phase", 0), "samples from_phase")
    refuse_masked(samples.get("times"), "samples times")
    try:
        times = np.asarray(samples.get("times", ()), dtype=float)
    except (TypeError, ValueError):
        raise Error(f"samples times are {samples['times']!r}: give numbers") from None
    if sum((evenly != 0, every != 0, times.size > 0)) != 1:
        raise Error("samples= asks for no samples, or in several ways: give the number of evenly spaced times, the "
                    "times, or dict(every=, capacity=) for every n-th step")
    if times.ndim == 2 and len(times) != size:
        raise Error(f"the sample times have {len(times)} rows for {size} instances: give one row for each, or the same "
                    "times for all in one dimension")
    if times.ndim > 2:
        raise Error("the sample times have more than two dimensions: give one row for each instance, or one for all")
    own = times.ravel() if times.ndim == 2 else ()
    capacity = samples.get("capacity")
    if capacity is None:
        if every:
            raise Error("samples every n-th step need capacity=, the number of samples to keep per instance")
        sampled = max(phases - from_phase, 1)
        given = times.shape[-1] * (1 if phase_length else sampled)
        capacity = evenly * sampled if evenly else given
    options.sample(states, _whole(capacity, "samples capacity"), evenly, [] if times.ndim == 2 else times.tolist(),
                   list(own), every, _real(samples.get("minimum_spacing", 0), "samples minimum_spacing"),
                   from_phase)
    return {components.states[c]: c for c in states}


def _set_events(options, events, components, count):
    """Options of events: the model's own, replaced by those that the call gives by name; for `count` events."""
    changed = {}
    for key, value in _by_name(events, "events", "events={\"impact\": dict(stop_after=5)}").items():
        name = key if isinstance(key, str) else getattr(key, "name", None)
        if name not in components.event_names:
            raise unknown(str(name), components.event_names, "event of the model")
        _only(value, ("direction", "tolerance", "stop_after"), f"event '{name}'")
        changed[name] = value
    for event in components.events:
        of_call = changed.get(event.name, {})
        direction = of_call.get("direction", event.direction)
        if not isinstance(direction, str) or direction not in _directions:
            raise Error(f"the direction of event '{event.name}' is {direction!r}: give \"falling\", \"rising\" or "
                        "\"either\"")
        tolerance = of_call.get("tolerance", event.tolerance)
        tolerance = _default_event_tolerance if tolerance is None else _real(tolerance, "tolerance")
        options.add_event(_directions[direction], tolerance,
                          _whole(of_call.get("stop_after", event.stop_after), "stop_after"))
    for _ in range(len(components.events), count):
        options.add_event(0, _default_event_tolerance, 0)


def _progress_function(progress):
    """The function to call with the numbers of instances done and of all, and what to do at the end."""
    if not progress:
        return None, lambda: None
    if callable(progress):
        return progress, lambda: None
    try:
        from tqdm.auto import tqdm
    except ImportError:
        raise Error("progress=True shows a bar of the package tqdm, which is missing: `pip install tqdm`, or give a "
                    "function of two numbers, instances done and all") from None
    bar = tqdm(unit="instance", unit_scale=True)

    def show(done, total):
        bar.total = total
        bar.update(done - bar.n)

    return show, bar.close


def _device_name(device, interpreted):
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


def _positive_infinity(value):
    return math.inf if value is None else _real(value, "maximum_step")


def make_options(components, size, *, phases, record, samples, step, minimum_step, maximum_step, growth_limit,
                 shrink_limit, max_steps, time_limit, phase_length, carry_on, carry_on_step, sub_samples,
                 accumulation_limit, schedule, advice):
    """The core's options, but for tolerances and events, and the places of what is recorded and sampled, by name."""
    options = _core.Options()
    options.phases = _whole(phases, "phases")
    options.step = math.nan if step is None else _real(step, "step")
    options.minimum_step = _real(minimum_step, "minimum_step")
    options.maximum_step = _positive_infinity(maximum_step)
    options.growth_limit = _real(growth_limit, "growth_limit")
    options.shrink_limit = _real(shrink_limit, "shrink_limit")
    options.max_steps = _whole(max_steps, "max_steps", 1 << 62)
    options.time_limit = 0 if time_limit is None else _real(time_limit, "time_limit")
    options.phase_length = _real(phase_length, "phase_length")
    options.carry_on(bool(carry_on), bool(carry_on_step))
    options.sub_samples = _whole(sub_samples, "sub_samples")
    options.accumulation_limit = _whole(accumulation_limit, "accumulation_limit")
    if not advice:
        options.without_advice()
    if not isinstance(schedule, str) or schedule not in _schedules:
        raise Error(f"there is no schedule {schedule!r}: choose one of {', '.join(_schedules)}")
    options.set_schedule(_schedules[schedule])
    recorded = _set_records(options, record, components)
    sampled = _set_samples(options, samples, components, options.phases, options.phase_length, size)
    return options, recorded, sampled


def device_names(device, interpreted):
    """The names of one device or of several, each once, as the core knows them, and why "auto" takes no GPU."""
    named = [device] if isinstance(device, str) else list(device) if isinstance(device, (list, tuple)) else [device]
    for one in named:
        if not isinstance(one, str):
            raise Error(f"device {one!r} is unknown: use \"auto\", \"cpu\", \"cuda\", \"cuda:1\" for the second GPU, "
                        "or a list of such names")
    found = [_device_name(d, interpreted) for d in named]
    if not found:
        raise Error("device= names no device: leave it out, or give \"cpu\"")
    return list(dict.fromkeys(name for name, _ in found)), next((why for _, why in found if why), None)


def kernel_for(device, model, components, method, control, sampled, precision, interpreted):
    """The kernel of a model and a method for a device of the core, and the names of all components that it has."""
    if not device.startswith("cuda"):
        return choose_kernel(model, components, method, control, sampled, precision, interpreted)
    if interpreted:
        raise Error("a model is interpreted on the CPU alone: leave out interpreted=, or give device=\"cpu\"")
    names = components.names
    return nvrtc.kernel(*model.source(), method_type(method, control, sampled), precision,
                        (len(names[2]), len(names[3])), int(device.partition(":")[2]),
                        bool(components.generated)), names


def choose_kernel(model, components, method, control, sampled, precision, interpreted):
    """The kernel for a model and a method, compiled or interpreted, and the names of all components that it has."""
    written = method_type(method, control, sampled)
    if interpreted or (interpreted is None and compiler.known_compiler() is None):
        why = "as asked" if interpreted else "as there is no C++ compiler"
        if precision != "double" or control:
            raise Error(f"a model is interpreted, {why}, in double precision and with the usual control alone: leave "
                        "out precision= and control=, or install a C++ compiler")
        return tape.kernel(model, components, method, why), tape.padded(components)
    return compiler.kernel(*model.source(), written, precision), components.names


def _inputs(components, given):
    """What results tell of the inputs."""
    return {name: array for name, array in given.items() if components.place[name][0] in (
        "parameter", "shared", "shared_integer", "state")}


def _first_recorded(record):
    """The number of the first phase that is recorded."""
    return int(dict(record).get("from_phase", 0)) if hasattr(record, "items") else 0


def solve(model, sweep=None, *, start=None, time=None, phases=1, record=None, samples=None, method=None, control=(),
          rtol=1e-8, atol=1e-8, step=None, minimum_step=0, maximum_step=None, growth_limit=5, shrink_limit=0.1,
          max_steps=1_000_000, time_limit=None, phase_length=0, carry_on=False, carry_on_step=False, events=None,
          sub_samples=1, accumulation_limit=50, tolerance_scale=None, invalid="refuse", schedule="automatic", size=None,
          precision="double", device="auto", interpreted=None, advice=True, progress=None, **unknown):
    """Integrates a model for all instances of a sweep, and returns a `Run`.

    model             from `myriad.model(...)`
    sweep             values by component, `{k: np.linspace(0.2, 0.3, 1000), B: 0.3}`: arrays with one value for each
                      instance, or numbers for all; or `myriad.grid(...)`, `myriad.zip(...)`
    start             initial values of states (and accessories) by component, as in the sweep
    time              begin and end of the time domain in the model's unit; each a number, or an array with one value
                      for each instance; the end may be before the begin
    phases            integration phases, each from begin to end unless `phase_length` or `carry_on` says otherwise
    record            what to keep at the end of each phase: components, as in `[x, v]`, or
                      `dict(from_phase=, states=, accessories=, time=)`; `run["t"]` (`run["time"]` if the model has
                      a t of its own) or `run[myriad.time]` are the recorded times
    samples           dense output: a number of evenly spaced times, an array of times, or `dict(states=, evenly= |
                      times= | every=, capacity=, minimum_spacing=, from_phase=)`
    method, control   as in the C++ library: "tsitouras_5" (default), "dormand_prince_5", "cash_karp", "verner_7",
                      "dormand_prince_8", "runge_kutta_4", "rosenbrock_23", "rodas_5p"; control is one or several of
                      "pi_control", "pid_control", "rms_norm", "mixed_scale", "automatic_first_step",
                      "tolerance_per_instance", the last with `tolerance_scale=`
    rtol, atol        tolerances of the error per step: numbers, lists in the order of the states, or dicts by state
    step              the fixed step, or the first one of an adaptive method, which else follows from the slope, the
                      tolerances and the domain
    max_steps         trial steps in a phase, after which an instance ends as "max_steps"
    time_limit        seconds after which the call returns: what is left ends as "interrupted"
    carry_on          phases begin where the last one ended, as for phases that events end
    carry_on_step     phases begin with the step size that the last one would have tried next, and not with `step`:
                      for many short phases of a smooth motion
    events            changes of `direction`, `tolerance` or `stop_after` of events by name
    invalid           "refuse" inputs that are not finite, or "mark" their instances as invalid_input
    size              number of instances, if no array gives it
    precision         "double" or "float"
    device            "cpu", "cpu:4" (threads), "cuda", "cuda:1" (the second GPU), or "auto", the first GPU if there is
                      one, and NVRTC to compile for it, and the CPU otherwise; or a list of GPUs, which divide the
                      instances among them, with the bits that one of them has
    interpreted       True runs the model without compiling it, several times slower; None does so only where there
                      is no compiler, which the report tells
    advice            False leaves out the notes of the report that take some work: whether stability limits the steps
                      of an explicit method, and whether phases are too long for the smallest Lyapunov exponent
    progress          True for a bar, or a function of the numbers of instances done and of all

    Raises `myriad.Error` if something is missing or does not fit, before any work. Ctrl-C raises
    `myriad.Interrupted`, whose `run` has what is done; instances that take more than half a second longer end as
    "interrupted"."""
    begin = clock.perf_counter()
    refuse_options(unknown, inspect.signature(solve).parameters, "solve")
    if precision not in ("double", "float"):
        raise Error(f"precision is {precision!r}: give \"double\" or \"float\"")
    devices, no_gpu = device_names(device, interpreted)
    on_gpu = devices[0].startswith("cuda")
    if len(devices) > 1 and not all(d.startswith("cuda") for d in devices):
        raise Error(f"device is {device!r}, and several devices of a call must be GPUs: name GPUs alone, or use "
                    "myriad.study, which uses CPU and GPUs together")
    if isinstance(model, type) or not hasattr(model, "source"):
        raise Error(f"the model is a {type(model).__name__}: make it by myriad.model(...), as in "
                    "myriad.solve(myriad.model({x: v, v: -x}), ...)")
    method = default if method is None else method
    components = Components(model)
    given, domain, count = _gather(components, sweep, start, time, size)
    method_type(method, control, samples is not None)  # refuses what does not exist
    if method in fixed_step and step is None:
        raise Error(f"{method} takes fixed steps: give step=")
    options, recorded, sampled = make_options(
        components, count, phases=phases, record=record, samples=samples, step=step, minimum_step=minimum_step,
        maximum_step=maximum_step, growth_limit=growth_limit, shrink_limit=shrink_limit, max_steps=max_steps,
        time_limit=time_limit, phase_length=phase_length, carry_on=carry_on, carry_on_step=carry_on_step,
        sub_samples=sub_samples, accumulation_limit=accumulation_limit, schedule=schedule,
        advice=advice)
    if invalid == "mark":
        options.mark_invalid()
    elif invalid != "refuse":
        raise Error(f"invalid is {invalid!r}: give \"refuse\" or \"mark\"")

    if count == 0:
        real = np.dtype("f8" if precision == "double" else "f4")
        from_phase = _first_recorded(record)
        return Run(components, EmptyEnsemble(components, given, real, options.sample_capacity),
                   EmptyReport(max(options.phases - from_phase, 0), real), no_kernel, sweep, _inputs(components, given),
                   recorded, sampled, clock.perf_counter() - begin, from_phase)
    kernels = [kernel_for(d, model, components, method, control, samples is not None, precision, interpreted)
               for d in devices]
    kernel, names = kernels[0]
    options.set_tolerances(_per_state(rtol, components, "rtol", len(names[0])),
                           _per_state(atol, components, "atol", len(names[0])))
    _set_events(options, events, components, len(names[-1]))
    kind = _core.Ensemble64 if precision == "double" else _core.Ensemble32
    function, finish = _progress_function(progress)
    try:
        ensemble = kind(kernel.library, *names, count)
        _fill(ensemble, components, given, domain, names, np.dtype("f8" if precision == "double" else "f4"))
        if on_gpu and any(isinstance(array, DeviceInput) for array in given.values()):
            _core.wait_for_gpu(int(devices[0].partition(":")[2]))  # for what other libraries do there
        if tolerance_scale is not None:
            scale = _numbers(tolerance_scale, "tolerance_scale")
            if isinstance(scale, DeviceInput):
                raise Error("'tolerance_scale' is on a GPU: copy it to the host")
            if scale.ndim and len(scale) != count:
                raise Error(f"'tolerance_scale' has {len(scale)} values for {count} instances: give one for each")
            ensemble.array("tolerance_scale")[...] = scale
        report, failure = _core.solve([(k.library, d) for (k, _), d in zip(kernels, devices)], ensemble, options,
                                      function)
    except Error as error:
        raise with_event_names(error, components.event_names) from None
    finally:
        finish()
    run = Run(components, ensemble, report, kernel, sweep, _inputs(components, given), recorded, sampled,
              clock.perf_counter() - begin, _first_recorded(record), [no_gpu] if no_gpu else [])
    if failure is not None:
        if isinstance(failure, KeyboardInterrupt):
            raise Interrupted(run) from None
        raise failure
    return run
