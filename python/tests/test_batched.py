# SPDX-License-Identifier: MIT
"""Models as functions of arrays, and in JAX and PyTorch, compared with closed forms."""

import concurrent.futures

import numpy as np
import pytest

import myriad_ode as my

x, v = my.states("x v")
k, B = my.parameters("k B")
spring = my.model({x: v, v: B - k * x}, name="spring")
times = np.array([0.5, 1.0, 2.0])
tight = {"rtol": 1e-10, "atol": 1e-10}
sets = np.array([[1.0, 1.0], [2.0, 0.5], [3.0, -1.0]])  # of k and x(0)


def closed_form(theta, t):
    k, x0 = theta[..., 0, None], theta[..., 1, None]
    return (x0 - 0.5 / k) * np.cos(np.sqrt(k) * t) + 0.5 / k


def closed_slopes(theta, t):
    k, x0 = theta[..., 0, None], theta[..., 1, None]
    w = np.sqrt(k)
    by_k = 0.5 / k**2 * (np.cos(w * t) - 1) - (x0 - 0.5 / k) * np.sin(w * t) * t / (2 * w)
    return np.stack([by_k, np.cos(w * t)], axis=-1)


@pytest.fixture(scope="module")
def position():
    return my.batched(spring, free=[k, x], of=x, sweep={B: 0.5}, start={v: 0}, time=(0, 2), samples=times, **tight)


@pytest.fixture
def launches(monkeypatch):
    """The numbers of instances of the calls of the core from Python."""
    sizes, usual = [], my.Batched.repeated

    def counted(self, with_jacobian):
        call = usual(self, with_jacobian)
        return lambda rows, results: (sizes.append(len(rows)), call(rows, results))

    monkeypatch.setattr(my.Batched, "repeated", counted)
    return sizes


def test_a_batch_of_any_shape_is_one_ensemble(position, launches):
    np.testing.assert_allclose(position(sets)[..., 0], closed_form(sets, times), rtol=1e-7, atol=1e-9)
    assert position(sets[0]).shape == (3, 1)
    assert position(np.broadcast_to(sets, (4, 3, 2))).shape == (4, 3, 3, 1)
    assert launches == [3, 1, 12]


def test_a_batch_has_the_derivatives_of_its_closed_form(position):
    values, slopes = position.with_jacobian(sets)
    np.testing.assert_allclose(values[..., 0], closed_form(sets, times), rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(slopes[..., 0, :], closed_slopes(sets, times), rtol=1e-7, atol=1e-9)


def test_instances_that_failed_are_nan():
    bursting = my.batched(my.model({x: k * x * x}, name="bursting"), free=[k], of=[x, my.time], start={x: 1.0},
                          time=(0, 2), max_steps=1000)
    values, slopes = bursting.with_jacobian([[0.1], [1.0]])
    np.testing.assert_allclose(values[0], [1 / 0.8, 2], rtol=1e-6)
    np.testing.assert_allclose(slopes[0, :, 0], [2 / 0.8**2, 0], rtol=1e-5)
    assert np.isnan(values[1]).all() and np.isnan(slopes[1]).all()


@pytest.mark.parametrize("arguments, message", [
    (dict(free=[k, x], of=x, sweep={B: 0.5, k: 1}), "'k' is in free= and has a value in sweep="),
    (dict(free=[k, k], of=x), "name at least one component each"),
    (dict(free=["q"], of=x), "'q' is no component that free= can name"),
    (dict(free=[k], of=x, start={"nope": 1}), "'nope' is no component of the model that start= can set: .*x, v"),
    (dict(free=[k], of=x, sweep={"b": 1}), "'b' is no component of the model that the sweep can set: .*'B'"),
    (dict(free=[k], of=["q"]), "'q' is no state, accessory or output"),
    (dict(free=[k], of=x, size=3), "chooses size= itself"),
    (dict(free=[k], of=my.time, samples=3), "leave out samples="),
])
def test_wrong_functions_are_refused(arguments, message):
    with pytest.raises(my.Error, match=message):
        my.batched(spring, time=(0, 1), **arguments)


def test_arguments_of_wrong_shapes_are_refused(position):
    with pytest.raises(my.Error, match=r"the argument has the shape \(3,\): its last axis has the values of k, x"):
        position([1.0, 2.0, 3.0])


@pytest.fixture(scope="module")
def jax():
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", True)
    return jax


def test_jax_takes_gradients_of_a_batch_in_one_call_of_the_core_without_python(jax, position):
    f = position.to_jax()

    def loss(theta):
        return (f(theta) ** 2).sum()

    expected = 2 * np.einsum("bt,bti->bi", closed_form(sets, times), closed_slopes(sets, times))
    squares = (closed_form(sets, times) ** 2).sum(axis=1)
    for program, argument, found in (
            (jax.vmap(jax.grad(loss)), sets, expected), (jax.vmap(jax.vmap(loss)), np.stack([sets]), squares[None]),
            (jax.grad(lambda all: jax.vmap(loss)(all).sum()), sets, expected)):
        np.testing.assert_allclose(program(argument), found, rtol=1e-6, atol=1e-8)
        text = jax.jit(program).lower(argument).compile().as_text()
        assert text.count('custom_call_target="myriad_on_cpu"') == 1 and "callback" not in text


@pytest.mark.parametrize("adjoint", [False, True])
def test_jax_has_forward_and_reverse_derivatives(jax, adjoint):
    f = my.batched(spring, free=[k, x], of=x, sweep={B: 0.5}, start={v: 0}, time=(0, 2), samples=times, device="cpu",
                   adjoint=adjoint, **tight).to_jax()
    at = sets[1]
    expected = closed_slopes(sets, times)[1]
    for jacobian in (jax.jacfwd(f), jax.jacrev(f), jax.jit(jax.jacrev(f))):
        np.testing.assert_allclose(jacobian(at)[:, 0], expected, rtol=1e-7, atol=1e-9)
    values, moved = jax.jvp(f, (at,), (np.array([1.0, -2.0]),))
    np.testing.assert_allclose(moved[:, 0], expected @ [1, -2], rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(values[:, 0], closed_form(at, times), rtol=1e-7)
    pulled, = jax.vjp(f, at)[1](np.ones((3, 1)))
    np.testing.assert_allclose(pulled, expected.sum(axis=0), rtol=1e-7)
    np.testing.assert_allclose(jax.jit(jax.vmap(jax.jacfwd(f)))(sets)[:, :, 0], closed_slopes(sets, times), rtol=1e-7,
                               atol=1e-9)


@pytest.mark.parametrize("adjoint", [False, True])
def test_jax_is_told_of_another_way_than_second_derivatives(jax, adjoint):
    f = my.batched(spring, free=[k, x], of=x, sweep={B: 0.5}, start={v: 0}, time=(0, 2), samples=times, device="cpu",
                   adjoint=adjoint, **tight).to_jax()

    def loss(theta):
        return f(theta).sum()

    for second in (jax.hessian(loss), jax.jit(jax.hessian(loss)), jax.jacfwd(jax.jacfwd(f)),
                   jax.grad(lambda theta: jax.grad(loss)(theta).sum()),
                   lambda at: jax.jvp(jax.grad(loss), (at,), (at,))):
        with pytest.raises(my.Error, match="second derivatives of a solution .* Gauss-Newton"):
            second(sets[0])
    # a gradient inside of what is differentiated by something else has none
    slopes = jax.grad(lambda factor: factor**2 * jax.grad(loss)(sets[0]).sum())(3.0)
    np.testing.assert_allclose(slopes, 6 * closed_slopes(sets, times)[0].sum(), rtol=1e-6)


def test_jax_takes_values_in_single_precision_and_integrates_in_double(jax, position):
    with jax.enable_x64(False):
        f = position.to_jax()
        at = sets.astype(np.float32)
        values, slopes = jax.jit(f)(at), jax.jit(jax.vmap(jax.jacrev(f)))(at)
        assert values.dtype == slopes.dtype == np.float32
        expected = position.with_jacobian(at)
        np.testing.assert_array_equal(values, expected[0].astype(np.float32))
        np.testing.assert_array_equal(slopes, expected[1].astype(np.float32))
        assert "myriad_on_cpu" in jax.jit(f).lower(at).as_text()


def test_jax_goes_by_python_where_the_core_alone_cannot_or_no_compiler_is_there(jax, position, monkeypatch, tmp_path):
    file = tmp_path / "spring.ode"
    file.write_text("par k=1\ninit x=1, v=0\nx' = v\nv' = 0.5 - k*x\naux twice=2*x\ndone\n")
    doubled = my.batched(my.read_xpp(str(file)), free=["k", "x"], of="twice", time=(0, 2), samples=times, **tight)
    program = jax.jit(jax.vmap(jax.jacrev(doubled.to_jax())))
    assert "callback" in program.lower(sets).as_text()
    np.testing.assert_allclose(program(sets)[:, :, 0], 2 * closed_slopes(sets, times), rtol=1e-7, atol=1e-9)
    monkeypatch.setattr("myriad_ode.gradients.xla_handler.is_there", lambda: False)
    program = jax.jit(position.to_jax())
    assert "callback" in program.lower(sets).as_text()
    np.testing.assert_array_equal(program(sets), position(sets))


def test_jax_programs_run_in_several_threads_and_tell_what_is_wrong(jax, position):
    program = jax.jit(jax.vmap(jax.grad(lambda theta: (position.to_jax()(theta) ** 2).sum())))
    expected = program(sets)
    with concurrent.futures.ThreadPoolExecutor(4) as threads:
        for found in threads.map(lambda _: program(sets), range(200)):
            np.testing.assert_array_equal(found, expected)
    wrong = sets.copy()
    wrong[1, 0] = np.nan
    with pytest.raises(Exception, match=r"parameter \d \(k\) is not finite in 1 of 3 instances, first in instance 1"):
        jax.block_until_ready(program(wrong))
    np.testing.assert_array_equal(program(sets), expected)  # and goes on


def test_a_weight_of_zero_counts_nothing_where_a_derivative_does_not_exist(position, monkeypatch):
    slopes = np.ones((1, *position.shape, 2))
    slopes[0, 1:] = np.nan
    monkeypatch.setattr(position, "with_jacobian", lambda rows: (np.ones((1, *position.shape)), slopes))
    weights = np.zeros(position.shape)
    weights[0] = 2
    np.testing.assert_array_equal(position.vjp(sets[0], weights)[1], [2, 2])
    assert np.isnan(position.vjp(sets[0], weights + 1)[1]).all()


def test_jax_lets_a_weight_of_zero_count_nothing(jax):
    from myriad_ode.gradients.jax_rules import product_with_vector
    jacobian = np.array([[2.0, np.nan], [0.0, 3.0]])

    def product(vector):
        return product_with_vector().bind(jacobian, vector)

    along, weights = np.array([1.0, 0.0]), np.array([0.0, 1.0])
    np.testing.assert_array_equal(jax.jit(product)(along), [2, 0])
    transposed = jax.linear_transpose(product, along)
    np.testing.assert_array_equal(transposed(weights)[0], [0, 3])
    np.testing.assert_array_equal(jax.vmap(transposed)(np.eye(2))[0], [[2, np.nan], [0, 3]])


def test_torch_has_the_gradients_of_the_closed_form(position, launches):
    torch = pytest.importorskip("torch")
    f = position.to_torch()
    theta = torch.tensor(sets, requires_grad=True)
    f(theta).square().sum().backward()
    expected = 2 * np.einsum("bt,bti->bi", closed_form(sets, times), closed_slopes(sets, times))
    np.testing.assert_allclose(theta.grad.numpy(), expected, rtol=1e-6, atol=1e-8)
    assert launches == [3]
    loss = lambda one: f(one).square().sum()  # noqa: E731
    several = torch.func.vmap(torch.func.grad(loss))(torch.tensor(sets))
    np.testing.assert_allclose(several.numpy(), expected, rtol=1e-6, atol=1e-8)
    assert launches == [3, 3]
    slopes = torch.func.jacfwd(f)(torch.tensor(sets[0]))
    np.testing.assert_allclose(slopes[:, 0].numpy(), closed_slopes(sets, times)[0], rtol=1e-7, atol=1e-9)
    with pytest.raises(my.Error, match="second derivatives"):
        gradient, = torch.autograd.grad(f(theta).square().sum(), theta, create_graph=True)
        gradient.sum().backward()
