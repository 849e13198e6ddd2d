# SPDX-License-Identifier: MIT
"""Functions of arrays by the core alone have what `solve` has, to the last bit, and go by `solve` where they must."""

import concurrent.futures
import os
import pickle
import signal
import threading
import time

import numpy as np
import pytest

import myriad_ode as my

x, v = my.states("x v")
k, B, g = my.parameters("k B g")
hits = my.accessory("hits")
spring = my.model({x: v, v: B - k * x}, name="spring")
bouncing = my.model({x: v, v: -g}, events=my.event(x, direction="falling", do={v: -0.8 * v, hits: hits + 1}),
                    initialise={hits: 0.0}, name="bouncing")
sets = np.array([[1.0, 1.0], [2.0, 0.5], [3.0, 2.0], [4.0, 1.5], [0.5, 3.0]])


def by_solve(function, values, with_jacobian=False):
    """The same function, without the core's own call."""
    plain = pickle.loads(pickle.dumps(function))
    plain.repeated = lambda with_jacobian: None
    return plain.with_jacobian(values) if with_jacobian else plain(values)


@pytest.mark.parametrize("model, arguments", [
    (spring, dict(free=[k, x], of=[v, x], sweep={B: 0.5}, start={v: 0}, samples=4)),
    (bouncing, dict(free=[g, x], of=[hits, v, my.time], start={v: 0})),
])
def test_the_core_alone_has_the_bits_of_solve(model, arguments):
    function = my.batched(model, time=(0, 2), device="cpu", **arguments)
    for values in sets, sets[0], np.stack([sets, sets]), sets[:0]:
        assert function.repeated(False) is not None
        np.testing.assert_array_equal(function(values), by_solve(function, values))
    assert function.repeated(True) is not None
    for found, expected in zip(function.with_jacobian(sets), by_solve(function, sets, True)):
        np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("model, arguments", [
    (spring, dict(free=[k, x], of=[v, my.time], sweep={B: 0.5}, method="rodas_5p", rtol=1e-5, interpreted=True)),
    (spring, dict(free=[k, x], of=x, sweep={B: 0.5}, samples=[0.0, 0.5, 2.0], precision="float", rtol=1e-4)),
    (bouncing, dict(free=[g, x], of=[x], samples=5, events={"event_1": {"stop_after": 2}}, interpreted=True)),
    (my.model({x: -k * x}, noise={x: B}), dict(free=[k, B, x], of=x, noise_step=0.01, step=0.01, seed=3)),
])
def test_the_core_alone_has_the_values_of_solve_with_other_options(model, arguments):
    start = {v: 0} if len(model.states) > 1 else {}
    function = my.batched(model, start=start, time=(0, 2), device="cpu", **arguments)
    values = np.column_stack([sets, sets[:, 0]])[:, :len(function.free)]
    assert function.repeated(False) is not None
    np.testing.assert_array_equal(function(values), by_solve(function, values))


def test_instances_that_failed_are_nan_in_both_ways():
    function = my.batched(my.model({x: k * x * x}), free=k, of=[x, my.time], start={x: 1.0}, time=(0, 2),
                          max_steps=1000, interpreted=True)
    found = function([[0.1], [1.0], [0.2]])
    assert np.isnan(found[1]).all() and np.isfinite(found[[0, 2]]).all()
    np.testing.assert_array_equal(found, by_solve(function, [[0.1], [1.0], [0.2]]))


def test_what_the_core_alone_cannot_do_goes_by_solve():
    pytest.importorskip("libsbml")
    from sbml_models import compartment, document, initially, parameter, reaction, species
    decay = my.read_sbml(document([
        compartment("c", 1), species("A", amount=3), species("B", amount=0), parameter("k", 1), parameter("k2"),
        initially("k2", "2 * k"), reaction("R", "A -> B", "c * k2 * A")]))
    usual = {"time": (0, 1), "interpreted": True}
    for model, arguments in (
            (decay, {"free": "k", "of": "A"}),  # from which k2 follows
            (decay, {"free": "k2", "of": "R"}),  # which is an output
            (spring, {"free": k, "of": x, "sweep": {B: 1}, "start": {x: 1, v: 0}, "tolerance_scale": 2.0})):
        assert my.batched(model, **arguments, **usual).repeated(False) is None
    rates = np.array([[0.5], [1.0]])
    np.testing.assert_allclose(my.batched(decay, free="k", of="A", **usual)(rates), 3 * np.exp(-2 * rates), rtol=1e-6)
    flow = my.batched(decay, free="k2", of="R", **usual)(rates)
    np.testing.assert_allclose(flow, 3 * rates * np.exp(-rates), rtol=1e-6)
    by_k2 = my.batched(decay, free="k2", of="A", **usual)
    assert by_k2.repeated(False) is not None
    np.testing.assert_allclose(by_k2(rates), 3 * np.exp(-rates), rtol=1e-6)


def test_threads_call_a_function_at_a_time():
    function = my.batched(spring, free=[k, x], of=x, sweep={B: 0.5}, start={v: 0}, time=(0, 2), samples=3,
                          interpreted=True)
    expected = function(sets)
    with concurrent.futures.ThreadPoolExecutor(4) as threads:
        for found in threads.map(lambda _: function(sets), range(200)):
            np.testing.assert_array_equal(found, expected)


def test_wrong_values_are_told_with_the_names_of_components():
    function = my.batched(spring, free=[k, x], of=x, sweep={B: 0.5}, start={v: 0}, time=(0, 2), interpreted=True)
    with pytest.raises(my.Error, match=r"state 0 \(x\) is not finite in 1 of 3 instances, first in instance 2"):
        function([[1.0, 1.0], [1.0, 2.0], [1.0, np.nan]])
    assert np.isfinite(function(sets)).all()


def test_a_function_that_was_called_pickles():
    function = my.batched(spring, free=[k, x], of=x, sweep={B: 0.5}, start={v: 0}, time=(0, 2), interpreted=True)
    expected = function(sets)
    again = pickle.loads(pickle.dumps(function))
    np.testing.assert_array_equal(again(sets), expected)


@pytest.mark.parametrize("in_jax", [False, True])
def test_an_interrupt_ends_a_function_by_the_core_alone(in_jax):
    many = np.linspace(100, 200, 4000)[:, None]
    function = my.batched(spring, free=k, of=x, sweep={B: 0}, start={x: 1, v: 0}, time=(0, 1e5),
                          max_steps=1_000_000_000, interpreted=True)
    assert function.repeated(False) is not None
    call, raised, said = function, KeyboardInterrupt, None
    if in_jax:
        jax = pytest.importorskip("jax")
        raised, said, many = jax.errors.JaxRuntimeError, "the call was interrupted", many.astype(np.float32)
        program = jax.jit(function.to_jax()).lower(many).compile()
        call = lambda rows: jax.block_until_ready(program(rows))  # noqa: E731
    began = time.perf_counter()
    interrupt = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    with pytest.raises(raised, match=said):
        interrupt.start()
        call(many)
    assert time.perf_counter() - began < 8
    assert np.isfinite(function([[1e-9]])).all()  # and the next one works
