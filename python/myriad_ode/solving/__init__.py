# SPDX-License-Identifier: MIT
"""`solve`: its options and inputs."""
