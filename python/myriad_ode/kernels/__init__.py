# SPDX-License-Identifier: MIT
"""What integrates: compiled for CPUs and GPUs, or interpreted."""
