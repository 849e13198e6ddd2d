# SPDX-License-Identifier: MIT
"""Myriad: very large ensembles of small systems of ordinary differential equations, from models written in Python."""

from . import _core, cache
from .cpp_model import CppModel, Event
from .errors import Error
from .methods import controls, methods
from .run import Interrupted, Run, status_names
from .solve import solve

__version__ = _core.version
