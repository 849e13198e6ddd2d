# SPDX-License-Identifier: MIT
"""The values of all instances."""
