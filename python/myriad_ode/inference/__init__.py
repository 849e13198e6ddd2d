# SPDX-License-Identifier: MIT
"""Models and data: fits, profiles, designs."""
