# SPDX-License-Identifier: MIT
"""Time courses that SED-ML describes: models with changed attributes, and when they are simulated."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from ...base.errors import Error
from ...solving.solve import solve
from ..cellml.model import read_cellml
from ..sbml.model import read_sbml
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

    def solve(self, sweep: Any = None, **options: Any) -> Run:
        """Integrates the model, by default once with its own values, and samples all states at the times. Arguments
        are those of `my.solve`."""
        times = {"time": (self.begin, float(self.times[-1])), "samples": self.times}
        return solve(self.model, sweep, **{**times, **options})


def read_sedml(path: Path | str) -> dict[str, TimeCourse]:
    """The time courses of a document of SED-ML (Level 1), or of all that an archive of COMBINE (OMEX) has, by the names
    of their tasks. It needs the package python-libsbml or libcellml for the models.

    Models are files of SBML and CellML beside the document or in the archive, or other models of the document; changes
    of attributes are made in those of SBML. `my.read_sedml("study.omex")["task1"].solve(rtol=1e-9)` is the simulation
    as it is described; a sweep and other options are those of `my.solve`. The algorithm is named and not followed.

    Raises `my.Error` with task or model for what is not supported: simulations that are no uniform time courses,
    repeated tasks, models that are elsewhere, changes of other kinds than attributes, and what is not valid.
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


def _tag(element: ElementTree.Element) -> str:
    return element.tag.rpartition("}")[2]


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
        """The time courses by the names of their tasks."""
        return {task.get("id", ""): self._course(task) for task in self._listed("listOfTasks")}

    def _course(self, task: ElementTree.Element) -> TimeCourse:
        name, wanted = task.get("id", ""), task.get("simulationReference", "")
        if _tag(task) != "task":
            self._refuse(f"task '{name}' is a <{_tag(task)}>, and only a <task> is read: sweep the values that it sets")
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
        text = element.get(attribute, "")
        try:
            return float(text)
        except ValueError:
            self._refuse(f"the simulation '{element.get('id')}' has {attribute}=\"{text}\": give a number")

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
