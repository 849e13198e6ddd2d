# SPDX-License-Identifier: MIT
"""How Python's options differ from the C++ library's table of options, from which the others come as they are."""

from __future__ import annotations

# Options that have another name here.
names = {
    "relative_tolerance": "rtol", "absolute_tolerance": "atol", "phase_time": "carry_on",
    "phase_step": "carry_on_step", "invalid_instances": "invalid"}

# Options of two choices that are True or False here, with the choice that is True.
true_choices = {"phase_time": "carry_on", "phase_step": "carry_on", "advice": "on"}

# Options that are not here: results read the counters; `progress` is an argument of its own; kernels that are compiled
# at run time have their place for shared parameters, and chunks, from the package.
left_out = ("counting", "progress", "block_size", "chunk_size", "shared_placement")

# Options that a study has as an argument of its own, with more that it does.
arguments_of_study = ("seed",)

# Components of both kinds are named together, and a table of sample times has a row for each instance.
left_out_of_structs = ("record.integer_accessories", "samples.times_of_instances")
