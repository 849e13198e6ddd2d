#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that imports of the Python package only point down: a package imports those before it in LAYERS alone, and no
files import each other in a circle. Imports for type checkers and within functions count.

Usage: check_import_graph.py [FOLDER], by default the package in python/myriad_ode."""

import ast
import pathlib
import sys

from check_include_graph import find_cycle

# From the bottom: each may import those before it.
LAYERS = ("base", "symbolic", "models", "codegen", "kernels", "sweeps", "results", "solving", "studies", "dynamics",
          "gradients", "inference", "formats")
COMPILED = "_core"  # the extension module, which everything may import


def modules_of(root):
    """The files by their names below the package, as "base.errors"; a package's own file has the package's name, and
    the first one's, which brings everything together, is left out."""
    named = {".".join(path.relative_to(root).with_suffix("").parts): path for path in sorted(root.rglob("*.py"))}
    return {name.removesuffix(".__init__"): path for name, path in named.items() if name != "__init__"}


def imports_of(name, path, package, modules):
    """(line, module) of everything that a file imports of the package; "" is the package itself."""
    parts = [*name.split("."), "__init__"] if path.name == "__init__.py" else name.split(".")
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            for alias in node.names:
                head, _, rest = alias.name.partition(".")
                if head == package:
                    yield node.lineno, rest
        elif isinstance(node, ast.ImportFrom):
            head, _, rest = (node.module or "").partition(".")
            if node.level == 0 and head != package:
                continue
            start = [] if node.level == 0 else parts[:len(parts) - node.level]
            below = [part for part in (rest if node.level == 0 else node.module or "").split(".") if part]
            for alias in node.names:
                of = ".".join([*start, *below])
                inner = f"{of}.{alias.name}" if of else alias.name
                yield node.lineno, inner if inner in modules or inner == COMPILED else of


def complaints(root):
    """What imports point up or go in a circle."""
    modules = modules_of(root)
    if not modules:
        return [f"no files in {root}"]
    found, graph = [], {name: {} for name in modules}
    for name, path in modules.items():
        layer = name.partition(".")[0]
        if layer not in LAYERS:
            found.append(f"{path.relative_to(root)} is in no layer: put it into one of {', '.join(LAYERS)}")
            continue
        for line, target in imports_of(name, path, root.name, modules):
            where = f"{path.relative_to(root)}:{line}"
            other = target.partition(".")[0]
            if other == COMPILED:
                continue
            if other not in LAYERS or LAYERS.index(other) > LAYERS.index(layer):
                below = LAYERS[:LAYERS.index(layer) + 1]
                found.append(f"{where} imports {target or 'the package itself'}: '{layer}' may import "
                             f"{', '.join(below)} alone; move what it needs down, or turn the import round")
            if target in modules and target != name:
                graph[name].setdefault(target, f"{where} imports {target}")
    if cycle := find_cycle(graph):
        links = [graph[file][cycle[(i + 1) % len(cycle)]] for i, file in enumerate(cycle)]
        found.append("files import each other in a circle: " + "; ".join(links))
    return found


def main(root):
    found = complaints(root)
    print(*found, f"{len(modules_of(root))} files", sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else
                  pathlib.Path(__file__).resolve().parents[2] / "python/myriad_ode"))
