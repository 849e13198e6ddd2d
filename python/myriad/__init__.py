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
from .run import Interrupted, Run, status_names
from .solve import solve
from .study import Study, study
from .study_result import Damage, StudyResult, open_study, verify
from .symbols import *  # noqa: F403
from .table import *  # noqa: F403
from .tangents import *  # noqa: F403

__version__ = _core.version

_public = ["CppModel", "Damage", "Error", "Interrupted", "Run", "Study", "StudyResult", "cache", "controls", "methods",
           "open_study", "plots", "reduce", "solve", "status_names", "study", "verify",
           *(name for part in ("axes", "expression", "grid", "interpolate", "model", "symbols", "table", "tangents")
             for name in _sys.modules[f"{__name__}.{part}"].__all__)]
# What `from myriad import *` brings: nothing that has the name of a function of Python's, such as abs.
__all__ = [name for name in _public if not hasattr(_builtins, name)]


_renamed = {"logspace": "geomspace", "random_uniform": "uniform", "random_normal": "normal"}


def __getattr__(name):
    if name in _renamed:
        raise AttributeError(f"myriad.{name} is myriad.{_renamed[name]}, NumPy's name")
    raise AttributeError(f"module 'myriad' has no attribute '{name}'")


def __dir__():
    return sorted([*_public, "__version__"])
