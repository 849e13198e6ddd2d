# SPDX-License-Identifier: MIT
"""Attractors, hysteresis and noise on a GPU beside a CPU: `scripts/gpu.sh --python` runs these."""

import os

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode import _core
from myriad_ode.models.methods import stochastic

pytestmark = pytest.mark.skipif(os.environ.get("MYRIAD_TEST_DEVICE") != "cuda" or bool(_core.no_gpu()),
                                reason="MYRIAD_TEST_DEVICE is not cuda, or there is no GPU")

x, v, y = my.states("x v y")
k, B, sigma = my.parameters("k B sigma")
wells = my.model({x: v, v: x - x**3 - k * v + B * my.cos(my.time)}, name="wells")


@pytest.mark.parametrize("amplitude, kinds", [(0.2, {"cycle"}), (0.35, {"cycle", "chaotic"})])
def test_basins_are_those_of_a_cpu(amplitude, kinds):
    places = np.linspace(-2, 2, 60)
    call = dict(start=my.grid({x: places, v: places}), time=(0, 2 * np.pi), transient=100, phases=60, rtol=1e-8,
                atol=1e-8)
    here, there = (my.attractors(wells, {k: 0.2, B: amplitude}, device=device, **call) for device in ("cpu", "cuda"))
    assert {one.kind for one in there} == kinds and [one.name for one in here] == [one.name for one in there]
    assert (here.labels == there.labels).mean() > 0.99  # chaotic transients end by chance


def test_cycles_and_steady_states_of_a_flow_are_those_of_a_cpu():
    oscillator = my.model({x: v, v: k * (1 - x * x) * v - x}, name="oscillator")
    call = dict(start=my.grid({x: np.linspace(-3, 3, 20), v: np.linspace(-3, 3, 20)}), time=(0, 1))
    for values in (0.5, -0.5):
        here, there = (my.attractors(oscillator, {k: values}, device=device, **call) for device in ("cpu", "cuda"))
        assert np.array_equal(here.labels, there.labels) and [one.name for one in here] == [one.name for one in there]


def test_hysteresis_and_continuation_are_those_of_a_cpu():
    hard = my.model({x: v, v: -x - x**3 - k * v + B * my.cos(2 * my.time)}, name="hard")
    call = dict(time=(0, np.pi), transient=60, phases=24)
    values = {k: 0.2, B: np.linspace(0.2, 4, 39)}
    here, there = (my.hysteresis(hard, values, start={x: 0, v: 0}, device=device, **call) for device in ("cpu", "cuda"))
    assert here.interval() == there.interval()
    grid = my.grid({x: np.linspace(-3, 3, 8), v: np.linspace(-6, 6, 8)})
    here, there = (my.continuation(hard, values, start=grid, device=device, **call) for device in ("cpu", "cuda"))
    np.testing.assert_allclose(here.shares, there.shares, atol=2 / 64)


@pytest.mark.parametrize("method", sorted(stochastic))
def test_paths_are_those_of_a_cpu(method):
    additive = my.model({x: v, v: -x - k * v, y: -y}, noise={v: sigma, y: 0.5 * sigma}, name="additive")
    call = dict(paths=1000, start={x: 1, v: 0, y: 1}, time=(0, 2), step=1 / 64, method=method, seed=3,
                samples=np.linspace(0, 2, 9))
    here, there = (my.solve(additive, {k: 0.3, sigma: [0.1, 0.5]}, device=device, **call) for device in ("cpu", "cuda"))
    assert set(here.status) == set(there.status) == {"success"}
    for name in ("x", "v", "y"):
        np.testing.assert_allclose(here.samples[name], there.samples[name], rtol=1e-11, atol=1e-12)
