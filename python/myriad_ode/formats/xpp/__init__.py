# SPDX-License-Identifier: MIT
"""Models from XPP."""
