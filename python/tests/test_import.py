# SPDX-License-Identifier: MIT
"""`import myriad_ode`: how long it takes, and what completion offers afterwards."""

import resource
import subprocess
import sys

import pytest

import myriad_ode as my


def seconds(statement):
    """Processor seconds of a process with this statement alone, the least of some."""
    def once():
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([sys.executable, "-c", statement], check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    return min(once() for _ in range(4))


def test_an_import_takes_no_more_than_five_of_numpy():
    # From 3.1 to 3.9 were measured; with scipy.optimize it would be 6.8, with matplotlib.pyplot 7.7.
    assert seconds("import myriad_ode") < 5 * seconds("import numpy")


@pytest.mark.parametrize("module", [my.cache, my.designs, my.plots, my.reduce], ids=lambda m: m.__name__)
def test_completion_in_a_public_module_offers_what_is_public(module):
    assert dir(module) == sorted(module.__all__)
    assert all(getattr(module, name).__doc__ for name in dir(module))
