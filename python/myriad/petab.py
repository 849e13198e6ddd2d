# SPDX-License-Identifier: MIT
"""Problems of parameter estimation in PEtab's format, version 1: a model of SBML, and tables of observables,
measurements, conditions and parameters."""

from __future__ import annotations

import logging
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import Error
from .fit import Fit, fit
from .least_squares import LeastSquares, least_squares
from .sbml import SbmlModel, read_sbml
from .sbml_document import library
from .sbml_math import Refused

if TYPE_CHECKING:
    from .hints import Array, Path

__all__ = ["read_petab", "PetabProblem"]


class PetabProblem:
    """A problem of PEtab's, as `read_petab` returns it: what `my.fit` takes."""

    def __init__(self, model: SbmlModel, data: dict[str, Array], sigma: dict[str, Array],
                 free: dict[str, tuple[Any, ...]], nominal: dict[str, float]) -> None:
        self.model = model  #: the model, with a rule for each observable and the values of the condition
        self.data = data  #: times "t" and measurements by observable
        self.sigma = sigma  #: their standard deviations
        self.free = free  #: bounds of the parameters to estimate
        self.nominal = nominal  #: the nominal values of these

    def fit(self, **options: Any) -> Fit:
        """`my.fit` of the problem; options are those of `my.fit`, as starts=, method=, rtol=."""
        return fit(self.model, self.data, free=self.free, sigma=self.sigma, **options)

    def least_squares(self, **options: Any) -> LeastSquares:
        """`my.least_squares` of the problem, for other optimisers. Its loss is PEtab's chi^2 / 2."""
        return least_squares(self.model, self.data, free=self.free, sigma=self.sigma, **options)

    def __repr__(self) -> str:
        return (f"<myriad.PetabProblem of {sum(int(np.isfinite(v).sum()) for n, v in self.data.items() if n != 't')} "
                f"measurements, to estimate {', '.join(self.free)}>")


def read_petab(path: Path) -> PetabProblem:
    """The problem of a YAML file of PEtab, version 1, for `my.fit`. It needs the packages petab and python-libsbml.

    One condition, observables by any formula, normal noise of known deviation. Raises `myriad.Error` with the table and
    the id for what is not supported: several conditions, preequilibration, steady states, noise that is estimated or a
    formula, other distributions and transformations, observableParameters, priors, parameters on which initial values
    depend; and for what petab itself finds wrong."""
    problem = _read(path)
    libsbml = library()
    document = libsbml.readSBMLFromString(problem.model.to_sbml_str())
    model = document.getModel()
    parameters = problem.parameter_df
    _refuse_priors(parameters)
    free, nominal = {}, {}
    for name, row in parameters.iterrows():
        if model.getElementBySId(name) is None:
            _add_parameter(model, name, constant=True)
        if model.getParameter(name) is None:
            raise Refused(f"the table of parameters has '{name}', which is no global parameter of the model")
        value = row.get("nominalValue", np.nan)
        if row["estimate"]:
            free[name] = (float(row["lowerBound"]), float(row["upperBound"]),
                          *(() if row["parameterScale"] == "lin" else ("log",)))
            nominal[name] = float(value)
            value = value if np.isfinite(value) else free[name][1]
        _set(libsbml, model, name, value)
    condition = _condition(problem)
    for target, value in condition.items():
        if target in free:
            raise Refused(f"the condition sets '{target}', which the table of parameters says to estimate")
        _set(libsbml, model, target, value)
    for name, row in problem.observable_df.iterrows():
        _add_parameter(model, name, constant=False)
        rule = model.createAssignmentRule()
        rule.setVariable(name)
        rule.setMath(_formula(libsbml, row["observableFormula"], f"observable '{name}'"))
    data, sigma = _measurements(problem)
    made = read_sbml(libsbml.writeSBMLToString(document), parameters=list(free))
    return PetabProblem(made, data, sigma, free, nominal)


class _Said(logging.Handler):
    """What petab's checks write to the log."""

    def __init__(self) -> None:
        super().__init__(logging.ERROR)
        self.messages: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.messages.append(record.getMessage())


def _read(path: Path) -> Any:
    try:
        from petab import v1
    except ImportError:
        raise Error("read_petab needs the package petab: `pip install petab python-libsbml`") from None
    name = os.fspath(path)
    if not os.path.isfile(name):
        raise Error(f"there is no file '{name}': give the path of a YAML file of PEtab")
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
    return problem


def _given(table: Any, column: str) -> Any:
    """What a column has, by row, if there is one."""
    values = table[column] if column in table else table.iloc[:0, 0]
    return values[values.notna() & (values.astype(str) != "")].items()


def _refuse_priors(parameters: Any) -> None:
    for name, kind in _given(parameters, "objectivePriorType"):
        raise Refused(f"the table of parameters has a prior of '{name}', {kind}: fits are of measurements alone")


def _condition(problem: Any) -> dict[str, Any]:
    """What the one condition that is measured at sets."""
    measurements = problem.measurement_df
    for _, name in _given(measurements, "preequilibrationConditionId"):
        raise Refused(f"measurements begin after preequilibration, at the condition '{name}'")
    names = list(dict.fromkeys(measurements["simulationConditionId"]))
    if len(names) > 1:
        raise Refused(f"there are measurements at several conditions, {', '.join(map(repr, names))}")
    row = problem.condition_df.loc[names[0]]
    return {target: value for target, value in row.items() if target != "conditionName" and not (
        isinstance(value, float) and np.isnan(value))}


def _measurements(problem: Any) -> tuple[dict[str, Array], dict[str, Array]]:
    """Times and values in a row for each measurement, and standard deviations."""
    table = problem.measurement_df
    for row, _ in _given(table, "observableParameters"):
        raise Refused(f"measurements of '{table['observableId'][row]}' have observableParameters")
    times = table["time"].to_numpy(float)
    if np.isinf(times).any():
        raise Refused(f"there are measurements of '{table['observableId'][np.isinf(times)].iloc[0]}' in a steady state")
    data, sigma = {"t": times}, {}
    for name, row in problem.observable_df.iterrows():
        here = (table["observableId"] == name).to_numpy()
        if not here.any():
            continue
        for column, usual in (("observableTransformation", "lin"), ("noiseDistribution", "normal")):
            if (given := row.get(column, usual)) not in (usual, "") and given == given:
                raise Refused(f"observable '{name}' has the {column} {given}: only {usual} is supported")
        data[name] = np.where(here, table["measurement"].to_numpy(float), np.nan)
        sigma[name] = np.where(here, _deviations(name, row["noiseFormula"], table, here), 1.0)
    return data, sigma


def _deviations(name: str, formula: Any, table: Any, here: Array) -> Any:
    """Standard deviations of an observable: a number, or of each row, where the formula is its placeholder alone."""
    given = table["noiseParameters"] if str(formula).strip() == f"noiseParameter1_{name}" else None
    try:
        return float(formula) if given is None else np.where(here, given, 1.0).astype(float)
    except (TypeError, ValueError):
        what = formula if given is None else ", ".join(dict.fromkeys(map(str, given[here])))
        raise Refused(f"the noise of observable '{name}' is {what}: only numbers are supported") from None


def _formula(libsbml: Any, formula: Any, what: str) -> Any:
    settings = libsbml.L3ParserSettings()
    settings.setParseLog(libsbml.L3P_PARSE_LOG_AS_LN)  # as PEtab means it
    tree = libsbml.parseL3FormulaWithSettings(str(formula), settings)
    if tree is None:
        raise Refused(f"the formula of {what}, {formula}: {' '.join(libsbml.getLastParseL3Error().split())}")
    return tree


def _add_parameter(model: Any, name: str, constant: bool) -> None:
    made = model.createParameter()
    made.setId(name)
    made.setConstant(constant)


def _set(libsbml: Any, model: Any, target: str, value: Any) -> None:
    """Gives a parameter, compartment or species an initial value, a number or the id of a parameter."""
    while model.getInitialAssignmentBySymbol(target) is not None:
        model.removeInitialAssignment(target)
    parameter = model.getParameter(target)
    if parameter is not None and not isinstance(value, str):
        parameter.setValue(float(value))
        return
    assignment = model.createInitialAssignment()
    assignment.setSymbol(target)
    assignment.setMath(_formula(libsbml, value, f"the initial value of '{target}'"))
