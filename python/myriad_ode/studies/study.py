# SPDX-License-Identifier: MIT
"""Studies: ensembles of any size along axes by name, computed chunk by chunk, kept in a store in which they go on after
a stop, and handed to any executor. The C++ library's `study` with a model of Python's."""

from __future__ import annotations

import dataclasses
import functools
import hashlib
import os
import pickle
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from .. import _core
from ..base import html
from ..base.component_kinds import recorded as recorded_kinds
from ..base.core_words import in_words, with_event_names
from ..base.errors import Error
from ..kernels import nvrtc
from ..kernels.choose import kernel_for
from ..kernels.devices import device_names
from ..models import time_jumps
from ..models.any_model import AnyModel
from ..models.components import Components, listed
from ..models.delays import refuse_history_steps
from ..models.located_switches import note_on_sliding
from ..models.methods import method_type, stochastic
from ..models.noise import control_for, count_of_paths, method_for, refuse_options_of_paths
from ..models.once_per_phase import prepared
from ..models.sensitivities import note_on
from ..models.whole_numbers import check_whole_numbers
from ..results.report import Interrupted
from ..solving.core_options import finish_options, longest_step, make_options, options_of, takes_options
from ..solving.gather import ends_of, full_name, refuse_backwards
from ..solving.options import Options, StudyArguments
from ..solving.past import prepare_past
from ..solving.progress import ProgressDisplay
from ..sweeps.inputs import by_name, only, path_text, real, text, whole
from ..sweeps.sweep import Sweep
from ..symbolic.functions import draws
from ..symbolic.node import Node
from ..symbolic.symbols import time as time_symbol
from .executed_run import ExecutedRun
from .instances import set_instances
from .outputs import with_outputs
from .reduce import Reduction
from .result import StudyResult

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ..kernels.compiler import Kernel
    from ..models.methods import Control, Method
    from ..symbolic.types import ByComponent, Path, Precision, Progress, SomeComponents

__all__ = ["Study", "study"]

_keep_choices = ("end", "records", "samples", "random", "status", "work")


class Study:
    """A parameter study, made by `study`. `run` computes it."""

    def __init__(self, model: AnyModel, sweep: Any, options: dict[str, Any]) -> None:
        self._given, self._has_store = (model, sweep, options), False
        self._build(model, sweep, **options)

    def __reduce__(self) -> tuple[Any, ...]:
        return Study, self._given

    # -- What the study is --------------------------------------------------------------------------------------------

    def _build(self, model: AnyModel, sweep: Sweep | ByComponent | None, *, start: ByComponent | None,
               time: tuple[Any, Any] | None, keep: SomeComponents | Mapping[str, Any] | None,
               reduce: Reduction | Sequence[Reduction], draws: int | None, paths: int | None, seed: int | None,
               title: str, units: Mapping[Any, str] | None, notes: Mapping[str, object] | None, method: Method | None,
               control: Control | Sequence[Control], options: Options, precision: Precision,
               interpreted: bool | None) -> None:
        if not isinstance(model, AnyModel):
            raise Error(f"the model is a {type(model).__name__}: make it by my.model(...)")
        if precision not in ("double", "float"):
            raise Error(f"precision is {precision!r}: give \"double\" or \"float\"")
        model, sweep = _computed_by(model, sweep)
        model, start = _computed_by(model, start)
        chosen = method_for(model, method, precision)
        control = control_for(model, chosen, control, options)
        reductions = _reductions(reduce)
        model, options = with_outputs(model, keep, options, reductions)
        model = prepared(model)
        components = self._components = Components(model)
        seed = whole(options.seed if seed is None else seed, "seed", (1 << 63) - 1)
        options = dataclasses.replace(options, seed=seed if chosen in stochastic else 0)
        refuse_options_of_paths(chosen, options.seed, options.noise_step)
        refuse_history_steps(model, options.history_steps)
        samples = options.samples
        _refuse_own_samples(samples)
        core_options, recorded, sampled = make_options(components, 0, options)
        finish_options(core_options, options, components, len(components.states), len(components.events))
        core_options.invalid_instances = "mark"
        self._interpreted = interpreted
        self._notes = [one for one in (time_jumps.note(model, longest_step(options)), note_on(model)) if one]
        self._kernels: dict[str, Kernel] = {}
        self._kernel_for = lambda device: kernel_for(device, model, components, chosen, control, samples is not None,
                                                     precision, self._interpreted)
        try:
            made = self._core = _core.Study(
                {kind: [model.called.get(name, name) for name in names] for kind, names in components.names.items()},
                list(components.tables.values()), model.generator,
                "float64" if precision == "double" else "float32", model.name or "model",
                method_type(chosen, control, samples is not None).replace("myriad::", ""))
            refuse_backwards(model, *_known_ends(time))
            instances = set_instances(made, components, sweep, start, time, draws is not None or paths is not None)
            values = instances.values
            prepare_past(model, chosen, values, (values.get("t_begin"), values.get("t_end")), options, core_options)
            self._own_domains = instances.own_domains
            made.options(core_options)
            self._looks_at_domains = bool(samples is not None or options.phase_length or options.carry_on)
            if draws is not None:
                made.repeat(whole(draws, "draws", 1 << 62), "draw")
            if paths is not None:
                made.repeat(count_of_paths(model, paths), "path")
            made.seed(seed & ((1 << 64) - 1))
            check_whole_numbers(model.generate, made.size, instances.shared_integers)
            self._name = functools.partial(_name, model, components)
            self._set_kept(made, components, keep, bool(recorded or sampled or reduce or core_options.record.time))
            for reduction in reductions:
                made.reduce(reduction.core())
            self._describe(made, components, model, title, units, notes)
        except Error as error:
            raise with_event_names(error, components.event_names) from None

    def _describe(self, made: _core.Study, components: Components, model: AnyModel, title: str,
                  units: Mapping[Any, str] | None, notes: Mapping[str, object] | None) -> None:
        """What tells the study from others."""
        of_model = {name: unit for name, unit in components.units.items() if name in components.place}
        for key, unit in {**of_model, **by_name(units, "units", "units={x: \"m\"}")}.items():
            name = "t" if key is time_symbol else self._name(key)
            made.unit(name, text(unit, f"the unit of '{name}'"))
        if title:
            made.title(text(title, "the title"))
        values = np.array(list(components.tables.values()), float)
        made.note("model", hashlib.sha256(model.source()[0].encode() + values.tobytes()).hexdigest()[:32])
        for key, value in by_name(notes, "notes", "notes={\"who\": \"...\"}").items():
            key = text(key, "the key of a note")
            made.note(f"user.{key}", text(value, f"the note '{key}'"))

    def _set_kept(self, made: _core.Study, components: Components, keep: Any, anything_else: bool) -> None:
        if keep is None:
            keep = {} if anything_else else {
                "end": [name for name in components.of(recorded_kinds) if name not in components.hidden]}
        elif not hasattr(keep, "items"):
            keep = {"end": keep}
        only(keep, _keep_choices, "keep=")
        end = keep.get("end", ())
        end = listed(end)
        names = ["t" if key is time_symbol else self._name(key) for key in end]
        made.keep(names, *(bool(keep.get(choice, choice != "work")) for choice in _keep_choices[1:]))

    @property
    def size(self) -> int:
        """The number of instances."""
        return self._core.size

    def __len__(self) -> int:
        return self.size

    def __repr__(self) -> str:
        return f"<myriad study of {self.size} instances>"

    def _repr_html_(self) -> str:
        return html.table([("study of", f"{self.size} instances"), ("model", repr(self._given[0]))])

    # -- The run ------------------------------------------------------------------------------------------------------

    def _use(self, devices: Sequence[str], chunk: int | None) -> None:
        """Sets the devices of the next run, and gets their kernels."""
        for device in devices:
            if device not in self._kernels:
                if device.startswith("cuda"):
                    if self._components.generated and self._own_domains and self._looks_at_domains:
                        raise Error("the model generates its instances, and each has a time domain of its own, which a "
                                    "GPU cannot look at for samples=, phase_length= or carry_on=: use device=\"cpu\", "
                                    "or give the same time= to all")
                    nvrtc.load_study_kernels(int(device.partition(":")[2]))
                self._kernels[device], names = self._kernel_for(device)
                self._core.add_kernel(device, self._kernels[device].library, names)
        self._runs_interpreted = any(self._kernels[d].origin.startswith("interpreted") for d in devices)
        self._core.note("kernel", "interpreted" if self._runs_interpreted else "compiled")
        self._core.set_run(devices, whole(chunk or 0, "chunk", 1 << 62))

    def run(self, store: Path | None = None, *, device: str | Sequence[str] = "auto", chunk: int | None = None,
            executor: Any = None, check: Literal["sizes", "checksums"] = "sizes", expiry: float = 60,
            arithmetic: Literal["same", "any"] = "same", progress: Progress = None) -> StudyResult:
        """Computes what is not there yet, and returns a `StudyResult`.

        store      a folder, in which the study goes on if it is run again, also by several processes at a time, each
                   with this call; it is a Zarr group (version 3). None: results are in memory
        device     a device or a list of devices, which are used at the same time: "cpu", "cpu:4", "cuda", "cuda:1", or
                   "auto", which is as in `solve`; with an executor the devices of each worker, by default "cpu:1"
        chunk      instances that are computed and stored together; None: by memory and number. A store keeps its own
        executor   any executor of `concurrent.futures`, as ProcessPoolExecutor or one of Dask, loky, mpi4py and
                   Parsl: its workers compute chunks, and send their values here, where they are kept
        check      what is looked at of a store that exists: "sizes" of files, or "checksums", for which all is read
        expiry     seconds after which chunks of a process on another machine that gives no sign of life are taken over;
                   infinity: never
        arithmetic "same": a store that another instruction set, compiler or library began is refused, since results
                   differ in their last digits; "any": it is gone on with, and `warnings` says so
        progress   True for a bar, or a function of the numbers of instances done and of all

        A GPU that fails is left out with a warning, and its chunks are done by the other devices. GPUs of one kind give
        the same bits; a CPU's results differ by rounding errors.

        Ctrl-C ends a run when the chunks under way are done, or after ten seconds, and raises `my.Interrupted`,
        whose `run` has what is done; so does the store, in which the next run goes on. Raises `my.Error` if the
        store is of another study, with what differs, if a disk is full, and if a worker of an executor dies; what was
        done stays in the store, and of an executor's run `error.result` has it."""
        if check not in ("sizes", "checksums"):
            raise Error(f"check is {check!r}: give \"sizes\" or \"checksums\"")
        if arithmetic not in ("same", "any"):
            raise Error(f"arithmetic is {arithmetic!r}: give \"same\" or \"any\"")
        folder = "" if store is None else os.path.abspath(path_text(store))
        if device == "auto" and executor is not None:
            device = "cpu:1"
        devices, no_gpu = device_names(device, self._interpreted)
        show = ProgressDisplay(progress)
        try:
            if not folder and self._has_store:  # from an earlier run
                self._build(*self._given[:2], **self._given[2])
            seconds = real(expiry, "expiry")
            if not seconds >= 1e-3:
                raise Error(f"expiry is {expiry!r}: give seconds, 0.001 or more, or infinity for never")
            self._core.set_store(folder, min(seconds, 1e9), check == "checksums", arithmetic == "any")
            self._has_store = bool(folder)
            if executor is not None:
                return ExecutedRun(self, executor, devices, chunk, folder or None, show).run()
            self._use(devices, chunk)
            (results, facts), failure = self._core.run(show)
            result = self._result(results, facts, folder or None, [*([no_gpu] if no_gpu else []), *self._notes])
            if failure is not None:
                if isinstance(failure, KeyboardInterrupt):
                    raise Interrupted(result) from None
                raise failure
            return result
        except Error as error:
            raise with_event_names(error, self._components.event_names) from error.__cause__
        finally:
            show.close()

    def _result(self, results: _core.Results, facts: Mapping[str, Any], folder: str | None,
                notes: Iterable[str] = ()) -> StudyResult:
        sliding = note_on_sliding(self._given[0], facts.get("by_status", {}))
        origins = dict.fromkeys(kernel.origin for kernel in self._kernels.values())
        return StudyResult(results, folder, {**facts, "kernel": ", ".join(origins),
                                              "notes": [*map(in_words, facts["notes"]), *notes,
                                                        *([sliding] if sliding else [])]})

    def payload(self) -> bytes:
        """This study as bytes, for other processes, which are to run the same kernel. By cloudpickle if it is there,
        which takes functions of scripts along."""
        try:
            import cloudpickle as by
        except ImportError:
            by = pickle
        model, sweep, options = self._given
        try:
            return by.dumps((Study, (model, sweep, {**options, "interpreted": self._runs_interpreted})))
        except Exception as error:
            raise Error("the study cannot be sent to the workers of an executor, as it does not pickle: "
                        f"{error}") from None


def _name(model: AnyModel, components: Components, key: Any) -> str:
    """What the core's study calls a component."""
    kind, dot, name = full_name(components, key).rpartition(".")
    return kind + dot + model.called.get(name, name)


def _reductions(given: Reduction | Sequence[Reduction]) -> list[Reduction]:
    """Those of a study as a list."""
    several: list[Any] = list(given) if isinstance(given, (list, tuple)) else [given] if given else []
    for one in several:
        if not isinstance(one, Reduction):
            raise Error(f"reduce= has {one!r}: give reductions, as in [my.reduce.mean(\"x_end\")]")
    return several


def _known_ends(time: tuple[Any, Any] | None) -> tuple[Any, Any]:
    """Begin and end of time, where both are numbers; else NaN."""
    given = (None, None) if time is None else ends_of(time)
    return given if all(isinstance(one, (int, float)) for one in given) else (np.nan, np.nan)


def _refuse_own_samples(samples: Any) -> None:
    """Refuses sample times of each instance."""
    times: Any = samples.get("times", ()) if isinstance(samples, Mapping) else samples
    if np.ndim(times) > 1:
        raise Error("a study has no sample times for each instance: give the same times for all, or a number of "
                    "evenly spaced ones")


def _computed_by(model: AnyModel, given: Any) -> tuple[AnyModel, Any]:
    """The model that also computes what is given as expressions, where instances are integrated, and the rest of what
    is given. A single draw is none of these: the core draws it."""
    def is_expression(value: Any) -> bool:
        return isinstance(value, Node) and (value.op not in draws or any(b.op != "constant" for b in value.args))

    computed = {} if not isinstance(given, Mapping) else {k: v for k, v in given.items() if is_expression(v)}
    if not computed:
        return model, given
    return model.with_generated(computed), {k: v for k, v in given.items() if k not in computed}


@takes_options(StudyArguments)
def study(model: AnyModel, sweep: Sweep | ByComponent | None = None, *, start: ByComponent | None = None,
          time: tuple[Any, Any] | None = None, keep: SomeComponents | Mapping[str, Any] | None = None,
          reduce: Reduction | Sequence[Reduction] = (), draws: int | None = None, paths: int | None = None,
          seed: int | None = None, title: str = "", units: Mapping[Any, str] | None = None,
          notes: Mapping[str, object] | None = None, method: Method | None = None,
          control: Control | Sequence[Control] = (), options: Options | None = None, precision: Precision = "double",
          interpreted: bool | None = None, **others: Unpack[StudyArguments]) -> Study:
    """A parameter study of a model: a `Study`, which `.run(...)` computes, in memory that does not grow with its size.
    What `generate=` of the model sets is given neither in the sweep nor in start.

    sweep     as in `solve`: `my.grid(...)` for all combinations of its axes, or a dict whose arrays go together.
              Besides arrays and numbers, values are `my.linspace(a, b, n)`, `my.geomspace(a, b, n)`, of which
              none is stored, and `my.uniform(a, b)`, `my.normal(mean, deviation)`, which draw a
              value for each instance. States and `my.t_begin`, `my.t_end` may have axes too. A dict may also have
              expressions, of draws and of parameters and shared values, as `my.lognormal(5, 0.3) * (weight / 70)`,
              which `generate=` of the model then computes
    start     initial values, as in `solve`
    time      begin and end; None for one that is in the sweep
    keep      components whose last values are kept, `my.time` for the time at which the last phase ended; or
              `dict(end=, records=, samples=, random=, status=, work=)`, of which all but work are True: whether
              records, samples, random values,
              statuses, and the numbers of steps are kept. By default all states, accessories and outputs of a file
              if nothing is recorded, sampled or reduced
    reduce    reductions over all instances, `my.reduce.mean("x_end")` and others, or over some axes,
              `my.reduce.mean("x_end", over="path")`
    draws     instances for each point of the other axes, as for random values
    paths     so many paths of each of these instances, for a model with noise, along a last axis "path". Each is an
              instance, with random values of its own
    seed      of random values: those along axes depend on it, the component and the instance's number alone, and those
              that `generate=` of the model draws on it, the draw and the instance's number; and of the paths of a model
              with noise. By default that of `options`
    units     {component: unit} for results; notes: {key: text}, anything that tells this study from others, such as the
              version of data: a store that was made with other notes is refused

    method, control, precision, interpreted, options, record, samples, events, rtol and atol are as in `solve`.
    Inputs that are not finite mark their instances as invalid_input. Results have the names of a run's: "x" at recorded
    phases, "x_sample", "x_end", "t_last", "status"; of initial values "x_start". Raises `my.Error`.

    The options:"""
    return Study(model, sweep, dict(
        start=start, time=time, keep=keep, reduce=reduce, draws=draws, paths=paths, seed=seed,
        title=title, units=units, notes=notes,
        method=method, control=control, options=options_of(options, others, study), precision=precision,
        interpreted=interpreted))
