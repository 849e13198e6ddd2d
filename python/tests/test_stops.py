# SPDX-License-Identifier: MIT
"""Exact stop times: doses and switches at times that are given."""

import numpy as np
import pytest

import myriad as my

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
    assert run["ke"] == 0


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
    (lambda: treatment(1.5), r"stops\[0\] is float.*make it by myriad.stop"),
    (lambda: treatment(my.stop(1, name="int")), "keyword of C"),
    (lambda: treatment(my.stop(my.parameter("stop_time"))), "'stop_time' names a parameter"),
])
def test_wrong_stops_are_refused(make, message):
    with pytest.raises(my.Error, match=message):
        make()
