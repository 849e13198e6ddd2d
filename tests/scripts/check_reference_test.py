#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""scripts/reference.py finds what has no description, in a copy of the sources from which descriptions were taken."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

# File, what is taken away or added, and the entity that must then be named.
CHANGES = (
    ("include/myriad/host/solve/solver.hpp", r"    /// The largest number of instances\.\n", "", "solver::capacity"),
    ("include/myriad/host/options/options.hpp", r"///< trial steps per phase.*", "", "options::max_steps"),
    ("include/myriad/kernel/core/status.hpp", r"///< a linear solve of an implicit method failed", "",
     "status::singular_jacobian"),
    ("include/myriad/kernel/scalar/select.hpp", r"/// Infinity\.\n", "", "infinity_of"),
    ("include/myriad/kernel/model/lane.hpp", r"  ///< number of the instance in the ensemble", "", "lane::index"),
    ("include/myriad/instantiate.hpp", r"/// The same in single precision.*\n", "", "MYRIAD_INSTANTIATE_FLOAT"),
    ("include/myriad/host/model/describe.hpp", r"\nnamespace myriad \{\n", "\nnamespace myriad {\nint added();\n",
     "added"),
    ("CMakeLists.txt", r'option\(MYRIAD_WERROR "[^"]*"', 'option(MYRIAD_WERROR ""', "MYRIAD_WERROR"),
)


def main():
    if shutil.which("doxygen") is None:
        print("Skipped: there is no doxygen")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        shutil.copytree(ROOT / "include", copy / "include")
        shutil.copytree(ROOT / "cmake", copy / "cmake")
        shutil.copy(ROOT / "CMakeLists.txt", copy)
        for name, old, new, _ in CHANGES:
            text = (copy / name).read_text(encoding="utf-8")
            changed, count = re.subn(old, new, text, count=1)
            if count != 1:
                print(f"{name} has no '{old}' any more: change this test")
                return 1
            (copy / name).write_text(changed, encoding="utf-8")
        done = subprocess.run([sys.executable, "-B", ROOT / "scripts" / "reference.py", "--check", "--source", copy],
                              capture_output=True, text=True, check=False)
    named = set(re.findall(r": (\S+) has no description", done.stdout))
    expected = {entity for *_, entity in CHANGES}
    print(f"expected {sorted(expected)}, found {sorted(named)}")
    return 0 if done.returncode == 1 and named == expected else 1


if __name__ == "__main__":
    sys.exit(main())
