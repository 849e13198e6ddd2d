#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""scripts/reference.py finds what has no description, names without an entry, and what Doxygen warns of.

Each in a copy of the sources that was changed so."""

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
    ("include/myriad/host/options/options.hpp", r"///< smallest step size; 0: the resolution of t", "",
     "options::minimum_step"),
    ("include/myriad/kernel/core/status.hpp", r"///< a linear solve of an implicit method failed", "",
     "status::singular_jacobian"),
    ("include/myriad/kernel/scalar/select.hpp", r"/// Infinity\.\n", "", "infinity_of"),
    ("include/myriad/kernel/model/lane.hpp", r"  ///< number of the instance in the ensemble", "", "lane::index"),
    ("include/myriad/instantiate.hpp", r"/// The same in single precision.*\n", "", "MYRIAD_INSTANTIATE_FLOAT"),
    ("include/myriad/host/model/describe.hpp", r"\nnamespace myriad \{\n", "\nnamespace myriad {\nint added();\n",
     "added"),
    ("include/myriad/version.hpp", r"/// Third number of the version\.\n", "", "MYRIAD_VERSION_PATCH"),
    ("CMakeLists.txt", r'option\(MYRIAD_WERROR "[^"]*"', 'option(MYRIAD_WERROR ""', "MYRIAD_WERROR"),
)

# The same for names that are looked for in a model, a method or the environment.
CONCEPTS, KINDS = "include/myriad/kernel/model/concepts.hpp", "include/myriad/kernel/model/component_kinds.hpp"
MEMBER_CHANGES = (
    ("docs/model_members.md", r"### `pack_batches`\n", "", "pack_batches"),
    ("docs/model_members.md", r"\| `n_vectors` \|.*\n", "", "n_vectors"),
    ("docs/method_members.md", r"\| `extra_node` \|.*\n", "", "extra_node"),
    ("docs/environment.md", r"\| `MYRIAD_INSTRUCTION_SET` \|.*\n", "", "MYRIAD_INSTRUCTION_SET"),
    (CONCEPTS, r"MYRIAD_MODEL_DECLARATION\(scalar_only\)\n", r"\g<0>MYRIAD_MODEL_DECLARATION(new_declaration)\n",
     "new_declaration"),
    (CONCEPTS, r"MYRIAD_HOOK_NAME\(finalise\)\n", r"\g<0>MYRIAD_HOOK_NAME(new_hook)\n", "new_hook"),
    (KINDS, r'row\(event, events, "event", void\)', r'\g<0> row(new_kind, new_kinds, "new kind", void)',
     ("new_kind", "n_new_kind", "unit_new_kind", "n_unit_new_kind")),
    ("backends/openmp/myriad/openmp/packs.hpp", r"requires \{ Model::pack_batches; \}",
     r"requires { Model::pack_batches; Model::new_member; }", "new_member"),
    ("docs/model_members.md", r"### `max_block_size`\n", r"\g<0>\n### `nobody_asks`\n", "nobody_asks"),
)
WARNED_OF = (("include/myriad/kernel/state/kernel_arguments.hpp", r"/// The arguments of a kernel\.\n",
              "/// The arguments \\\\of_a kernel.\n", "of_a"),)


def changed_check(changes):
    """Exit status and output of the check in a copy with the changes; None if one cannot be made any more."""
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        for part in ("include", "cmake", "backends", "src", "docs"):
            shutil.copytree(ROOT / part, copy / part)
        shutil.copy(ROOT / "CMakeLists.txt", copy)
        for name, old, new, _ in changes:
            text = (copy / name).read_text(encoding="utf-8")
            changed, count = re.subn(old, new, text, count=1)
            if count != 1:
                print(f"{name} has no '{old}' any more: change this test")
                return None
            (copy / name).write_text(changed, encoding="utf-8")
        done = subprocess.run([sys.executable, "-B", ROOT / "scripts" / "reference.py", "--check", "--source", copy],
                              capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr


def finds(changes, pattern):
    """Whether the check fails, and names just what the changes say."""
    done = changed_check(changes)
    if done is None:
        return False
    named = set(next(filter(None, match)) for match in re.findall(pattern, done[1]))
    expected = set()
    for *_, names in changes:
        expected |= {names} if isinstance(names, str) else set(names)
    print(f"expected {sorted(expected)}, found {sorted(named)}")
    return done[0] == 1 and named == expected


def main():
    if shutil.which("doxygen") is None:
        print("Skipped: there is no doxygen")
        return 77
    fine = [finds(CHANGES, r": (\S+) has (no) description"),
            finds(MEMBER_CHANGES, r": (\w+) is looked for by name|nothing looks for (\w+)"),
            finds(WARNED_OF, r"unknown command '?[\\@]?(\w+)(')?")]
    return 0 if all(fine) else 1


if __name__ == "__main__":
    sys.exit(main())
