# SPDX-License-Identifier: MIT
"""Time courses that SED-ML describes: models with changed attributes, and when they are simulated."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from ...base.errors import Error
from ...solving.solve import solve
from ...sweeps.inputs import by_name
from ..cellml.model import read_cellml
from ..sbml.model import SbmlModel, read_sbml
from .archive import Files, xml_of

if TYPE_CHECKING:
    from xml.etree import ElementTree

    from ...models.recorded import RecordedModel
    from ...results.run import Run
    from ...symbolic.types import Array


@dataclass(frozen=True)
class TimeCourse:
    """A task of SED-ML: a model, and the times at which its solution is wanted, in the model's unit."""

    name: str
    model: RecordedModel
    begin: float  #: the time of the initial values
    times: Array  #: of the results
    algorithm: str  #: the identifier of the ontology KiSAO, as "KISAO:0000019"; not followed
    changes: dict[str, Array] = field(default_factory=dict)  #: what a repeated task sets, one value for each repetition

    def solve(self, sweep: Any = None, **options: Any) -> Run:
        """Integrates the model and samples all states at the times. Without a sweep, the instances are those of a
        repeated task, or one with the model's own values. Arguments are those of `my.solve`; initial values in `start`
        stand beside those that the task sets, or in their place."""
        if sweep is None:
            aliases = _aliases(self.model)
            changed = {aliases.get(name, name): values for name, values in self.changes.items()}
            sweep = {name: values for name, values in changed.items() if name in self.model.parameters}
            starts = {name: values for name, values in changed.items() if name not in sweep}
            given = by_name(options.get("start"), "start", "start={\"S1\": 1.0}")
            options["start"] = {**starts, **{getattr(key, "name", key): values for key, values in given.items()}}
        times = {"time": (self.begin, float(self.times[-1])), "samples": self.times}
        return solve(self.model, sweep or None, **{**times, **options})


def read_sedml(path: Path | str) -> dict[str, TimeCourse]:
    """The time courses of a document of SED-ML (Level 1), or of all that an archive of COMBINE (OMEX) has, by the names
    of their tasks. It needs the package python-libsbml or libcellml for the models.

    Models are files of SBML and CellML beside the document or in the archive, or other models of the document; changes
    of attributes are made in those of SBML. `my.read_sedml("study.omex")["task1"].solve(rtol=1e-9)` is the simulation
    as it is described; a sweep and other options are those of `my.solve`. A repeated task of one time course is a sweep
    of what it sets. The algorithm is named and not followed.

    Raises `my.Error` with task or model for what is not supported: simulations that are no uniform time courses,
    repeated tasks that compute values or go on from where they were, models that are elsewhere, changes of other kinds
    than attributes, and what is not valid.
    """
    files = Files(path)
    documents = files.documents()
    if not documents:
        files.refuse("its manifest names no document of SED-ML: unpack it, and read its model")
    found: dict[str, TimeCourse] = {}
    for document in documents:
        for name, course in _Document(files, document).courses().items():
            found[name if name not in found else f"{document}:{name}"] = course
    return found


def _aliases(model: RecordedModel) -> Mapping[str, str]:
    """The model's components by the other names that files of SBML have for them."""
    return model.aliases if isinstance(model, SbmlModel) else {}


def _tag(element: ElementTree.Element) -> str:
    return element.tag.rpartition("}")[2]


_most_steps_of_range = 10_000_000


class _Document:
    """A document of SED-ML."""

    def __init__(self, files: Files, name: str) -> None:
        self._files, self._name = files, name
        self._prefixes: dict[str, str] = {}
        self._root = xml_of(files.read(name), name, self._prefixes)
        if "sed-ml.org" not in self._root.tag or _tag(self._root) != "sedML":
            self._refuse(f"the first element is <{_tag(self._root)}>, and not <sedML>")
        self._of_models = {one.get("id", ""): one for one in self._listed("listOfModels")}
        self._simulations = {one.get("id", ""): one for one in self._listed("listOfSimulations")}
        self._models: dict[str, RecordedModel] = {}

    def _refuse(self, what: str) -> NoReturn:
        raise Error(f"'{self._name}': {what}")

    def _listed(self, what: str, within: ElementTree.Element | None = None) -> list[ElementTree.Element]:
        """The elements of a list, in the document or in one of its elements."""
        return [one for all_of in (self._root if within is None else within) if _tag(all_of) == what for one in all_of
                if _tag(one) not in ("notes", "annotation")]

    def courses(self) -> dict[str, TimeCourse]:
        """The time courses by the names of their tasks, those that others repeat too."""
        tasks = {task.get("id", ""): task for task in self._listed("listOfTasks")}
        found = {name: self._course(task) for name, task in tasks.items() if _tag(task) != "repeatedTask"}
        models = {name: task.get("modelReference", "") for name, task in tasks.items()}
        return {name: found[name] if name in found else self._repeated(task, found, models)
                for name, task in tasks.items()}

    def _repeated(self, task: ElementTree.Element, courses: dict[str, TimeCourse],
                  models: dict[str, str]) -> TimeCourse:
        """A time course that is repeated with other values; `models` are those of tasks."""
        name, of_tasks = task.get("id", ""), self._listed("listOfSubTasks", task)
        wanted = of_tasks[0].get("task", "") if len(of_tasks) == 1 else ""
        if wanted not in courses:
            repeats = ", ".join(f"'{one.get('task', '')}'" for one in of_tasks) or "nothing"
            self._refuse(f"the repeated task '{name}' repeats {repeats}: only one <task> can be repeated")
        if task.get("resetModel", "true") not in ("true", "1"):
            self._refuse(f"the repeated task '{name}' goes on from where the last repetition ended: write "
                         "resetModel=\"true\"")
        ranges = {one.get("id", ""): self._values(one, name) for one in self._listed("listOfRanges", task)}
        count = len(ranges.get(task.get("range", ""), ()))
        changes: dict[str, Array] = {}
        for change in self._listed("listOfChanges", task) or self._listed("listOfSetValues", task):
            symbols = [(one.text or "").strip() for math in change for one in math if _tag(math) == "math"]
            of_id = re.search(r"""\[@id=(['"])([^'"]+)\1\](/@\w+)?$""", change.get("target", "").strip())
            if len(symbols) != 1 or symbols[0] not in ranges or of_id is None:
                self._refuse(f"the repeated task '{name}' sets {change.get('target')} to a formula: only values of a "
                             "range, <ci>, of a parameter or a species, [@id='k'], are read")
            if change.get("modelReference", models[wanted]) != models[wanted]:
                self._refuse(f"the repeated task '{name}' sets {change.get('target')} of another model than that of "
                             f"'{wanted}'")
            self._check_set(name, models[wanted], of_id.group(2), (of_id.group(3) or "").removeprefix("/@"))
            changes[of_id.group(2)] = ranges[symbols[0]][:count]
        if not (changes and count) or any(len(values) != count for values in changes.values()):
            self._refuse(f"the repeated task '{name}' sets nothing, or has no range with a value for each repetition")
        model = courses[wanted].model
        for one in changes:
            if one not in {*model.parameters, *model.states, *_aliases(model)}:
                self._refuse(f"the repeated task '{name}' sets '{one}', which is no parameter and no species")
        return replace(courses[wanted], name=name, changes=changes)

    def _check_set(self, task: str, model: str, one: str, attribute: str) -> None:
        """Refuses a target that is no value, or that of a species in other units than it has in its equations."""
        data, language = self._changed(model, [])
        root = xml_of(data, model)
        found = {element.get("id", ""): element for element in root.iter() if "id" in element.attrib}
        element = found.get(one)
        wanted = ["", "value", "size"] if "cellml" not in language else ["", "initial_value"]
        if element is not None and _tag(element) == "species":
            home = found.get(element.get("compartment", ""))
            is_amount = element.get("hasOnlySubstanceUnits", "false") in ("true", "1") or (
                home is not None and home.get("spatialDimensions") in ("0", "0.0"))
            wanted = ["", "initialAmount" if is_amount else "initialConcentration"]
        if attribute not in wanted:
            self._refuse(f"the repeated task '{task}' sets {attribute} of '{one}': set {wanted[1]}, as which its "
                         "equations have it")

    def _values(self, one: ElementTree.Element, name: str) -> Array:
        """The values of a range."""
        if _tag(one) == "vectorRange":
            return np.array([self._number_of(value.text or "", f"a <value> of '{name}'") for value in one])
        if _tag(one) != "uniformRange":
            self._refuse(f"the repeated task '{name}' has a <{_tag(one)}>: only uniform and vector ranges are read")
        first, last = (self._number(one, end) for end in ("start", "end"))
        steps = self._number(one, "numberOfSteps" if "numberOfSteps" in one.attrib else "numberOfPoints")
        if not 1 <= steps <= _most_steps_of_range or steps != int(steps):
            self._refuse(f"the repeated task '{name}' has a range of {steps:g} steps")
        if one.get("type", "linear") == "linear":
            return np.linspace(first, last, int(steps) + 1)
        if not (first > 0 and last > 0):
            self._refuse(f"the repeated task '{name}' has a logarithmic range from {first:g} to {last:g}")
        return np.geomspace(first, last, int(steps) + 1)

    def _course(self, task: ElementTree.Element) -> TimeCourse:
        name, wanted = task.get("id", ""), task.get("simulationReference", "")
        if _tag(task) != "task":
            self._refuse(f"task '{name}' is a <{_tag(task)}>, and only a <task> or a <repeatedTask> is read: sweep the "
                         "values that it sets")
        if wanted not in self._simulations:
            self._refuse(f"task '{name}' names the simulation '{wanted}', which is not there")
        simulation = self._simulations[wanted]
        if _tag(simulation) != "uniformTimeCourse":
            self._refuse(f"the simulation '{wanted}' of task '{name}' is a <{_tag(simulation)}>, and only a "
                         "<uniformTimeCourse> is read")
        begin, first, last = (self._number(simulation, f"{what}Time") for what in ("initial", "outputStart",
                                                                                   "outputEnd"))
        count = "numberOfSteps" if "numberOfSteps" in simulation.attrib else "numberOfPoints"
        steps = self._number(simulation, count)
        if not (begin <= first < last < np.inf) or steps < 1 or steps != int(steps):
            self._refuse(f"the simulation '{wanted}' has the times {begin:g}, {first:g} and {last:g} with {steps:g} "
                         "steps: give initialTime <= outputStartTime < outputEndTime and a step or more")
        algorithm = next((one.get("kisaoID", "") for one in simulation if _tag(one) == "algorithm"), "")
        return TimeCourse(name, self._model(task.get("modelReference", "")), begin,
                          np.linspace(first, last, int(steps) + 1), algorithm)

    def _number(self, element: ElementTree.Element, attribute: str) -> float:
        return self._number_of(element.get(attribute, ""), f"{attribute} of '{element.get('id')}'")

    def _number_of(self, text: str, what: str) -> float:
        try:
            return float(text)
        except ValueError:
            self._refuse(f"{what} is \"{text}\": give a number")

    # -- Models --------------------------------------------------------------------------------------------------------

    def _model(self, name: str) -> RecordedModel:
        if name not in self._models:
            data, language = self._changed(name, [])
            self._models[name] = (read_cellml if "cellml" in language else read_sbml)(data.decode())
        return self._models[name]

    def _changed(self, name: str, above: list[str]) -> tuple[bytes, str]:
        """The text of a model with its changes, and its language."""
        if name not in self._of_models:
            self._refuse(f"the model '{name}' is not there")
        if name in above:
            self._refuse(f"the model '{name}' is made of itself")
        model = self._of_models[name]
        source, language = model.get("source", ""), model.get("language", "")
        if source.removeprefix("#") in self._of_models:
            data, of_source = self._changed(source.removeprefix("#"), [*above, name])
            language = language or of_source
        elif re.match(r"[a-zA-Z][a-zA-Z0-9+.-]+:", source):
            self._refuse(f"the model '{name}' is at {source}: put the file beside the document, and name it as source")
        else:
            data = self._files.read(source, self._name)
        changes = self._listed("listOfChanges", model)
        if changes:
            from xml.etree import ElementTree
            root = xml_of(data, source)
            for change in changes:
                self._apply(change, root, name)
            data = ElementTree.tostring(root, encoding="utf-8")
        return data, language

    def _apply(self, change: ElementTree.Element, root: ElementTree.Element, name: str) -> None:
        """Changes an attribute."""
        target = change.get("target", "")
        if _tag(change) != "changeAttribute":
            self._refuse(f"the model '{name}' has a <{_tag(change)}>, and only <changeAttribute> is read")
        path, _, attribute = target.rpartition("/@")
        of_model = root.tag[1:].partition("}")[0]  # also where the document has another level of SBML
        namespaces = {**self._prefixes, "sbml": of_model, "cellml": of_model}
        _, _, inner = path.lstrip("/").partition("/")
        try:
            found = root.findall(f"./{inner}", namespaces) if attribute else []
        except (SyntaxError, KeyError, TypeError):  # of a path that is none
            found = []
        if len(found) != 1:
            self._refuse(f"the target {target} of the model '{name}' is {len(found) or 'no'} elements: name one "
                         "attribute, as in /sbml:sbml/sbml:model/sbml:listOfParameters/sbml:parameter[@id='k']/@value")
        if attribute not in found[0].attrib and attribute not in ("value", "size"):  # which have a default
            self._refuse(f"the target {target} of the model '{name}' is an attribute that the element does not have: "
                         f"it has {', '.join(found[0].attrib)}")
        found[0].set(attribute, change.get("newValue", ""))
