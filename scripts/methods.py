# SPDX-License-Identifier: MIT
"""The names of the library's methods, for other scripts."""

import pathlib
import re

_LIST = pathlib.Path(__file__).resolve().parent.parent / "include/myriad/kernel/methods/method_list.hpp"
METHODS = tuple(re.findall(r"\bDO\((\w+)\)", _LIST.read_text(encoding="utf-8")))
