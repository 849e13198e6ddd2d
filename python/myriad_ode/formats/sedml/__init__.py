# SPDX-License-Identifier: MIT
"""Simulation experiments from SED-ML, also in archives of COMBINE."""
