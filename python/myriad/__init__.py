# SPDX-License-Identifier: MIT
"""Myriad: very large ensembles of small systems of ordinary differential equations, from models written in Python."""

from __future__ import annotations

import builtins as _builtins
import sys as _sys

from . import (_core, cache as cache, designs as designs, numpy_functions as numpy_functions, plots as plots,
               reduce as reduce)
from .axes import *  # noqa: F403
from .function import *  # noqa: F403
from .cpp_model import CppModel as CppModel
from .errors import Error as Error
from .expression import *  # noqa: F403
from .fit import *  # noqa: F403
from .grid import *  # noqa: F403
from .interpolate import *  # noqa: F403
from .least_squares import *  # noqa: F403
from .methods import controls as controls, methods as methods
from .model import *  # noqa: F403
from .options import (EventChoice as EventChoice, Options as Options, RecordChoice as RecordChoice,
                      SampleChoice as SampleChoice)
from .run import Interrupted as Interrupted, Run as Run
from .petab import PetabProblem as PetabProblem, read_petab as read_petab
from .sbml import SbmlModel as SbmlModel, read_antimony as read_antimony, read_sbml as read_sbml
from .sensitivities import *  # noqa: F403
from .solve import solve as solve
from .statuses import status_names as status_names
from .study import Study as Study, study as study
from .study_result import Damage as Damage, StudyResult as StudyResult, open_study as open_study, verify as verify
from .symbols import *  # noqa: F403
from .table import *  # noqa: F403
from .tangents import *  # noqa: F403
from .trigger import *  # noqa: F403
from .units import *  # noqa: F403
from .xpp import XppModel as XppModel, read_xpp as read_xpp

__version__ = _core.version

_public = ["CppModel", "Damage", "Error", "EventChoice", "Interrupted", "Options", "PetabProblem", "RecordChoice",
           "Run", "SampleChoice", "SbmlModel", "Study", "StudyResult", "XppModel", "cache", "controls", "designs",
           "methods", "open_study", "plots", "read_antimony", "read_petab", "read_sbml", "read_xpp", "reduce", "solve",
           "status_names", "study", "verify",
           *(name for part in ("axes", "function", "expression", "fit", "grid", "interpolate", "least_squares", "model",
                               "sensitivities", "symbols", "table", "tangents", "trigger", "units")
             for name in _sys.modules[f"{__name__}.{part}"].__all__)]
# What `from myriad import *` brings: nothing that has the name of a function of Python's, such as abs.
__all__ = [name for name in _public if not hasattr(_builtins, name)]


def __dir__() -> list[str]:
    return sorted([*_public, "__version__"])
