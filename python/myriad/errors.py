# SPDX-License-Identifier: MIT
"""What the package raises: one class, so that callers can tell its messages from those of other packages."""

import os
import sys

import numpy as np

_here = os.path.dirname(os.path.abspath(__file__)) + os.sep


class Error(ValueError):
    """Something in a model, a sweep or the options of a call is wrong; the message says what and what to do."""


def users_line():
    """File and line of the innermost caller outside this package, as (file, line), or None."""
    frame = sys._getframe(1)
    while frame is not None and frame.f_code.co_filename.startswith(_here):
        frame = frame.f_back
    return None if frame is None else (frame.f_code.co_filename, frame.f_lineno)


def refuse_masked(values, what):
    """Refuses a masked array, whose hidden values would count as given."""
    if isinstance(values, np.ma.MaskedArray):
        if np.ma.is_masked(values):
            raise Error(f"{what} has masked values{at(users_line())}: every value is needed, so fill them, as by "
                        ".filled(0.0), or leave out their instances")


def at(line):
    """', FILE:LINE' for messages; nothing where the line is not known."""
    return "" if line is None else f" ({os.path.basename(line[0])}:{line[1]})"
