# SPDX-License-Identifier: MIT
"""Models from files."""
