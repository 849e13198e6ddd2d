# SPDX-License-Identifier: MIT
"""`solve`: checks names and shapes, fills an ensemble of the core, integrates it and hands the arrays over."""

from __future__ import annotations

import dataclasses
import functools
import time as clock
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from ..base.core_words import with_event_names
from ..base.errors import Error
from ..kernels.choose import kernel_for
from ..kernels.devices import device_names
from ..models import time_jumps
from ..models.any_model import AnyModel
from ..models.components import Components
from ..models.delays import refuse_history_steps, refuse_method
from ..models.located_switches import note_on_sliding
from ..models.methods import method_type
from ..models.noise import control_for, count_of_paths, method_for, refuse_options_of_paths
from ..models.once_per_phase import prepared
from ..models.sensitivities import WithSensitivities, note_on, with_sensitivities
from ..models.units import spread
from ..results.no_instances import EmptyEnsemble, EmptyReport, kernel as no_kernel
from ..results.past_states import PastStates
from ..results.report import Interrupted
from ..results.run import Run
from ..results.sensitivities import note
from ..sweeps.gpu_inputs import DeviceInput
from ..sweeps.inputs import numbers
from ..sweeps.sweep import Sweep, with_paths
from .core_options import finish_options, longest_step, make_options, options_of, takes_options
from .gather import fill, gather, given_values, refuse_backwards
from .options import Options, SolveArguments
from .past import prepare_past
from .progress import ProgressDisplay
from .sensitivity_options import start_derivatives, with_derivatives

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ..models.methods import Control, Method
    from ..symbolic.types import ByComponent, Precision, Progress, SomeComponents, Values


class Call:
    """A call of `solve`: what it computes, then its inputs and options, and at last what it has computed."""

    ensemble: Any
    report: Any
    kernel: Any
    failure: BaseException | None
    past: PastStates | None = None  # for outputs that read it

    def __init__(self, model: AnyModel, method: Method | None, control: Control | Sequence[Control],
                 precision: Precision, free: SomeComponents | None, sensitivity_control: bool) -> None:
        if precision not in ("double", "float"):
            raise Error(f"precision is {precision!r}: give \"double\" or \"float\"")
        if not isinstance(model, AnyModel):
            raise Error(f"the model is a {type(model).__name__}: make it by my.model(...), as in "
                        "my.solve(my.model({x: v, v: -x}), ...)")
        self.method, self.control, self.precision = method_for(model, method, precision), control, precision
        self.real = np.dtype("f8" if precision == "double" else "f4")
        if isinstance(model, WithSensitivities) and free is None and not sensitivity_control:
            model = with_sensitivities(model.model, model.free, control=False)
        self.model: AnyModel = (prepared(model) if free is None else
                                with_sensitivities(model, free, sensitivity_control))
        refuse_method(self.model, self.method)
        self.components = Components(self.model)

    def gather(self, sweep: Sweep | ByComponent | None, start: ByComponent | None, time: tuple[Values, Values] | None,
               size: int | None, options: Options, paths: int | None = None) -> None:
        """Takes inputs and options, and refuses those that do not fit."""
        if paths is not None:
            given = spread(sweep, "the sweep", None) if isinstance(sweep, Mapping) else sweep
            sweep = with_paths(given, count_of_paths(self.model, paths))
        values = given_values(self.components, sweep, start)
        if isinstance(self.model, WithSensitivities):
            self.components.defaults = {**self.components.defaults, **start_derivatives(self.model, values)}
        self.sweep = sweep
        self.given, self.domain, self.count = gather(self.components, values, sweep, time, size)
        refuse_backwards(self.model, *self.domain)
        if isinstance(self.model, WithSensitivities):
            options = with_derivatives(self.model, options, self.components)
        self.options = options
        self.control = control_for(self.model, self.method, self.control, options)
        method_type(self.method, self.control, options.samples is not None)  # refuses what does not exist
        refuse_options_of_paths(self.method, options.seed, options.noise_step)
        refuse_history_steps(self.model, options.history_steps)
        self.core_options, self.recorded, self.sampled = make_options(self.components, self.count, options)
        prepare_past(self.model, self.method, self.given, self.domain, options, self.core_options)

    def prepare(self, devices: Sequence[str], interpreted: bool | None) -> None:
        """Gets the kernels."""
        self._kernels = [kernel_for(device, self.model, self.components, self.method, self.control,
                                    self.options.samples is not None, self.precision, interpreted)
                         for device in devices]
        self.kernel, self._names = self._kernels[0]
        finish_options(self.core_options, self.options, self.components, len(self._names["state"]),
                       len(self._names["event"]))

    def filled(self) -> Any:
        """An ensemble that has all that is given."""
        kind: Any = _core.Ensemble64 if self.precision == "double" else _core.Ensemble32
        ensemble = kind(self.kernel.library, self._names, self.count)
        fill(ensemble, self.components, self.given, self.domain, self._names, self.real)
        return ensemble

    def integrate(self, devices: Sequence[str], tolerance_scale: Values | None, make_consistent: bool,
                  progress: Progress) -> None:
        """Fills the ensemble, and integrates it, once all is prepared."""
        display = ProgressDisplay(progress)
        try:
            self.ensemble = self.filled()
            takes_from_gpu = any(isinstance(array, DeviceInput) for array in self.given.values())
            if takes_from_gpu and devices[0].startswith("cuda"):
                _core.wait_for_gpu(int(devices[0].partition(":")[2]))  # for what other libraries do there
            if tolerance_scale is not None:
                self._scale_tolerances(tolerance_scale)
            # kernels see to it after `initialise`, without which equations are not what they will be
            after_hook = self.model.mass_matrix is not None and bool(self.model.initialise)
            if make_consistent and not after_hook:
                if takes_from_gpu:
                    raise Error("make_consistent=True changes arrays on the host, and some are on a GPU: copy them to "
                                "the host")
                _core.make_consistent(self.kernel.library, self.ensemble)
            self.report, self.failure = _core.solve([(k.library, d) for (k, _), d in zip(self._kernels, devices)],
                                                    self.ensemble, self.core_options, display if progress else None)
        except Error as error:
            raise with_event_names(error, self.components.event_names) from None
        finally:
            display.close()

    def _scale_tolerances(self, given: Values) -> None:
        scale = numbers(given, "tolerance_scale")
        if isinstance(scale, DeviceInput):
            raise Error("'tolerance_scale' is on a GPU: copy it to the host")
        if scale.ndim and len(scale) != self.count:
            raise Error(f"'tolerance_scale' has {len(scale)} values for {self.count} instances: give one for each")
        self.ensemble.array("tolerance_scale")[...] = scale

    def remember_past(self, given: Options, again: Callable[..., Run]) -> None:
        """Has outputs that read the past of samples get it from another run, by `again`."""
        if self.components.past_outputs and given.phases == 1:
            self.past = PastStates(lambda times: again(
                options=dataclasses.replace(given, samples={"times": times}, record=None)).samples)

    def run_of_none(self) -> Run:
        """The run of a sweep without instances, which needs no kernel."""
        record, samples = self.core_options.record, self.core_options.samples
        self.ensemble = EmptyEnsemble(self.components, self.given, self.real, samples.capacity)
        self.report = EmptyReport(max(self.core_options.phases - record.from_phase, 0), self.real)
        self.kernel, self.failure = no_kernel, None
        return self.run(0.0)

    def describe(self) -> dict[str, Any]:
        """What is solved, as plain values."""
        default = Options()
        controls = [self.control] if isinstance(self.control, str) else list(self.control)
        return {"model": self.model.name or "model", "source": self.model.source()[0], "method": self.method,
                "control": controls, "precision": self.precision,
                "options": {name: repr(value) for name, value in vars(self.options).items()
                            if value is not getattr(default, name) and repr(value) != repr(getattr(default, name))}}

    def run(self, seconds: float, note_of_device: str | None = None) -> Run:
        """What has been computed, in so many seconds. Raises what ended the computation."""
        notes = (note_of_device, time_jumps.note(self.model, longest_step(self.options)), note_on(self.model))
        run = Run(self.components, self.ensemble, self.report, self.kernel, self.sweep, self.given, self.domain,
                  self.recorded, self.sampled, seconds, self.core_options.record, [one for one in notes if one],
                  self.describe, self.past)
        if isinstance(self.model, WithSensitivities) and self.count and (undefined := note(run)) is not None:
            run.report.notes.append(undefined)
        if (sliding := note_on_sliding(self.model, run.report.by_status)) is not None:
            run.report.notes.append(sliding)
        if isinstance(self.failure, KeyboardInterrupt):
            raise Interrupted(run) from None
        if self.failure is not None:
            raise self.failure
        return run


def devices_of(device: str | Sequence[str], interpreted: bool | None) -> tuple[list[str], str | None]:
    """The devices of a call, and a note if there is no GPU for "auto"."""
    devices, no_gpu = device_names(device, interpreted)
    if len(devices) > 1 and not all(d.startswith("cuda") for d in devices):
        raise Error(f"device is {device!r}, and several devices of a call must be GPUs: name GPUs alone, or use "
                    "my.study, which uses CPU and GPUs together")
    return devices, no_gpu


@takes_options(SolveArguments)
def solve(model: AnyModel, sweep: Sweep | ByComponent | None = None, *, start: ByComponent | None = None,
          time: tuple[Values, Values] | None = None, method: Method | None = None,
          control: Control | Sequence[Control] = (),
          options: Options | None = None, tolerance_scale: Values | None = None, size: int | None = None,
          paths: int | None = None, precision: Precision = "double", device: str | Sequence[str] = "auto",
          interpreted: bool | None = None, make_consistent: bool = False, progress: Progress = None,
          free: SomeComponents | None = None, sensitivity_control: bool = True,
          **others: Unpack[SolveArguments]) -> Run:
    """Integrates a model for all instances of a sweep, and returns a `Run`.

    model             from `my.model(...)`
    sweep             values by component, `{k: np.linspace(0.2, 0.3, 1000), B: 0.3}`: arrays with one value for each
                      instance, or numbers for all; or `my.grid(...)`, `my.zip(...)`
    start             initial values of states (and accessories) by component, as in the sweep
    time              begin and end of the time domain in the model's unit; each a number, or an array with one value
                      for each instance; the end may be before the begin
    options           an `Options`, for several calls; those that are given by their names, below, come before it
    record            what to keep at the end of each phase: components, as in `[x, v]`, or
                      `dict(from_phase=, states=, accessories=, time=)`; `run["t"]` are the recorded times
    samples           dense output: a number of evenly spaced times, an array of times, or `dict(states=, evenly= |
                      times= | every=, capacity=, minimum_spacing=, from_phase=)`
    method, control   one of `my.methods`, by default "tsitouras_5", and for a model with noise "euler_maruyama"; one
                      or several of `my.controls`, of which "tolerance_per_instance" is with `tolerance_scale=`
    rtol, atol        tolerances of the error per step: numbers, lists in the order of the states, or dicts by state
    events            changes of `direction`, `tolerance` or `stop_after` of events by name
    size              number of instances, if no array gives it
    paths             so many paths of each instance of the sweep, for a model with noise: a last axis of the sweep, so
                      that path j of instance i is the instance i * paths + j. Arrays are in the sweep, not in start=
    precision         "double" or "float"
    device            "cpu", "cpu:4" (threads), "cuda", "cuda:1" (the second GPU), or "auto": the first GPU if there is
                      one, and NVRTC, and otherwise the CPU; or a list of GPUs, which divide the instances
    interpreted       True runs the model without compiling it, several times slower; None does so only where there
                      is no compiler, which the report tells
    make_consistent   True changes initial states so that they satisfy the algebraic equations of a model with a
                      singular mass matrix, by Newton's method, in directions that leave M y as it is; otherwise values
                      that do not are refused
    progress          True for a bar, or a function of the numbers of instances done and of all
    free              components that derivatives of the results are by, `run.sensitivity[x, k]`: initial states,
                      parameters, shared values, and `my.t_begin` and `my.t_end`, the ends of the time domain
    sensitivity_control  whether their errors take part in choosing the steps

    Raises `my.Error` if something is missing or does not fit, before any work. Ctrl-C raises `my.Interrupted`, whose
    `run` has what is done; instances that take more than half a second longer end as "interrupted".

    The options:"""
    begin = clock.perf_counter()
    given = options_of(options, others, solve)
    devices, no_gpu = devices_of(device, interpreted)
    call = Call(model, method, control, precision, free, sensitivity_control)
    call.gather(sweep, start, time, size, given, paths)
    if call.count == 0:
        return call.run_of_none()
    call.remember_past(given, functools.partial(
        solve, model, sweep, start=start, time=time, method=method, control=control, tolerance_scale=tolerance_scale,
        size=size, paths=paths, precision=precision, device=device, interpreted=interpreted,
        make_consistent=make_consistent))
    call.prepare(devices, interpreted)
    call.integrate(devices, tolerance_scale, make_consistent, progress)
    return call.run(clock.perf_counter() - begin, no_gpu)
