# SPDX-License-Identifier: MIT
"""What a run returns."""
