#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The reference of the Python package, from its sources, which are not imported.

Usage: scripts/python_reference.py (--check | --write FOLDER) [--source FOLDER]

Public is what the package has in `_public`, with what `__all__` of its modules adds; of a public module its `__all__`,
or its functions; of a class what has no underscore. --check names what has no description, or no type of an argument or
of what it returns, and fails if there is one; --write writes the pages as Markdown.
"""

import argparse
import ast
import inspect
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PACKAGE = "python/myriad_ode"

# The pages, and the files whose names they have. A public name of another file is an error.
PAGES = {
    "python_solve": ("Python: solve and runs", "What a call takes and returns.",
                     ["solving.solve", "solving.options", "results.run", "results.load", "results.report",
                      "base.statuses", "sweeps.sweep", "symbolic.axes", "results.gpu_results", "base.errors",
                      "models.methods"]),
    "python_model": ("Python: models", "Equations, events and hooks, and the symbols and functions in them.",
                     ["codegen.model", "models.event", "models.doses", "models.dose_table", "models.trigger",
                      "symbolic.symbols", "symbolic.functions", "symbolic.delays", "symbolic.distributions",
                      "symbolic.expression", "symbolic.interpolate", "symbolic.table", "models.tangents",
                      "models.located_switches",
                      "results.exponents", "models.cpp_model", "formats.sbml.model", "models.units",
                      "formats.cellml.model", "formats.sedml.experiments", "formats.xpp.model"]),
    "python_fit": ("Python: sensitivities and fits", "Derivatives of results, and what is fitted to data by them.",
                   ["models.sensitivities", "results.sensitivities", "gradients.batched", "inference.least_squares",
                    "inference.objective", "inference.fitting", "inference.profile", "inference.experiments",
                    "inference.likelihood", "inference.noise_models", "inference.priors",
                    "formats.petab.problem", "inference.designs"]),
    "python_dynamics": ("Python: attractors", "What orbits come to: attractors, basins, steady states, hysteresis.",
                        ["dynamics.attractors", "dynamics.continuation", "dynamics.hysteresis",
                         "dynamics.steady_states"]),
    "python_study": ("Python: studies", "Studies, reductions, and results on disk.",
                     ["studies.study", "studies.result", "studies.reduce"]),
    "python_tools": ("Python: pictures and the cache", "`my.plots`, `run.plot`, and `my.cache`.",
                     ["base.plots", "results.run_plots", "kernels.cache"]),
}
# Classes that public functions return, whose members users call though they do not make them.
RETURNED = {"results.report": ["Report"], "sweeps.sweep": ["Sweep"], "symbolic.axes": ["Axis"],
            "symbolic.table": ["Table"], "models.dose_table": ["DoseTable"],
            "studies.reduce": ["Reduction"], "models.tangents": ["WithTangents"],
            "results.run_plots": ["Plots"], "inference.profile": ["Profile"], "inference.objective": ["Objective"],
            "inference.designs": ["Design", "Indices"], "results.gpu_results": ["DeviceArray", "DeviceResults"],
            "symbolic.expression": ["Expression", "Condition"]}


class Entity:
    """A public function, class, value or module."""

    def __init__(self, name, node, module, text):
        self.name, self.node, self.module, self.text, self.members = name, node, module, text, []


def docstring(node):
    return inspect.cleandoc(ast.get_docstring(node) or "")


def assigned_names(node):
    if isinstance(node, ast.AnnAssign):
        return [node.target.id] if isinstance(node.target, ast.Name) else []
    return [t.id for t in getattr(node, "targets", []) if isinstance(t, ast.Name)]


def comment_of(node, lines):
    """The comment `#:` behind a value or above it."""
    behind = re.search(r"#: (.*)", lines[node.end_lineno - 1])
    if behind:
        return behind[1]
    above, number = [], node.lineno - 2
    while number >= 0 and lines[number].strip().startswith("#:"):
        above.insert(0, lines[number].strip()[2:].strip())
        number -= 1
    return " ".join(above)


def description_of_value(node, lines):
    """A value's comment, or the text that a function which makes functions is given."""
    made = getattr(node, "value", None)
    if isinstance(made, ast.Call) and len(made.args) == 2 and isinstance(made.args[1], ast.Constant):
        return str(made.args[1].value)
    return comment_of(node, lines)


class Module:
    """The definitions of a file."""

    def __init__(self, name, file):
        self.name, self.path = name, name.replace(".", "/") + ".py"
        text = file.read_text(encoding="utf-8")
        self.tree, self.lines = ast.parse(text), text.splitlines()
        self.all, self.found = [], {}
        for node in self.tree.body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                self.found[node.name] = Entity(node.name, node, self, docstring(node))
            for name in assigned_names(node):
                if name == "__all__" and isinstance(node.value, ast.List):
                    self.all = ast.literal_eval(node.value)
                self.found[name] = Entity(name, node, self, description_of_value(node, self.lines))
        for entity in self.found.values():
            if isinstance(entity.node, ast.ClassDef):
                entity.members = list(self.members_of(entity.node))
        self.text = docstring(self.tree)

    def members_of(self, node):
        """Functions, properties and documented attributes of a class."""
        for part in node.body:
            if isinstance(part, ast.FunctionDef):
                if part.name == "__init__":
                    for inner in ast.walk(part):
                        target = getattr(inner, "targets", [getattr(inner, "target", None)])[0]
                        if isinstance(inner, (ast.Assign, ast.AnnAssign)) and isinstance(target, ast.Attribute):
                            text = comment_of(inner, self.lines)
                            if text and not target.attr.startswith("_"):
                                yield Entity(target.attr, inner, self, text)
                elif not part.name.startswith("_"):
                    yield Entity(part.name, part, self, docstring(part))

    def public(self):
        """All names of a module that is itself public."""
        return self.all or [n for n, e in self.found.items() if not n.startswith("_") and
                            isinstance(e.node, ast.FunctionDef) and e.text]


def add_inherited(modules):
    """Gives `Model` the members of the record that it is made of."""
    model, recorded = modules["codegen.model"].found["Model"], modules["models.recorded"].found["RecordedModel"]
    own = {member.name for member in model.members}
    model.members += [member for member in recorded.members if member.name not in own]


def read(source):
    """All public entities: (page, name as users write it, entity)."""
    files = {".".join(f.relative_to(source / PACKAGE).with_suffix("").parts): f
             for f in sorted((source / PACKAGE).rglob("*.py"))}
    modules = {name: Module(name, f) for name, f in files.items()}
    add_inherited(modules)
    package = modules["__init__"]
    public = next(n.value for n in package.tree.body if "_public" in assigned_names(n))
    names = [e.value for e in public.elts if isinstance(e, ast.Constant)]
    comprehension = next(e.value for e in public.elts if isinstance(e, ast.Starred))
    names += [n for part in ast.literal_eval(comprehension.generators[0].iter) for n in modules[part].all]
    imported, public_modules = {}, {}
    for node in package.tree.body:
        if isinstance(node, ast.ImportFrom) and node.level == 1:
            for alias in node.names:
                if alias.name == "*":
                    imported.update((n, node.module) for n in modules[node.module].all)
                elif f"{node.module}.{alias.name}" in modules:
                    public_modules[alias.name] = f"{node.module}.{alias.name}"
                else:
                    imported[alias.asname or alias.name] = node.module
    found, problems = [], []
    for name in names:
        if name in public_modules:
            module = modules[public_modules[name]]
            found += [(f"my.{name}.{n}", module.found[n]) for n in module.public()]
        elif name in imported and name in modules[imported[name]].found:
            found.append((f"my.{name}", modules[imported[name]].found[name]))
        else:
            problems.append(f"{PACKAGE}/__init__.py: {name} is public and defined nowhere")
    for module, classes in RETURNED.items():
        there = {entity.name for _, entity in found}
        found += [(n, modules[module].found[n]) for n in classes if n not in there]
    placed = []
    for name, entity in found:
        page = next((p for p, (_, _, of) in PAGES.items() if entity.module.name in of), None)
        if page is None:
            problems.append(f"{PACKAGE}/{entity.module.path}: {name} is on no page of scripts/python_reference.py")
        placed.append((page, name, entity))
    return modules, placed, problems


def arguments_of(function):
    a = function.args
    return [*a.posonlyargs, *a.args, *([a.vararg] if a.vararg else []), *a.kwonlyargs, *([a.kwarg] if a.kwarg else [])]


def untyped(entity, is_member):
    """What of a function has no type."""
    node = entity.node
    if not isinstance(node, ast.FunctionDef):
        return []
    arguments = arguments_of(node)
    is_static = any(isinstance(d, ast.Name) and d.id == "staticmethod" for d in node.decorator_list)
    missing = [a.arg for a in arguments[1 if is_member and not is_static else 0:] if a.annotation is None]
    return missing + (["what it returns"] if node.returns is None else [])


def check(placed, problems):
    count = 0
    for _, name, entity in placed:
        inner = [(f"{name}.{m.name}", m, True) for m in entity.members]
        for full, one, is_member in [(name, entity, False), *inner]:
            count += 1
            where = f"{PACKAGE}/{one.module.path}:{one.node.lineno}: {full}"
            if not one.text:
                problems.append(f"{where} has no description")
            for what in untyped(one, is_member):
                problems.append(f"{where}: {what} has no type")
        for part in getattr(entity.node, "body", []):
            if isinstance(entity.node, ast.ClassDef) and getattr(part, "name", "") == "__init__":
                for what in untyped(Entity("__init__", part, entity.module, ""), True):
                    if what != "what it returns":
                        problems.append(f"{PACKAGE}/{entity.module.path}:{part.lineno}: {name}: {what} has no type")
    print("\n".join([*problems, f"{count} public names of the Python package"]))
    return 1 if problems else 0


def signature(name, node, is_member):
    """How a function is called, an argument in a line if it is long."""
    arguments = ast.unparse(node.args)
    if is_member:
        arguments = re.sub(r"^self(, )?", "", arguments)
    returns = f" -> {ast.unparse(node.returns)}" if node.returns else ""
    line = f"{name}({arguments}){returns}"
    if len(line) <= 100:
        return line
    parts, depth, begin = [], 0, 0
    for i, c in enumerate(arguments):
        depth += (c in "([{") - (c in ")]}")
        if c == "," and depth == 0:
            parts.append(arguments[begin:i].strip())
            begin = i + 1
    return "\n".join([f"{name}(", *(f"    {p}," for p in [*parts, arguments[begin:].strip()]), f"){returns}"])


def markdown(text):
    """A description: paragraphs, with lists of arguments as they are."""
    parts = []
    for part in text.split("\n\n"):
        lines = part.splitlines()
        is_list = sum(bool(re.match(r"[\w, ]+?(  |: )|    ", line)) for line in lines) == len(lines)
        parts.append("```text\n" + part + "\n```" if is_list and len(lines) > 1 else part)
    return "\n\n".join(parts)


def entry(name, entity):
    """The section of one entity."""
    out = [f"## `{name.removeprefix('my.')}`"]
    node = entity.node
    if isinstance(node, ast.FunctionDef):
        out.append(f"```python\n{signature(name, node, False)}\n```")
    elif isinstance(node, ast.ClassDef):
        init = next((p for p in node.body if getattr(p, "name", "") == "__init__"), None)
        made = signature(name, init, True).removesuffix(" -> None") if init else name
        out.append(f"```python\nclass {made if name.startswith('my.') else name}\n```")
    out.append(markdown(entity.text))
    for m in entity.members:
        is_property = any(getattr(d, "id", "") == "property" for d in getattr(m.node, "decorator_list", []))
        if isinstance(m.node, ast.FunctionDef) and not is_property:
            out.append(f"```python\n{signature('.' + m.name, m.node, True)}\n```\n\n{markdown(m.text)}")
        else:
            of = getattr(m.node, "returns", None) or getattr(m.node, "annotation", None)
            out.append(f"**`.{m.name}`**{f': `{ast.unparse(of)}`' if of else ''}. {markdown(m.text)}")
    return "\n\n".join(out)


def write(folder, modules, placed):
    for page, (title, about, _) in PAGES.items():
        out = [f"# {title}", about]
        here = [(n, e) for p, n, e in placed if p == page]
        out += [f"`{m}`: {text}" for m, text in sorted(
            {n.rpartition(".")[0]: e.module.text for n, e in here if n.count(".") == 2}.items())]
        out += [entry(n, e) for n, e in here]
        (folder / f"{page}.md").write_text("\n\n".join(out) + "\n", encoding="utf-8")


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--check", action="store_true")
    what.add_argument("--write", metavar="FOLDER", type=pathlib.Path)
    parser.add_argument("--source", metavar="FOLDER", type=pathlib.Path, default=ROOT)
    asked = parser.parse_args(arguments)
    modules, placed, problems = read(asked.source)
    if asked.check or problems:
        return check(placed, problems)
    asked.write.mkdir(parents=True, exist_ok=True)
    write(asked.write, modules, placed)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
