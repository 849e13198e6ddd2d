# SPDX-License-Identifier: MIT
"""The options of `solve` and `study`. Written by scripts/options.py from the table of options."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, TypedDict

from ..symbolic.types import Component, NotGiven, SomeComponents, Tolerance, Values

__all__ = ["EventChoice", "Options", "RecordChoice", "SampleChoice"]


class EventChoice(TypedDict, total=False):
    """How an event is detected, instead of what the model says.

    direction: which sign changes count, in the direction of integration
    tolerance: value of the event function up to which an event is located; 0: as closely as t and the state resolve (in
        [0, inf), in the function's unit)
    stop_after: detections in a phase that end it, as `stopped_by_event`; 0: never (in [0, 2000000000])
    """

    direction: Literal["falling", "either", "rising", "none"]
    tolerance: float
    stop_after: int


class RecordChoice(TypedDict, total=False):
    """What is kept at the end of each phase.

    from_phase: first phase of the call that is kept (in [0, inf))
    states: states to keep at the end of each phase
    accessories: accessories to keep
    time: whether the time is kept
    """

    from_phase: int
    states: SomeComponents
    accessories: SomeComponents
    time: bool


class SampleChoice(TypedDict, total=False):
    """Dense output: exactly one of `evenly`, `times` and `every` says at which times.

    states: states to sample along every trajectory
    capacity: samples kept per instance, over all phases and calls (in [1, 2000000000])
    evenly: number of evenly spaced times in each phase, ends included (in 0 or [2, 2000000000])
    times: or these times in each phase (in the model's unit of time)
    every: or the ends of every n-th accepted step (in 0 or [1, 2000000000])
    minimum_spacing: least time between samples by steps (in [0, inf), in the model's unit of time)
    from_phase: first phase of the call that is sampled (in [0, inf))
    """

    states: SomeComponents
    capacity: int
    evenly: int
    times: Values
    every: int
    minimum_spacing: float
    from_phase: int


class StudyArguments(TypedDict, total=False):
    """Options of `study`, by keyword."""

    phases: int
    rtol: Tolerance
    atol: Tolerance
    step: float | None
    minimum_step: float
    maximum_step: float | None
    growth_limit: float
    shrink_limit: float
    max_steps: int
    carry_on: bool
    phase_length: float
    carry_on_step: bool
    noise_step: float
    history_steps: int
    events: Mapping[Component, EventChoice] | None
    sub_samples: int
    accumulation_limit: int
    record: SomeComponents | RecordChoice | None
    samples: Values | SampleChoice | None
    advice: bool
    schedule: Literal["automatic", "in_order", "dynamic", "by_cost"]


class SolveArguments(StudyArguments, total=False):
    """Options of `solve`, by keyword."""

    time_limit: float
    seed: int
    invalid: Literal["refuse", "mark"]


@dataclass(frozen=True, kw_only=True)
class Options:
    """The options of a call of `solve` or `study`, to be given as `options=`, or each by its name.

    phases: integration phases in this call (in [1, 1000000000])
    rtol: error per step over the magnitude of a state: one value, or one per state (in [0, inf))
    atol: error per step: one value, or one per state (in [0, inf), in the state's unit)
    step: first step of a phase, which else follows from slope, tolerances and domain; for fixed steps their length,
        which must be given (in (0, inf), in the model's unit of time)
    minimum_step: smallest step size; 0: the resolution of t (in [0, inf), in the model's unit of time)
    maximum_step: largest step size (in (0, inf], in the model's unit of time)
    growth_limit: largest factor from one step to the next (in [1, inf))
    shrink_limit: smallest factor from one step to the next (in (0, 1))
    max_steps: trial steps per phase; an instance that needs more ends as `max_steps`; 0: 200 000 adaptive steps, or 2e9
        fixed ones (in single precision 1.6e7) (in 0 or [1, 2000000000])
    time_limit: time from the beginning of the call after which what is left ends as `interrupted`: instances under way
        where they are, the others as they were; 0: no limit (in [0, inf], in seconds)
    carry_on: a phase starts at t_begin, or where the last one ended (`carry_on`), for phases that events or hooks end
    phase_length: time continues from phase to phase, and phases end at t_begin + length, + 2 length, ...; 0: phases go
        to t_end (in [0, inf), in the model's unit of time)
    carry_on_step: a phase starts with `step`, or with the last step size (`carry_on`)
    seed: seed of the paths of a stochastic equation (in [0, 4294967295])
    noise_step: cells of these paths: steps that are a multiple of one, or a number of 65536ths of one, follow the same
        path; the longest adaptive step; 0: the step, or for adaptive ones a 64th of the domain or phase (in [0, inf),
        in the model's unit of time)
    history_steps: steps of the past that are kept of each instance of a model with delays; 0: 256 adaptive steps, 1024
        fixed ones, or in Python those of the longest constant lag (in [0, 1048576], in steps)
    events: how events are detected: one entry for each; none: defaults for all
    sub_samples: points per step at which event functions are evaluated, and with two or more also where they turn: what
        crosses zero and comes back within a step is found (in [1, 10000])
    accumulation_limit: repeated actions of one event without leaving its surface, after which the instance ends as
        `event_accumulation` (in [1, 65535])
    record: what to keep at the end of each phase
    samples: dense output, in C++ of a method `dense<method>`
    advice: whether to check after the call, if it took many steps, for stiffness (with some evaluations of `rhs` on the
        host) and for phases too long for Lyapunov exponents
    invalid: for inputs that are not finite, or new states or parameters of instances that have ended: refuse the call,
        or mark the former, skip the latter, and run the rest
    schedule: order in which instances are integrated; changes no bit of the results
    """

    phases: int = 1
    rtol: Tolerance = NotGiven(1e-8)
    atol: Tolerance = NotGiven(1e-8)
    step: float | None = None
    minimum_step: float = 0
    maximum_step: float | None = None
    growth_limit: float = 5
    shrink_limit: float = 0.1
    max_steps: int = 0
    time_limit: float = 0
    carry_on: bool = False
    phase_length: float = 0
    carry_on_step: bool = False
    seed: int = 0
    noise_step: float = 0
    history_steps: int = 0
    events: Mapping[Component, EventChoice] | None = None
    sub_samples: int = 1
    accumulation_limit: int = 50
    record: SomeComponents | RecordChoice | None = None
    samples: Values | SampleChoice | None = None
    advice: bool = True
    invalid: Literal["refuse", "mark"] = "refuse"
    schedule: Literal["automatic", "in_order", "dynamic", "by_cost"] = "automatic"
