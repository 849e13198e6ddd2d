# SPDX-License-Identifier: MIT
"""Problems from PEtab."""
