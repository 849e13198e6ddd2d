# SPDX-License-Identifier: MIT
"""Shared by the tests: a cache of their own, and models whose solutions are known."""

import os
import shlex
import signal
import tempfile

import pytest

if "PYTEST_XDIST_WORKER" not in os.environ:  # whose processes share the cache of the one that starts them
    _cache = tempfile.TemporaryDirectory(prefix="myriad-tests-")
    # before the package is imported, and for the processes that tests start
    os.environ["MYRIAD_CACHE_DIR"] = _cache.name
if os.environ.get("MYRIAD_TEST_DEVICE") != "cuda":  # as in the tests of the C++ library
    os.environ["CUDA_VISIBLE_DEVICES"] = "-1"

# What a shell starts in the background ignores Ctrl-C, and with it Python and the processes that tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)

import myriad_ode as my  # noqa: E402
from myriad_ode.kernels import choose, compiler  # noqa: E402

# Kernels of tests are compiled in about half of the time, with the same results, in the whole session.
_quick = "-DMYRIAD_OUT_OF_LINE"
_compiler = compiler.find_compiler()
_command = () if _compiler is None else tuple(word for word in _compiler.command if word != _quick)
if _command:
    os.environ["MYRIAD_CXX"] = shlex.join((*_command, _quick))

# What asks for the interpreter, which is compiled already, is compiled with the package's headers as they are now.
if os.environ.get("MYRIAD_TEST_COMPILED"):
    _choose_kernel = choose.choose_kernel
    choose.choose_kernel = lambda *arguments: _choose_kernel(*arguments[:-1], False)


@pytest.fixture(autouse=True)
def flags_of_users(request, monkeypatch):
    """Tests of how users get kernels are marked: `@pytest.mark.as_users_compile`."""
    if _command and request.node.get_closest_marker("as_users_compile") is not None:
        monkeypatch.setenv("MYRIAD_CXX", shlex.join(_command))


OSCILLATOR = """
#include <myriad/model.hpp>
struct oscillator {  // x'' = -w^2 x
    enum state { x, v, n_state };
    enum parameter { w, n_parameter };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], -p[w] * p[w] * y[x]};
    }
};
"""

BALL = """
#include <myriad/model.hpp>
struct ball {  // falls, and bounces with a loss
    enum state { height, speed, n_state };
    enum parameter { loss, n_parameter };
    enum shared { g, n_shared };
    enum accessory { top, n_accessory };
    enum integer_accessory { bounces, n_integer_accessory };
    enum event { impact, n_event };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[speed], -R(p.shared[g])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[height]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        lane.accessory[top] = lane.y[height];
        lane.integer_accessory[bounces] = 0;
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) {
        lane.y[speed] = -lane.parameter[loss] * lane.y[speed];
        lane.integer_accessory[bounces] += 1;
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) {
        lane.accessory[top] = lane.y[height] + lane.y[speed] * lane.y[speed] / (2 * lane.shared[g]);
    }
};
"""


@pytest.fixture
def oscillator():
    """x'' = -w^2 x"""
    return my.CppModel(OSCILLATOR, "oscillator", "x v", "w")


@pytest.fixture
def ball():
    """A ball that bounces."""
    return my.CppModel(BALL, "ball", "height speed", "loss", "g", accessories="top", integer_accessories="bounces",
                       events={"impact": dict(direction="falling", tolerance=1e-10)})


def pytest_addoption(parser):
    parser.addoption("--full", action="store_true", help="also what is marked as long")
    parser.addoption("--all", action="store_true",
                     help="also what takes minutes: all models and GPUs, and what is marked as thorough")


def pytest_collection_modifyitems(config, items):
    if config.getoption("--all"):
        return
    for item in items:
        if item.get_closest_marker("thorough"):
            item.add_marker(pytest.mark.skip(reason="takes long, and others show most of it: --all"))
        elif item.get_closest_marker("long") and not config.getoption("--full"):
            item.add_marker(pytest.mark.skip(reason="takes long: --full"))
