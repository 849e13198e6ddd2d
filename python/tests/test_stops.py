# SPDX-License-Identifier: MIT
"""Exact stop times: doses and switches at times that are given."""

import numpy as np
import pytest

import myriad_ode as my

gut, blood = my.states("gut blood")
ka, ke, dose, interval, doses = my.parameters("ka ke dose interval doses")
given = my.integer_accessory("given")
last = my.accessory("last")
equations = {gut: -ka * gut, blood: ka * gut - ke * blood}


def treatment(*stops, **others):
    return my.model(equations, stops=stops, name="treatment", **others)


def contents(model, **values):
    values = {"gut": 0, "blood": 0, "ka": 1.2, "ke": 0.3, **values}
    return my.solve(model, values, time=(0, 10), method="tsitouras_5", rtol=1e-10, atol=1e-10, device="cpu",
                    interpreted=False)


def bateman(t, first, interval, doses):
    since = t - (first + interval * np.arange(doses))
    since = since[since > 0]
    return 1.2 / (1.2 - 0.3) * np.sum(np.exp(-0.3 * since) - np.exp(-1.2 * since))


def test_doses_are_given_at_equal_intervals():
    model = treatment(my.stop(0, every=interval, count=doses, name="intake",
                              do={gut: gut + dose, given: given + 1, last: my.time}), accessories={given: 0})
    intervals, counts = np.array([0.7, 1.3, 2.5]), np.array([4, 5, 100])
    run = contents(model, dose=100, interval=intervals, doses=counts)
    numbers = np.minimum(counts, np.floor(10 / intervals) + 1)
    np.testing.assert_array_equal(run["given"], numbers)
    np.testing.assert_array_equal(run["last"], (numbers - 1) * intervals)
    expected = [100 * bateman(10, 0, i, int(n)) for i, n in zip(intervals, numbers)]
    np.testing.assert_allclose(run["blood"], expected, rtol=1e-7)


def test_doses_without_an_end():
    run = contents(treatment(my.stop(0.5, every=1, do={given: given + 1}), accessories={given: 0}))
    assert run["given"] == 10


def test_times_are_listed_and_what_happens_differs():
    model = treatment(my.stop([1, 2 * interval, 4], do={gut: gut + 1}), my.stop("2 * ke", do={"ke": 0}))
    run = contents(model, interval=1.5, ke=0.75)
    expected = np.exp(-1.2 * 9) + np.exp(-1.2 * 7) + np.exp(-1.2 * 6)
    np.testing.assert_allclose(run["gut"], expected, rtol=1e-7)
    assert run["ke_end"] == 0 and run["ke"] == 0.75


def test_a_stop_ends_the_phase():
    model = treatment(my.stop([1, 2, 3], do={given: given + 1, last: my.time, my.end_phase: given == 1}),
                      accessories={given: 0})
    run = contents(model)
    assert run["last"] == 2
    assert run["given"] == 2


def test_an_accessory_is_the_time_of_what_comes_later():
    x, = my.states("x")
    due = my.accessory("due")
    rises = my.event(x - 1, direction="rising", do={due: my.time + 0.25})
    model = my.model({x: 1}, events=rises, stops=my.stop(due, do={x: x - 5, due: float("inf")}),
                     initialise={due: my.where(my.phase == 0, float("inf"), due)})
    run = my.solve(model, {"x": 0}, time=(0, 3), method="tsitouras_5", device="cpu", interpreted=False)
    np.testing.assert_allclose(run["x"], -2, rtol=1e-9)


# What is set anew: x' = 1, set to 0 at x = 1 by an event that sets `due`.

x, y = my.states("x y")
due, other, seen = my.accessory("due"), my.accessory("other"), my.accessory("seen")
spikes = my.integer_accessory("spikes")
never = 1e300
noted = {given: given + 1, seen: my.time}


def spiking(*stops, at_spike=None, level=1.0, initialise=None, **first):
    spike = my.event(x - level, direction="rising", do={x: 0, spikes: spikes + 1, **(at_spike or {})})
    values = {due: never, other: never, seen: -1, given: 0, spikes: 0, **{my.accessory(n): v for n, v in first.items()}}
    begins = {target: my.where(my.phase == 0, value, target) for target, value in values.items()}
    return my.model({x: 1}, events=spike, stops=stops, name="spiking", initialise={**begins, **(initialise or {})})


def counts(model, end=5.5, start=0.0, **options):
    run = my.solve(model, {"x": start}, time=(0, end), method="tsitouras_5", device="cpu:1", interpreted=True,
                   **options)
    assert run.report.failed == 0
    return int(run["spikes"][0]), int(run["given"][0]), float(run["seen"][0])


@pytest.mark.parametrize("delay", [0, 0.25, 0.75])
def test_a_stop_that_every_event_sets_anew_acts_every_time(delay):
    spiked, acted, last = counts(spiking(my.stop(due, do=noted), at_spike={due: my.time + delay}))
    assert spiked == 5
    assert acted == (5 if delay < 0.5 else 4)
    assert last == pytest.approx(acted + delay, rel=1e-14)


def test_a_neuron_spikes_again_after_each_refractory_time():
    """v' = 2 - v from 0 to 1 in ln 2; there it rests for 0.3."""
    v, resting = my.state("v"), my.integer_accessory("resting")
    model = my.model({v: my.where(resting == 1, 0.0, 2 - v)}, name="neuron",
                     accessories={resting: 0, due: never, spikes: 0},
                     events=my.event(v - 1, direction="rising", do={v: 0, resting: 1, spikes: spikes + 1,
                                                                    due: my.time + 0.3}),
                     stops=my.stop(due, do={resting: 0}))
    run = my.solve(model, {"v": 0}, time=(0, 20), method="tsitouras_5", rtol=1e-10, atol=1e-10, device="cpu:1",
                   interpreted=True)
    assert run["spikes"] == 1 + np.floor((20 - np.log(2)) / (np.log(2) + 0.3))


def test_an_action_sets_its_own_time_anew():
    own = {due: my.time + 0.5}
    model = spiking(my.stop(due, do={**noted, **own}), due=0.25, level=100)
    assert counts(model) == (0, 11, 5.25)
    assert counts(model, end=5.25) == (0, 11, 5.25)


@pytest.mark.parametrize("phases", [2, 5, 11])
def test_a_stop_set_anew_acts_as_often_however_the_domain_is_cut(phases):
    model = spiking(my.stop(due, do=noted), at_spike={due: my.time + 0.25})
    assert counts(model, phases=phases, phase_length=5.5 / phases)[:2] == (5, 5)
    own = spiking(my.stop(due, do={**noted, due: my.time + 0.5}), level=100, due=0.25)
    assert counts(own, phases=phases, phase_length=5.5 / phases)[:2] == (0, 11)


def test_a_phase_that_goes_on_acts_at_its_start_if_it_sets_a_stop_there():
    begins = spiking(my.stop(due, do=noted), level=100, initialise={due: my.time})
    assert counts(begins, phases=11, phase_length=0.5)[1] == 11


def test_a_time_that_has_passed_does_not_act_and_one_set_while_another_waits_replaces_it():
    assert counts(spiking(my.stop(due, do=noted), at_spike={due: my.time - 0.5}))[1] == 0
    waits = spiking(my.stop(due, do=noted), at_spike={due: my.time + 1.5})  # the next event comes first
    assert counts(waits)[1] == 0
    assert counts(waits, end=6.75)[1] == 0
    once = spiking(my.stop(due, do=noted), at_spike={due: my.where(spikes < 3, my.time + 1.5, due)})
    assert counts(once)[1:] == pytest.approx((1, 4.5), rel=1e-14)


def test_a_time_that_stays_acts_once_and_one_that_is_set_to_the_same_instant_anew_acts_again():
    assert counts(spiking(my.stop(2.5, do={**noted, due: 2.5}), my.stop(due, do={given: given + 10})))[1] == 11
    stays = spiking(my.stop(due, do={**noted, due: due}), at_spike={due: 2.5})
    assert counts(stays)[1:] == (1, 2.5)
    # the action takes its time away, and that of the stop after it gives it back, twice
    back = my.stop(other, do={due: my.where(given < 3, other, never), other: never})
    again = spiking(my.stop(due, do={**noted, due: never, other: my.time}), back, at_spike={due: 2.5}, level=2)
    assert counts(again)[1:] == (3, 2.5)


def test_times_of_a_list_that_actions_set_need_not_stay_in_order():
    model = spiking(my.stop([due, other], do=noted), at_spike={
        due: my.where(spikes == 1, my.time + 0.5, due), other: my.where(spikes == 0, my.time + 0.25, other)})
    assert counts(model)[1:] == pytest.approx((2, 2.5), rel=1e-14)
    both = spiking(my.stop([due, other], do=noted), at_spike={due: my.time + 0.5, other: my.time + 0.25})
    assert counts(both, end=5.4)[1:] == pytest.approx((9, 5.25), rel=1e-14)


def test_the_first_of_equal_intervals_is_set_anew():
    model = spiking(my.stop(due, every=0.25, count=2, do=noted), at_spike={due: my.time + 0.125})
    assert counts(model)[1:] == pytest.approx((10, 5.375), rel=1e-14)
    # at 0, 1, 2, where the interval becomes 2, of which a multiple is now: it has acted at this instant
    grows = spiking(my.stop(0, every=other, do={**noted, other: my.where(my.time < 2, 1, 2)}), level=100,
                    other=1)
    assert counts(grows)[1:] == (4, 4.0)


def test_a_stop_set_anew_acts_backwards_in_time():
    spike = my.event(x - 1, do={x: 2, spikes: spikes + 1, due: my.time - 0.25})
    model = my.model({x: 1}, events=spike, stops=my.stop(due, do=noted), name="backwards",
                     accessories={due: -never, seen: 0, given: 0, spikes: 0})
    run = my.solve(model, {"x": 2}, time=(0, -5.5), method="tsitouras_5", device="cpu:1", interpreted=True)
    assert (run["spikes"], run["given"]) == (5, 5)
    assert run["seen"][0] == pytest.approx(-5.25, rel=1e-14)


def test_samples_one_rounding_from_a_stop_show_the_state_before_the_action():
    model = my.model({x: 0}, stops=my.stop(0.1 + 0.2, do={x: 1}), name="sampled")
    times = [np.nextafter(0.3, 0), 0.3, np.nextafter(0.1 + 0.2, 1), 0.4, np.nextafter(0.4, 1)]
    run = my.solve(model, {"x": 0}, time=(0, 0.4), samples=times, method="tsitouras_5", device="cpu:1",
                   interpreted=True)
    np.testing.assert_array_equal(np.ravel(run[x]), [0, 0, 0, 1, 1])
    begins = my.solve(model, {"x": 0}, time=(0.1, 0.4), samples=[np.nextafter(0.1, 0), 0.1, 0.4], method="tsitouras_5",
                      device="cpu:1", interpreted=True)
    np.testing.assert_array_equal(np.ravel(begins[x]), [0, 0, 1])
    with pytest.raises(my.Error, match=r"to 0\.400000000001,.*from 0 to 0\.4"):
        my.solve(model, {"x": 0}, time=(0, 0.4), samples=[0.4 + 1e-12], method="tsitouras_5", device="cpu:1",
                 interpreted=True)


def test_stops_are_written_as_cpp():
    text = treatment(my.stop(0, every=interval, count=doses, name="intake", do={gut: gut + dose})).cpp()
    assert "enum stop { intake, n_stop };" in text
    assert "return myriad::recurring(number, R(0), R(p[interval]), R(p[doses]));" in text
    assert "static void after_stop(int, int, auto& lane) {" in text
    assert "stop" not in my.model(equations).cpp()


@pytest.mark.parametrize("make, message", [
    (lambda: my.stop([1, 2], every=3), "give one time or a list of times, or the first one with every="),
    (lambda: my.stop(1, count=3), "give one time or a list of times"),
    (lambda: my.stop([]), "give one time or a list of times"),
    (lambda: treatment(my.stop(gut)), "gut stands in the time of stop stop_1.*make an event where a state decides"),
    (lambda: treatment(my.stop(my.time + 1)), "time stands in the time of stop stop_1"),
    (lambda: treatment(1.5), r"stops\[0\] is float.*make it by my.stop"),
    (lambda: treatment(my.stop(1, name="int")), "keyword of C"),
    (lambda: treatment(my.stop(my.parameter("stop_time"))), "'stop_time' names a parameter"),
])
def test_wrong_stops_are_refused(make, message):
    with pytest.raises(my.Error, match=message):
        make()
