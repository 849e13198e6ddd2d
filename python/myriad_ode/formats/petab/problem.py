# SPDX-License-Identifier: MIT
"""Problems of parameter estimation in PEtab's format: a model of SBML, and tables of observables, measurements,
conditions and parameters."""

from __future__ import annotations

import logging
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import Error
from ...inference.fitting import Fit, minimised
from ...inference.measurements import Given, losses
from ...inference.objective import Free
from ...inference.priors import Prior
from ..sbml.math import Refused
from ..sbml.model import SbmlModel
from .likelihood import Experiment, Observed, PetabLikelihood
from .model import PetabModel
from .priors import read_prior
from .solutions import SteadyStates
from .version2 import Tables, is_version_2, read_version_2

if TYPE_CHECKING:
    from ...symbolic.types import Array, ByComponent, Path, Values

__all__ = ["read_petab", "PetabProblem"]


class PetabProblem:
    """A problem of PEtab's, as `read_petab` returns it."""

    def __init__(self, experiment: Experiment, nominal: dict[str, float], measurements: Any) -> None:
        self._experiment = experiment
        self.model = experiment.model  #: the model, with a rule for each observable and its noise
        self.conditions = experiment.conditions  #: of the measurements, as "drug" or "drug after rest", a steady state
        #: bounds of the parameters to estimate
        self.free = {f.name: (f.least, f.most, *(("log",) if f.log else ())) for f in experiment.free}
        self.nominal = nominal  #: the nominal values of these
        self.measurements = measurements  #: the table of measurements, a data frame

    def likelihood(self, **options: Any) -> PetabLikelihood:
        """The likelihood of the problem as a function of the parameters to estimate, for other optimisers and samplers;
        options are those of `my.solve`, as method=, rtol=."""
        return PetabLikelihood(self._experiment, options)

    def fit(self, starts: int | ByComponent = 16, iterations: int = 100, tolerance: float = 1e-10, seed: int = 0,
            **options: Any) -> Fit:
        """Fits the parameters from many starts, as `my.fit` does, with arguments as there. The loss is the negative
        logarithm of likelihood and priors."""
        return minimised(self.likelihood(**options), starts, iterations, tolerance, seed)

    def simulate(self, values: Values | None = None, **options: Any) -> Any:
        """PEtab's table of simulations, a data frame, at values of the parameters to estimate, in the order of `free`,
        or at the nominal values; options are those of `my.solve`."""
        at = list(self.nominal.values()) if values is None else values
        table = self.measurements.rename(columns={"measurement": "simulation"})
        table["simulation"] = self.likelihood(**options).simulate(at)
        return table

    def __repr__(self) -> str:
        several = f" at {len(self.conditions)} conditions" if len(self.conditions) > 1 else ""
        return (f"<myriad_ode.PetabProblem of {len(self.measurements)} measurements{several}, to estimate "
                f"{', '.join(self.free)}>")


def read_petab(path: Path) -> PetabProblem:
    """The problem of a YAML file of PEtab, version 1 or 2. It needs the packages petab and python-libsbml.

    It may have several conditions; observables and noise by any formula, with placeholders that measurements set;
    noise that is estimated, with a normal or a Laplace distribution on a linear or logarithmic scale; priors; steady
    states of other conditions in which experiments begin, and measurements in steady states, at the time inf. Problems
    of version 2 may also have experiments of several periods, whose conditions change values at given times by
    formulas. Raises `my.Error` with table, row and column for what is not supported (docs/fits.md#petab-problems), and
    for what petab itself finds wrong."""
    return _Reader(_read(path)).problem()


class _Said(logging.Handler):
    """What petab's checks write to the log."""

    def __init__(self) -> None:
        super().__init__(logging.ERROR)
        self.messages: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.messages.append(record.getMessage())


def _read(path: Path) -> Tables:
    try:
        from petab import v1
    except ImportError:
        raise Error("read_petab needs the package petab: `pip install petab python-libsbml`") from None
    name = os.fspath(path)
    if not os.path.isfile(name):
        raise Error(f"there is no file '{name}': give the path of a YAML file of PEtab")
    if is_version_2(name):
        return read_version_2(name)
    said, log = _Said(), logging.getLogger("petab.v1")
    propagates, log.propagate = log.propagate, False
    log.addHandler(said)
    try:
        problem = v1.Problem.from_yaml(name)
        wrong = v1.lint_problem(problem)
    except Exception as error:  # of any kind, by pandas, yaml and petab
        raise Refused(f"petab cannot read '{name}': {error}") from None
    finally:
        log.removeHandler(said)
        log.propagate = propagates
    if wrong:
        raise Refused(f"'{name}' is no valid problem of PEtab: {' '.join(' '.join(said.messages).split())}")
    if problem.model.type_id != "sbml":
        raise Refused(f"the model is {problem.model.type_id}, not SBML")
    if problem.mapping_df is not None:
        raise Refused("there is a mapping table")
    return Tables(problem.parameter_df, problem.observable_df, problem.measurement_df, problem.condition_df,
                  problem.model.to_sbml_str(), problem.sbml_model, {}, {}, problem.measurement_df)


def _is_given(value: Any) -> bool:
    return not (value is None or isinstance(value, float) and np.isnan(value) or value == "")


def _number(value: Any) -> float | None:
    try:
        return float(value)
    except (TypeError, ValueError):
        return None


class _Reader:
    """Turns the tables of a problem, as petab reads them, into what a likelihood is computed from."""

    def __init__(self, problem: Tables) -> None:
        self._tables = problem
        self._parameters, self._observables = problem.parameter_df, problem.observable_df
        self._measurements, self._table = problem.measurement_df, problem.condition_df
        self._made = PetabModel(problem.sbml)
        self._free: list[Free] = []
        self._set_to_free: dict[str, int] = {}
        self._fixed: dict[str, float] = {}
        self._priors: list[tuple[int, Prior]] = []
        self._constants = {p.getId(): p.getValue() for p in problem.sbml_model.getListOfParameters()
                           if p.isSetValue() and p.getConstant()
                           and problem.sbml_model.getInitialAssignmentBySymbol(p.getId()) is None}

    def problem(self) -> PetabProblem:
        for name, row in self._parameters.iterrows():
            self._parameter(str(name), row)
        self._experiments()
        self._set_conditions()
        observed = [self._observed(str(name), row) for name, row in self._observables.iterrows()
                    if (self._measurements["observableId"] == name).any()]
        model, of_experiments, before = self._of_experiments(self._made.read())

        def of_components(given: dict[str, Given]) -> dict[str, Given]:
            return {model.aliases.get(name, name): values for name, values in given.items()}

        times = self._measurements["time"].to_numpy(float)
        sampled = self._measurements.get("sampled", self._measurements["time"]).to_numpy(float)
        numbers = {b: i for i, b in enumerate(self._befores)}
        steady = SteadyStates([str(b) for b in self._befores], np.array([numbers.get(b, -1) for b, _ in self._pairs]),
                              of_components(before),
                              {model.stored.get(name, name): rows for name, rows in self._reset.items()},
                              np.unique(self._experiment_of[np.isinf(times)]))
        experiment = Experiment(
            model, self._free, [self._name_of(b, c) for b, c in self._pairs],
            of_components(of_experiments), self._experiment_of, times, sampled,
            self._measurements["measurement"].to_numpy(float),
            [Observed(name, model.outputs[value], model.outputs[noise], kind, scale, rows, of_components(placeholders))
             for name, value, noise, kind, scale, rows, placeholders in observed], self._priors, steady,
            np.array([self._tables.begins.get(c, 0.0) for _, c in self._pairs]))
        nominal = self._parameters["nominalValue"] if "nominalValue" in self._parameters else {}
        return PetabProblem(experiment, {f.name: float(nominal.get(f.name, np.nan)) for f in self._free},
                            self._tables.measured)

    def _name_of(self, before: str | None, condition: str) -> str:
        """What an experiment is called: as in version 2, or as its conditions."""
        names = self._tables.names
        return names[condition] if names else condition if before is None else f"{condition} after {before}"

    def _parameter(self, name: str, row: Any) -> None:
        """A row of the table of parameters."""
        if not row["estimate"]:
            self._fixed[name] = float(row["nominalValue"])
            self._made.fix(name, self._fixed[name])
            return
        of_version_2 = row.get("prior")  # what read_prior_2 gives, or None
        prior, (least, most) = of_version_2 or read_prior(name, row)
        least, most = (pick(end, float(row[f"{which}Bound"])) if np.isfinite(row[f"{which}Bound"]) else end
                       for pick, which, end in ((max, "lower", least), (min, "upper", most)))
        self._free.append(Free(name, (least, most, *(() if row["parameterScale"] == "lin" else ("log",)))))
        self._set_to_free[self._made.set(name, "the table of parameters")] = len(self._free) - 1
        if prior is not None:
            self._priors.append((len(self._free) - 1, prior))

    def _experiments(self) -> None:
        """The experiments of the measurements, each at a condition, some after a steady state of another."""
        table = self._measurements
        before = (table["preequilibrationConditionId"] if "preequilibrationConditionId" in table else
                  [None] * len(table))
        pairs = [(b if _is_given(b) else None, c) for b, c in zip(before, table["simulationConditionId"])]
        self._pairs = list(dict.fromkeys(pairs))
        self._befores = list(dict.fromkeys(b for b, _ in self._pairs if b is not None))
        number = {pair: i for i, pair in enumerate(self._pairs)}
        self._experiment_of = np.array([number[pair] for pair in pairs])
        self._conditions = list(dict.fromkeys([*(c for _, c in self._pairs), *self._befores]))

    def _set_conditions(self) -> None:
        """What conditions set parameters to."""
        self._set_to = {name: Given.of([(k, 0.0)] * len(self._conditions)) for name, k in self._set_to_free.items()}
        self._reset: dict[str, Array] = {}  # by target, whether experiments set it anew
        at_start = {*self._befores, *(c for b, c in self._pairs if b is None)}
        for target in self._table.columns:
            cells = {c: self._table.loc[c, target] for c in self._conditions}
            if target == "conditionName" or not any(_is_given(cell) for cell in cells.values()):
                continue
            if target in self._parameters.index:
                raise Refused(f"the condition table, column {target}: the table of parameters has '{target}' too")
            parameter = self._made.set(target, "the condition table")
            self._reset[target] = np.array([_is_given(cells[c]) for _, c in self._pairs])
            resolved = []
            for condition, cell in cells.items():
                where = f"the condition table, row '{condition}', column {target}"
                if _is_given(cell):
                    resolved.append(self._resolved(cell, condition, where))
                elif target in self._made.file_values:
                    resolved.append((-1, self._made.file_values[target]))
                elif parameter != target and condition not in at_start:
                    resolved.append((-1, 0.0))  # not read, as it has its value in the steady state
                else:
                    raise Refused(f"{where}: there is no value, and that of the model is no number")
            self._set_to[parameter] = Given.of(resolved)

    def _of_experiments(self, model: SbmlModel) -> tuple[SbmlModel, dict[str, Given], dict[str, Given]]:
        """What experiments set parameters to, and the steady states before them. What is estimated and nothing of an
        experiment but of the steady state before is the value of a parameter that nothing reads, so that there are
        derivatives by it."""
        number = {c: i for i, c in enumerate(self._conditions)}
        experiments = [number[c] for _, c in self._pairs]
        befores = [number[c] for c in self._befores]
        of_experiments = {name: given.at(np.array(experiments, int)) for name, given in self._set_to.items()}
        before = {name: given.at(np.array(befores, int)) for name, given in self._set_to.items()}
        of_model = [g for name, g in self._set_to.items() if model.aliases.get(name, name) in model.parameters]

        def free(condition: str | None) -> set[int]:
            return {int(given.free[number[condition]]) for given in of_model} - {-1} if condition is not None else set()

        missing = [sorted(free(b) - free(c)) for b, c in self._pairs]
        most = max(map(len, missing))
        for place in range(most):
            given = Given.of([(of[place], 0.0) if place < len(of) else (-1, 0.0) for of in missing])
            of_experiments[self._made.add_constant(f"before_{place + 1}")] = given
        return self._made.read() if most else model, of_experiments, before

    def _resolved(self, cell: Any, condition: str, where: str, asked: tuple[str, ...] = ()) -> tuple[int, float]:
        """What a cell of a table stands for: the number of a free component, or -1 and a number."""
        value = _number(cell)
        if value is not None and np.isfinite(value):
            return -1, value
        name = str(cell).strip()
        free = [k for k, f in enumerate(self._free) if f.name == name]
        if free:
            return free[0], 0.0
        known = {**self._constants, **self._fixed}
        if name in self._table.columns and name not in asked and _is_given(self._table.loc[condition, name]):
            return self._resolved(self._table.loc[condition, name], condition, where, (*asked, name))
        if name not in known:
            raise Refused(f"{where}: {cell}, which is no number, nor a parameter with a value")
        return -1, known[name]

    def _observed(self, name: str, row: Any) -> tuple[str, str, str, str, str, Array, dict[str, Given]]:
        """A row of the table of observables: ids of the formulas of the observable and its noise, the distribution of
        that, its scale, the rows of its measurements and what they set placeholders to."""
        where = f"the observable table, row '{name}', column"
        distribution = str(given) if _is_given(given := row.get("noiseDistribution")) else "normal"
        if distribution not in losses:
            raise Refused(f"{where} noiseDistribution: {distribution}; supported are {', '.join(losses)}")
        scale = given if _is_given(given := row.get("observableTransformation")) else "lin"
        table = self._measurements
        rows = np.flatnonzero(table["observableId"] == name)
        placeholders: dict[str, Given] = {}
        for kind in ("observable", "noise"):
            ids = self._made.add_placeholders(f"{row['observableFormula']} {row['noiseFormula']}", kind, name)
            placeholders |= self._placeholders(name, ids, f"{kind}Parameters", rows)
        if scale != "lin" and not (table["measurement"].to_numpy(float)[rows] > 0).all():
            raise Refused(f"{where} observableTransformation: {scale}, and not all measurements are positive")
        value = self._made.add(name, row["observableFormula"], f"{where} observableFormula")
        noise = self._made.add(f"noise_of_{name}", row["noiseFormula"], f"{where} noiseFormula")
        return name, value, noise, distribution, str(scale), rows, placeholders

    def _placeholders(self, name: str, ids: list[str], column: str, rows: Array) -> dict[str, Given]:
        """What measurements set the placeholders of an observable to."""
        resolved: dict[str, list[tuple[int, float]]] = {placeholder: [] for placeholder in ids}
        table = self._measurements
        cells = table[column].tolist() if column in table else [None] * len(table)
        conditions = table["simulationConditionId"].tolist()
        known: dict[Any, list[tuple[int, float]]] = {}
        for i in rows:
            cell, condition = cells[i], conditions[i]
            if (cell, condition) not in known:
                where = f"the measurement table, row {i + 1}, column {column}"
                parts = (cell.split(";") if isinstance(cell, str) else [cell]) if _is_given(cell) else []
                if len(parts) != len(ids):
                    raise Refused(f"{where}: {len(parts)} values for the {len(ids)} of {', '.join(ids) or name}")
                known[cell, condition] = [self._resolved(part, condition, where) for part in parts]
            for placeholder, value in zip(ids, known[cell, condition]):
                resolved[placeholder].append(value)
        return {placeholder: Given.of(values) for placeholder, values in resolved.items()}
