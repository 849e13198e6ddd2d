# SPDX-License-Identifier: MIT
"""Models with delays that are interpreted: bit by bit as compiled ones."""

import numpy as np
import pytest

import myriad_ode as my
import test_delayed_units
import test_delays
from test_delays import exact, k, k_seen, sigma, t, tau, x, y

two_lags = my.model({x: k * my.delayed(x, tau) - 0.5 * my.delayed(x, sigma), k_seen: my.delayed(x, tau)},
                    history={x: k - t * t / 3}, name="two_lags")
neutral = my.model({x: k * (my.delayed_slope(x, tau) + my.delayed(x, tau)) - x}, history={x: t * (1 - t)},
                   name="neutral")
watched = my.model({x: 1, y: my.delayed(x, 1 + x * x / 4), k_seen: 0}, stops=my.stop(1.2, do={x: -x}), triggers=[
    my.trigger((my.delayed(x, 0.7) > 0.5) & (y < 2), do={y: y + 1}, delay=0.3)], events=[
    my.event(my.delayed(x, tau) - 0.5, direction="rising", do={k_seen: my.delayed(y, tau)})], name="watched")
of_watched = dict(sweep={tau: np.linspace(0.3, 1.4, 21)}, start={x: 0, y: 0, k_seen: 0}, time=(0, 4), samples=33)
of_lags = dict(sweep={tau: np.linspace(0.3, 1.4, 21), sigma: np.linspace(1.5, 0.4, 21), k: -1.0},
               start={k_seen: 0}, time=(0, 4), samples=33)


@pytest.mark.parametrize("model, call", [
    (two_lags, dict(of_lags, method="dormand_prince_5", phases=3, carry_on_step=True, **exact)),
    (two_lags, dict(of_lags, method="runge_kutta_4", step=1 / 64)),
    (neutral, dict(sweep={tau: np.linspace(0.3, 1.4, 21), k: 0.4}, time=(0, 4), method="rodas_5p", rtol=1e-7,
                   history_steps=1024)),
    (watched, dict(of_watched, method="tsitouras_5", history_steps=1024, **exact)),
    (test_delays.relay, dict(test_delays.in_short_rings, sweep=test_delays.sweep_of(test_delays.relay),
                             method="dormand_prince_5", history_steps=128)),
    (test_delays.vanishing, dict(test_delays.in_short_rings, sweep=test_delays.sweep_of(test_delays.vanishing),
                                 method="cash_karp", history_steps=128))])
def test_delays_have_the_bits_of_compiled_ones(model, call):
    compiled, interpreted = my.solve(model, **call), my.solve(model, interpreted=True, **call)
    assert compiled.report.failed == 0
    assert interpreted.report.kernel == "interpreted, as asked"
    np.testing.assert_array_equal(interpreted.accepted_steps, compiled.accepted_steps)
    np.testing.assert_array_equal(interpreted.rejected_steps, compiled.rejected_steps)
    for name in model.states:
        assert compiled[name].tobytes() == interpreted[name].tobytes(), name


def test_rings_and_lags_that_cannot_be_are_the_same_statuses():
    call = dict(sweep={tau: [1.0, -1.0, 0.0, 3.9]}, start={x: 1}, time=(0, 5), maximum_step=1 / 64, history_steps=128,
                invalid="mark")
    run = my.solve(my.model({x: -my.delayed(x, tau)}), interpreted=True, **call)
    assert list(run.status) == ["success", "invalid_delay", "invalid_delay", "history_overflow"]


def test_units_that_see_each_other_late_are_interpreted():
    call = dict(sweep={test_delayed_units.a: 1.5, test_delayed_units.b: 0.5} | test_delayed_units.conduction,
                start={test_delayed_units.x: [1, 2, 3, 4]}, time=(0, 4), **exact)
    runs = [my.solve(test_delayed_units.cells, interpreted=interpreted, **call) for interpreted in (True, False)]
    np.testing.assert_allclose(runs[0]["x_3_end"], runs[1]["x_3_end"], rtol=1e-9)


@pytest.mark.parametrize("change, said", [
    (lambda: dict(free=[tau]), "it has sensitivities, and delays"),
    (lambda: dict(method="verner_7"), "the interpreter has the methods")])
def test_what_the_interpreter_does_not_take_of_delays(change, said):
    with pytest.raises(my.Error, match=said):
        my.solve(test_delays.delaying, {tau: 1.0}, start={x: 1}, time=(0, 1), interpreted=True, **change())
