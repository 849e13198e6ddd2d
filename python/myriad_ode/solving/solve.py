# SPDX-License-Identifier: MIT
"""`solve`: checks names and shapes, fills an ensemble of the core, integrates it and hands the arrays over."""

from __future__ import annotations

import time as clock
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from ..base import component_kinds as kinds
from ..base.core_words import with_event_names
from ..base.errors import Error
from ..kernels.choose import kernel_for
from ..kernels.devices import device_names
from ..models import time_jumps
from ..models.any_model import AnyModel
from ..models.components import Components
from ..models.methods import default, fixed_step, method_type
from ..models.once_per_phase import prepared
from ..models.sensitivities import WithSensitivities, note_on, with_sensitivities
from ..results.no_instances import EmptyEnsemble, EmptyReport, kernel as no_kernel
from ..results.run import Interrupted, Run
from ..results.sensitivities import note
from ..sweeps.gpu_inputs import DeviceInput
from ..sweeps.inputs import numbers
from ..sweeps.sweep import Sweep
from .core_options import finish_options, longest_step, make_options, options_of, takes_options
from .gather import fill, gather, names_given
from .options import Options, SolveArguments
from .progress import ProgressDisplay
from .sensitivity_options import start_derivatives, with_derivatives

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ..models.methods import Control, Method
    from ..symbolic.types import ByComponent, Precision, Progress, SomeComponents, Values


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

    model             from `my.model(...)`
    sweep             values by component, `{k: np.linspace(0.2, 0.3, 1000), B: 0.3}`: arrays with one value for each
                      instance, or numbers for all; or `my.grid(...)`, `my.zip(...)`
    start             initial values of states (and accessories) by component, as in the sweep
    time              begin and end of the time domain in the model's unit; each a number, or an array with one value
                      for each instance; the end may be before the begin
    options           an `Options`, for several calls; those that are given by their names, below, come before it
    record            what to keep at the end of each phase: components, as in `[x, v]`, or
                      `dict(from_phase=, states=, accessories=, time=)`; `run["t"]` (`run["time"]` if the model has
                      a t of its own) or `run[my.time]` are the recorded times
    samples           dense output: a number of evenly spaced times, an array of times, or `dict(states=, evenly= |
                      times= | every=, capacity=, minimum_spacing=, from_phase=)`
    method, control   as in the C++ library: one of `my.methods`, by default "tsitouras_5"; control is one or
                      several of `my.controls`, of which "tolerance_per_instance" is with `tolerance_scale=`
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
                      parameters and shared values, and `my.t_begin` and `my.t_end`, the ends of the time
                      domain; `run.sensitivity[x, k]` are then the derivatives
    sensitivity_control  whether their errors take part in choosing the steps; without, the solution is that of a call
                      without sensitivities

    Raises `my.Error` if something is missing or does not fit, before any work. Ctrl-C raises
    `my.Interrupted`, whose `run` has what is done; instances that take more than half a second longer end as
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
                    "my.study, which uses CPU and GPUs together")
    if not isinstance(model, AnyModel):
        raise Error(f"the model is a {type(model).__name__}: make it by my.model(...), as in "
                    "my.solve(my.model({x: v, v: -x}), ...)")
    chosen = default if method is None else method
    if isinstance(model, WithSensitivities) and sensitivities is None and not sensitivity_control:
        model = with_sensitivities(model.model, model.by, control=False)
    model = prepared(model) if sensitivities is None else with_sensitivities(model, sensitivities, sensitivity_control)
    components = Components(model)
    if isinstance(model, WithSensitivities):
        components.defaults = {**components.defaults, **start_derivatives(
            model, names_given(components, sweep, start))}
    given, domain, count = gather(components, sweep, start, time, size)
    if isinstance(model, WithSensitivities):
        given_options = with_derivatives(model, given_options, components)
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
        fill(ensemble, components, given, domain, names, np.dtype("f8" if precision == "double" else "f4"))
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
    notes = [one for one in (no_gpu, time_jumps.note(model, longest_step(given_options)), note_on(model)) if one]
    run = Run(components, ensemble, report, kernel, sweep, _inputs(components, given), recorded, sampled,
              clock.perf_counter() - begin, core_options.record.from_phase, notes)
    if isinstance(model, WithSensitivities) and (undefined := note(run)) is not None:
        run.report.notes.append(undefined)
    if failure is not None:
        if isinstance(failure, KeyboardInterrupt):
            raise Interrupted(run) from None
        raise failure
    return run
