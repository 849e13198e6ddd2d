#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compiles a CUDA file and checks ptxas' report on each kernel against limits written in the file's comments.

A limit is a comment line

    // limit: <kernel> [stack BYTES] [spill BYTES] [code BYTES] [registers COUNT]
    // limit: <kernel> [registers_within FACTOR of <other kernel>]

and every kernel named must be within it: stack frame, spill stores plus spill loads, instructions of the kernel and of
the functions that it calls, registers, registers compared with another kernel of the same file (a hand-written one).
<kernel> is the function's name without namespace, template arguments and parameters; with the template arguments, it
means that instance only (as in `run<lorenz, rk4>`, their namespaces and last ones left out or not). Kernels without a
limit are listed and pass. A line

    // forbid: <type> in <kernel>

means that the kernel's PTX has no instruction on that type, such as f64. Exit status: 0 all within, 1 a limit broken or
the compiler failed, 2 a wrong limit line or option.
"""
import argparse
import re
import shutil
import struct
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Resources:
    """ptxas' report on one kernel."""

    stack: int = 0
    spill: int = 0
    registers: int = 0
    code: int = 0


@dataclass
class Limit:
    """One limit line: the kernel, upper bounds by name, and (factor, other kernel) or None."""

    kernel: str
    bounds: dict = field(default_factory=dict)
    within: tuple = None


class WrongLimit(Exception):
    """A malformed limit line."""


def read_limits(source):
    """Limits in the comments of a source text."""
    limits = []
    for number, line in enumerate(source.splitlines(), 1):
        match = re.match(r"\s*//\s*limit:\s*(.*?)\s*$", line)
        if not match:
            continue
        text = match.group(1)
        split = re.match(r"(?P<kernel>\w+(?:<.*?>(?=\s))?)\s+(?P<rest>.*)$", text)
        if not split:
            raise WrongLimit(f"line {number}: '{text}' names no kernel with a limit")
        limit = Limit(split.group("kernel"))
        rest = split.group("rest")
        while rest:
            bound = re.match(r"(stack|spill|code|registers)\s+(\d+)\s*", rest)
            within = re.match(r"registers_within\s+(\d+(?:\.\d+)?)\s+of\s+(\w+(?:<.*?>(?=\s|$))?)\s*", rest)
            if bound:
                limit.bounds[bound.group(1)] = int(bound.group(2))
            elif within:
                limit.within = (float(within.group(1)), within.group(2))
            else:
                raise WrongLimit(f"line {number}: '{rest}' is no limit: give stack, spill, code or registers and a "
                                 "number, or registers_within FACTOR of KERNEL")
            rest = rest[(bound or within).end():]
        limits.append(limit)
    return limits


def read_forbidden(source):
    """(type, kernel) of the `forbid` comments of a source text."""
    forbidden = []
    for number, line in enumerate(source.splitlines(), 1):
        match = re.match(r"\s*//\s*forbid:\s*(.*?)\s*$", line)
        if not match:
            continue
        parts = re.match(r"(\w+) in (\w+(?:<.*>)?)$", match.group(1))
        if not parts:
            raise WrongLimit(f"line {number}: '{match.group(1)}' is not TYPE in KERNEL")
        forbidden.append(parts.groups())
    return forbidden


def check_ptx(ptx, forbidden, names=None):
    """Complaints about instructions on forbidden types, from the text of a PTX module."""
    bodies, kernel = {}, None
    for line in ptx.splitlines():
        entry = re.search(r"\.entry (\w+)", line)
        if entry:
            kernel = entry.group(1)
            bodies[kernel] = []
        elif kernel:
            bodies[kernel].append(line.strip())
    names = names or demangle(bodies)
    bodies = {short_name(names[mangled]): lines for mangled, lines in bodies.items()}
    complaints = []
    for kind, kernel in forbidden:
        chosen = matching(bodies, kernel)
        if not chosen:
            complaints.append(f"{kernel}: may not use {kind}, but there is no such kernel")
        for name in chosen:
            used = [line for line in bodies[name] if re.search(rf"\.{kind}\b", line) and not line.startswith(".")]
            if used:
                complaints.append(f"{name}: {len(used)} instructions on {kind}, the first: {used[0]}")
    return complaints


def demangle(names):
    """C++ names of mangled ones."""
    names = list(names)
    tool = shutil.which("c++filt") or shutil.which("cu++filt") or shutil.which("llvm-cxxfilt")
    if not names or not tool:
        return dict(zip(names, names))
    shown = subprocess.run([tool], input="\n".join(names), capture_output=True, text=True, check=True).stdout
    return dict(zip(names, shown.splitlines()))


def short_name(demangled):
    """Name of a kernel without return type, namespaces and parameters, template arguments kept.

    `void myriad::cuda::run<lorenz, rk4>(double*)` gives `run<lorenz, rk4>`.
    """
    depth, start, end = 0, 0, len(demangled)
    anonymous = "(anonymous namespace)"
    text = demangled.replace(anonymous, "_" * len(anonymous))
    for position, character in enumerate(text):
        if character == "<":
            depth += 1
        elif character == ">":
            depth -= 1
        elif depth == 0 and character == "(":
            end = position
            break
        elif depth == 0 and (character == " " or text.startswith("::", position - 1)):
            start = position + 1
    return demangled[start:end]


def read_report(report, names=None):
    """Resources by short name, from ptxas -v. `names` demangles; None asks c++filt."""
    found, kernel = {}, None
    for line in report.splitlines():
        entry = re.search(r"Compiling entry function '(\S+)'", line)
        properties = re.search(r"Function properties for (\S+)", line)
        memory = re.search(r"(\d+) bytes stack frame, (\d+) bytes spill stores, (\d+) bytes spill loads", line)
        registers = re.search(r"Used (\d+) registers", line)
        if entry:
            kernel = entry.group(1)
            found[kernel] = Resources()
            current = kernel
        elif properties:
            current = properties.group(1)
        elif memory and kernel:
            # A function that was not inlined counts towards the kernel above it.
            target = found[current] if current in found else found[kernel]
            target.stack += int(memory.group(1))
            target.spill += int(memory.group(2)) + int(memory.group(3))
        elif registers and kernel:
            found[kernel].registers = int(registers.group(1))
    names = names or demangle(found)
    return {short_name(names[mangled]): resources for mangled, resources in found.items()}


def read_code(cubin, names=None):
    """Bytes of instructions by short name, from a cubin: an ELF file with a section `.text.<mangled>` per kernel."""
    table, = struct.unpack_from("<Q", cubin, 0x28)
    size, count, of_names = struct.unpack_from("<3H", cubin, 0x3a)
    headers = [struct.unpack_from("<IIQQQQ", cubin, table + i * size) for i in range(count)]
    sections = {}
    for header in headers:
        begin = headers[of_names][4] + header[0]
        sections[cubin[begin:cubin.index(b"\0", begin)].decode()] = header[5]
    found = {name.removeprefix(".text."): bytes for name, bytes in sections.items() if name.startswith(".text.")}
    names = names or demangle(found)
    return {short_name(names[mangled]): bytes for mangled, bytes in found.items()}


def plain(name):
    """A name without spaces and namespaces, as limits may be written."""
    return re.sub(r"\w+::", "", name.replace(" ", ""))


def matching(kernels, name):
    """Names of the kernels that match `name`: itself, or all instances of the template that begin with its
    arguments."""
    return [kernel for kernel in kernels
            if plain(kernel) == plain(name) or ("<" not in name and kernel.split("<")[0] == name)
            or (name.endswith(">") and plain(kernel).startswith(plain(name)[:-1] + ","))]


def check(kernels, limits):
    """Complaints about kernels (resources by name) that break limits."""
    complaints = []
    for limit in limits:
        names = matching(kernels, limit.kernel)
        if not names:
            complaints.append(f"{limit.kernel}: has a limit, but there is no such kernel "
                              f"(there are: {', '.join(kernels) or 'none'})")
        for name in names:
            used = kernels[name]
            for what, bound in limit.bounds.items():
                if getattr(used, what) > bound:
                    complaints.append(f"{name}: {what} {getattr(used, what)}, allowed {bound}")
            if limit.within:
                factor, other = limit.within
                others = matching(kernels, other)
                if len(others) != 1:
                    complaints.append(f"{name}: is compared with {other}, and {len(others)} kernels have that name")
                elif used.registers > factor * kernels[others[0]].registers:
                    complaints.append(f"{name}: registers {used.registers}, allowed {factor} times the "
                                      f"{kernels[others[0]].registers} of {other}")
    return complaints


def compile_command(arguments, source, output, to_ptx=False):
    """The nvcc call: one real architecture and its PTX, no flag that myriad_add_models does not have."""
    architecture = arguments.arch.removeprefix("sm_")
    code = f"compute_{architecture}" if to_ptx else f"[sm_{architecture},compute_{architecture}]"
    command = [arguments.nvcc, "-std=c++20", "-O3", "-prec-div=false", "-ptx" if to_ptx else "-c", "-o", output,
               f"-gencode=arch=compute_{architecture},code={code}", "-Xptxas", "-v", "-Xcompiler", "-Wall,-Wextra",
               "-Werror", "all-warnings"]
    for directory in arguments.include:
        command += ["-I", directory]
    for directory in arguments.system_include:
        command += ["-isystem", directory]
    return command + arguments.flag + [source]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("source", help="the .cu file")
    parser.add_argument("--nvcc", default="nvcc", help="the compiler (default: nvcc)")
    parser.add_argument("--arch", default="sm_90", help="real architecture, its PTX is made too (default: sm_90)")
    parser.add_argument("--include", action="append", default=[], metavar="DIR", help="include directory")
    parser.add_argument("--system-include", action="append", default=[], metavar="DIR",
                        help="include directory without warnings")
    parser.add_argument("--flag", action="append", default=[], help="further compiler flag, as in --flag=-DX=1")
    arguments = parser.parse_args()

    try:
        text = Path(arguments.source).read_text(encoding="utf-8")
        limits, forbidden = read_limits(text), read_forbidden(text)
    except (OSError, WrongLimit) as error:
        print(f"{arguments.source}: {error}", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as folder:
        command = compile_command(arguments, arguments.source, str(Path(folder) / "kernel.o"))
        command += ["--keep", "--keep-dir", folder]
        print(" ".join(command))
        try:
            result = subprocess.run(command, capture_output=True, text=True, check=False)
        except OSError as error:
            print(f"{arguments.nvcc}: {error}", file=sys.stderr)
            return 2
        ptx = ""
        if forbidden and result.returncode == 0:
            output = str(Path(folder) / "kernel.ptx")
            made = subprocess.run(compile_command(arguments, arguments.source, output, to_ptx=True),
                                  capture_output=True, text=True, check=False)
            ptx = Path(output).read_text(encoding="utf-8") if made.returncode == 0 else ""
        code = {name: bytes for cubin in Path(folder).glob("*.cubin") for name, bytes in
                read_code(cubin.read_bytes()).items()}
    report = result.stdout + result.stderr
    if result.returncode != 0:
        print(report)
        print(f"{arguments.source} does not compile")
        return 1
    kernels = read_report(report)
    for name, used in kernels.items():
        used.code = code[name]
    limited = {name for limit in limits for name in matching(kernels, limit.kernel)}
    for name, used in kernels.items():
        note = "" if name in limited else "  (no limit)"
        print(f"{name}: {used.registers} registers, stack {used.stack}, spill {used.spill}, code {used.code}{note}")
    complaints = check(kernels, limits) + check_ptx(ptx, forbidden)
    for complaint in complaints:
        print(f"too much: {complaint}")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
