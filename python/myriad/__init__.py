# SPDX-License-Identifier: MIT
"""Myriad: very large ensembles of small systems of ordinary differential equations, from models written in Python."""

from . import _core, cache, reduce
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
