# SPDX-License-Identifier: MIT
"""Attractors and basins: published examples, closed forms, and what must not change them."""

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode.dynamics import clusters

x, y, z, v = my.states("x y z v")
k, B, w = my.parameters("k B w")
quick = dict(interpreted=True, exponents=False)
forced = my.model({x: v, v: x - x**3 - k * v + B * my.cos(w * my.time)}, name="forced")
free = my.model({x: v, v: x - x**3 - k * v}, name="free")


def test_pendulum_over_three_magnets_has_thirds():
    """Motter, Gruiz, Karolyi and Tel, Phys. Rev. Lett. 111 (2013) 194101, from starts in threes that a rotation by a
    third of a circle turns into each other."""
    u, s = my.states("u s")
    magnets = np.array([[2, 0], [-1, np.sqrt(3)], [-1, -np.sqrt(3)]]) / np.sqrt(12)
    pull = [((a - x)**2 + (b - y)**2 + 0.09)**-1.5 for a, b in magnets]
    pendulum = my.model({x: u, u: sum(p * (a - x) for p, (a, _) in zip(pull, magnets)) - 0.25 * x - 0.2 * u,
                         y: s, s: sum(p * (b - y) for p, (_, b) in zip(pull, magnets)) - 0.25 * y - 0.2 * s})
    places = np.random.default_rng(1).uniform(0.1, 1.4, 60) * np.exp(1j * np.linspace(0.05, 2, 60))
    turned = np.concatenate([places * np.exp(2j * np.pi * i / 3) for i in range(3)])
    found = my.attractors(pendulum, start={x: turned.real, y: turned.imag, u: 0, s: 0}, time=(0, 1), transient=60,
                          phases=20, **quick)
    assert [one.name for one in found] == ["stable focus"] * 3
    np.testing.assert_allclose(found.shares, 1 / 3, atol=0.02)
    at = np.array([[one.mean["x"], one.mean["y"]] for one in found])
    # each near a magnet, drawn to the centre by the string
    assert (np.sqrt(((at[:, None] - magnets)**2).sum(axis=2)).min(axis=1) < 0.06).all()
    of = at[found.labels] @ [1, 1j]
    same = np.abs(of[60:120] - of[:60] * np.exp(2j * np.pi / 3)) < 1e-6
    assert same.mean() > 0.95


def test_lorenz_84_has_a_fixed_point_a_cycle_and_chaos():
    """Freire, Bonatto, DaCamara and Gallas, Chaos 18 (2008) 033121; parameters and shares of starts in a cube as in
    the tests of Attractors.jl: 0.645, 0.18, 0.175."""
    lorenz_84 = my.model({x: -y**2 - z**2 - 0.255 * x + 0.255 * 6.886, y: x * y - y - 4 * x * z + 1.347,
                          z: 4 * x * y + x * z - z})
    found = my.attractors(lorenz_84, start={s: my.uniform(-3, 3) for s in (x, y, z)}, draws=400, time=(0, 0.5), **quick)
    by_kind = {one.kind: one for one in found}
    assert len(found) == 3 and set(by_kind) == {"fixed point", "aperiodic", "cycle"}
    for kind, share in (("fixed point", 0.645), ("aperiodic", 0.18), ("cycle", 0.175)):
        one = by_kind[kind]
        assert abs(one.share - share) < 4 * one.error
        assert one.error == pytest.approx(np.sqrt(one.share * (1 - one.share) / 400))
    point = by_kind["fixed point"]
    assert point.steady_state.is_stable
    # where z' = 0 and y' = 0, both are functions of x
    at = point.mean["x"]
    np.testing.assert_allclose(point.mean["z"], -4 * at * point.mean["y"] / (at - 1), rtol=1e-8)


def test_two_wells_have_half_of_a_symmetric_grid_each():
    found = my.attractors(free, {k: 0.2}, start=my.grid({x: np.linspace(-2, 2, 20), v: np.linspace(-2, 2, 20)}),
                          time=(0, 1), **quick)
    assert found.shares.tolist() == [0.5, 0.5] and found.labels.shape == (20, 20)
    assert (found.labels == 1 - found.labels[::-1, ::-1]).all()
    for one, at in zip(found, (-1, 1)):
        assert one.kind == "fixed point" and one.mean["x"] == pytest.approx(at, abs=1e-9)
        np.testing.assert_allclose(one.steady_state.eigenvalues, [-0.1 + 1j * np.sqrt(1.99), -0.1 - 1j * np.sqrt(1.99)],
                                   rtol=1e-9)


def test_forced_duffing_has_the_shares_of_attractors_jl():
    """Its test "Duffing oscillator: stroboscopic map" has 0.511 and 0.489, with an error of 0.01."""
    places = np.linspace(-2.2, 2.2, 24)
    found = my.attractors(forced, {k: 0.15, B: 0.2, w: 1}, start=my.grid({x: places, v: places}),
                          time=(0, 2 * np.pi), transient=60, phases=24, **quick)
    assert [(one.kind, one.returns) for one in found] == [("cycle", 1)] * 2
    np.testing.assert_allclose(sorted(found.shares), [0.489, 0.511], atol=0.03)


@pytest.mark.parametrize("amplitude, returns", [(0.20, 1), (0.28, 2), (0.29, 4), (0.37, 5), (0.65, 2)])
def test_duffing_has_the_periods_of_the_textbook(amplitude, returns):
    """Jordan and Smith, Nonlinear Ordinary Differential Equations (2007), with k = 0.3 and w = 1.2; the pair of wells
    has a pair of cycles where each stays in its own."""
    found = my.attractors(forced, {k: 0.3, B: amplitude, w: 1.2}, start={x: np.linspace(-1.5, 1.5, 6), v: 0.1},
                          time=(0, 2 * np.pi / 1.2), transient=150, phases=40, **quick)
    of = [one for one in found if one.returns == returns]
    assert of and of[0].period == pytest.approx(returns * 2 * np.pi / 1.2)
    assert len(of[0].points["x"]) == returns
    if amplitude < 0.3:
        assert len(found) == 2 and found[0].mean["x"] * found[1].mean["x"] < 0


def test_neither_order_nor_number_of_starts_changes_labels():
    generator = np.random.default_rng(3)
    starts = {x: generator.uniform(-2, 2, 150), v: generator.uniform(-2, 2, 150)}
    options = dict(time=(0, 2 * np.pi), transient=60, phases=24, **quick)
    one = my.attractors(forced, {k: 0.2, B: 0.35, w: 1}, start=starts, **options)
    order = generator.permutation(150)
    other = my.attractors(forced, {k: 0.2, B: 0.35, w: 1}, start={s: of[order] for s, of in starts.items()}, **options)
    assert sorted(a.kind for a in one) == ["aperiodic", "cycle"]
    assert (one.labels[order] == other.labels).all()


def test_orbits_that_diverge_are_a_class_of_their_own():
    found = my.attractors(my.model({x: x**2 - 1}), start={x: np.linspace(-2, 2, 41)}, time=(0, 1), **quick)
    assert [one.name for one in found] == ["stable node"]
    starts = np.linspace(-2, 2, 41)
    assert (found.labels[starts < 0.99] == 0).all() and (found.labels[starts > 1.01] == -1).all()
    assert found.labels[30] == -2 and "unstable node at x = 1" in found.notes[0]  # at rest between the two
    assert sum(found.diverged.values()) == 10 and "diverged or failed: 24.39 %" in repr(found)
    growing = my.attractors(my.model({x: x}), start={x: [1.0, -1.0]}, time=(0, 1), **quick)
    assert len(growing) == 0 and growing.diverged == {"success": 2} and "beyond all bounds" in repr(growing)


def test_cycles_of_a_flow_have_their_periods():
    """r' = r (1 - r^2), and an angle that turns with w: the cycle r = 1 of period 2 pi / w."""
    square = x**2 + y**2
    model = my.model({x: x * (1 - square) - w * y, y: y * (1 - square) + w * x})
    starts = my.grid({x: np.linspace(-1, 1, 5), y: np.linspace(-1, 1, 5)})
    for slice_ in (0.5, 1.0, np.pi / 3):  # the last one has a common measure with the period
        found = my.attractors(model, {w: 2}, start=starts, time=(0, slice_), phases=40, transient=40, **quick)
        assert len(found) == 1 and found[0].share == 24 / 25
        assert found[0].period == pytest.approx(np.pi, rel=2e-4)
        assert found[0].ranges["x"] == pytest.approx((-1, 1), abs=5e-3)
        assert "unstable focus at x = 0, y = 0" in found.notes[0]


@pytest.mark.parametrize("slice_", [0.3, 2, 10, 20])
def test_the_period_of_a_cycle_does_not_depend_on_the_slice(slice_):
    """Van der Pol's oscillator with k = 1 has the period 6.66328686 (Andersen and Geer, SIAM J. Appl. Math. 42 (1982)
    678), of which 20 is nearly three."""
    model = my.model({x: v, v: (1 - x**2) * v - x})
    found = my.attractors(model, start={x: 1.0, v: 0}, time=(0, slice_), transient=100, phases=60, **quick)
    assert [one.period for one in found] == pytest.approx([6.66328686], rel=2e-5)


@pytest.mark.parametrize("slope, domain", [(1 + 0 * x, (0, 1)), (1 / (1 + x**2), (0, 1)), (1e-3 * x, (0, 1)),
                                           (0.1 + 0.01 * my.cos(my.time), (0, 2 * np.pi))])
def test_orbits_that_drift_come_to_no_attractor(slope, domain):
    found = my.attractors(my.model({x: slope}), start={x: [1.0, 2.0]}, time=domain, transient=30, phases=16, **quick)
    assert len(found) == 0 and found.labels.tolist() == [-2, -2]
    assert "2 starts have not come to an attractor" in found.notes[0]


@pytest.mark.parametrize("size, fast", [(1e-8, 1), (1e8, 1), (1e-8, 1e16)])
def test_units_of_states_make_no_difference(size, fast):
    """Two wells at the distance `size` in x, whose speeds are `fast` times as large."""
    model = my.model({x: v / fast, v: fast * (x - x**3 / size**2) - 0.3 * v})
    speed = size * fast
    found = my.attractors(model, start=my.grid({x: size * np.linspace(-2, 2, 5), v: speed * np.linspace(-1, 1, 4)}),
                          time=(0, 1), transient=100, phases=30, atol={x: 1e-8 * size, v: 1e-8 * speed}, **quick)
    assert [one.share for one in found] == [0.5, 0.5]
    assert sorted(one.mean["x"] for one in found) == pytest.approx([-size, size])
    assert {one.place() for one in found} == {f"x = {-size:.4g}, v = 0", f"x = {size:.4g}, v = 0"}


def test_fast_parts_of_a_cycle_are_resolved():
    """Van der Pol's relaxation oscillation for k = 50: its period is (3 - 2 log 2) k + 7.0143 / k^(1/3) + ...
    (Dorodnitsyn 1947), its largest speed about 4/3 k for a short time, which samples of slices of 10 step over."""
    model = my.model({x: v, v: k * (1 - x**2) * v - x})
    found = my.attractors(model, {k: 50}, start={x: np.linspace(-2, 2, 5), v: 1.0}, time=(0, 10), transient=40,
                          phases=40, method="rodas_5p", **quick)
    period = (3 - 2 * np.log(2)) * 50 + 7.0143 / 50**(1 / 3)
    assert len(found) == 1 and found[0].period == pytest.approx(period, rel=0.01)
    assert found[0].ranges["v"] == pytest.approx((-200 / 3, 200 / 3), rel=0.05)


def test_many_attractors_are_shown_in_part():
    """A ring of ten weakly coupled bistable units has two to the ten of them."""
    ring = my.states([f"x{i}" for i in range(10)])
    model = my.model({one: one - one**3 + 0.05 * (ring[i - 1] - one) for i, one in enumerate(ring)})
    starts = np.random.default_rng(5).choice([-0.7, 0.7], (10, 60))
    found = my.attractors(model, start=dict(zip(ring, starts)), time=(0, 1), transient=30, phases=8, **quick)
    assert len(found) == len({tuple(column) for column in starts.T})
    same = (starts[:, :, None] == starts[:, None]).all(axis=0)
    assert ((found.labels[:, None] == found.labels) == same).all()
    assert repr(found).count("\n") == 21 and f"and {len(found) - 20} more, with" in repr(found)


@pytest.mark.parametrize("c, returns", [(4, 1), (6, 2), (8.5, 4)])
def test_roessler_cycles_are_the_same_on_a_section_and_without(c, returns):
    """The period doubles at these values as in textbooks, for a = b = 0.1."""
    equations = {x: -y - z, y: x + 0.1 * y, z: 0.1 + z * (x - k)}
    options = dict(start={x: np.linspace(-6, -4, 4), y: 0, z: 0}, transient=100, phases=60, **quick)
    section = my.attractors(my.model(equations, events=my.event(y, direction="falling", stop_after=1)), {k: c},
                            time=(0, np.inf), **options)
    flow = my.attractors(my.model(equations), {k: c}, time=(0, 2), **options)
    assert len(section) == len(flow) == 1 and section[0].returns == returns
    assert section[0].period == pytest.approx(flow[0].period, rel=1e-3)


def test_angles_count_by_their_direction():
    """A damped pendulum with a torque: at rest, or turning over. Its orbits end after different numbers of turns."""
    pendulum = my.model({x: v, v: 0.5 - 0.2 * v - my.sin(x)})
    starts = my.grid({x: np.linspace(-3, 3, 6), v: np.linspace(-2, 3, 6)})
    found = my.attractors(pendulum, start=starts, time=(0, 1), angles=[x], transient=80, phases=40, **quick)
    assert sorted(one.kind for one in found) == ["cycle", "fixed point"]
    rest = found[[one.kind for one in found].index("fixed point")]
    assert rest.mean["x"] == pytest.approx(np.arcsin(0.5))
    turning = found[1 - list(found).index(rest)]
    assert turning.ranges["x"] == pytest.approx((-np.pi, np.pi), abs=0.3) and turning.ranges["v"][0] > 0


def test_exponents_tell_tori_from_chaos():
    model = my.model({x: v, v: (k * (1 - x**2) - 0.2 * (1 - k)) * v + (1 - 2 * k) * x - (1 - k) * x**3
                      + B * my.cos(w * my.time)})  # Duffing's for k = 0, van der Pol's for k = 1
    options = dict(start={x: np.linspace(-1, 1, 6), v: 0}, transient=100, phases=60)
    chaos = my.attractors(model, {k: 0, B: 0.3, w: 1}, time=(0, 2 * np.pi), **options)
    torus = my.attractors(model, {k: 1, B: 0.5, w: 1.7}, time=(0, 2 * np.pi / 1.7), **options)
    assert [one.kind for one in chaos] == ["chaotic"] and [one.kind for one in torus] == ["quasiperiodic"]
    assert 0.1 < chaos[0].exponent < 0.25 and abs(torus[0].exponent) < 2e-3


def test_without_a_compiler_what_does_not_return_is_aperiodic():
    found = my.attractors(forced, {k: 0.2, B: 0.3, w: 1}, start={x: [0.1, 0.4], v: 0}, time=(0, 2 * np.pi),
                          transient=60, phases=24, interpreted=True)
    assert [one.kind for one in found] == ["aperiodic"] and "are not told apart" in found.notes[0]


def test_modes_go_on_with_their_orbits():
    """A thermostat: between two switches the temperature goes to 2 or to 0 exponentially, with rate 1/2."""
    heating = my.integer_accessory("heating")
    room = my.model({x: my.where(heating == 1, 1.0, 0.0) - 0.5 * x}, events=[
        my.event(x - 1.2, direction="rising", do={heating: 0}),
        my.event(x - 0.8, direction="falling", do={heating: 1})])
    found = my.attractors(room, start={x: np.linspace(0, 1.1, 4), heating: 1}, time=(0, 0.3), transient=50, phases=40,
                          **quick)
    assert [one.kind for one in found] == ["cycle"]
    assert found[0].period == pytest.approx(2 * np.log(1.2 / 0.8) + 2 * np.log((2 - 0.8) / (2 - 1.2)), rel=2e-3)


def test_borders_are_where_neighbours_differ():
    model = my.model({x: x - x**3, y: -y})
    found = my.attractors(model, start=my.grid({x: np.linspace(-1, 1, 10), y: np.linspace(-1, 1, 4)}), time=(0, 1),
                          transient=40, phases=16, **quick)
    assert np.argwhere(found.borders).tolist() == [[i, j] for i in (4, 5) for j in range(4)]
    draws = my.attractors(model, start={x: my.uniform(-1, 1), y: 0}, draws=20, time=(0, 1), transient=40, phases=16,
                          **quick)
    with pytest.raises(my.Error, match="have no neighbours"):
        _ = draws.borders


def test_pictures_tables_and_datasets():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    options = dict(time=(0, 1), transient=60, phases=16, **quick)
    found = my.attractors(free, {k: 0.5}, start=my.grid({x: np.linspace(-2, 2, 9), v: np.linspace(-1, 1, 6)}),
                          **options)
    axes = found.plot()
    drawn = axes.collections[0].get_array()
    assert drawn.shape == (6, 9) and (drawn.T == found.labels).all()
    words = [label.get_text() for label in axes.figure.axes[1].get_yticklabels()]
    assert len(words) == 2 and words[0].startswith("stable focus\nx = ") and words[0].endswith(" %")
    assert sorted(line.get_xdata()[0] for line in axes.lines) == pytest.approx([-1, 1])
    assert found.plot("v", "x").get_xlabel() == "v at the start"
    with pytest.raises(my.Error, match="over two states: give two, or neither"):
        found.plot("x", "x")
    data = my.attractors(free, {k: 0.5}, start={x: my.uniform(-2, 2), v: my.normal(0, 1)}, draws=30, **options)
    assert len(data.plot().get_legend().get_texts()) == 2
    table = pytest.importorskip("pandas") and found.to_pandas()
    assert table["share"].sum() == 1 and table.loc[0, "x_min"] == found[0].ranges["x"][0]
    dataset = pytest.importorskip("xarray") and found.to_xarray()
    assert dataset["label"].dims == ("x_start", "v_start") and dataset["label"].sel(x_start=-2, v_start=1) in (0, 1)
    assert "stable focus" in found._repr_html_()
    matplotlib.pyplot.close("all")


@pytest.mark.parametrize("call, message", [
    (dict(start={x: 1}), "initial value of 'v' is missing"),
    (dict(start={x: 1, v: 0, k: 1}), "'k' is no state that start= can set"),
    (dict(start={x: my.uniform(-1, 1), v: 0}), "give the number of draws"),
    (dict(draws=10), "nothing is drawn"),
    (dict(sweep={k: [0.1, 0.2]}), "2 values of k: give one, or use my.continuation"),
    (dict(sweep=my.grid({k: [0.1, 0.2]})), "the sweep varies k: give one value"),
    (dict(phases=4), "phases is 4: give at least 8"),
    (dict(tolerance=2), "tolerance is 2: give a part"),
    (dict(bound=-1), "bound is -1: give a positive number"),
    (dict(time=(0, np.inf)), "no event ends a phase, and time has no end"),
    (dict(time=(0, -1)), "time goes from 0 to -1: give an end after the begin"),
    (dict(record=[x]), "no option 'record' here: give states="),
    (dict(rtoll=1e-6), "no option 'rtoll'"),
    (dict(states=["q"]), "'q' is no component of the model"),
    (dict(states=[]), "states= names no state"),
    (dict(sweep={k: my.uniform(0, 1)}), "the value of k in the sweep is .*: give a number"),
    (dict(start={x: my.uniform(-1, 1), v: 0}, draws=4, seed=-1), "seed is -1"),
    (dict(model=3), "the model is a int: make it by"),
])
def test_wrong_calls_are_refused(call, message):
    with pytest.raises(my.Error, match=message):
        my.attractors(**{"model": free, "sweep": {k: 0.1}, "start": {x: [0, 1], v: 0}, "time": (0, 1), **call})


def test_models_whose_orbits_come_to_nothing_are_refused():
    for model, message in ((my.model({x: -x}, noise={x: 0.1}), "has noise"),
                           (my.with_tangents(my.model({x: -x}), 1), "has tangents")):
        with pytest.raises(my.Error, match=message):
            my.attractors(model, start={x: [0, 1]}, time=(0, 1))


def test_points_return_only_if_they_do_so_for_good():
    phase = np.arange(240)

    def circle(turns):
        return np.stack([np.cos(2 * np.pi * turns * phase), np.sin(2 * np.pi * turns * phase)], axis=1)

    points = np.stack([circle(1 / 3), circle(2 / 7), circle(0.25 + 1e-4), circle(0.6180339887)])
    lag, off = clusters.lags(points, 0.01)
    assert lag.tolist() == [3, 7, 0, 0] and off[0] < 1e-12  # the third is nearly back after four, and drifts


def test_many_orbits_are_grouped_without_comparing_all():
    generator = np.random.default_rng(2)
    centres = generator.uniform(-1, 1, (20, 4))
    which = generator.integers(0, 20, 50_000)
    points = centres[which][:, None, :2] + 1e-5 * generator.normal(size=(50_000, 8, 2))
    features = clusters.features_of(points, 0.01, may_return=True)
    leaders, group = clusters.grouped(features, points[:, -1], 0.01, 100)
    assert len(leaders) == 20 and len({(a, b) for a, b in zip(which, group)}) == 20


def test_legends_tell_attractors_of_one_kind_apart():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    model = my.model({y: -y, x: k * x - x**3}, name="pitchfork")
    along = my.continuation(model, {k: [0.5, 1.0, 1.5]}, start={y: [0.5, 0.5], x: [-1.0, 1.0]}, time=(0, 1),
                            transient=60, phases=16, **quick)
    words = [text.get_text() for text in along.plot().get_legend().get_texts()]
    assert sorted(word.partition(": ")[2] for word in words) == [  # y is alike
        "stable node\nx = -1 at k = 1", "stable node\nx = 1 at k = 1"]
    matplotlib.pyplot.close("all")


def test_legends_tell_attractors_apart_that_only_a_hidden_state_does():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    model = my.model({y: -y, z: -z, x: x - x**3}, name="hidden")
    found = my.attractors(model, start={y: [0.5, 0.2], z: [0.5, -0.2], x: [-1.0, 1.0]}, time=(0, 1), transient=60,
                          phases=16, **quick)
    words = [text.get_text().rpartition("\n")[0] for text in found.plot(y, z).get_legend().get_texts()]
    assert sorted(words) == ["stable node\nx = -1", "stable node\nx = 1"]
    matplotlib.pyplot.close("all")
