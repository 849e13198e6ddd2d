#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that nothing reads what messages say, which is for people: Python's sources and scripts, and those in C++.

Errors and notes have parts and classes, by which programs tell them apart. Usage: check_messages.py [FOLDER], by
default that of the sources."""

import ast
import pathlib
import re
import sys

PYTHON = ("python/myriad_ode/**/*.py", "scripts/*.py")
CPP = ("src/*/*.cpp", "src/*/*/*.cpp", "src/*/*.hpp", "include/myriad/host/*/*.hpp", "include/myriad/study/**/*.hpp",
       "python/src/*.cpp", "python/src/*.hpp", "backends/cuda/myriad/cuda/*.cuh")
SEARCHES = {"count", "endswith", "find", "index", "partition", "removeprefix", "removesuffix", "replace", "rfind",
            "rindex", "rpartition", "rsplit", "split", "splitlines", "startswith", "translate"}
# what() or the words of a statement, maybe in parentheses or as another kind of string, and then a member of strings
# that looks for something, or a comparison.
SEARCH_IN_CPP = re.compile(
    r"(?:\bwhat\(\)|[.>]words|\bsaid\(\)\.text\(\))\s*\)*\s*(?:\.\s*(?:compare|contains|ends_with|find|find_\w+|rfind|"
    r"starts_with|substr)\b|[=!]=\s*\")|\bregex_\w+\([^;]*\bwhat\(\)|\bstrstr\([^;]*\bwhat\(\)")


class Reads(ast.NodeVisitor):
    """The lines in which a message is searched or changed: of an exception that was caught, or the words of the core,
    which functions get as `said`."""

    def __init__(self):
        self.messages, self.caught, self.lines = set(), frozenset(), []

    def is_message(self, node):
        """Whether it has the text of a message, maybe changed."""
        if isinstance(node, ast.Name):
            return node.id in self.messages
        if isinstance(node, ast.Call):
            if isinstance(node.func, ast.Name) and node.func.id in ("str", "repr", "format"):
                return any(self.is_message(a) or self.is_caught(a) for a in node.args)
            return isinstance(node.func, ast.Attribute) and self.is_message(node.func.value)
        if isinstance(node, ast.Subscript):
            return self.is_message(node.value)
        return isinstance(node, ast.Attribute) and node.attr == "args" and self.is_caught(node.value)

    def is_caught(self, node):
        return isinstance(node, ast.Name) and node.id in self.caught

    def visit_FunctionDef(self, node):
        outside = set(self.messages)
        self.messages |= {a.arg for a in node.args.args if a.arg == "said"}
        self.generic_visit(node)
        self.messages = outside

    def visit_ExceptHandler(self, node):
        outside = self.caught, set(self.messages)
        if node.name:
            self.caught = self.caught | {node.name}
        self.generic_visit(node)
        self.caught, self.messages = outside

    def visit_Assign(self, node):
        self.generic_visit(node)
        if self.is_message(node.value):
            self.messages |= {target.id for target in node.targets if isinstance(target, ast.Name)}

    def visit_Call(self, node):
        self.generic_visit(node)
        if not isinstance(node.func, ast.Attribute):
            return
        of = node.func.value
        if (node.func.attr in SEARCHES and self.is_message(of)
                or isinstance(of, ast.Name) and of.id == "re" and any(map(self.is_message, node.args))):
            self.lines.append(node.lineno)

    def visit_Compare(self, node):
        self.generic_visit(node)
        if any(map(self.is_message, [node.left, *node.comparators])):
            self.lines.append(node.lineno)


def reads_in_python(text):
    """The numbers of the lines of a Python source that read a message."""
    visitor = Reads()
    visitor.visit(ast.parse(text))
    return visitor.lines


def reads_in_cpp(text):
    """The numbers of the lines of a C++ source that read a message."""
    return [text.count("\n", 0, found.start()) + 1 for found in SEARCH_IN_CPP.finditer(text)]


def main(root):
    files, found = 0, []
    for patterns, reads in ((PYTHON, reads_in_python), (CPP, reads_in_cpp)):
        for path in sorted(path for pattern in patterns for path in root.glob(pattern)):
            files += 1
            found += [f"{path.relative_to(root)}:{line}: reads what a message says: give the error a part or a class"
                      for line in reads(path.read_text(encoding="utf-8"))]
    print(*found, f"{files} files", sep="\n")
    return 1 if found or files < 100 else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[2]))
