# SPDX-License-Identifier: MIT
"""The limits on the kept past that Python repeats are those of C++."""

import pathlib
import re

import myriad_ode.solving.past as past

_include = pathlib.Path(__file__).parents[2] / "include" / "myriad"


def _found(header, pattern):
    found = re.search(pattern, (_include / header).read_text())
    assert found, (header, pattern)
    return tuple(int(number) for number in found.groups())


def test_limits_of_jumps_are_those_of_the_library():
    pattern = r"most_jumps_of_one = (\d+), most_jumps_to_second = (\d+) \* most_jumps_of_one;"
    one, times = _found("kernel/event/breaking_points.hpp", pattern)
    assert (past._most_jumps, past._most_to_second) == (one, times * one)


def test_largest_number_of_history_steps_is_that_of_the_option():
    pattern = r'option_entry\{"history_steps", .*from_to\(0, (\d+)\)'
    assert _found("host/options/option_table.hpp", pattern) == (past._largest,)
