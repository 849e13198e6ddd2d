# SPDX-License-Identifier: MIT
"""Files of SBML as python-libsbml reads them: checked, and with their submodels flattened."""

from __future__ import annotations

import os
import re
from typing import Any

from ...base.errors import Error
from .math import Refused


# libsbml's numbers of errors: no encoding is named; a unit, or a unit that it is made of, is not there
_harmless = 1002, 10313, 20410
_pictures = "layout", "render"  # packages that say how a model is drawn, and nothing about what it means


def library() -> Any:
    """The module libsbml."""
    try:
        import libsbml
    except ImportError:
        raise Error("read_sbml needs the package python-libsbml: `pip install python-libsbml`") from None
    return libsbml


def named(element: Any, what: str | None = None) -> str:
    """An element for messages: "species 'S1' (line 12)"."""
    name = element.getIdAttribute() if hasattr(element, "getIdAttribute") else element.getId()
    name = name or (element.getVariable() if hasattr(element, "getVariable") else "") or (
        element.getSymbol() if hasattr(element, "getSymbol") else "")
    line = f" (line {element.getLine()})" if element.getLine() else ""
    return f"{what or element.getElementName()}" + (f" '{name}'" if name else "") + line


def read(source: Any) -> tuple[Any, Any]:
    """The document of a file, or of a text that holds one, and its model without submodels."""
    libsbml = library()
    text = source if isinstance(source, str) and source.lstrip().startswith("<") else None
    if text is None:
        path = os.fspath(source)
        if not os.path.isfile(path):
            raise Error(f"there is no file '{path}': give the path of a file of SBML, or its text")
        document = libsbml.readSBMLFromFile(os.path.abspath(path))  # external models are looked for beside it
    else:
        document = libsbml.readSBMLFromString(text)
    _check(libsbml, document)
    if document.getModel() is None:
        raise Refused("the document has no model")
    _refuse_packages(document)
    if document.getPlugin("comp") is not None:
        _flatten(libsbml, document)
    return document, document.getModel()


def _check(libsbml: Any, document: Any) -> None:
    """Refuses what is no valid SBML. Units are not checked: no value depends on them."""
    if not _errors(libsbml, document):
        for category in (libsbml.LIBSBML_CAT_UNITS_CONSISTENCY, libsbml.LIBSBML_CAT_MODELING_PRACTICE,
                         libsbml.LIBSBML_CAT_SBO_CONSISTENCY):
            document.setConsistencyChecks(category, False)
        # which writes functions out at every call: checks of what they make would not end
        if document.getModel() is not None and _written_out(libsbml, document.getModel()) > 10_000:
            document.setConsistencyChecks(libsbml.LIBSBML_CAT_GENERAL_CONSISTENCY, False)
        document.checkConsistency()
    for error in _errors(libsbml, document)[:1]:
        raise Refused(f"line {error.getLine()} is no valid SBML: {' '.join(error.getMessage().split())}")


def _written_out(libsbml: Any, model: Any) -> int:
    """The most calls that a function of the model is, with those of the functions that it calls."""
    most, calls = 0, dict[str, int]()
    for i in range(model.getNumFunctionDefinitions()):  # which call those above them alone
        definition, count = model.getFunctionDefinition(i), 1
        waiting = [definition.getBody()]
        while waiting:
            node = waiting.pop()
            if node is None:
                continue
            if node.getType() == libsbml.AST_FUNCTION:
                count += calls.get(node.getName(), 0)
            waiting += [node.getChild(j) for j in range(node.getNumChildren())]
        calls[definition.getId()] = count
        most = max(most, count)
    return most


def _errors(libsbml: Any, document: Any) -> list[Any]:
    log = document.getErrorLog()
    found = [document.getError(i) for i in range(document.getNumErrors())]
    counting = {e.getErrorId() for e in found if not _is_of_pictures(e)} - {*_harmless}
    for number in {e.getErrorId() for e in found} - counting:
        log.removeAll(number)  # else libsbml stops there
    errors = [document.getError(i) for i in range(document.getNumErrors())]
    return [e for e in errors if e.getSeverity() in (libsbml.LIBSBML_SEV_ERROR, libsbml.LIBSBML_SEV_FATAL)
            and not _is_of_pictures(e)]


def _is_of_pictures(error: Any) -> bool:
    """Whether an error is one of a package that draws the model. What such a package has where it may not be, as in a
    document of Level 2, counts as the core's, and only the message names the package."""
    return error.getPackage() in _pictures or any(re.search(rf"\bpackage '?{name}", error.getMessage(), re.IGNORECASE)
                                                  for name in _pictures)


def _refuse_packages(document: Any) -> None:
    """Refuses packages of Level 3 that change what the model means."""
    for i in range(document.getNumPlugins()):
        name = document.getPlugin(i).getPackageName()
        if name != "comp" and document.getPackageRequired(name) and document.getLevel() > 2 and name != (
                "l3v2extendedmath"):
            raise Refused(f"the package '{name}' of SBML Level 3, on which the model depends")
    if document.getNumUnknownPackages():
        raise Refused(f"the package {document.getUnknownPackageURI(0)} of SBML Level 3, which libsbml does not know")


def _flatten(libsbml: Any, document: Any) -> None:
    """Replaces submodels by what they contain."""
    properties = libsbml.ConversionProperties()
    properties.addOption("flatten comp", True)
    properties.addOption("performValidation", False)
    if document.convert(properties) != libsbml.LIBSBML_OPERATION_SUCCESS:
        said = [document.getError(i).getMessage() for i in range(document.getNumErrors())]
        raise Refused("the submodels cannot be flattened" + (f": {' '.join(said[-1].split())}" if said else ""))
