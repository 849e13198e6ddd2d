# SPDX-License-Identifier: MIT
"""Models from CellML."""
