# SPDX-License-Identifier: MIT
"""Expressions, what is made of them, and how they are read."""
