# SPDX-License-Identifier: MIT
"""What everything else rests on: errors, the core's words, kinds of components, statuses, pictures of arrays."""
