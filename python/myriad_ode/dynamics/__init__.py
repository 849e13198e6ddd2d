# SPDX-License-Identifier: MIT
"""What orbits come to in the end: attractors and their basins, steady states, hysteresis."""
