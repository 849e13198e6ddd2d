#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that the layers of the library only point down: folders of headers include each other without a cycle, and
the kernel body, which both compilers see, includes nothing of the host side, no Eigen and no library that only a host
has. Of the kernel body, the headers in GPU_CODE alone have other code for GPUs, and none has members that share
addresses, which nvcc lays out in two ways. The folder gpu alone names CUDA's runtime, compiler and intrinsics, in all
sources of the include roots and of --sources."""
import argparse
import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+(["<])([^">]+)[">]', re.MULTILINE)

# Headers that device code does not need, except for their constants and types, stay out of the kernel body. xsimd
# belongs to the packs.
KERNEL_LIBRARY = {
    "array", "bit", "cmath", "concepts", "cstddef", "cstdint", "cstring", "iterator", "limits", "string_view",
    "type_traits", "utility", "xsimd/xsimd.hpp",
}

# The headers with code of their own for GPUs. All others are the same for every compiler.
GPU_CODE = {
    "myriad/kernel/core/macros.hpp",            # execution spaces, unrolling, barriers
    "myriad/kernel/core/team.hpp",              # what the threads of a team do together
    "myriad/kernel/core/vec.hpp",               # indices out of range, which the host's compiler refuses
    "myriad/kernel/model/rhs_weight.hpp",       # from which weight on a right-hand side is called
    "myriad/kernel/model/unit_views.hpp",       # numbers of units, likewise
    "myriad/kernel/scalar/fast_float.hpp",      # functions in single precision
    "myriad/kernel/scalar/math.hpp",            # functions of one number
    "myriad/kernel/scalar/trigonometry.hpp",
    "myriad/kernel/scalar/control_number.hpp",  # the step-size control's kind of number
    "myriad/kernel/controller/norm.hpp",
    "myriad/kernel/controller/fast_power.hpp",
    "myriad/kernel/integrator/warp_aggregation.hpp",
    "myriad/kernel/stepper/step_memory.hpp",    # the shared memory of a block
}

NO_UNIQUE_ADDRESS = re.compile(r"^[^/\n]*\[\[no_unique_address\]\]", re.MULTILINE)
ASKS_FOR_GPU = re.compile(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*\bMYRIAD_(?:FOR_GPU|ON_GPU|GPU_HAS_\w+)\b", re.MULTILINE)

# What CUDA alone has: its runtime, its driver's library, the macros of its compilers, PTX, and intrinsics. What HIP
# spells as CUDA does is used as it is; in quotes are names that users know.
NAMES_OF_CUDA = re.compile(
    r"(?<!\")\b(?:cuda[A-Z]\w*|cuda_runtime\w*|dim3|__(?:CUDA\w*|NVCC)__|nv_diag\w+|warpSize"
    r"|__\w+_sync|__(?:activemask|syncwarp|popcl?l?|ffsl?l?|clzl?l?|brevl?l?|nanosleep|ldg|fdividef)"
    r"|__(?:double2\w+|hiloint2double|float_as_\w+|f?(?:mul|add|fma|dmul|dadd|fmaf)_r[nduz]))\b"
    r"|\basm(?: volatile)?\(\"[a-z]")
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


def read_texts(roots):
    """The headers of all include roots, by the path used in includes."""
    return {path.relative_to(root).as_posix(): path.read_text(encoding="utf-8")
            for root in roots for path in sorted(root.rglob("*")) if path.suffix in (".hpp", ".cuh")}


def layer(header):
    """gpu, kernel, host, study, openmp, cuda, python, or public: what users include."""
    folder = header.split("/")[1:-1]
    known = ("gpu", "kernel", "host", "study", "openmp", "cuda", "python")
    return folder[0] if folder and folder[0] in known else "public"


# The layers that a header of each layer may include.
BELOW = {
    "gpu": {"gpu"},
    "kernel": {"kernel", "gpu"},
    "host": {"host", "kernel"},
    "study": {"study", "public", "host", "kernel"},
    "openmp": {"openmp", "host", "kernel"},
    "cuda": {"cuda", "host", "kernel", "gpu"},
    "python": {"python", "openmp", "cuda", "host", "kernel", "gpu", "public"},
    "public": {"public", "study", "host", "kernel"},
}


def misplaced_includes(headers):
    """The includes of a header that its layer forbids."""
    for header, includes in headers.items():
        own = layer(header)
        for _, name in includes:
            if name.startswith("myriad/"):
                if name not in headers:
                    yield f"{header} includes {name}, which does not exist"
                elif layer(name) not in BELOW[own]:
                    yield (f"{header} includes {name}: code of the layer '{own}' may include "
                           f"{' and '.join(sorted(BELOW[own]))} alone; move what it needs down")
            elif own == "kernel" and name not in KERNEL_LIBRARY:
                yield (f"{header} includes <{name}>, which the kernel body, seen by both compilers, does without: "
                       "move the code that needs it to the host side")


def misplaced_gpu_code(texts, gpu_code):
    """The headers outside the backends that ask for a GPU's compiler and may not, or are said to and do not."""
    asking = {header for header, text in texts.items()
              if layer(header) not in ("gpu", "cuda", "python") and ASKS_FOR_GPU.search(text)}
    for header in sorted(asking - gpu_code):
        yield (f"{header} asks whether it is compiled for GPUs: the kernel body is one source for all compilers; use a "
               "macro of myriad/kernel/core/macros.hpp, or name the header in GPU_CODE")
    for header in sorted(gpu_code - asking):
        yield f"GPU_CODE names {header}, which does not ask whether it is compiled for GPUs: remove it there"


def names_of_cuda(texts):
    """The places outside the folder gpu that name what CUDA alone has."""
    for name, text in texts.items():
        found = layer(name) != "gpu" and NAMES_OF_CUDA.search(COMMENT.sub("", text))
        if found:
            yield (f"{name} has {found.group()}, which is CUDA's: take what myriad/gpu/runtime.hpp has for it, or add "
                   "it there")


def ambiguous_layouts(texts):
    """The headers of the kernel body with members that share addresses: nvcc 13 lays such a class out in two ways, one
    for copies of it and one for its members."""
    for header, text in texts.items():
        if layer(header) == "kernel" and NO_UNIQUE_ADDRESS.search(text):
            yield (f"{header} has a member with [[no_unique_address]]: nvcc copies such a class with another layout "
                   "than it reads its members with; leave the attribute out, an empty member costs no register")


def folder_graph(headers):
    """For each folder, the folders that it includes, each with one such include as an example."""
    graph = {}
    for header, includes in headers.items():
        folder = header.rpartition("/")[0]
        graph.setdefault(folder, {})
        for _, name in includes:
            target = name.rpartition("/")[0]
            if name in headers and target != folder:
                graph[folder].setdefault(target, f"{header} includes {name}")
    return graph


def find_cycle(graph):
    """The folders of one cycle, or None."""
    finished, trail = set(), []

    def visit(folder):
        if folder in trail:
            return trail[trail.index(folder):]
        if folder in finished:
            return None
        trail.append(folder)
        for target in graph.get(folder, {}):
            found = visit(target)
            if found:
                return found
        finished.add(trail.pop())
        return None

    for folder in graph:
        found = visit(folder)
        if found:
            return found
    return None


def complaints(roots, gpu_code=frozenset(GPU_CODE), sources=()):
    texts = read_texts(roots)
    if not texts:
        return [f"no headers in {', '.join(map(str, roots))}"]
    headers = {header: INCLUDE.findall(text) for header, text in texts.items()}
    others = {path.as_posix(): path.read_text(encoding="utf-8")
              for folder in sources for path in sorted(folder.rglob("*.[ch]pp"))}
    found = [*misplaced_includes(headers), *misplaced_gpu_code(texts, gpu_code), *ambiguous_layouts(texts),
             *names_of_cuda({**texts, **others})]
    graph = folder_graph(headers)
    cycle = find_cycle(graph)
    if cycle:
        links = [graph[folder][cycle[(i + 1) % len(cycle)]] for i, folder in enumerate(cycle)]
        found.append("folders include each other in a circle: " + "; ".join(links))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("roots", nargs="+", type=Path, help="folders that are on the include path")
    parser.add_argument("--sources", nargs="*", type=Path, default=[], help="folders of sources beside them")
    options = parser.parse_args()
    found = complaints(options.roots, sources=options.sources)
    for complaint in found:
        print(complaint, file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
