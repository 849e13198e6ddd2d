# SPDX-License-Identifier: MIT
"""Studies, and their results on disk."""
