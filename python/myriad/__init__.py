# SPDX-License-Identifier: MIT
"""Myriad: very large ensembles of small systems of ordinary differential equations, from models written in Python."""

import builtins as _builtins
import sys as _sys

from . import _core, cache, numpy_functions, plots, reduce
from .axes import *  # noqa: F403
from .cpp_model import CppModel
from .errors import Error
from .expression import *  # noqa: F403
from .grid import *  # noqa: F403
from .interpolate import *  # noqa: F403
from .methods import controls, methods
from .model import *  # noqa: F403
from .options import EventChoice, Options, RecordChoice, SampleChoice
from .run import Interrupted, Run, status_names
from .solve import solve
from .study import Study, study
from .study_result import Damage, StudyResult, open_study, verify
from .symbols import *  # noqa: F403
from .table import *  # noqa: F403
from .tangents import *  # noqa: F403

__version__ = _core.version

_public = ["CppModel", "Damage", "Error", "EventChoice", "Interrupted", "Options", "RecordChoice", "Run",
           "SampleChoice", "Study", "StudyResult", "cache", "controls", "methods", "open_study", "plots", "reduce",
           "solve", "status_names", "study", "verify",
           *(name for part in ("axes", "expression", "grid", "interpolate", "model", "symbols", "table", "tangents")
             for name in _sys.modules[f"{__name__}.{part}"].__all__)]
# What `from myriad import *` brings: nothing that has the name of a function of Python's, such as abs.
__all__ = [name for name in _public if not hasattr(_builtins, name)]


def __dir__():
    return sorted([*_public, "__version__"])
