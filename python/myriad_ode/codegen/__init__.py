# SPDX-License-Identifier: MIT
"""Models as text: C++, the interpreter's tape, adjoints."""
