# SPDX-License-Identifier: MIT
"""Coupled units: components over units, couplings by matrices, events of each."""

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode.codegen.unit_writer import unit_form

n = 12
rng = np.random.default_rng(3)
full = rng.normal(size=(n, n))
banded = np.where(np.abs(np.subtract.outer(np.arange(n), np.arange(n))) <= 2, full, 0)
weights = rng.normal(size=n)
all_round = np.stack([np.roll(weights, i) for i in range(n)])
near = weights * (np.minimum(np.arange(n), n - np.arange(n)) <= 1)
ring = np.stack([np.roll(near, i) for i in range(n)])
x0, v0 = rng.normal(size=n), rng.normal(size=n)


@pytest.mark.parametrize("couple, matrix", [
    (lambda u: u.full_coupling("A", full), full),
    (lambda u: u.banded_coupling("A", banded, 2), banded),
    (lambda u: u.circulant_coupling("A", all_round), all_round),
    (lambda u: u.circulant_coupling("A", ring, 1), ring)])
def test_a_coupling_is_the_product_with_its_matrix(couple, matrix):
    units = my.units(n)
    x, v = units.states("x v")
    A = couple(units)
    model = my.model({x: v, v: A @ np.sin(x) - 0.5 * v})
    assert model.states == [name for i in range(n) for name in (f"x_{i}", f"v_{i}")]
    np.testing.assert_allclose(model.derivatives(0.3, np.stack([x0, v0], axis=1).ravel()),
                               np.stack([v0, matrix @ np.sin(x0) - 0.5 * v0], axis=1).ravel(), rtol=1e-12, atol=1e-12)


def test_models_with_other_matrices_have_the_same_code():
    def model(matrix):
        units = my.units(n)
        x = units.state("x")
        return my.model({x: units.banded_coupling("A", matrix, 2) @ x})
    assert model(banded).hash == model(2 * banded).hash


def test_equations_have_a_value_for_each_unit_or_one_for_all():
    units = my.units(3)
    x, v = units.states("x v")
    k, c = units.parameter("k"), my.parameter("c")
    model = my.model({x: -c, v: [k[0] * x[2], x[0] + v[1], 7]})
    assert model.parameters == ["c", "k_0"]
    given = {"c": 2.0, "k_0": 3.0}
    assert list(model.derivatives(0.0, [1, 4, 2, 5, 3, 6], **given)) == [-2, 9, -2, 6, -2, 7]


def test_hooks_events_and_summaries_of_units_are_written_out():
    units = my.units(3)
    x, v = units.states("x v")
    top, count = units.accessory("top"), units.integer_accessory("count")
    model = my.model({x: v, v: -x}, accessories={top: my.phase_maximum(x), count: 0},
                     events=units.events(v, name="turn", direction="falling",
                                         do=lambda i: {count[i]: count[i] + 1, v[(i + 1) % 3]: -v[(i + 1) % 3]}),
                     finalise={x: 2 * x})
    assert [e.name for e in model.events] == ["turn_0", "turn_1", "turn_2"]
    assert model.accessories == ["top_0", "top_1", "top_2"]
    assert model.integer_accessories == ["count_0", "count_1", "count_2"]
    code = model.cpp()
    assert "lane.y[v_0] = -lane.y[v_0]" in code and "lane.y[x_2] = 2 * lane.y[x_2]" in code
    assert "{observed_x_1, myriad::over_phase::maximum, top_1}" in code


@pytest.mark.parametrize("make, message", [
    (lambda u: u.full_coupling("A", np.ones((3, 2))), "the coupling A is not square, but has shape (3, 2)"),
    (lambda u: u.full_coupling("A", np.ones((2, 2))), "the coupling A has 2 rows, but there are 3 units"),
    (lambda u: u.full_coupling("A", [[1, 2, 3], [1, 2, 3], [1, 2, np.inf]]), "has entries that are not finite"),
    (lambda u: u.circulant_coupling("A", [[1, 2, 3], [3, 1, 2], [2, 4, 1]]),
     "the coupling A is not circulant: entry (2, 1) is 4.0, but 3.0 in row 0"),
    (lambda u: u.banded_coupling("A", np.ones((3, 3)), 1), "entry (0, 2) of the coupling A is 1.0, outside the band"),
    (lambda u: u.banded_coupling("A", np.ones((3, 3)), 3), "give a whole number from 0 to 2"),
    (lambda u: u.circulant_coupling("A", np.ones((3, 3)), 0), "entry (0, 1) of the coupling A is 1.0, outside the"),
    (lambda u: u.circulant_coupling("A", np.ones((3, 3)), 2), "give a whole number from 0 to 1"),
    (lambda u: u.full_coupling("A", np.ones((3, 3))) @ [1, 2], "the coupling A sums values of shape (2,)"),
    (lambda u: u.events([1, 2], name="e"), "the events e have shape (2,)"),
    (lambda u: u.state("x y"), "'x y' is no name for a state"),
    (lambda u: my.units(0), "there are 0 units"),
    (lambda u: my.units(3, threads_per_instance=3), "threads_per_instance is 3"),
    (lambda u: my.units(3, threads_per_instance=True), "threads_per_instance is True"),
    (lambda u: my.units(3, threads_per_instance=64.0), "threads_per_instance is 64.0"),
    (lambda u: my.model({u.state("x"): [1, 2]}), "equations has values of shape (2,) for x_0 to x_2"),
    (lambda u: my.model({u.state("x"): 1, my.state("x_1"): 2}), "x_1 stands in equations twice"),
    (lambda u: u.state("x")[3], "index 3 is out of bounds"),
])
def test_units_that_do_not_fit_are_refused(make, message):
    with pytest.raises((my.Error, IndexError)) as refused:
        make(my.units(3))
    assert message in str(refused.value)


def test_values_of_a_run_are_given_for_all_units():
    units = my.units(2)
    x, k = units.state("x"), units.parameter("k")
    rates = np.array([1.0, 2.0, 3.0])
    run = my.solve(my.model({x: -k * x}), {k: [rates, 4.0]}, start={x: 1}, time=(0, 1), rtol=1e-9,
                   record=dict(states=[x]))
    np.testing.assert_allclose(run["x_0"][:, 0], np.exp(-rates), rtol=1e-7)
    np.testing.assert_allclose(run["x_1"][:, 0], np.exp(-4.0) * np.ones(3), rtol=1e-7)


def test_a_full_coupling_of_many_units_is_written_without_making_all_derivatives(monkeypatch):
    from myriad_ode.codegen import jacobian

    def refuse(*_):
        raise AssertionError("16384 derivatives are made, and left out")

    units = my.units(128)
    angle = units.state("angle")
    model = my.model({angle: units.full_coupling("A", np.ones((128, 128))) @ np.sin(angle)})
    monkeypatch.setattr(jacobian, "derivatives", refuse)
    assert "jacobian" not in model.cpp()


def alike(count=20, **options):
    """Units with couplings of two kinds, neighbours, and parameters and shared values of their own."""
    units = my.units(count, **options)
    x, v = units.states("x v")
    k, w, c = units.parameter("k"), units.shared("w"), my.parameter("c")
    near = units.circulant_coupling("C", np.stack([np.roll([0.1, 0.2, *[0] * (count - 3), 0.3], i)
                                                   for i in range(count)]), 1)
    F = units.full_coupling("F", np.random.default_rng(2).normal(size=(count, count)) / count)
    force = np.roll(w, 2) * my.cos(my.time) + F @ (k * x * v) + F @ x
    return my.model({x: v + near @ x, v: -k * np.roll(x, -1) - c * v + force}), (x, v, k, w, c)


def test_units_that_are_alike_are_written_as_one_unit_for_gpus():
    model, (x, v, k, w, c) = alike()
    text, struct = model.device_source("tsitouras_5", "double")
    assert f"using {struct} = myriad::coupled_units<{struct}_unit, 20>;" in text
    assert model.device_source("rodas_5p", "double") == model.source()
    kinds = model.states, model.parameters, model.shared
    as_units = my.CppModel("#include <myriad/coupled_units.hpp>\n" + text, struct, *kinds)
    values = {c: 0.3, **{k[i]: 1 + 0.1 * i for i in range(20)}, **{w[i]: 0.05 * i for i in range(20)}}
    start = {**{x[i]: 0.2 * i - 1 for i in range(20)}, **{v[i]: 0.1 * i for i in range(20)}}
    of_tables = {name: model.shared_values[name] for name in model.shared if name in model.shared_values}
    one = my.solve(model, values, start=start, time=(0, 2), rtol=1e-9, device="cpu")
    other = my.solve(as_units, {**{s.value[1]: value for s, value in values.items()}, **of_tables},
                     start={s.value[1]: value for s, value in start.items()}, time=(0, 2), rtol=1e-9, device="cpu")
    for name in model.states:
        np.testing.assert_allclose(other[name], one[name], rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize("precision, allowed", [("double", 1e-11),
                                                pytest.param("float", 1e-4, marks=pytest.mark.long)])
def test_matrices_of_units_are_the_couplings_of_cpp(precision, allowed):
    """Of every form; one matrix for two sums is declared once."""
    units = my.units(n)
    x, y = units.states("x y")
    F, B = units.full_coupling("F", full / n), units.banded_coupling("B", banded / n, 2)
    C, D = units.circulant_coupling("C", ring, 1), units.circulant_coupling("D", all_round / n)
    model = my.model({x: C @ x - x + F @ np.sin(y), y: B @ y + D @ np.sin(y) + F @ x - y})
    text = unit_form(model).source("ring")
    declared = " ".join(text.partition("couplings[] = {")[2].partition("}")[0].split())
    assert declared == ("myriad::circulant_coupling(published_0, 1), myriad::full_coupling(published_1), "
                        "myriad::same_coupling(published_0, 1), myriad::banded_coupling(published_2, 2), "
                        "myriad::circulant_coupling(published_1)")
    assert "for (" not in text and "p.shared" not in text
    values = model.shared_values
    assert (values["B[3,5]"], values["C[0,11]"], values["F[7,2]"]) == (banded[3, 5] / n, near[11], full[7, 2] / n)
    as_units = my.CppModel("#include <myriad/coupled_units.hpp>\n" + text, "ring", model.states, [], model.shared)
    more = dict(time=(0, 1), rtol=1e-6, precision=precision, device="cpu")
    one = my.solve(model, start={x: x0, y: v0}, **more)
    start = {s.value[1]: v for s, v in zip((*x, *y), (*x0, *v0))}
    other = my.solve(as_units, {**values}, start=start, **more)
    for name in model.states:
        np.testing.assert_allclose(other[name], one[name], rtol=allowed, atol=allowed)


def test_units_say_how_many_threads_of_a_gpu_integrate_an_instance():
    assert "threads_per_instance = 16;" in alike(threads_per_instance=16)[0].device_source("cash_karp", "double")[0]
    few, _ = alike(4)
    assert few.device_source("cash_karp", "double") == few.source()  # one thread has registers for eight states
    alone, _ = alike(threads_per_instance=1)
    assert alone.device_source("cash_karp", "double") == alone.source()


def test_hooks_events_and_summaries_of_units_are_those_of_one_unit_for_gpus():
    units = my.units(20)
    x, v = units.states("x v")
    top, count, total = units.accessory("top"), units.integer_accessory("count"), my.accessory("total")
    model = my.model(
        {x: v, v: -x}, accessories={top: my.phase_maximum(x), count: 0, total: 0}, after_step={my.end_phase: x[2] > 9},
        events=[*units.events(v, name="turn", do=lambda i: {count[i]: count[i] + 1, v[(i + 1) % 20]: -v[(i + 1) % 20]}),
                *units.events(x, name="pass")],
        stops=my.stop(1.0, do={v: 2 * v, total: x[0] + x[1]}), finalise={x: x + v, v: v - x},
        generate={x: my.uniform()})
    assert model.accessories[:2] == ["total", "top_0"]
    assert [e.name for e in model.events[:3]] == ["turn_0", "pass_0", "turn_1"]
    text = model.device_source("cash_karp", "double")[0]
    for written in ("enum unit_event { turn, pass, n_unit_event };", "{observed_x, myriad::over_phase::maximum, top}",
                    "if (lane.of(2).y[x] > 9) wanted = myriad::action::end_phase;", "if (event == turn) {",
                    "lane.of(unit_1).y[v] = -lane.of(unit_1).y[v];", "lane.unit_integer_accessory[count] = myriad::",
                    "lane.accessory[total] = lane.of(0).y[x] + lane.of(1).y[x];", "instance.y[38] = uniform"):
        assert written in text, written
    assert text.count("lane.y[x] += lane.y[v];") == 1 and "next_v" in text  # from what was there before


@pytest.mark.parametrize("more", [
    lambda x: dict(events=[my.event(x[0])]), lambda x: dict(finalise={x[0]: 1}),
    lambda x: dict(finalise={x: np.roll(x, 1)}),
    lambda x: dict(accessories={my.accessory("top"): my.phase_maximum(x[0])}),
    lambda x: dict(initialise={my.accessory("a"): x[0], x: my.accessory("a")}),
    lambda x: dict(triggers=my.trigger(x[0] > 1, do={x[0]: 0}))])
def test_units_whose_hooks_are_not_alike_are_written_out_for_gpus(more):
    x = my.units(20).state("x")
    model = my.model({x: -x}, **more(x))
    assert unit_form(model) is None and model.device_source("cash_karp", "double") == model.source()


@pytest.mark.parametrize("name", ["publish", "published_3", "unit", "threads_per_instance", "x"])
def test_units_with_names_that_a_unit_has_itself_are_written_out_for_gpus(name):
    x, k = my.units(20).state("x"), my.parameter(name)
    assert unit_form(my.model({x: -k * x})) is None


def test_units_that_are_not_alike_are_written_out_for_gpus():
    units = my.units(20)
    x = units.state("x")
    full = units.full_coupling("A", np.ones((20, 20)))
    assert unit_form(my.model({x: -x})) is not None
    assert unit_form(my.model({x: -np.arange(20) * x})) is None
    assert unit_form(my.model({x: x[0] - x})) is None  # all read the first
    assert unit_form(my.model({x: full @ (np.arange(20) * x)})) is None
    assert unit_form(my.model({x: full @ np.roll(x, 1)})) is None
