# SPDX-License-Identifier: MIT
"""The names of the library's methods, for other scripts."""

import pathlib
import re

_LIST = pathlib.Path(__file__).resolve().parent.parent / "include/myriad/kernel/methods/method_list.hpp"
_OF_KIND = {kind: tuple(re.findall(r"\bDO\((\w+)\)", names)) for kind, names in re.findall(
    r"#define MYRIAD_(\w+)_METHODS\(DO\)((?:.*\\\n)*.*)", _LIST.read_text(encoding="utf-8"))}
ORDINARY = (*_OF_KIND["EXPLICIT"], *_OF_KIND["STIFF"])  #: those for ordinary equations
METHODS = (*ORDINARY, *_OF_KIND["STOCHASTIC"])
