# SPDX-License-Identifier: MIT
"""Models of CellML as libCellML reads them: their imports resolved, checked and analysed."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any, NoReturn

from ...base.errors import Error
from .document import Document, Refused
from .older import modernise

_most_files = 1000  #: of a model with imports


def library() -> Any:
    """The module libcellml."""
    try:
        import libcellml
    except ImportError:
        raise Error("read_cellml needs the package libcellml: `pip install libcellml`") from None
    return libcellml


class Analysed:
    """A model that libCellML has read, with its imports, and analysed: `model` has its equations as trees."""

    def __init__(self, source: Any) -> None:
        self.libcellml = library()
        self._lines: dict[tuple[str, str], str] = {}
        self._files: dict[Path, Any] = {}
        self._under_way: list[Path] = []
        text = source if isinstance(source, (str, bytes)) and source.lstrip()[:1] in ("<", b"<") else None
        if text is not None:
            self.beside: Path | None = None
            given = self._given(Document(text), None)
        else:
            path = Path(os.fspath(source))
            if not path.is_file():
                raise Error(f"there is no file '{path}': give the path of a file of CellML, or its text")
            self.beside = path.resolve().parent
            given = self._of_file(path.resolve())
        self.name = given.name()
        self.model = self._analysed(given)

    def where(self, component: str, variable: str = "") -> str:
        """A component, or a variable in it, for messages: "variable 'x' in component 'c' (line 12)"."""
        line = self._lines.get((component, variable), "")
        what = f"variable '{variable}' in component '{component}'" if variable else f"component '{component}'"
        return f"{what} ({line})" if line else what

    def place(self, variable: Any) -> str:
        """A variable of libCellML's, for messages."""
        return self.where(_component(variable), variable.name())

    def all_variables(self) -> list[Any]:
        """The variables of all components, also those that are connected."""
        return [c.variable(i) for c in _components(self._flat) for i in range(c.variableCount())]

    # -- Files ---------------------------------------------------------------------------------------------------------

    def _of_file(self, path: Path) -> Any:
        if path in self._under_way:
            raise Refused(f"'{path.name}' imports itself, by way of {', '.join(p.name for p in self._under_way)}")
        if path not in self._files:
            if len(self._files) >= _most_files:
                raise Refused(f"the model imports more than {_most_files} files")
            self._under_way.append(path)
            file = path.name if self._files or len(self._under_way) > 1 else ""
            self._files[path] = self._given(Document(path.read_bytes(), file), path.parent)
            self._under_way.pop()
        return self._files[path]

    def _given(self, document: Document, folder: Path | None) -> Any:
        """The model of a document, with those that it imports."""
        modernise(document)
        parser = self.libcellml.Parser(document.version == "2.0")
        model = parser.parseModel(document.text())
        of = f" of '{document.file}'" if document.file else ""
        for key, line in document.lines.items():
            self._lines.setdefault(key, f"line {line}{of}")
        if parser.errorCount():
            self._refuse(parser.error(0))
        imported = {element.get("{http://www.w3.org/1999/xlink}href", ""):
                    document.path_of(element, folder, self.beside) for element in document.imports()}
        for path in imported.values():
            self._of_file(path)
        if imported:
            for item in (*_components(model), *(model.units(i) for i in range(model.unitsCount()))):
                if item.isImport() and item.importSource().url() in imported:
                    item.importSource().setUrl(str(imported[item.importSource().url()]))
        return model

    def _analysed(self, model: Any) -> Any:
        if model.hasImports():
            importer = self.libcellml.Importer(False)
            for path, imported in self._files.items():  # all that it needs, so that it opens nothing
                importer.addModel(imported, str(path))
            importer.resolveImports(model, "")
            flat = None if importer.errorCount() else importer.flattenModel(model)
            if flat is None or importer.errorCount():
                self._refuse(importer.error(0))
            model = flat
        model.linkUnits()
        model.fixVariableInterfaces()
        self._flat = model  # which the variables of the analysis belong to
        analyser, kinds = self._analyser(model), self.libcellml.AnalyserModel.Type
        found = analyser.analyserModel()
        if found.type() in (kinds.DAE, kinds.NLA):
            self._refuse_unsolved(found)
        if analyser.errorCount():
            self._refuse(analyser.error(0))
        return found

    def _analyser(self, model: Any) -> Any:
        """An analysis of a model. Time loses its initial value, since a call says when it starts, and what no equation
        reads or gives is left out."""
        rules = self.libcellml.Issue.ReferenceRule
        while True:
            analyser = self.libcellml.Analyser()
            analyser.analyseModel(model)
            errors = [analyser.error(i) for i in range(analyser.errorCount())]
            times, unknown = ([e.item().variable() for e in errors if e.referenceRule() == rule]
                              for rule in (rules.ANALYSER_VOI_INITIALISED, rules.ANALYSER_VARIABLE_UNUSED))
            unread = [v for v in unknown if not re.search(rf">\s*{re.escape(v.name())}\s*<", v.parent().math())]
            if not times and not unread:
                return analyser
            for variable in times:
                variable.removeInitialValue()
            for variable in unread:
                variable.removeAllEquivalences()
                variable.parent().removeVariable(variable)

    # -- Messages ------------------------------------------------------------------------------------------------------

    def _refuse(self, issue: Any) -> NoReturn:
        """Refuses what libCellML has found, with the line of the variable or component that it names."""
        item, kinds = issue.item(), self.libcellml.CellmlElementType
        said = " ".join(issue.description().split())
        place = ""
        if item.type() == kinds.VARIABLE:
            place = self.place(item.variable())
        elif item.type() in (kinds.COMPONENT, kinds.MATH) and item.component() is not None:
            place = self.where(item.component().name())
        said = said if len(said) < 1000 else f"{said[:1000]}..."
        rules = self.libcellml.Issue.ReferenceRule
        if issue.referenceRule() in (rules.ANALYSER_VARIABLE_UNUSED, rules.ANALYSER_VARIABLE_UNDERCONSTRAINED):
            said = "nothing gives its value: write an initial_value, or an equation with it alone on the left"
        named = re.search("component '([^']*)'", said)  # as libCellML says of a formula
        if not place and named and (line := self._lines.get((named[1], ""))):
            said = f"{said} (component '{named[1]}' begins in {line})"
        raise Refused(f"{place}: {said}" if place else said)

    def _refuse_unsolved(self, found: Any) -> NoReturn:
        kinds = self.libcellml.AnalyserEquation.Type
        equations = [e for e in found.analyserEquations() if e.type() == kinds.NLA]
        unknowns = [get(i).variable() for e in equations for count, get in (
            (e.algebraicVariableCount(), e.algebraicVariable), (e.stateCount(), e.state)) for i in range(count)]
        place = self.place(unknowns[0]) if unknowns else "a variable"
        raise Refused(f"{place} is the unknown of an equation that has to be solved for it, which Myriad does not do "
                      "in models of CellML: write it, or its derivative, alone on the left; my.model(..., "
                      "mass_matrix=...) has algebraic equations")


def _component(variable: Any) -> str:
    return str(variable.parent().name())


def _components(owner: Any) -> list[Any]:
    """The components of a model in the order of the file, those inside others behind these."""
    found, waiting = [], [owner]
    while waiting:
        inside = waiting.pop()
        found.append(inside)
        waiting += [inside.component(i) for i in reversed(range(inside.componentCount()))]
    return found[1:]
