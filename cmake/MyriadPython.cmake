# SPDX-License-Identifier: MIT
# Finds a Python 3 (MYRIAD_PYTHON) for the checks written in it; none of them needs more than its standard library.

find_program(MYRIAD_PYTHON NAMES python3 DOC "Python 3, for checks")
mark_as_advanced(MYRIAD_PYTHON)
