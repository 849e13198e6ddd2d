# SPDX-License-Identifier: MIT
"""Models as functions of values, and their derivatives."""
