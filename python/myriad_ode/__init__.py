# SPDX-License-Identifier: MIT
"""Myriad: very large ensembles of small systems of ordinary differential equations, from models written in Python."""

from __future__ import annotations

import builtins as _builtins
import sys as _sys

from . import _core
from .base import plots as plots
from .base.errors import Error as Error
from .base.statuses import status_names as status_names
from .codegen.model import *  # noqa: F403
from .dynamics.attractors import *  # noqa: F403
from .dynamics.continuation import *  # noqa: F403
from .dynamics.hysteresis import *  # noqa: F403
from .dynamics.steady_states import *  # noqa: F403
from .formats.cellml.model import CellmlModel as CellmlModel, read_cellml as read_cellml
from .formats.petab.problem import PetabProblem as PetabProblem, read_petab as read_petab
from .formats.sbml.model import SbmlModel as SbmlModel, read_antimony as read_antimony, read_sbml as read_sbml
from .formats.sedml.experiments import TimeCourse as TimeCourse, read_sedml as read_sedml
from .formats.xpp.model import XppModel as XppModel, read_xpp as read_xpp
from .gradients.batched import *  # noqa: F403
from .inference import designs as designs, noise_models as noise_models, priors as priors
from .inference.experiments import *  # noqa: F403
from .inference.fitting import *  # noqa: F403
from .inference.least_squares import *  # noqa: F403
from .inference.likelihood import *  # noqa: F403
from .kernels import cache as cache
from .models.cpp_model import CppModel as CppModel
from .models.dose_table import *  # noqa: F403
from .models.doses import *  # noqa: F403
from .models.event import *  # noqa: F403
from .models.located_switches import *  # noqa: F403
from .models.methods import controls as controls, methods as methods
from .models.sensitivities import *  # noqa: F403
from .models.tangents import *  # noqa: F403
from .models.trigger import *  # noqa: F403
from .models.units import *  # noqa: F403
from .results.exponents import *  # noqa: F403
from .results.load import load as load
from .results.report import Interrupted as Interrupted
from .results.run import Run as Run
from .results.sensitivities import *  # noqa: F403
from .solving.options import (EventChoice as EventChoice, Options as Options, RecordChoice as RecordChoice,
                              SampleChoice as SampleChoice)
from .solving.solve import solve as solve
from .studies import reduce as reduce
from .studies.result import Damage as Damage, StudyResult as StudyResult, open_study as open_study, verify as verify
from .studies.study import Study as Study, study as study
from .sweeps.sweep import *  # noqa: F403
from .symbolic import numpy_functions as numpy_functions
from .symbolic.axes import *  # noqa: F403
from .symbolic.delays import *  # noqa: F403
from .symbolic.distributions import *  # noqa: F403
from .symbolic.expression import *  # noqa: F403
from .symbolic.functions import *  # noqa: F403
from .symbolic.interpolate import *  # noqa: F403
from .symbolic.symbols import *  # noqa: F403
from .symbolic.table import *  # noqa: F403

__version__ = _core.version

_public = ["CellmlModel", "CppModel", "Damage", "Error", "EventChoice", "Interrupted", "Options", "PetabProblem",
           "RecordChoice", "Run", "SampleChoice", "SbmlModel", "Study", "StudyResult", "TimeCourse", "XppModel",
           "cache", "controls", "designs", "load", "methods", "noise_models", "open_study", "plots", "priors",
           "read_antimony", "read_cellml", "read_petab", "read_sbml", "read_sedml", "read_xpp", "reduce", "solve",
           "status_names", "study", "verify",
           *(name for part in ("codegen.model", "dynamics.attractors", "dynamics.continuation", "dynamics.hysteresis",
                               "dynamics.steady_states", "gradients.batched", "inference.experiments",
                               "inference.fitting", "inference.least_squares", "inference.likelihood",
                               "models.dose_table", "models.doses", "models.event", "models.located_switches",
                               "models.sensitivities", "models.tangents", "models.trigger", "models.units",
                               "results.exponents", "results.sensitivities", "sweeps.sweep", "symbolic.axes",
                               "symbolic.delays", "symbolic.distributions", "symbolic.expression", "symbolic.functions",
                               "symbolic.interpolate", "symbolic.symbols", "symbolic.table")
             for name in _sys.modules[f"{__name__}.{part}"].__all__)]
# What `from myriad_ode import *` brings: nothing that has the name of a function of Python's, such as abs.
__all__ = [name for name in _public if not hasattr(_builtins, name)]


def __dir__() -> list[str]:
    return sorted([*_public, "__version__"])
