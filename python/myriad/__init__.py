# SPDX-License-Identifier: MIT
"""Myriad: large ensembles of small systems of ordinary differential equations, on CPUs and GPUs."""

from .errors import Error
from .expression import *  # noqa: F403
from .grid import *  # noqa: F403
from .model import *  # noqa: F403
from .symbols import *  # noqa: F403
