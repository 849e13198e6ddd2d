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

    def __init__(self, sweep, records=(), samples=(), final=(), states=(), accessories=()):
        self.sweep, self.size = sweep, sweep.size
        self.records, self.samples, self.final = dict(records), dict(samples), dict(final)
        self.failed = np.zeros(self.size, bool)
        self.status_codes = np.ones(self.size, np.uint8)
        self.t_sample = np.tile(np.arange(3.0), (self.size, 1))
        self.units, self.time_unit, self.from_phase = {"x": "mol"}, "", 4
        self.states, self.accessories = dict(states), dict(accessories)
        self.parameters, self.start = {}, {}

    def __getitem__(self, name):
        return self.final[name]

    def _along(self, dimension, name):
        return {"phase": self.records, "sample": self.samples}[dimension].get(name)


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


def test_outputs_are_drawn_where_they_are_recorded_or_sampled():
    model = my.read_xpp("aux twice=2*x\nx'=-x\n")
    run = my.solve(model, my.grid(x=[1.0, 2.0]), time=(0, 1), samples=5, record=["x"], phases=2, interpreted=True)
    assert run.plot.time_series("twice").lines[1].get_ydata().tolist() == run["twice_sample"][1].tolist()
    assert run.plot.phase_portrait("x", "twice").lines[0].get_xydata()[0].tolist() == [1, 2]
    assert run.plot.bands("twice").get_ylabel() == "twice"
    assert len(run.plot.bifurcation("x", "twice").lines[0].get_ydata()) == 4


def test_a_run_refuses_to_draw_what_is_not_there():
    run = ARun(my.grid(k=[1.0, 2.0], B=[3.0, 4.0]), records={"x": np.ones((4, 3))}, samples={"x": np.ones((4, 3))})
    for draw, message in [
            (lambda: Plots(run).map("k", "k", "x"), "k is named twice"),
            (lambda: Plots(run).map("k", "B", "x", phase=3), "phase is 3: 3 phases were recorded"),
            (lambda: Plots(run).time_series("x", instances="all"), "instances 'all': give numbers from 0 to 3"),
            (lambda: Plots(run).time_series("x", instances=[]), r"instances \[\]: give numbers"),
            (lambda: Plots(run).time_series("x", axes=3), "axes= is of type int: give axes of matplotlib"),
            (lambda: Plots(run).bands("x", quantiles=[-1, 2]), r"quantiles are \[-1.0, 2.0\]: give ascending"),
            (lambda: Plots(run).bands("x", quantiles=[]), r"quantiles are \[\]"),
            (lambda: Plots(ARun(my.grid(k=[]), samples={"x": np.ones((0, 3))})).time_series("x"), "no instances"),
            (lambda: plots.parameter_map([], [1.0], np.ones((0, 1))), "a map takes at least one of each")]:
        with pytest.raises(my.Error, match=message):
            draw()
    empty = ARun(my.grid(k=[]), records={"x": np.ones((0, 3))})
    assert not len(Plots(empty).bifurcation("k", "x").lines[0].get_xdata())


def test_lines_are_told_apart_by_what_differs():
    run = ARun(my.grid(k=[1.0, 2.0, 3.0], B=[5.0], x=[7.0]), samples={"x": np.ones((3, 3))}, states={"x": np.ones(3)})
    assert [line.get_label() for line in Plots(run).time_series("x").lines] == ["k = 1", "k = 2", "k = 3"]
    run.sweep, run.parameters, run.start = None, {"k": np.ones(3), "B": np.array([1.0, 2.5, 4.0])}, {"x": 1.0}
    assert [line.get_label() for line in Plots(run).time_series("x").lines] == ["B = 1", "B = 2.5", "B = 4"]
    run.start = {"x": np.array([0.0, 1.0, 1.0])}
    assert Plots(run).time_series("x").lines[0].get_label() == "B = 1, x at the start (mol) = 0"
    run.parameters = run.start = {}
    assert Plots(run).time_series("x", instances=[2, 0]).lines[0].get_label() == "instance 2"


def test_a_map_of_a_run_follows_the_axes_of_its_grid_and_leaves_failures_out():
    run = ARun(my.grid(k=[1.0, 2.0], B=[3.0, 4.0, 5.0], c=7.0), final={"x": np.arange(6.0)})
    run.failed[5] = True
    drawn = Plots(run).map("B", "k", "x").collections[0].get_array()
    assert drawn[0].tolist() == [0, 1, 2] and drawn[1, :2].tolist() == [3, 4] and drawn.mask[1, 2]


def test_what_starts_differently_has_colours_of_its_own():
    sweep = my.grid(k=[1.0, 2.0], x=[-1.0, 0.5])
    run = ARun(sweep, records={"x": np.arange(8.0).reshape(4, 2)}, states={"x": np.zeros(4)})
    axes = Plots(run).bifurcation("k", "x")
    first, second = axes.lines
    assert first.get_xydata().tolist() == [[1, 0], [1, 1], [2, 4], [2, 5]]
    assert second.get_xydata().tolist() == [[1, 2], [1, 3], [2, 6], [2, 7]]
    assert first.get_color() != second.get_color()
    legend = axes.get_legend()
    assert [text.get_text() for text in legend.get_texts()] == ["-1", "0.5"]
    assert legend.get_title().get_text() == "x at the start (mol)"
    axes = Plots(run).bifurcation("k", "x", by=())
    assert len(axes.lines) == 1 and axes.get_legend() is None
    axes = Plots(run).bifurcation("x", "x", by="k")
    assert axes.get_xlabel() == "x at the start (mol)" and axes.get_legend().get_title().get_text() == "k"


def test_many_starts_have_a_scale_of_colours_and_many_sets_of_starts_say_so():
    starts = np.linspace(0.5, 2, 12)
    run = ARun(my.grid(k=[1.0, 2.0], x=starts), records={"x": np.zeros((24, 1))}, states={"x": np.zeros(24)})
    axes = Plots(run).bifurcation("k", "x")
    points, = axes.collections
    assert points.get_array().tolist() == [*starts, *starts]
    assert axes.figure.axes[1].get_ylabel() == "x at the start (mol)"
    run = ARun(my.grid(k=[1.0, 2.0], x=starts, v=[0.0, 1.0]), records={"x": np.zeros((48, 1))},
               states={"x": np.zeros(48), "v": np.zeros(48)})
    legend = Plots(run).bifurcation("k", "x").get_legend()
    assert [text.get_text() for text in legend.get_texts()][-1] == "17 others"
    assert legend.get_title().get_text() == "x at the start (mol), v at the start"


def test_a_map_of_a_state_over_its_start_says_which_is_which():
    run = ARun(my.grid(x=[1.0, 2.0], v=[3.0, 4.0]), states={"x": np.arange(4.0), "v": np.arange(4.0)},
               records={"v": np.ones((4, 3))}, accessories={"peak": np.ones(4)})
    axes = Plots(run).map("x", "v", "x")
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x at the start (mol)", "v at the start")
    assert axes.figure.axes[1].get_ylabel() == "x at the end (mol)"
    for z, phase, label in (("v", -1, "v at the end"), ("v", 1, "v at the end of phase 5"), ("peak", -1, "peak")):
        assert Plots(run).map("x", "v", z, phase=phase).figure.axes[1].get_ylabel() == label


def test_truth_values_words_and_few_whole_numbers_are_classes():
    for z, labels in ((np.array([[True, False], [True, True]]), ["no", "yes"]),
                      (np.array([["b", "a"], ["b", "b"]]), ["b", "a"]), (np.array([[3, 7], [3, 3]]), ["3", "7"])):
        axes = plots.parameter_map([0, 1], [0, 1], z, zlabel="kind")
        bar = axes.figure.axes[1]
        assert [label.get_text() for label in bar.get_yticklabels()] == labels and bar.get_ylabel() == "kind"
        assert axes.collections[0].cmap.N == 2
    axes = plots.parameter_map([0, 1], [0, 1], np.array([[0.0, 1.0], [1.0, 1.0]]))
    assert axes.collections[0].cmap.N > 2


def test_a_map_has_as_many_colours_as_classes_or_says_that_there_are_too_many():
    for classes in (2, 8, 9, 20):
        z = np.repeat(np.arange(classes), np.arange(classes) + 1)[:, None]
        axes = plots.parameter_map(np.arange(len(z)), [0], z, names=[f"class {i}" for i in range(classes)])
        shown = axes.collections[0]
        found = {tuple(colour) for colour in shown.cmap(shown.norm(np.unique(shown.get_array())))}
        labels = [label.get_text() for label in axes.figure.axes[1].get_yticklabels()]
        assert len(found) == len(labels) == min(classes, 8)
        if classes > 8:  # the most frequent ones keep theirs
            assert labels == [*(f"class {i}" for i in range(classes - 7, classes)), f"{classes - 7} others"]


def test_values_of_both_signs_have_diverging_colours_around_zero():
    signed, positive = np.array([[-1.0, 3.0], [np.nan, 0.5]]), np.array([[1e-17, 3.0], [-1e-17, 0.5]])
    shown = plots.parameter_map([0, 1], [0, 1], signed).collections[0]
    assert shown.cmap.name == "RdBu_r" and shown.norm(0.0) == 0.5 and shown.norm(3.0) == 1
    assert plots.parameter_map([0, 1], [0, 1], positive).collections[0].cmap.name == "viridis"
    shown = plots.parameter_map([0, 1], [0, 1], signed, vmin=-2, vmax=1, cmap="PiYG").collections[0]
    assert shown.cmap.name == "PiYG" and (shown.norm.vmin, shown.norm.vmax) == (-2, 1)


@pytest.mark.parametrize("draw", [
    lambda style: plots.bifurcation([1, 2], [[1], [2]], **style).lines[0],
    lambda style: plots.time_series([1, 2], [[1, 2], [3, 4]], labels=["a", "b"], **style).lines[0],
    lambda style: plots.phase_portrait([1, 2], [3, 4], points=True, **style).lines[0],
    lambda style: plots.waterfall([1, 2], [True, True], **style).lines[0],
    lambda style: plots.profile([1, 2, 3], [2, 1, 2], 1.5, **style).lines[0],
    lambda style: plots.data_and_model([1, 2], [3, 4], [1, 2], [3, 4], **style).lines[0],
])
def test_arguments_of_matplotlib_override_by_any_of_their_names(draw):
    line = draw({"c": "red", "lw": 3, "ms": 5, "mew": 2, "ls": "--", "label": "mine", "zorder": 7})
    assert line.get_color() == "red" and line.get_linewidth() == 3 and line.get_markersize() == 5
    assert line.get_markeredgewidth() == 2 and line.get_linestyle() == "--" and line.get_label() == "mine"
    assert line.get_zorder() == 7


def test_arguments_of_matplotlib_override_in_pictures_without_lines():
    bar = plots.statuses(["a"], fc="red", height=0.2).patches[0]
    assert bar.get_facecolor()[:3] == (1, 0, 0) and bar.get_height() == 0.2
    area = plots.bands([1, 2], [[1, 1], [2, 2]], [0.1, 0.9], fc="red").collections[0]
    assert area.get_facecolor()[0][:3].tolist() == [1, 0, 0]
    shown = plots.parameter_map([0, 1], [0, 1], np.ones((2, 2), int), cmap="plasma", rasterized=False).collections[0]
    assert not shown.get_rasterized() and shown.cmap(0) == matplotlib.colormaps["plasma"](0.0)


def test_legends_are_beside_the_curves_and_within_the_figure():
    lines = np.ones((5, 3))
    axes = plots.time_series([1, 2, 3], lines, labels=list("abcde"))
    axes.figure.canvas.draw()
    legend = axes.get_legend().get_window_extent()
    assert legend.x0 >= axes.get_window_extent().x1 and legend.x1 <= axes.figure.bbox.x1
    _, given = pyplot.subplots()  # without a layout that makes room for it
    plots.time_series([1, 2, 3], lines, labels=list("abcde"), axes=given)
    given.figure.canvas.draw()
    assert given.get_legend().get_window_extent().x1 <= given.get_window_extent().x1


def test_bands_lie_between_quantiles_that_belong_together():
    t = np.array([0.0, 1.0, 2.0])
    y = np.arange(5.0)[:, None] + np.zeros(3)
    axes = plots.bands(t, y, [0.05, 0.25, 0.5, 0.75, 0.95])
    outer, inner = (area.get_paths()[0].get_extents() for area in axes.collections)
    assert (outer.y0, outer.y1, inner.y0, inner.y1) == (0, 4, 1, 3)
    assert axes.lines[0].get_ydata().tolist() == [2, 2, 2]
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["90 % of all", "50 % of all", "median"]
    for quantiles in ([0.05, 0.5], [0.5, 0.05, 0.95], [0.05, 0.5, 0.9]):
        with pytest.raises(my.Error, match="y has shape|each with its counterpart"):
            plots.bands(t, y[:3], quantiles)


def test_quantiles_of_the_population_are_as_often_within_those_of_samples_as_the_confidence_says():
    random, wanted = np.random.default_rng(3), np.array([0.05, 0.5, 0.9])
    low, high = my.reduce.confidence_levels(wanted, 500, level=0.9)
    samples = random.random((4000, 500))  # whose quantiles are their levels
    lower, upper = np.quantile(samples, low, axis=1).T, np.quantile(samples, high, axis=1).T
    np.testing.assert_allclose(((lower <= wanted) & (wanted <= upper)).mean(axis=0), 0.9, atol=0.02)
    assert my.reduce.confidence_levels([0, 1], 10).tolist() == [[0, 1], [0, 1]]
    with pytest.raises(my.Error, match="give quantiles from 0 to 1"):
        my.reduce.confidence_levels([5, 95], 100)


def test_bands_show_within_which_values_quantiles_are():
    t, y = np.arange(3.0), np.array([[0.0, 1, 2], [3, 4, 5]])
    axes = plots.bands(t, y, [0.1, 0.9], within=[y - 0.5, y + 0.5])
    drawn = [line.get_ydata().tolist() for line in axes.lines]
    assert drawn == [*(y - 0.5).tolist(), *(y + 0.5).tolist()]
    with pytest.raises(my.Error, match=r"within has shape \(2, 2, 2\)"):
        plots.bands(t, y, [0.1, 0.9], within=np.zeros((2, 2, 2)))


def test_bands_of_a_run_are_of_the_instances_that_did_not_fail():
    y = np.outer(np.arange(11.0), [1, 2, 3])
    run = ARun(my.grid(k=np.arange(11.0)), samples={"x": y})
    run.failed[10] = True
    axes = Plots(run).bands("x", quantiles=[0, 0.5, 1])
    assert axes.collections[0].get_paths()[0].get_extents().y1 == 27 and axes.lines[0].get_ydata()[0] == 4.5
    assert axes.get_ylabel() == "x (mol)"
    run.t_sample = run.t_sample * np.arange(11)[:, None]
    with pytest.raises(my.Error, match="not sampled at the same times"):
        Plots(run).bands("x")


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


def ticks(axis):
    axis.axes.figure.canvas.draw()
    least, most = axis.get_view_interval()
    return [text.get_text() for place, text in zip(axis.get_majorticklocs(), axis.get_majorticklabels())
            if least <= place <= most]


@pytest.mark.parametrize("loss, plateaus", [
    (297.1 * (1 + 1e-9 * np.arange(20)), 1),              # rounding of one minimum
    (1e-20 * (1 + np.arange(20)), 20),                    # without a tolerance for data that the model meets
    (np.repeat([297.1, 298.3, 302.0, 900.0], 5) + 1e-8 * np.arange(20), 4),
    (np.repeat([297.1, 6700.0], 10) + 1e-8 * np.arange(20), 2),
])
def test_equal_losses_are_one_plateau_and_ticks_differ(loss, plateaus):
    axes = plots.waterfall(loss[::-1], np.ones(20, bool))
    assert len(np.unique(axes.lines[0].get_ydata())) == plateaus
    shown = ticks(axes.yaxis)
    assert len(shown) > 1 and len(set(shown)) == len(shown)
    assert len(np.unique(plots.waterfall(loss, np.ones(20, bool), tolerance=1e4).lines[0].get_ydata())) == 1


@pytest.mark.parametrize("least, most", [(1, 1.5), (3, 9), (1, 50), (1, 1e6)])
def test_logarithmic_axes_have_several_ticks(least, most):
    axes = plots.parameter_map(np.geomspace(least, most, 7), [0, 1], np.ones((7, 2)))
    shown = ticks(axes.xaxis)
    assert axes.get_xscale() == "log" and len(shown) > 1 and len(set(shown)) == len(shown)


def test_profile_is_logarithmic_over_a_wide_range_alone():
    wide, narrow = np.geomspace(0.01, 1, 9), np.linspace(0.9, 1.1, 9)
    loss = 1 + np.linspace(-2, 2, 9)**2
    assert plots.profile(wide, loss, 4.0, logarithmic=True).get_xscale() == "log"
    axes = plots.profile(narrow, loss, 4.0, logarithmic=True, xlabel="k")
    assert axes.get_xscale() == "linear" and axes.get_xlabel() == "k"
    assert axes.lines[1].get_ydata()[0] == 4
    with pytest.raises(my.Error, match="x has 9 values and loss 8"):
        plots.profile(wide, loss[1:], 4.0)
