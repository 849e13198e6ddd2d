# SPDX-License-Identifier: MIT
"""Models: recorded, written in C++, or made of others."""
