# SPDX-License-Identifier: MIT
"""Problems in version 2 of PEtab as tables of version 1: experiments become initial values and events of the SBML, and
conditions that tell experiments apart."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...base.errors import Error
from ..sbml.math import Refused
from .formulas import written
from .periods import Period, Periods
from .priors import read_prior_2

_noise = {"normal": ("normal", "lin"), "log-normal": ("normal", "log"), "laplace": ("laplace", "lin"),
          "log-laplace": ("laplace", "log")}


@dataclass
class Tables:
    """The tables of a problem, as version 1 has them, and its SBML. `begins` has the time at which the experiment of a
    condition begins, `names` what it is called, and `measured` is the table of measurements as it was given."""

    parameter_df: Any
    observable_df: Any
    measurement_df: Any
    condition_df: Any
    sbml: str
    sbml_model: Any
    begins: dict[str, float]
    names: dict[str, str]
    measured: Any


def is_version_2(name: str) -> bool:
    """Whether a file says that it is of version 2; what is no such file is for petab to tell."""
    import yaml
    try:
        with open(name, encoding="utf-8") as file:
            content = yaml.safe_load(file)
    except (OSError, UnicodeDecodeError, yaml.YAMLError):
        return False
    return isinstance(content, dict) and str(content.get("format_version", "")).split(".")[0] == "2"


def read_version_2(name: str) -> Tables:
    """The problem of a YAML file of PEtab, version 2, as tables of version 1. Raises `Refused` for what petab finds
    wrong and for what is not supported."""
    try:
        from petab import v2
        from petab.v2.lint import ValidationIssueSeverity
    except ImportError:
        raise Error("problems in version 2 of PEtab need a newer package petab: `pip install -U petab`") from None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # those about events are checked here
        try:
            problem = v2.Problem.from_yaml(name)
            found = problem.validate()
        except Exception as error:  # of any kind, by pydantic, pandas, yaml and petab
            raise Refused(f"petab cannot read '{name}': {error}") from None
        wrong = [issue.message for issue in found if issue.level >= ValidationIssueSeverity.ERROR]
        if wrong:
            raise Refused(f"'{name}' is no valid problem of PEtab: {' '.join(' '.join(map(str, wrong)).split())}")
    _check(problem)
    measured, of_experiments = problem.measurement_df, _periods(problem)
    made = Periods(problem.model.to_sbml_str(), list(of_experiments.values()))
    conditions, measurements = _experiments(of_experiments, made, measured)
    begins = {f"{name}_": next(p.time for p in periods if np.isfinite(p.time)) for name, periods in
              of_experiments.items() if np.isfinite(periods[-1].time)}
    return Tables(_parameters(problem), _observables(problem), measurements, conditions, made.text,
                  problem.model.sbml_model, begins, {f"{name}_": name for name in of_experiments}, measured)


def _check(problem: Any) -> None:
    """Refuses what has no counterpart."""
    if len(problem.models) != 1 or problem.model.type_id != "sbml":
        raise Refused("read_petab reads problems of a single model, of SBML")
    if problem.config is not None and problem.config.extensions:
        raise Refused(f"the problem has the extension {', '.join(problem.config.extensions)}: read_petab knows none")
    for row in problem.mappings:
        if row.model_id is not None and row.model_id != row.petab_id:
            raise Refused(f"the mapping table, row '{row.petab_id}': read_petab renames nothing: use the id "
                          f"'{row.model_id}' of the model in the tables")
    model = problem.model.sbml_model
    ruled = {r.getVariable() for r in model.getListOfRules() if r.isAssignment()}
    for condition in problem.conditions:
        for change in condition.changes:
            where = f"the condition table, row '{condition.id}', target {change.target_id}"
            if change.target_id in ruled:
                raise Refused(f"{where}: a rule of the model sets it")
            if model.getElementBySId(change.target_id) is None:
                raise Refused(f"{where}: the model has nothing of that id")


def _periods(problem: Any) -> dict[str, list[Period]]:
    """The periods of each experiment, in the order of time; and one of measurements without an experiment."""
    found = {e.id: [Period(float(p.time), {
        c.target_id: written(c.target_value)
        for c in problem.get_changes_for_period(p)}) for p in e.sorted_periods] for e in problem.experiments}
    if any(m.experiment_id is None for m in problem.measurements):
        found[""] = []
    for name, periods in found.items():
        if not periods:
            periods.append(Period(0.0, {}))
        _check_times(problem, name, [p.time for p in periods])
    return found


def _is_at_rest(periods: Sequence[Period]) -> bool:
    """Whether an experiment is a steady state alone, which it has at all times."""
    return np.isinf(periods[-1].time)


def _check_times(problem: Any, name: str, times: Sequence[float]) -> None:
    """Refuses measurements of an experiment at times that it does not have, or whose value is not known."""
    begin = next((t for t in times if np.isfinite(t)), -np.inf)
    of_events = problem.model.sbml_model.getNumEvents() > 0
    for m in problem.measurements:
        time = float(m.time)
        if (m.experiment_id or "") != name:
            continue
        where = f"the measurement table, experiment '{name}' at {time:g}"
        if time < begin:
            raise Refused(f"{where}: it begins at {begin:g}")
        if np.isinf(time) and np.isfinite(begin) and (of_events and len(times) > 1 or times[-1] != 0):
            raise Refused(f"{where}: a steady state after another one of a model with events, or of an experiment with "
                          "a period that begins at another time than 0, is not supported")


def _experiments(of_experiments: Mapping[str, Sequence[Period]], made: Periods, measured: Any) -> tuple[Any, Any]:
    """The conditions of experiments and of the steady states before them: what each sets parameters to. And the
    measurements with these conditions; those at the begin of a period are sampled a little later, after its changes."""
    import pandas as pd
    rows: dict[str, dict[str, float]] = {}
    before: dict[str, str | None] = dict.fromkeys(of_experiments)
    later = {name: [p.time for p in periods[1:]] for name, periods in of_experiments.items()}
    for number, (name, periods) in enumerate(of_experiments.items()):
        rows[f"{name}_"] = made.settings(number)
        if np.isinf(periods[0].time) and not _is_at_rest(periods):
            before[name] = f"{name}_at_rest"
            rows[f"{name}_at_rest"] = made.settings(number, at_rest=True)
    table = pd.DataFrame(list(rows.values()), index=list(rows))
    ids = _ids(measured)
    begin = {name: next((p.time for p in periods if np.isfinite(p.time)), 0.0)
             for name, periods in of_experiments.items()}
    times = [np.inf if _is_at_rest(of_experiments[e]) else t for e, t in zip(ids, measured["time"].astype(float))]
    sampled = [t + 1e-12 * max(abs(t), t - begin[e]) if t in later[e] else t for e, t in zip(ids, times)]
    measurements = measured.assign(simulationConditionId=[f"{e}_" for e in ids], time=times, sampled=sampled,
                                   preequilibrationConditionId=[before[e] for e in ids])
    for column in ("observableParameters", "noiseParameters"):
        if column in measurements:
            measurements[column] = [";".join(map(str, c)) if isinstance(c, (list, tuple)) else c
                                    for c in measurements[column]]
    return table, measurements


def _ids(measured: Any) -> list[str]:
    return [e if isinstance(e, str) else "" for e in measured["experimentId"]]


def _observables(problem: Any) -> Any:
    """The table of observables, whose placeholders are called as in version 1."""
    import pandas as pd
    from sympy import Symbol
    rows = []
    for o in problem.observables:
        kind = str(getattr(o.noise_distribution, "value", o.noise_distribution))
        if kind not in _noise:
            raise Refused(f"the observable table, row '{o.id}', column noiseDistribution: {kind}; supported are "
                          f"{', '.join(_noise)}")
        distribution, scale = _noise[kind]
        names = {Symbol(str(p), real=True): Symbol(f"{what}Parameter{i}_{o.id}", real=True)
                 for what, of in (("observable", o.observable_placeholders), ("noise", o.noise_placeholders))
                 for i, p in enumerate(of or (), 1)}
        value = o.formula.subs(names)
        noise = o.noise_formula.subs(names).subs({Symbol(o.id, real=True): value})
        rows.append({"observableId": o.id, "observableFormula": written(value),
                     "noiseFormula": written(noise), "noiseDistribution": distribution,
                     "observableTransformation": scale})
    return pd.DataFrame(rows).set_index("observableId")


def _parameters(problem: Any) -> Any:
    """The table of parameters, on a linear scale."""
    import pandas as pd
    rows = []
    has_priors = any(p.estimate and p.prior_distribution for p in problem.parameters)
    for p in problem.parameters:
        row: dict[str, Any] = {"parameterId": p.id, "parameterScale": "lin", "lowerBound": p.lb, "upperBound": p.ub,
                               "nominalValue": np.nan if p.nominal_value is None else p.nominal_value,
                               "estimate": bool(p.estimate), "prior": None}
        if p.estimate and has_priors:
            row["prior"] = read_prior_2(p)
        rows.append(row)
    return pd.DataFrame(rows).set_index("parameterId")
