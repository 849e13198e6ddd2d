# SPDX-License-Identifier: MIT
"""Models from SBML."""
