# SPDX-License-Identifier: MIT
"""Gradients by an adjoint, compared with closed forms, and with forward sensitivities of the same steps."""

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode.gradients import adjoint

x, y = my.states("x y")
a, b, c = my.parameters("a b c")
tight = {"rtol": 1e-10, "atol": 1e-10}
times = np.array([0.0, 0.3, 0.31, 1.0, 2.0])  # the start, two in one step, and the end
sets = np.array([[1.0, 0.5, 0.7, 1.2], [2.0, 0.9, 0.3, 0.8], [0.5, 1.5, 1.0, 0.2]])  # of a, b, c and x at the start
driven = my.model({x: a * x - b * x * y + c * my.sin(3 * my.time) * x, y: b * x * y - y + c * my.exp(-x * x)},
                  name="driven")
functions = {"free": [a, b, c, x], "start": {y: 1.0}}


def both(model, values, weights=None, **arguments):
    """The results and the gradient by an adjoint, and by forward sensitivities of the same steps."""
    made = [my.batched(model, adjoint=adjoint, device="cpu", sensitivity_control=False, **arguments)
            for adjoint in (True, False)]
    shape = (*np.shape(values)[:-1], *made[0].shape)
    weights = np.cos(np.arange(np.prod(shape))).reshape(shape) if weights is None else weights
    return made[0].vjp(values, weights), made[1].vjp(values, weights)


def assert_equal(found, expected, rtol=1e-9):
    """Rounding, as tolerances concern both alike; relative to the largest of an instance's derivatives."""
    np.testing.assert_allclose(found[0], expected[0], rtol=1e-12, atol=1e-12)
    assert np.isfinite(expected[1]).all()
    size = np.abs(expected[1]).max(axis=-1, keepdims=True)
    np.testing.assert_allclose(found[1] / size, expected[1] / size, rtol=rtol, atol=rtol)


# one of each kind: with Hermite's interpolant, or their own, with slopes at the end or extra stages; stiff ones
@pytest.mark.parametrize("method", ["tsitouras_5", *(pytest.param(method, marks=pytest.mark.thorough) for method in (
    "rosenbrock_23", "runge_kutta_4", "cash_karp", "verner_7", "rodas_5p"))])
def test_an_adjoint_has_the_derivatives_of_the_same_steps(method):
    options = {"step": 0.01} if method == "runge_kutta_4" else {"rtol": 1e-5, "atol": 1e-5}
    assert_equal(*both(driven, sets, of=[x, y], time=(0, 2), samples=times, method=method, **functions, **options))


def test_an_adjoint_of_the_end_goes_backwards_in_time_too():
    assert_equal(*both(driven, sets, of=[y, x], time=(2, 0.5), rtol=1e-6, atol=1e-6, **functions))
    assert_equal(*both(driven, sets[0], of=y, time=(2, 0.5), samples=4, rtol=1e-6, atol=1e-6, **functions))


def test_the_gradient_of_a_spring_is_that_of_its_closed_form():
    k = my.parameter("k")
    spring = my.batched(my.model({x: y, y: -k * x}), free=[k, x], of=x, start={y: 0}, time=(0, 2), samples=[0.5, 2.0],
                        adjoint=True, device="cpu", **tight)
    k, x0, t = np.array([1.0, 2.0, 3.0]), np.array([1.0, 0.5, -1.0]), np.array([0.5, 2.0])
    w = np.sqrt(k)[:, None]
    # half the sum of squares
    values, gradient = spring.vjp(np.stack([k, x0], axis=1), lambda values: values)
    expected = x0[:, None] * np.cos(w * t)
    np.testing.assert_allclose(values[..., 0], expected, rtol=1e-8, atol=1e-9)
    np.testing.assert_allclose(gradient[:, 0], np.sum(-expected * x0[:, None] * np.sin(w * t) * t / (2 * w), axis=1),
                               rtol=1e-7)
    np.testing.assert_allclose(gradient[:, 1], np.sum(expected * np.cos(w * t), axis=1), rtol=1e-7)


def robertson():
    u, v, w = my.states("u v w")
    k1, k2, k3 = rates = my.parameters("k1 k2 k3")
    model = my.model({u: -k1 * u + k3 * v * w, v: k1 * u - k2 * v * v - k3 * v * w, w: k2 * v * v}, name="robertson")
    return model, (u, v, w), rates


@pytest.mark.long
def test_stiff_gradients_are_those_of_controlled_sensitivities():
    model, states, rates = robertson()
    call = dict(free=rates, of=states, start=dict(zip(states, (1, 0, 0))), time=(0, 400), samples=[0.4, 40.0, 400.0],
                method="rodas_5p", rtol=1e-10, atol=dict(zip(states, (1e-10, 1e-14, 1e-10))), device="cpu")
    at, weights = np.array([0.04, 3e7, 1e4]), np.array([1.0, 1e4, -0.5])
    found = my.batched(model, adjoint=True, **call).vjp(at, weights)[1]
    # derivatives by the rates, in steps that are chosen for them too
    tolerances = {**call["atol"], **{f"{s.value[1]}_by_{r.value[1]}": 1e-10 / value * scale for r, value in zip(
        rates, at) for s, scale in zip(states, (1, 1e-4, 1))}}
    expected = my.batched(model, **{**call, "atol": tolerances}).vjp(at, weights)[1]
    np.testing.assert_allclose(found, expected, rtol=1e-7)


@pytest.mark.long
def test_a_stiff_network_that_needs_pivots_has_the_gradient_of_differences():
    n = 6
    substances, rates = my.states([f"s{i}" for i in range(n)]), my.parameters([f"k{i}" for i in range(n)])
    flows = [k * s * (1 + z) for k, s, z in zip(rates, substances, substances[2:] + substances[:2])]
    model = my.model({s: flows[i - 1] - flows[i] for i, s in enumerate(substances)}, name="ring")
    f = my.batched(model, free=rates, of=substances[::2], start={s: 0.1 * i for i, s in enumerate(substances)},
                   time=(0, 20), samples=[0.1, 20.0], adjoint=True, method="rodas_5p", rtol=1e-11, atol=1e-13,
                   device="cpu")
    at, weights = np.array([1e3, 0.04, 30.0, 1.0, 1e4, 2.0]), np.arange(1.0, 7).reshape(2, 3)
    gradient = f.vjp(at, weights)[1] * at
    near = np.exp([[d if i == j else 0 for j in range(n)] for i in range(n) for d in (-2e-3, -1e-3, 1e-3, 2e-3)]) * at
    losses = np.sum(f(near) * weights, axis=(1, 2)).reshape(n, 4)
    expected = losses @ [1, -8, 8, -1] / 12e-3
    np.testing.assert_allclose(gradient, expected, rtol=1e-6, atol=1e-7 * np.abs(expected).max())


@pytest.mark.thorough
def test_doses_at_stop_times_have_an_adjoint():
    dose, share = my.parameters("dose share")
    doses = my.stop(0.0, every=0.5, count=4, do={x: x + share * dose, y: y + (1 - share) * dose * my.exp(-x)})
    refill = my.stop([0.0, 1.0], do={x: x * (1 + y), y: y * y})  # at the time of doses, after them
    model = my.model({x: -a * x, y: a * x * x - b * y}, stops=[doses, refill], name="doses")
    at = np.array([[1.0, 0.5, 2.0, 0.7], [0.3, 1.0, 1.0, 0.2]])
    for samples in ([0.0, 0.5, 0.6, 1.7], None):  # some at the time of an action, which they show the state before
        assert_equal(*both(model, at, free=[a, b, dose, share], of=[x, y], start={x: 0.1, y: 0.2}, time=(0, 1.5 if
                           samples is None else 2), samples=samples, rtol=1e-8, atol=1e-8))


@pytest.mark.thorough
def test_events_that_depend_on_the_state_have_an_adjoint():
    g, r, floor = my.parameters("g r floor")
    impact = my.event(x - floor * (1 + 0.1 * my.sin(my.time)), direction="falling", do={y: -r * y}, name="impact")
    ball = my.model({x: y, y: -g - 0.05 * y * abs(y)}, events=impact, name="ball")
    at = np.array([[9.81, 0.8, 0.1, 1.0], [1.62, 0.6, -0.2, 0.5], [5.0, 0.9, 0.0, 2.0]])
    run = my.solve(ball, {g: 9.81, r: 0.8, floor: 0.1}, start={x: 1, y: 0}, time=(0, 2), record=[x])
    assert run["y"][0] != 0
    for samples in (np.array([0.2, 1.0, 1.9]), None):
        found, expected = both(ball, at, free=[g, r, floor, x], of=[x, y], start={y: 0}, time=(0, 1.9), samples=samples,
                               rtol=1e-11, atol=1e-11)
        # forward sensitivities see the event where the step's interpolant has it
        assert_equal(found, expected, rtol=1e-7)


def test_an_event_at_the_time_of_another_action_is_refused():
    model = my.model({x: -a, y: 0 * b}, events=my.event(x, do={y: y + 1}), stops=my.stop(1.0, do={y: 2 * y}))
    f = my.batched(model, free=[a, b], of=y, start={x: 1.0, y: 1.0}, time=(0, 2), adjoint=True, device="cpu")
    with pytest.raises(my.Error, match="several actions at one time"):
        f.vjp([[1.0, 1.0], [0.7, 1.0]], [1.0])


@pytest.mark.long
def test_events_without_an_action_change_no_gradient():
    watched = my.model(dict(zip([x, y], driven.rhs)), events=my.event(x - y), name="watched")
    call = dict(of=[x, y], time=(0, 2), samples=times, **functions, **tight)
    found, expected = both(watched, sets, **call)  # in steps that end at the event
    assert_equal(found, expected, rtol=1e-8)
    np.testing.assert_allclose(found[1], both(driven, sets, **call)[0][1], rtol=1e-7)


@pytest.mark.thorough
def test_a_network_with_sparse_factors_has_the_derivatives_of_the_same_steps():
    z = my.states([f"z{i}" for i in range(7)])
    flow = [a * z[i] - 50 * z[i + 1] * z[i + 1] for i in range(6)]
    back = z[6] * z[3]
    network = my.model({z[i]: (flow[i - 1] if i > 0 else back) - (flow[i] if i < 6 else back) for i in range(7)},
                       name="network")
    start = {one: 0.1 * (i + 1) for i, one in enumerate(z) if i != 4}
    assert_equal(*both(network, np.array([[3.0, 0.2], [1.0, 0.9]]), of=[z[0], z[6], z[5]], free=[a, z[4]], start=start,
                       time=(0, 2), samples=[0.1, 1.0, 2.0], method="rosenbrock_23", rtol=1e-5, atol=1e-6))


def test_instances_that_fail_are_nan_alone_and_the_order_changes_no_bit():
    model = my.model({x: a * x * x - b * y, y: c * x - y}, name="bursting")
    function = my.batched(model, free=[a, b, c, x], of=[x, y], start={y: 0.1}, time=(0, 2), samples=[0.5, 2.0],
                          adjoint=True, max_steps=2000, device="cpu:2")
    rows = np.random.default_rng(1).uniform(0.1, 0.6, (203, 4))
    alone = function.vjp(rows, np.ones((2, 2)))
    rows[[5, 77]] = [3.0, 0.1, 0.1, 1.0]  # goes to infinity
    values, gradient = function.vjp(rows, np.ones((2, 2)))
    failed = np.isnan(gradient).any(axis=1)
    assert list(np.flatnonzero(failed)) == [5, 77] and np.isnan(gradient[failed]).all() and np.isnan(values[5]).all()
    np.testing.assert_array_equal(gradient[~failed], alone[1][~failed])
    backwards = function.vjp(rows[::-1], np.ones((2, 2)))
    np.testing.assert_array_equal(backwards[1][::-1], gradient)
    np.testing.assert_array_equal(backwards[0][::-1], values)


def test_records_of_steps_take_bounded_memory(monkeypatch):
    bytes_of_records = []

    def solve(*arguments, samples, **options):
        run = my.solve(*arguments, samples=samples, **options)
        bytes_of_records.append(run.size * samples["capacity"] * 8 * (1 + len(run.states)))
        return run

    rows = np.repeat(sets, 100, axis=0)
    call = dict(of=[x, y], time=(0, 50), adjoint=True, rtol=1e-10, atol=1e-10, device="cpu:1", **functions)
    at_once = my.batched(driven, **call).vjp(rows, np.ones(2))
    monkeypatch.setattr("myriad_ode.gradients.forward.solve", solve)
    monkeypatch.setattr(adjoint, "_most_bytes", 1 << 20)
    in_groups = my.batched(driven, **call).vjp(rows, np.ones(2))
    assert len(bytes_of_records) > 10 and max(bytes_of_records) <= 1 << 20
    np.testing.assert_array_equal(in_groups[1], at_once[1])
    np.testing.assert_array_equal(in_groups[0], at_once[0])


def test_least_squares_have_loss_and_gradient_by_an_adjoint():
    data = {"t": [0.0, 0.5, 0.5, 1.0, 2.0], x: [1.2, 1.0, 1.1, np.nan, 0.7], y: [1.0, np.nan, 1.2, 0.8, 0.9]}
    call = dict(free={a: (0.1, 3), b: (0.1, 3, "log"), x: (0.1, 2)}, sweep={c: 0.5}, start={y: 1.0},
                sigma={x: 0.1, y: [0.1, 0.1, 0.2, 0.3, 0.1]}, device="cpu", **tight)
    forward, by_adjoint = (my.least_squares(driven, data, adjoint=adjoint, **call) for adjoint in (False, True))
    for at in ([1.0, 0.5, 1.2], [[1.0, 0.5, 1.2], [2.0, 0.9, 0.8]]):
        np.testing.assert_allclose(by_adjoint.loss(at), forward.loss(at), rtol=1e-8)
        np.testing.assert_allclose(by_adjoint.gradient(at), forward.gradient(at), rtol=1e-7)
        assert np.shape(by_adjoint.loss(at)) == np.shape(at)[:-1]
    np.testing.assert_allclose(by_adjoint.residuals([1.0, 0.5, 1.2]), forward.residuals([1.0, 0.5, 1.2]), rtol=1e-7)


def test_a_model_from_a_file_has_an_adjoint_of_its_outputs(tmp_path):
    file = tmp_path / "decay.ode"
    file.write_text("par a=1, b=2, k=3\nx' = -a*x/(k+x) + b/(1+k*k)\ninit x=1\naux flow=a*x/(k+x)+t\ndone\n")
    model = my.read_xpp(str(file))
    assert_equal(*both(model, [[1.0, 2.0, 3.0, 1.0], [0.5, 1.0, 2.0, 0.3]], free=["a", "b", "k", "x"], of=["flow", "x"],
                       time=(0, 2), samples=[0.5, 2.0], rtol=1e-8, atol=1e-8))


def test_jax_and_torch_take_gradients_by_an_adjoint():
    call = dict(of=[x, y], time=(0, 2), samples=times, device="cpu", **functions, **tight)
    function = my.batched(driven, adjoint=True, **call)
    expected = my.batched(driven, **call).vjp(sets, lambda values: 2 * values)[1]
    taken = 0
    try:
        import jax
        jax.config.update("jax_enable_x64", True)
        f = function.to_jax()
        loss = jax.jit(lambda theta: (f(theta) ** 2).sum())
        np.testing.assert_allclose(jax.grad(loss)(sets), expected, rtol=1e-7)
        np.testing.assert_allclose(jax.vmap(jax.grad(loss))(sets), expected, rtol=1e-7)
        taken += 1
    except ImportError:
        pass
    try:
        import torch
        theta = torch.tensor(sets, requires_grad=True)
        f = function.to_torch()
        f(theta).square().sum().backward()
        np.testing.assert_allclose(theta.grad.numpy(), expected, rtol=1e-7)
        several = torch.func.vmap(torch.func.grad(lambda one: f(one).square().sum()))(torch.tensor(sets))
        np.testing.assert_allclose(several.numpy(), expected, rtol=1e-7)
        taken += 1
    except ImportError:
        pass
    if not taken:
        pytest.skip("neither JAX nor PyTorch is installed")


@pytest.mark.parametrize("model, options, why", [
    (my.with_tangents(driven), {}, "not traced from Python"),
    (my.model({x: -a * x, y: b - y}, mass_matrix={y: 0}), {}, "a mass matrix"),
    (my.model({x: -a * x, y: b * x}, after_step={x: my.maximum(x, 0)}), {}, "has hooks or accessories"),
    (my.model({x: -a * x, y: b * x}, triggers=my.trigger(x < 0.5, delay=1, do={y: 0})), {}, "has triggers that wait"),
    (my.model({x: -a * x, y: x}, events=my.event(x - b, name="hit", stop_after=1)), {}, "the event 'hit' ends phases"),
    (my.model({x: -a * x, y: x}, events=my.event(x - b, name="hit", do={my.end_phase: True})), {}, "assigns end_phase"),
    (my.model({x: -a * x, y: x}, events=my.event(x - b, name="hit", do={y: my.step})), {}, "reads step"),
    (my.model({x: my.where(x > b, -a, 1.0) * x, y: x}, events=my.event(x - b, name="hit", do={y: 0})), {},
     "which may jump there"),
    (my.model({x: -a * x, y: x}, stops=my.stop(b, name="dose", do={y: 0})), {}, "the time of the stop 'dose' depends"),
    (driven, {"samples": [1.0, 0.5]}, "times of samples are out of order"),
    (driven, {"phases": 2}, "phases= is 2"),
    (driven, {"precision": "float"}, "double precision alone"),
    (driven, {"device": ["cpu", "cpu:1"]}, "device= names several devices, cpu, cpu:1"),
    (driven, {"of": my.time}, "a result is the time of the end"),
])
def test_what_has_no_adjoint_is_refused_with_a_cure(model, options, why):
    arguments = {"free": [a, b], "of": x, "start": {x: 1, y: 1}, "time": (0, 2), **options}
    with pytest.raises(my.Error, match=f"{why}.*leave out adjoint=True, for forward sensitivities"):
        my.batched(model, adjoint=True, **arguments)
