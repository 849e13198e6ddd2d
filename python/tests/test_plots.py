# SPDX-License-Identifier: MIT
"""Pictures: what is drawn, by the data of matplotlib's artists."""

import subprocess
import sys

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode.base import plots
from myriad_ode.results.run_plots import Plots

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402


@pytest.fixture(autouse=True)
def close_figures():
    yield
    pyplot.close("all")


def test_bifurcation_has_a_point_for_every_instance_and_phase():
    axes = plots.bifurcation(np.array([1.0, 2.0]), np.array([[3.0, 4.0], [5.0, np.nan]]), xlabel="k", ylabel="x")
    line, = axes.lines
    assert line.get_xydata().tolist() == [[1, 3], [1, 4], [2, 5]]
    assert axes.get_xlabel() == "k" and axes.get_ylabel() == "x"


def test_many_points_of_a_bifurcation_are_drawn_as_their_density():
    x = np.linspace(0, 1, 4000)
    y = np.random.default_rng(1).uniform(size=(4000, 100))
    axes = plots.bifurcation(x, y)
    assert not axes.lines and len(axes.collections) == 1
    shades = axes.collections[0].get_array()
    assert shades.max() == 1 and 100 < shades.count() < 1_000_000


def test_map_has_x_across_and_the_values_of_each_pair():
    z = np.array([[1.0, 2.0, 3.0], [4.0, np.nan, 6.0]])
    axes = plots.parameter_map([0.1, 1.0], [1.0, 2.0, 3.0], z, xlabel="k")
    drawn = axes.collections[0].get_array()
    assert drawn.shape == (3, 2) and drawn[2, 0] == 3 and drawn.mask[1, 1] and drawn.count() == 5


def test_axes_of_values_in_constant_ratio_are_logarithmic():
    axes = plots.parameter_map(np.geomspace(0.1, 10, 5), np.linspace(1, 2, 4), np.ones((5, 4)))
    assert axes.get_xscale() == "log" and axes.get_yscale() == "linear"


def test_map_of_names_shows_those_that_occur():
    axes = plots.parameter_map([0, 1], [0, 1, 2], np.array([[1, 1, 6], [6, 1, 1]]), names=list("abcdefg"))
    bar = axes.figure.axes[1]
    assert [label.get_text() for label in bar.get_yticklabels()] == ["b", "g"]
    assert axes.collections[0].get_array()[2].tolist() == [1, 0]


def test_lines_of_several_instances_have_a_legend():
    t = np.linspace(0, 1, 10)
    y = np.stack([np.sin(t), np.cos(t)])
    axes = plots.time_series(t, y, labels=["one", "two"])
    assert [line.get_label() for line in axes.lines] == ["one", "two"] and axes.get_legend() is not None
    assert np.array_equal(axes.lines[1].get_ydata(), np.cos(t))
    axes = plots.phase_portrait(y, y[::-1], labels=["one", "two"])
    assert np.array_equal(axes.lines[0].get_xdata(), np.sin(t))


def test_statuses_count_instances():
    axes = plots.statuses(np.array([1, 1, 1, 4], np.uint8), ["not_started", "success", "a", "b", "max_steps"])
    assert sorted(bar.get_width() for bar in axes.patches) == [1, 3]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["max steps", "success"]


@pytest.mark.parametrize("draw, message", [
    (lambda: plots.bifurcation([1, 2], [[1], [2], [3]]), "x has 2 values and y 3 rows"),
    (lambda: plots.parameter_map([1, 2], [1, 2], np.ones((2, 3))), r"shape \(2, 3\)"),
    (lambda: plots.phase_portrait([1, 2], [1, 2, 3]), "arrays of one shape"),
    (lambda: plots.time_series([1, 2], [1, 2, 3]), "a time for each value"),
])
def test_arrays_that_do_not_fit_are_refused(draw, message):
    with pytest.raises(my.Error, match=message):
        draw()


class ARun:
    """What `run.plot` reads of a run."""

    def __init__(self, sweep, records=(), samples=(), final=()):
        self.sweep, self.size = sweep, sweep.size
        self.records, self.samples, self.final = dict(records), dict(samples), dict(final)
        self.failed = np.zeros(self.size, bool)
        self.status_codes = np.ones(self.size, np.uint8)
        self.t_sample = np.tile(np.arange(3.0), (self.size, 1))
        self.units, self.time_unit = {"x": "mol"}, ""

    def __getitem__(self, name):
        return self.final[name]


def test_a_run_draws_its_components_by_name_or_symbol():
    k, x = my.parameter("k"), my.state("x")
    run = ARun(my.grid({k: [1.0, 2.0]}), records={"x": np.array([[1.0], [2.0]])}, samples={"x": np.ones((2, 3))})
    axes = Plots(run).bifurcation(k, x)
    assert axes.lines[0].get_xydata().tolist() == [[1, 1], [2, 2]]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("k", "x (mol)")
    assert Plots(run).time_series("x").lines[1].get_label() == "k = 2"
    with pytest.raises(my.Error, match="v was not recorded: give record="):
        Plots(run).bifurcation("k", "v")
    with pytest.raises(my.Error, match="no grid over k and B alone"):
        Plots(run).map("k", "B", "x")


def test_a_map_of_a_run_follows_the_axes_of_its_grid_and_leaves_failures_out():
    run = ARun(my.grid(k=[1.0, 2.0], B=[3.0, 4.0, 5.0], c=7.0), final={"x": np.arange(6.0)})
    run.failed[5] = True
    drawn = Plots(run).map("B", "k", "x").collections[0].get_array()
    assert drawn[0].tolist() == [0, 1, 2] and drawn[1, :2].tolist() == [3, 4] and drawn.mask[1, 2]


def test_the_functions_for_arrays_are_there_after_import_myriad():
    script = "import myriad_ode as my; print(my.plots.bifurcation.__name__)"
    told = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert told.stdout == "bifurcation\n", told.stderr


def test_waterfall_shows_which_starts_have_not_arrived():
    axes = plots.waterfall([3.0, np.inf, 1.0, 2.0], [True, False, True, False])
    arrived, on_the_way = axes.lines
    assert arrived.get_xydata().tolist() == [[1, 1], [3, 3]] and on_the_way.get_xydata().tolist() == [[2, 2]]
    assert axes.get_legend() is not None and axes.get_xlabel() == "starts (1 without a solution)"
    with pytest.raises(my.Error, match="loss has 2 values and converged 1"):
        plots.waterfall([1, 2], [True])


def test_profile_is_logarithmic_over_a_wide_range_alone():
    wide, narrow = np.geomspace(0.01, 1, 9), np.linspace(0.9, 1.1, 9)
    loss = 1 + np.linspace(-2, 2, 9)**2
    assert plots.profile(wide, loss, 4.0, logarithmic=True).get_xscale() == "log"
    axes = plots.profile(narrow, loss, 4.0, logarithmic=True, xlabel="k")
    assert axes.get_xscale() == "linear" and axes.get_xlabel() == "k"
    assert axes.lines[1].get_ydata()[0] == 4
    with pytest.raises(my.Error, match="x has 9 values and loss 8"):
        plots.profile(wide, loss[1:], 4.0)
