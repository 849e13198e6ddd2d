# SPDX-License-Identifier: MIT
"""Triggers: conditions of several comparisons, actions that wait, and their order."""

import numpy as np
import pytest

import myriad_ode as my

x, y = my.states("x y")
lag = my.parameter("lag")
at, log = my.accessory("at"), my.accessory("log")
count = my.integer_accessory("count")
noted = {count: count + 1, at: my.time}


def ramp(*triggers, **others):
    """x' = 1 and y' = 0."""
    return my.model({x: 1, y: 0}, triggers=triggers, **{"accessories": {count: 0, at: -1, log: 0}, **others})


def after(model, to=10, values=None, interpreted=True, **options):
    return my.solve(model, {"x": 0, "y": 0, **(values or {})}, time=(0, to), method="tsitouras_5", rtol=1e-9, atol=1e-9,
                    maximum_step=0.4, device="cpu:1", interpreted=interpreted, **options)


@pytest.mark.parametrize("condition, expected", [
    ((x > 2) & (my.time < 5), [2]), ((x > 2) & (my.time > 5), [5]), ((x > 2) | (my.time > 5), [2]),
    (~((x < 2) | (my.time <= 5)), [5]), ((x >= 2) & ~(x >= 3), [2]), ("x > 2 and not y > 1", [2]), (x < 0, []),
    (x >= 0, []), ((my.sin(my.time) > 0.5) & (x > 2), [2, 13 / 6 * np.pi]),
    ((x >= lag) & (lag >= 2), [3]), ((lag == 3) & (x >= 4), [4]), ((lag != 3) & (x >= 4), []),
])
def test_an_action_runs_where_a_condition_comes_to_hold(condition, expected):
    run = after(ramp(my.trigger(condition, do=noted), parameters=["lag"]), values={"lag": 3})
    assert run["count"] == len(expected)
    np.testing.assert_allclose(run["at"], expected[-1] if len(expected) else -1, rtol=1e-9)


def test_a_condition_of_whole_numbers_and_of_states_that_only_events_change():
    steps = my.stop([1, 2, 3, 4], do={y: y + 1, count: count + 1})
    model = ramp(my.trigger((count == 2) & (y == 2), do={at: my.time}), my.trigger(y != 0, do={log: my.time}),
                 stops=steps)
    run = after(model)
    assert run["at"] == 2 and run["log"] == 1


@pytest.mark.parametrize("condition, expected", [
    (x == 2, [2]), (x != 2, [2]), (my.sin(my.time) == 0.5, np.pi / 6 * np.array([1, 5, 13, 17])),
    ((x == 2) & (my.time < 1), []), ((x == 2) | (my.time > 5), [2, 5]), (y == 3, [4]), (my.floor(my.time) == 3, [3]),
    (my.where(x > 3, x, 10) < 5, [3])])
@pytest.mark.parametrize("delay", [None, 0.5])
def test_a_condition_may_hold_or_fail_for_an_instant(condition, expected, delay):
    moves = my.trigger(x >= 4, do={y: 3})  # from where it moves on
    once = my.trigger(condition, do=noted, delay=delay)
    run = after(my.model({x: 1, y: my.where(y > 2.5, 1, 0)}, triggers=[once, moves], accessories={
        count: 0, at: -1, log: 0}, name="ramp"))
    assert run["count"] == len(expected)
    np.testing.assert_allclose(run["at"], expected[-1] + (delay or 0) if len(expected) else -1, rtol=1e-9)


def test_an_action_that_does_not_persist_is_dropped_after_the_instant_at_which_its_condition_holds():
    kept = my.trigger(x == 2, do={count: count + 1}, delay=1)
    dropped = my.trigger(x == 2, do={count: count + 10}, delay=1, persistent=False)
    assert after(ramp(kept, dropped))["count"] == 1


def test_the_sample_at_the_start_has_what_triggers_do_there():
    begins = my.trigger(x >= 0, do={y: 2}, initial_value=False)
    run = after(ramp(begins, my.trigger(y > 1, do={y: y + 1}, priority=1)), to=1, samples=3)
    np.testing.assert_array_equal(run.samples["y"], [[3, 3, 3]])


def test_an_initial_value_lets_a_condition_come_to_hold_at_the_start():
    model = ramp(my.trigger(x >= 0, do={count: count + 1}, initial_value=False),
                 my.trigger(x >= 0, do={count: count + 10}))
    assert after(model)["count"] == 1


def test_actions_follow_from_each_other_at_one_instant():
    model = ramp(my.trigger(y > 0.5, do={count: 10 * count + 2}), my.trigger(x > 1, do={y: 1, count: 10 * count + 1}))
    run = after(model)
    assert run["count"] == 12 and run["y"] == 1


@pytest.mark.parametrize("start, apart", [(0, 1e-12), (1.7e9, 0.05), (1.7e9, 1e-5), (-1.7e9, 0.05)])
def test_actions_whose_times_differ_by_more_than_rounding_run_one_after_the_other(start, apart):
    later = my.trigger(x > 1, do={count: 10 * count + 1, at: my.time}, delay=1 + apart)
    sooner = my.trigger(x > 1, do={count: 10 * count + 2, log: my.time}, delay=1)
    run = my.solve(ramp(later, sooner), {"x": 0, "y": 0}, time=(start, start + 5), method="tsitouras_5", device="cpu:1",
                   maximum_step=0.4, interpreted=True)
    assert run["count"] == 21
    assert run["at"][0] - run["log"][0] == pytest.approx(apart, abs=4 * np.spacing(abs(start) + 2))


@pytest.mark.parametrize("interpreted", [True, False])
def test_delays_values_priorities_and_cancelling(interpreted):
    """The bits are those of the closed form: times of actions are sums of those of triggers and delays."""
    model = ramp(
        my.trigger(my.time >= 1, do={y: y + x, log: my.time}, delay=lag, persistent=False, name="late"),
        my.trigger(my.time >= 1, do={at: x}, delay=2, values_from_trigger_time=True, priority=1),
        my.trigger(my.time >= 3, do={x: 0, count: count + 1}, priority=2),
        my.trigger(count == 1, do={count: count + 10, y: 100 * y}))
    run = after(model, values={"lag": np.array([0.5, 2, 8.5])}, interpreted=interpreted)
    np.testing.assert_allclose(run["log"], [1.5, 3, 9.5])
    np.testing.assert_allclose(run["at"], 1)  # x at the trigger, not at the action
    np.testing.assert_allclose(run["x"], 7)  # from the trigger of the largest priority
    np.testing.assert_allclose(run["y"], [150, 0, 6.5], atol=1e-9)
    np.testing.assert_array_equal(run["count"], 11)


@pytest.mark.parametrize("interpreted", [True, False])
def test_an_action_that_waits_is_dropped_where_its_condition_ceases_to_hold(interpreted):
    holds = (x > 1) & (x < lag)
    model = ramp(my.trigger(holds, do=noted, delay=2, persistent=False, room=1),
                 my.trigger(holds, do={log: my.time}, delay=2, room=1))
    run = after(model, values={"lag": np.array([2.0, 4.0])}, interpreted=interpreted)
    np.testing.assert_array_equal(run["count"], [0, 1])
    np.testing.assert_allclose(run["at"], [-1, 3])
    np.testing.assert_allclose(run["log"], 3)


@pytest.mark.parametrize("interpreted", [True, False])
def test_more_actions_than_there_is_room_for_end_the_instance(interpreted):
    wave = my.trigger(my.sin(np.pi * my.time) > 0, do={count: count + 1}, delay=lag, room=2)
    run = after(ramp(wave), to=11.9, values={"lag": np.array([3.5, 5.5])}, interpreted=interpreted)
    assert list(run.status) == ["success", "queue_overflow"]
    assert run["count"][0] == 5
    assert run.t_last[1] == pytest.approx(4)  # triggered every 2, from 0 on, where the sine rises


def test_values_from_the_time_of_the_trigger_are_numbers_and_conditions():
    values = {count: count + 5, log: my.where(x > 2, 1, 2), my.end_phase: x < 2, y: 3}
    model = ramp(my.trigger(x > 1, do=values, delay=2, values_from_trigger_time=True, room=1))
    run = after(model)
    assert run["count"] == 5 and run["log"] == 2 and run["y"] == 3
    assert run.t_last == pytest.approx(3) and run.status[0] == "stopped_by_user"


@pytest.mark.parametrize("priorities, expected", [((None, None), 12), ((None, -5), 21), ((2, 3), 21), ((lag, 2), 12)])
def test_the_largest_priority_comes_first(priorities, expected):
    both = [my.trigger(x > 1, do={count: 10 * count + i}, priority=p) for i, p in enumerate(priorities, 1)]
    assert after(ramp(*both, parameters=["lag"]), values={"lag": 3})["count"] == expected


@pytest.mark.parametrize("priority, expected", [(None, 213), (0, 231)])
def test_of_equal_actions_the_first_in_the_list_or_with_priorities_the_one_triggered_first_runs(priority, expected):
    def digit(d, condition, **more):
        return my.trigger(condition, do={count: 10 * count + d, **more}, priority=priority)

    assert after(ramp(digit(1, y > 0.5), digit(2, x > 1, y=1), digit(3, x > 1)))["count"] == expected


@pytest.mark.parametrize("waiting_first", [True, False])
def test_an_action_that_waits_until_a_crossing_comes_before_that_of_the_crossing(waiting_first):
    both = [my.trigger(x > 1, delay=1.0, do={count: 10 * count + 1}), my.trigger(x > 2, do={count: 10 * count + 2})]
    assert after(ramp(*both[::1 if waiting_first else -1]))["count"] == 12


def test_the_order_of_ties_is_random_and_follows_from_the_seed():
    def orders(seed, interpreted=True, **priorities):
        both = [my.trigger(x > 1, do={count: 10 * count + i}, priority=priorities.get(f"p{i}")) for i in (1, 2)]
        return after(ramp(*both, tie_seed=seed, parameters=["lag"]), values={"lag": np.zeros(200)},
                     interpreted=interpreted)["count"]

    found = orders(3)
    assert set(found) == {12, 21} and 70 < np.sum(found == 12) < 130
    np.testing.assert_array_equal(found, orders(3, interpreted=False))
    assert np.any(found != orders(4))
    assert set(orders(3, p2=1)) == {21}


def test_stops_and_events_stand_beside_triggers():
    model = ramp(my.trigger(x > 1, do={y: y + 1}, delay=1), stops=my.stop([2, 4], do={y: 10 * y}),
                 events=my.event(x - 3, name="third", do={log: y}))
    run = after(model)
    assert run["y"] == 10 and run["log"] == 1  # at t = 2 the stop comes first


def test_a_model_with_stops_alone_is_interpreted():
    dose, period = my.parameters("dose period")
    model = my.model({x: -x}, stops=[my.stop(0.5, every=period, count=3, do={x: x + dose}),
                                     my.stop([1.25, 4], do={x: 0})])
    call = dict(sweep={"dose": 2.0, "period": np.array([0.5, 1.0])}, start={x: 1}, time=(0, 3), method="tsitouras_5",
                device="cpu:1")
    run, compiled = my.solve(model, interpreted=True, **call), my.solve(model, interpreted=False, **call)
    np.testing.assert_allclose(run["x"], compiled["x"], rtol=1e-15)  # the compiler fuses x + dose
    np.testing.assert_allclose(run["x"], [2 * np.exp(-1.5), 2 * np.exp(-1.5) + 2 * np.exp(-0.5)], rtol=1e-6)


def test_phases_go_on_with_what_waits():
    waits = my.trigger(x > 1, do=noted, delay=3, room=1)
    run = after(ramp(waits, accessories={}), to=6, phases=3, phase_length=2)
    assert run["count"] == 1 and run["at"] == pytest.approx(4)


def test_what_waits_is_not_among_the_results():
    run = after(ramp(my.trigger(x > 1, do=noted, delay=1)))
    assert set(run.accessories) == {"count", "at", "log"}


def test_triggers_are_written_as_cpp():
    text = ramp(my.trigger((x > 1) & (my.time < 5), do={y: 1}, name="begins")).cpp()
    assert "enum event { begins_side_1, begins_side_2, n_event };" in text
    assert "return !positive[begins_side_1] && !positive[begins_side_2];" in text
    assert "static void after_trigger(int, auto& lane) {" in text
    assert "queue" not in text and "trigger" not in my.model({x: 1}).cpp()
    waits = ramp(my.trigger(x > 1, do={y: x}, delay=1, room=3, values_from_trigger_time=True)).cpp()
    assert "#include <myriad/action_queue.hpp>" in waits
    assert "using queue = myriad::action_queue<due_time_1, due_action_1, 3, 1>;" in waits


def test_a_study_has_triggers(tmp_path):
    model = ramp(my.trigger(x > lag, do={y: y + 1}, delay=1))
    table = my.study(model, {"lag": np.arange(5.0)}, start={"x": 0, "y": 0}, time=(0, 3.5), interpreted=True,
                     keep=["y"]).run(tmp_path / "store", device="cpu")
    np.testing.assert_array_equal(table["y"], [1, 1, 1, 0, 0])


@pytest.mark.parametrize("make, message", [
    (lambda: ramp(my.trigger((x > 1) & my.is_finite(x))), r"`is_finite\(x\)` in trigger trigger_1 .*is no comparison"),
    (lambda: ramp(my.trigger(x)), "`x` is a number and not a condition"),
    (lambda: ramp(my.trigger(True)), "the condition of trigger trigger_1.* always holds"),
    (lambda: ramp(my.trigger(x > 1, delay=-1)), "the delay of trigger trigger_1.* is -1: it is a time"),
    (lambda: ramp(my.trigger(x > 1, delay=x > 2)), "trigger trigger_1: `x > 2` is a condition and not a number"),
    (lambda: ramp(my.trigger(x > 1), tie_seed=-1), "tie_seed is -1.*whole number from 0 on"),
    (lambda: ramp(tie_seed=1), "give a model with triggers a whole number"),
    (lambda: my.trigger(x > 1, room=0), "the room of a trigger is 0"),
    (lambda: my.trigger(x > 1, room=10**6), "the room of a trigger is 1000000.*at most 1000.*that may wait"),
    (lambda: ramp(*[my.trigger(x > k, delay=1, room=600) for k in (1, 2)]),
     "the triggers have room for 1200 actions.*at most 1000 in a model.*smaller room="),
    (lambda: my.trigger(x > 1, persistent="no"), "persistent of a trigger is 'no'"),
    (lambda: my.trigger(x > 1, name="int"), "keyword of C"),
    (lambda: ramp(my.event(x)), r"triggers\[0\] is Event.*make it by my.trigger"),
    (lambda: ramp(my.trigger(my.event_count("e") > 1)), "e stands in an equation, event or summary"),
    (lambda: my.model({x: 1, "condition": 0}, triggers=my.trigger(x > 1)), "'condition' names a state"),
    (lambda: my.model({x: 1, "due_time_1": 0}, triggers=my.trigger(x > 1, delay=1)), "'due_time_1' names both"),
])
def test_wrong_triggers_are_refused(make, message):
    with pytest.raises(my.Error, match=message):
        make()


def test_tangents_of_a_model_with_triggers_are_those_of_events_or_are_refused():
    def spectrum(**acts):
        model = my.with_tangents(my.model({x: 1 - x, y: x - y}, **acts))
        return my.exponents(my.solve(model, start={x: 0, y: 0.1}, time=(0, 20)))
    turn = {x: 0.1 * y, y: y + x}
    by_event = spectrum(events=my.event(x - 0.5, direction="rising", do=turn))
    np.testing.assert_array_equal(spectrum(triggers=my.trigger(x > 0.5, do=turn)), by_event)
    for more in ({"delay": 1}, {"initial_value": False}):
        with pytest.raises(my.Error, match="tangents do not take"):
            my.with_tangents(ramp(my.trigger(x > 1, do={y: 1}, **more)))
    with pytest.raises(my.Error, match="tangents do not take"):
        my.with_tangents(ramp(my.trigger((x > 1) & (y > 1), do={y: 1})))


@pytest.mark.parametrize("lag", ["with a delay", None])
def test_triggers_have_the_derivatives_of_differences(lag):
    """Of a crossing and of a time that is a parameter, after a delay that is one, of what an action makes hold, and of
    two triggers of one crossing, of which the first moves the state away from it."""
    a, b, c, T = (my.parameter(name) for name in "abcT")
    z = my.state("z")
    model = my.model({x: a, y: x, z: -b * z}, triggers=[
        my.trigger(x > c, delay=b * T if lag else None, do={x: 0.5 * b, y: y + x * T}),
        my.trigger(x > c, do={z: z + 0.1 * my.time}),
        my.trigger((my.time > T) & (x > 0), do={z: z + c}),
        my.trigger(z > 1.4, do={z: z * b})])
    values = {a: 1.0, b: 0.7, c: 1.0, T: 0.8}
    options = dict(start={x: 0.3, y: 1.0, z: 1.0}, time=(0, 1.9), rtol=1e-11, atol=1e-12)
    found = my.solve(model, values, free=[a, b, c, T], **options)
    for k in values:
        above, below = (my.solve(model, {**values, k: values[k] + step}, interpreted=True, **options)
                        for step in (1e-6, -1e-6))
        for s in (x, y, z):
            assert found.sensitivity[s, k] == pytest.approx((above[s] - below[s]) / 2e-6, abs=1e-6)


@pytest.mark.parametrize("step", [0.01, 0.02, 0.005, 0.003, 0.1])
def test_a_trigger_on_whose_surface_each_step_ends_is_neither_lost_nor_an_accumulation(step):
    clock, count = my.states("clock count")
    model = my.model({clock: 1, count: 0}, triggers=my.trigger(clock >= 0.01, do={clock: 0, count: count + 1}))
    run = my.solve(model, start={clock: 0, count: 0}, time=(0, 2.005), method="dormand_prince_5", rtol=1e-9, atol=1e-9,
                   maximum_step=step, step=step)
    assert run.status[0] == "success" and run["count"][0] == 200 and run["clock"][0] == pytest.approx(0.005, abs=1e-12)


@pytest.mark.parametrize("remainder, times", [
    (lambda t: my.fmod(t, 12) == 0, [0, 12, 24, 36]), (lambda t: my.fmod(t, 12) == 7, [7, 19, 31]),
    (lambda t: t - 12 * my.floor(t / 12) == 0, [0, 12, 24, 36]), (lambda t: my.fmod(t, 12) == 12, []),
    (lambda t: (t % 12 == 11) & (t > 20), [23, 35])])
def test_a_trigger_that_a_remainder_equals_a_number_happens_once_in_each_period(remainder, times):
    x, = my.states("x")
    model = my.model({x: 0 * x}, triggers=my.trigger(remainder(my.time), do={x: x + 1}, initial_value=False))
    run = my.solve(model, start={"x": 0}, time=(0, 40), samples=np.arange(40) + 0.5, interpreted=True)
    assert run["x"][0].tolist() == [sum(one <= i for one in times) for i in range(40)]


def test_a_trigger_whose_name_ends_with_an_underscore_may_compare_for_equality():
    x, = my.states("x")
    model = my.model({x: 1 + 0 * x}, triggers=my.trigger(x == 1, do={x: 5}, name="event_"))
    assert my.solve(model, start={"x": 0}, time=(0, 2), interpreted=True)["x"] == pytest.approx(6)


def test_values_of_the_time_of_a_trigger_have_derivatives():
    a, k, x = my.parameter("a"), my.parameter("k"), my.state("x")
    model = my.model({x: -k * x}, triggers=[
        my.trigger(my.time >= 1, do={x: x + a}, values_from_trigger_time=True, priority=2, delay=0.5),
        my.trigger(my.time >= 2, do={x: 2 * x + a}, values_from_trigger_time=True, priority=1)], name="kept")
    run = my.solve(model, {a: 0.3, k: 0.5}, start={x: 1.5}, time=(0, 3), free=[a, k], rtol=1e-10)

    def end(a, k):
        early = 1.5 * np.exp(-k)
        return (2 * (early + a) * np.exp(-0.5 * k) + a) * np.exp(-k)

    step = 1e-6
    assert run["x"] == pytest.approx(end(0.3, 0.5), rel=1e-8)
    assert run.sensitivity[x, a] == pytest.approx((end(0.3 + step, 0.5) - end(0.3 - step, 0.5)) / 2e-6, rel=1e-6)
    assert run.sensitivity[x, k] == pytest.approx((end(0.3, 0.5 + step) - end(0.3, 0.5 - step)) / 2e-6, rel=1e-6)
