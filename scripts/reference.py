#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The reference of the public interface, from the comments in the sources.

Usage: scripts/reference.py (--check | --write FOLDER) [--source FOLDER]

--check names every public entity without a description, and fails if there is one; --write writes the reference as
Markdown. Public is: what is in namespace myriad (not detail, host, studies or a backend, but for what public
functions take and return) and has public access; macros and CMake functions that users write; CMake options. Of
overloads one must be described, and a member that several methods have in one of them. What the sources look for by
name in a model or a method of the user's, and the environment variables that they read, must have entries on the
pages of MEMBER_PAGES. A warning of Doxygen's is an error. Exit status 77, "skipped" for ctest, if there is no
doxygen.
"""

import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import python_reference
from methods import METHODS

ROOT = pathlib.Path(__file__).resolve().parent.parent

# What the pages are about, and the headers whose entities they have, by the beginning of the path below
# include/myriad. A header that is named on no page is an error, so that nothing is left out.
PAGES = {
    "ensemble": ("Ensembles", "`<myriad/myriad.hpp>`. The data of all instances: set before a call, read after it.",
                 ["host/ensemble/ensemble.hpp", "host/ensemble/component_map.hpp",
                  "host/ensemble/trajectory_samples.hpp", "host/checks/make_consistent.hpp"]),
    "solve": ("Devices, solve and solver", "`<myriad/myriad.hpp>`, or `<myriad/device.hpp>` and `<myriad/solve.hpp>`.",
              ["host/backend/device.hpp", "host/solve/", "host/core/error.hpp", "version.hpp"]),
    "options": ("Options",
                "`<myriad/options.hpp>`. Checked once per call: `error` names an option that is out of range.",
                ["host/options/options.hpp", "kernel/state/kernel_arguments.hpp", "host/options/"]),
    "report": ("Reports and statuses", "`<myriad/myriad.hpp>`. How a call went, as a whole and instance by instance.",
               ["host/report/", "kernel/core/status.hpp", "kernel/model/matrix_facts.hpp", "host/backend/facts.hpp"]),
    "model": ("In a model", "`<myriad/model.hpp>`: what the functions of a model are called with, and what they use.",
              ["host/model/", "kernel/core/", "kernel/model/lane.hpp", "kernel/model/past.hpp",
               "kernel/model/event_signs.hpp",
               "kernel/model/jacobian_pattern.hpp",
               "kernel/model/mass_matrix.hpp", "kernel/model/recurring.hpp", "kernel/model/summaries.hpp",
               "kernel/model/tables.hpp", "kernel/scalar/"]),
    "random": ("Random numbers", "`<myriad/random.hpp>`.", ["kernel/model/random.hpp"]),
    "queue": ("Delayed actions", "`<myriad/action_queue.hpp>`.", ["kernel/model/action_queue.hpp"]),
    "tangent": ("Tangents and Lyapunov exponents", "`<myriad/tangent.hpp>`.",
                ["kernel/model/tangent.hpp", "host/ensemble/exponents.hpp"]),
    "sensitivity": ("Sensitivities", "`<myriad/sensitivity.hpp>`.",
                    ["kernel/model/sensitivity.hpp", "host/ensemble/sensitivities.hpp"]),
    "adjoint": ("Adjoints", "`<myriad/adjoint.hpp>`, and `<myriad/instantiate_adjoint.hpp>` for the model's file.",
                ["host/solve/adjoint.hpp"]),
    "coupled_units": ("Coupled units", "`<myriad/coupled_units.hpp>`.",
                      ["kernel/model/coupled_units.hpp", "kernel/model/coupling.hpp", "kernel/model/unit_views.hpp",
                       "host/ensemble/couplings.hpp"]),
    "study": ("Studies", "`<myriad/study.hpp>`, target `myriad::study`. Axes, what is kept, the run, results on disk.",
              ["study/study.hpp", "study/model_study.hpp", "study/plan/axes.hpp", "study/plan/reduction.hpp", "study/",
               "kernel/study/"]),
    "mpi": ("Studies over MPI", "`<myriad/mpi.hpp>`, target `myriad::mpi`.", ["mpi.hpp"]),
    "program": ("The command-line program", "`<myriad/program.hpp>`, target `myriad::program`: models for it.",
                ["program.hpp"]),
    "methods": ("Methods", "`<myriad/methods.hpp>`, and `<myriad/tableau.hpp>` for a method of your own.",
                ["kernel/methods/"]),
}

# Classes whose objects a model handles as R, masks or expressions, without naming their members.
OPAQUE = ("pack", "pack_mask", "dual", "dependence", "unknown_truth", "vec_values", "shared_values",
          "component_map::list")
# What public functions take and return of other namespaces. Objects of OPAQUE_STUDIES are passed on, or made by the
# library alone.
PUBLIC_STUDIES = ("along", "arithmetic", "attribute", "component", "component_kind", "component_names", "coordinate",
                  "damage", "dimension", "element", "layout", "other_arithmetic", "results", "resume_check", "role",
                  "store_options", "store_progress", "variable")
OPAQUE_STUDIES = ("any_model", "chunk_record", "column", "computed_chunk", "file_system", "handed_out_run",
                  "reduction_definition")
PUBLIC_ELSEWHERE = ("myriad::cuda::kernel_facts",  # report::kernel
                    *(f"myriad::studies::{name}" for name in PUBLIC_STUDIES))
MACROS = ("MYRIAD_FUNCTION", "MYRIAD_LAMBDA", "MYRIAD_INSTANTIATE", "MYRIAD_INSTANTIATE_FLOAT",
          "MYRIAD_INSTANTIATE_ADJOINT", "MYRIAD_VERSION",
          "MYRIAD_REGISTER_MODEL", "MYRIAD_REGISTER_MODEL_FLOAT",
          "MYRIAD_VERSION_MAJOR", "MYRIAD_VERSION_MINOR", "MYRIAD_VERSION_PATCH")
CMAKE_FUNCTIONS = ("myriad_add_models",)
# A user's project gets the defaults of the modules, before those of the library's own build.
CMAKE_FILES = ("cmake/MyriadModels.cmake", "cmake/MyriadXsimd.cmake", "cmake/MyriadCuda.cmake", "CMakeLists.txt")

# Pages of docs/ with an entry, a heading or the first cell of a row, for each name that the sources look for: in a type
# of that name, or in the environment. With the fewest names that there must be, else they were not read.
MEMBER_PAGES = {"Model": ("model_members", 35), "Method": ("method_members", 15), "environment": ("environment", 1)}
MEMBER_SOURCES = ("include", "backends", "src")

DOXYFILE = """
QUIET = YES
WARNINGS = YES
INPUT = "{source}/include/myriad"
RECURSIVE = YES
FILE_PATTERNS = *.hpp
STRIP_FROM_PATH = "{source}"
OUTPUT_DIRECTORY = "{output}"
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
EXTRACT_ALL = YES
AUTOLINK_SUPPORT = NO
HAVE_DOT = NO
MACRO_EXPANSION = YES
EXPAND_ONLY_PREDEF = YES
PREDEFINED = "MYRIAD_FUNCTION=" "MYRIAD_LAMBDA=" "__attribute__(x)=" "MYRIAD_WARN_OF_INDEX(i,n)="
EXPAND_AS_DEFINED = MYRIAD_UNARY MYRIAD_BINARY
FILTER_PATTERNS = *.hpp="sed -E 's/::inline MYRIAD_(TARGET|ABI)//; s/inline namespace MYRIAD_TARGET/namespace target/'"
"""


class Entity:
    """A public entity: its kind, name, declarations, description, place, and values or members."""

    def __init__(self, kind, name, file, line):
        self.kind, self.name, self.file, self.line = kind, name, file, line
        self.declarations, self.text, self.default = [], "", ""
        self.members, self.values = [], []


def plain(element):
    return "" if element is None else " ".join("".join(element.itertext()).split())


def markdown(element):
    """The text of a description as Markdown."""
    if element is None:
        return ""
    parts = []

    def inline(node):
        out = node.text or ""
        for child in node:
            if child.tag == "computeroutput":
                out += "`" + "".join(child.itertext()) + "`"
            elif child.tag == "emphasis":
                out += "*" + inline(child) + "*"
            elif child.tag in ("itemizedlist", "orderedlist", "verbatim", "programlisting", "simplesect"):
                parts.append(out.strip())
                out = ""
                block(child)
            else:
                out += inline(child)
            out += child.tail or ""
        return out

    def block(node):
        if node.tag in ("verbatim", "programlisting"):
            lines = "".join(node.itertext()).strip("\n")
            parts.append(f"```text\n{lines}\n```")
        elif node.tag in ("itemizedlist", "orderedlist"):
            parts.append("\n".join("* " + inline(item).strip() for item in node))
        else:
            text = inline(node).strip()
            if text:
                parts.append(text)

    for child in element:
        block(child)
    return "\n\n".join(part for part in parts if part).replace("<", "&lt;") if parts else ""


def description(node):
    both = [markdown(node.find("briefdescription")), markdown(node.find("detaileddescription"))]
    text = "\n\n".join(part for part in both if part)
    # "<" inside of code stays what it is
    return re.sub(r"`[^`]*`|```.*?```", lambda code: code[0].replace("&lt;", "<"), text, flags=re.S)


def template_head(node):
    """The line with the template parameters of a member or class; empty if it has none."""
    parameters = node.find("templateparamlist")
    if parameters is None:
        return ""
    names = []
    for p in parameters.findall("param"):
        text = " ".join(filter(None, [plain(p.find("type")), plain(p.find("declname"))]))
        default = plain(p.find("defval"))
        names.append(text + (f" = {default}" if default else ""))
    return f"template <{', '.join(names)}>\n"


def without_detail(text):
    return re.sub(r"\bdetail::", "", text)


def declaration(member):
    """How a member is declared, without its body."""
    head = template_head(member)
    kind, name = member.get("kind"), plain(member.find("name"))
    typename, arguments = plain(member.find("type")), plain(member.find("argsstring"))
    typename = without_detail(typename)
    if kind == "typedef":
        definition = plain(member.find("definition"))
        return head + without_detail(re.sub(r"using [\w:< >,]*?(\w+) =", r"using \1 =", definition)) + ";"
    if kind == "function":
        requirement = plain(member.find("requiresclause"))
        arguments = re.sub(r"\s*=\s*default$", "", arguments)
        prefix = "static " if member.get("static") == "yes" and "static" not in typename else ""
        if requirement:
            head += f"requires {requirement}\n"
        return without_detail(head + prefix + (typename + " " if typename else "") + name + arguments) + ";"
    return head + f"{typename} {name}{arguments};"


def place(node):
    location = node.find("location")
    return location.get("file"), int(location.get("line"))


def overloads(members, scope):
    """Members by name, in the order of the source: an entity each."""
    found = {}
    for m in members:
        name, kind = plain(m.find("name")), m.get("kind")
        arguments = plain(m.find("argsstring")).replace(" ", "")
        if m.get("prot") != "public" or kind == "friend" or "=delete" in arguments or name.startswith(("~", "MYRIAD_")):
            continue
        if name not in found:
            file, line = place(m)
            found[name] = Entity(kind, scope + name, file, line)
        entity = found[name]
        entity.declarations.append(declaration(m))
        text = description(m)
        if text and text not in entity.text:
            entity.text += ("\n\n" if entity.text else "") + text
        entity.default = plain(m.find("initializer")).removeprefix("=").strip()
        for value in m.findall("enumvalue"):
            entity.values.append((plain(value.find("name")), description(value)))
    return list(found.values())


def read_classes(folder):
    """All public entities of the C++ interface."""
    index = ElementTree.parse(folder / "index.xml").getroot()
    entities = []
    for entry in index.findall("compound"):
        kind, name = entry.get("kind"), plain(entry.find("name"))
        if kind not in ("namespace", "class", "struct", "concept") or not re.match(r"myriad(::|$)", name):
            continue
        internal = re.match(r"myriad::(detail|host|studies|openmp|cuda|gpu|target)\b", name)
        if internal and name not in PUBLIC_ELSEWHERE and (kind != "namespace" or name != "myriad::studies"):
            continue
        root = ElementTree.parse(folder / (entry.get("refid") + ".xml")).getroot().find("compounddef")
        if root.get("prot", "public") != "public":
            continue
        short = name.removeprefix("myriad::")
        if kind == "namespace":
            # Overloads are one entity if they are in one file, as min and max of packs and of integers are not.
            by_file = {}
            for m in root.iter("memberdef"):
                if not internal or m.get("kind") == "enum" and f"{name}::{plain(m.find('name'))}" in PUBLIC_ELSEWHERE:
                    by_file.setdefault(place(m)[0], []).append(m)
            for members in by_file.values():
                entities += overloads(members, "studies::" if internal else "")
            continue
        if "<" in short or short in OPAQUE and "::" in short:
            continue  # a specialisation
        file, line = place(root)
        entity = Entity(kind, short, file, line)
        entity.text = description(root)
        entity.declarations = [declaration_of_class(root, kind, short)]
        if short not in OPAQUE and kind != "concept":
            entity.members = overloads(root.iter("memberdef"), "")
            for member in entity.members:
                if member.name == short.split("::")[-1] and not member.text:
                    member.text = "Constructors." if entity.text and all(
                        re.search(r"\(\)|const .*&", d) for d in member.declarations) else ""
        entities.append(entity)
    described = {}  # members of methods by name: the first description serves all
    members = [m for e in entities if e.file.startswith("include/myriad/kernel/methods/") for m in e.members]
    for member in members:
        described[member.name] = described.get(member.name) or member.text
    for member in members:
        member.text = member.text or described[member.name]
    return [e for e in entities if not (e.kind == "function" and e.name in ("operator+", "operator-", "operator*",
                                                                            "operator/"))]


def declaration_of_class(root, kind, name):
    if kind == "concept":
        return without_detail(plain(root.find("initializer"))) + ";"
    return f"{template_head(root)}{kind} {name};"


def read_macros(source):
    entities = []
    for file in sorted((source / "include" / "myriad").rglob("*.hpp")):
        lines = file.read_text(encoding="utf-8").splitlines()
        for i, line in enumerate(lines):
            match = re.match(r"#define (MYRIAD_\w+(\([^)]*\))?)", line)
            if not match or match[1].split("(")[0] not in MACROS:
                continue
            entity = next((e for e in entities if e.name == match[1].split("(")[0]), None)
            if entity is None:
                entity = Entity("macro", match[1].split("(")[0], str(file.relative_to(source)), i + 1)
                entity.declarations = [match[1]]
                entities.append(entity)
            text, j = [], i - 1
            while lines[j].startswith("///"):
                text.insert(0, lines[j][3:].strip())
                j -= 1
            entity.text = entity.text or " ".join(text)
    for name in MACROS:
        if not any(e.name == name for e in entities):
            raise SystemExit(f"scripts/reference.py: no header defines {name}")
    return entities


def read_cmake(source):
    entities, seen = [], set()
    for name in CMAKE_FILES:
        file = source / name
        text = file.read_text(encoding="utf-8")
        for match in re.finditer(r"((?:^#.*\n)*)^function\((myriad_\w+)", text, flags=re.M):
            if match[2] in CMAKE_FUNCTIONS:
                entity = Entity("CMake function", match[2], name, text.count("\n", 0, match.start(2)) + 1)
                words = " ".join(line.lstrip("# ") for line in match[1].splitlines())
                usage = re.match(r"(myriad_\w+\([^)]*\))\s*", words)
                entity.declarations = [usage[1] if usage else match[2] + "(...)"]
                entity.text = words[usage.end():] if usage else words
                entity.text = entity.text[:1].upper() + entity.text[1:]
                entities.append(entity)
                seen.add(match[2])
        pattern = (r"^\s*(?:option\((MYRIAD_\w+)\s+\"((?:[^\"\\]|\\[\s\S])*)\"\s*([^)]*)\)"
                   r"|set\((MYRIAD_\w+)\s+(\S+)\s+CACHE\s+\w+\s+((?:\"(?:[^\"\\]|\\[\s\S])*\"\s*)*))")
        for match in re.finditer(pattern, text, flags=re.M):
            option = match[1] or match[4]
            if option in seen:
                continue
            seen.add(option)
            entity = Entity("CMake option", option, name, text.count("\n", 0, match.start()) + 1)
            words = match[2] if match[1] else " ".join(re.findall(r"\"((?:[^\"\\]|\\[\s\S])*)\"", match[6]))
            entity.text = " ".join(words.replace("\\\n", "").split())
            entity.default = (match[3] if match[1] else match[5]).strip()
            entities.append(entity)
    for name in CMAKE_FUNCTIONS:
        if name not in seen:
            raise SystemExit(f"scripts/reference.py: {name} is defined in none of {', '.join(CMAKE_FILES)}")
    return entities


def read(source, doxygen):
    with tempfile.TemporaryDirectory() as folder:
        doxyfile = pathlib.Path(folder, "Doxyfile")
        doxyfile.write_text(DOXYFILE.format(source=source, output=folder), encoding="utf-8")
        done = subprocess.run([doxygen, str(doxyfile)], check=True, capture_output=True, text=True)
        if done.stderr.strip():
            raise SystemExit(done.stderr.strip().replace(f"{source}/", "") + "\nDoxygen warns of comments: mend them")
        classes = read_classes(pathlib.Path(folder, "xml"))
    return classes, read_macros(source), read_cmake(source)


def expand_lists(texts):
    """Writes out lists of rows, as `#define KINDS(row) row(a) row(b)`, where they are used as `KINDS(MACRO)`."""
    lists = {}
    for text in texts.values():
        for name, row, body in re.findall(r"^\s*#\s*define (\w+)\((\w+)\)(.*)", text, flags=re.M):
            inner = "|".join([row, *lists])
            if re.fullmatch(rf"(\s*\b({inner})\([^()]*\))+\s*", body):
                lists[name] = re.sub(rf"\b{row}\b(?=[()])", "\\nROW", body)
    use = re.compile(rf"^(?!\s*#)(.*?)\b({'|'.join(lists) or '(?!)'})\(\s*(\w+)\s*\)", flags=re.M)
    for file, text in texts.items():
        while match := use.search(text):
            text = text[:match.start(2)] + lists[match[2]].replace("ROW", match[3]) + "\n" + text[match.end():]
        texts[file] = text


def write_out_nested_macros(texts):
    """Replaces the use of one macro in the definition of another of the same file by what it stands for."""
    define = re.compile(r"^(\s*#\s*define (\w+)\(([^)]*)\))(.*)", flags=re.M)
    for file, text in texts.items():
        for _, name, parameters, body in define.findall(text):
            def stands_for(call, parameters=parameters, body=body):
                values = dict(zip((p.strip() for p in parameters.split(",")), (a.strip() for a in call[1].split(","))))
                return re.sub(r"\w+", lambda word: values.get(word[0], word[0]), body)

            use = re.compile(rf"\b{name}\(([^()]*)\)")
            text = define.sub(lambda other: other[1] + use.sub(stands_for, other[4]), text)
        texts[file] = text


def names_looked_for(source, owner):
    """What the sources look for by name in a template parameter `owner`, as `owner::name`, with its first place.

    Names that a macro puts together from its arguments, as `owner::n_##kind`, are those of all its uses."""
    texts = {}
    for folder in MEMBER_SOURCES:
        for file in sorted((source / folder).rglob("*")):
            if file.suffix in (".hpp", ".cpp", ".cu", ".cuh"):
                text = re.sub(r"//.*|/\*.*?\*/", "", file.read_text(encoding="utf-8"))
                texts[str(file.relative_to(source))] = text.replace("\\\n", " ")
    expand_lists(texts)
    write_out_nested_macros(texts)
    found = {}
    if owner == "environment":
        for file, text in texts.items():
            for match in re.finditer(r"\b(?:getenv|variable)\(\"(\w+)\"\)", text):
                found.setdefault(match[1], file)
        return found
    member = re.compile(rf"\b{owner}>?::(?:template\s+)?(\w+(?:\s*##\s*\w+)*)")
    for file, text in texts.items():
        for line in text.splitlines():
            macro = re.match(r"\s*#\s*define (\w+)\(([^)]*)\)(.*)", line)
            if not macro:
                for match in re.finditer(rf"\b{owner}::(?:template\s+)?(\w+)", line):
                    found.setdefault(match[1], file)
                continue
            parameters = [p.strip() for p in macro[2].split(",")]
            for match in member.finditer(macro[3]):
                parts = re.split(r"\s*##\s*", match[1])
                if not any(p in parameters for p in parts):
                    if not match[0].startswith(f"{owner}>"):
                        found.setdefault(match[1], file)
                    continue
                for user, used in texts.items():
                    for call in re.finditer(rf"^(?!\s*#).*?\b{macro[1]}\((\w+)[^)]*\)", used, flags=re.M):
                        arguments = [a.strip() for a in call[0][call[0].index("(") + 1:-1].split(",")]
                        values = dict(zip(parameters, arguments))
                        found.setdefault("".join(values.get(p, p) for p in parts), user)
    return found


def check_members(source):
    """Names that the sources look for without an entry on their page, and headings that nothing looks for."""
    wrong = 0
    for owner, (page, fewest) in MEMBER_PAGES.items():
        file = source / "docs" / f"{page}.md"
        text = re.sub(r"^```.*?^```$", "", file.read_text(encoding="utf-8"), flags=re.M | re.S)
        wanted = names_looked_for(source, owner)
        headings = set(re.findall(r"`(\w+)`", "\n".join(re.findall(r"^### .*", text, flags=re.M))))
        cells = set(re.findall(r"`(\w+)`", "\n".join(re.findall(r"^\|[^|]*\|", text, flags=re.M))))
        for name in sorted(wanted.keys() - headings - cells):
            print(f"{wanted[name]}: {name} is looked for by name and has no entry in docs/{page}.md")
            wrong += 1
        for name in sorted(headings - wanted.keys()):
            print(f"docs/{page}.md: nothing looks for {name}")
            wrong += 1
        if len(wanted) < fewest:
            print(f"Only {len(wanted)} names in {owner} were found: something is wrong with how they are read")
            wrong += 1
        print(f"docs/{page}.md: {len(wanted)} names")
    return wrong


def page_of(entity):
    below = entity.file.removeprefix("include/myriad/")
    found = next((page for page, (_, _, files) in PAGES.items() if below.startswith(tuple(files))), None)
    return "model" if found is None and entity.kind == "macro" else found


def undocumented(entities):
    for e in entities:
        if not e.text:
            yield e, e.name
        for value, text in e.values:
            if not text:
                yield e, f"{e.name}::{value}"
        for m in e.members:
            if not m.text:
                yield m, f"{e.name}::{m.name}"
            for value, text in m.values:
                if not text:
                    yield m, f"{e.name}::{m.name}::{value}"


def unknown_types(entities):
    """Types of studies in declarations that are neither public nor known to be passed on."""
    for e in entities:
        for declaration_of_one in [d for some in (e, *e.members) for d in some.declarations]:
            for name in re.findall(r"studies::(\w+)", declaration_of_one):
                if name not in (*PUBLIC_STUDIES, *OPAQUE_STUDIES, e.name.removeprefix("studies::")):
                    yield e, name


def check(entities, source):
    wrong_members = check_members(source)
    missing = list(undocumented(entities))
    for entity, name in missing:
        print(f"{entity.file}:{entity.line}: {name} has no description: write a comment that begins with ///")
    homeless = [e for e in entities if not e.kind.startswith("CMake") and page_of(e) is None]
    for e in homeless:
        print(f"{e.file}:{e.line}: {e.name} is on no page of the reference: name its header in scripts/reference.py")
    for entity, name in unknown_types(entities):
        print(f"{entity.file}:{entity.line}: {entity.name} has studies::{name} in its declaration, which is in neither "
              "PUBLIC_STUDIES nor OPAQUE_STUDIES of scripts/reference.py")
        wrong_members += 1
    count = sum(1 + len(e.values) + sum(1 + len(m.values) for m in e.members) for e in entities)
    if count < 300:  # of about 500: else something was not read, and nothing was checked
        print(f"Only {count} public entities were found: something is wrong with how they are read")
        return 1
    print(f"{count} public entities, {len(missing)} without a description")
    return 1 if missing or homeless or wrong_members else 0


# On their pages before all others.
FIRST = ("ensemble", "options", "report", "status", "MYRIAD_FUNCTION", "MYRIAD_INSTANTIATE", "MYRIAD_INSTANTIATE_FLOAT",
         "vec", "lane", "inputs", "select", "device", "solve", "solver", *METHODS, "dense", "controlled")
_anchors = {}


def anchor(*names):
    """The anchor of an entity: that of the first of its name has no number."""
    text = "api-" + re.sub(r"\W+", "-", "-".join(names)).strip("-").lower().replace("_", "-")
    _anchors[text] = _anchors.get(text, 0) + 1
    return text if _anchors[text] == 1 else f"{text}-{_anchors[text]}"


def cell(text):
    return " ".join(text.split()).replace("|", "\\|")


def tidy(text):
    """A declaration without the spaces that Doxygen puts into template arguments."""
    return re.sub(r"(?<=[\w>*&)]) >", ">", re.sub(r"(?<=\w)< ", "<", text))


def code(declarations, language="text"):
    seen = [tidy(d) for d in dict.fromkeys(declarations)]
    return f"```{language}\n" + "\n".join(seen) + "\n```\n"


def where(entity):
    return f"`{entity.file}:{entity.line}`"


def write_entity(out, e):
    qualified = e.name if e.kind in ("macro",) or e.kind.startswith("CMake") else f"myriad::{e.name}"
    kind = {"variable": "constant", "typedef": "type"}.get(e.kind, e.kind)
    out.append(f"({anchor(e.name)})=\n## {kind} `{qualified}`\n")
    if e.kind == "enum":
        out.append(e.text + "\n\n| value | meaning |\n|---|---|")
        out.extend(f"| `{value}` | {cell(text)} |" for value, text in e.values)
        out.append("")
    else:
        out.append(code(e.declarations, "c++"))
        out.append(e.text + "\n")
    data = [m for m in e.members if m.kind == "variable"]
    if data:
        out.append("| member | meaning |\n|---|---|")
        for m in data:
            default = re.sub(r"std::numeric_limits<.*?>::", "", m.default).replace("quiet_NaN()", "NaN")
            default = default.replace("infinity()", "infinity")
            default = f" = {default}" if default and len(default) < 60 else ""
            kind = m.declarations[-1].split("\n")[-1].rpartition(f" {m.name}")[0]
            kind = re.sub(r"\b(static )?constexpr |\[\[no_unique_address\]\] ", "", kind)
            shown = tidy(kind + default).replace("myriad::", "")
            out.append(f"| **`{m.name}`**<br>`{cell(shown)}` | {cell(m.text)} |")
        out.append("")
    for m in e.members:
        if m.kind == "variable":
            continue
        out.append(f"({anchor(e.name, m.name)})=\n### `{m.name}`\n")
        if m.kind != "enum":
            out.append(code(m.declarations, "c++"))
        out.append(m.text + "\n")
        if m.values:
            out.append("| value | meaning |\n|---|---|")
            out.extend(f"| `{value}` | {cell(text)} |" for value, text in m.values)
            out.append("")
    out.append(f"*Source:* {where(e)}\n")


def entities_of(page, entities):
    """The entities of a page in their order: those of FIRST, then by file and line."""
    files = PAGES[page][2]

    def order(e):
        below = e.file.removeprefix("include/myriad/")
        first = FIRST.index(e.name) if e.name in FIRST else len(FIRST)
        return first, next((i for i, file in enumerate(files) if below.startswith(file)), -1), e.file, e.line

    return sorted((e for e in entities if not e.kind.startswith("CMake") and page_of(e) == page), key=order)


def write(entities, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for page, (title, lead, _) in PAGES.items():
        out = [f"# {title}\n", lead + "\n"]
        for e in entities_of(page, entities):
            write_entity(out, e)
        (folder / f"{page}.md").write_text("\n".join(out), encoding="utf-8")
    out = ["# CMake\n",
           "What `find_package(myriad)`, `add_subdirectory` and `FetchContent` provide.\n",
           "## Targets and components\n",
           "`find_package(myriad REQUIRED COMPONENTS openmp cuda)` asks for components; one that is not installed is",
           "an error. Without `COMPONENTS` all that are installed are found. `cmake --install --component` installs",
           "one.\n",
           "| component | target | what |\n|---|---|---|",
           "| `core`, always found | `myriad::myriad` | the headers, and a static library of what depends on no model: "
           "for code that uses no backend itself |",
           "| `openmp` | `myriad::openmp` | the CPU backend, with `myriad_add_models`; needs OpenMP, and "
           "xsimd unless `MYRIAD_SIMD` is `OFF` |",
           "| `cuda` | `myriad::cuda` | the GPU backend, in builds with `MYRIAD_ENABLE_CUDA` |",
           "\n`myriad_add_models` links the backends to the target that it is given.\n"]
    for e in entities:
        if e.kind == "CMake function":
            write_entity(out, e)
    out.append("## Options\n\n| option | default | meaning |\n|---|---|---|")
    for e in entities:
        if e.kind == "CMake option":
            default = e.default.replace('"', "")
            if "PROJECT_IS_TOP_LEVEL" in default:
                out.append(f"| `{e.name}` | `ON` in a build of the library alone, else `OFF` | {cell(e.text)} |")
                continue
            out.append(f"| `{e.name}` | {'`' + cell(default) + '`' if default else 'empty'} | {cell(e.text)} |")
    (folder / "cmake.md").write_text("\n".join(out) + "\n", encoding="utf-8")
    out = ["# Reference\n", "Every public entity, from the comments in the sources: a test fails on one without.\n",
           "| page | what |\n|---|---|"]
    for page, (title, _, _) in PAGES.items():
        names = [f"`{e.name}`" for e in entities_of(page, entities)]
        shown = list(dict.fromkeys(names))
        out.append(f"| [{title}]({page}.md) | {', '.join(shown[:8])}{', ...' if len(shown) > 8 else ''} |")
    out.append("| [CMake](cmake.md) | targets, components, `myriad_add_models`, options |")
    out.append("\nThe Python package, `myriad_ode`:\n\n| page | what |\n|---|---|")
    out.extend(f"| [{title}]({page}.md) | {about} |" for page, (title, about, _) in python_reference.PAGES.items())
    out.append("\nWhat is found by name, and not declared in a header:\n\n| page | what |\n|---|---|")
    out.append("| [Members of a model](../model_members.md) | components, functions, hooks, declarations |")
    out.append("| [Members of a method](../method_members.md) | those of an integration method of your own |")
    out.append("| [Environment variables](../environment.md) | those that are read when a program runs |")
    out.append("\n```{toctree}\n:hidden:\n" + "\n".join([*PAGES, "cmake", *python_reference.PAGES]) + "\n```")
    (folder / "index.md").write_text("\n".join(out) + "\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--check", action="store_true")
    what.add_argument("--write", type=pathlib.Path, metavar="FOLDER")
    parser.add_argument("--source", type=pathlib.Path, default=ROOT, metavar="FOLDER")
    arguments = parser.parse_args()
    doxygen = shutil.which("doxygen")
    if doxygen is None:
        print("Reference not checked: there is no doxygen on the PATH (Debian package doxygen)")
        return 77
    classes, macros, cmake = read(arguments.source.resolve(), doxygen)
    entities = macros + classes + cmake
    if arguments.check:
        return check(entities, arguments.source.resolve())
    write(entities, arguments.write)
    return 0


if __name__ == "__main__":
    sys.exit(main())
