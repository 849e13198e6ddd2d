# SPDX-License-Identifier: MIT
"""Numbers of `solve` against closed forms and SciPy, and the arrays that it returns."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import myriad_ode as my

w = np.linspace(1, 2, 37)
start = {"x": 1, "v": 0}


def test_end_values_are_those_of_the_closed_form(oscillator):
    run = my.solve(oscillator, {"w": w}, start=start, time=(0, 10), rtol=1e-11, atol=1e-12)
    assert run.report.by_status == {"success": 37}
    np.testing.assert_allclose(run["x"], np.cos(10 * w), rtol=0, atol=1e-8)
    np.testing.assert_allclose(run["v"], -w * np.sin(10 * w), rtol=0, atol=2e-8)
    np.testing.assert_array_equal(run.t_last, 10)
    np.testing.assert_array_equal(run["w"], w)
    assert run.accepted_steps.sum() == run.report.accepted_steps > 0
    assert 0 < run.report.compile_seconds < run.report.total_seconds and run.report.kernel_seconds == 0  # a GPU's


@pytest.mark.parametrize("method", ["dormand_prince_8", "rodas_5p"])
def test_methods_agree_with_scipy(oscillator, method):
    run = my.solve(oscillator, {"w": w}, start=start, time=(0, 3), rtol=1e-9, atol=1e-10, method=method)
    for i in (0, 20, 36):
        exact = solve_ivp(lambda t, y, k=w[i]: (y[1], -k * k * y[0]), (0, 3), (1, 0), rtol=1e-11, atol=1e-12,
                          method="DOP853").y[:, -1]
        np.testing.assert_allclose((run["x"][i], run["v"][i]), exact, rtol=0, atol=1e-7)


def test_threads_and_order_change_no_bit(oscillator):
    call = dict(start=start, time=(0, 10), phases=3, carry_on=False, record=["x"])
    one = my.solve(oscillator, {"w": w}, device="cpu:1", **call)
    many = my.solve(oscillator, {"w": w}, device="cpu:3", schedule="by_cost", **call)
    backwards = my.solve(oscillator, {"w": w[::-1]}, device="cpu:2", **call)
    assert one.report.threads == 1
    assert one["x"].tobytes() == many["x"].tobytes()
    assert one["x"].tobytes() == backwards["x"][::-1].tobytes()


def test_own_times_and_backwards(oscillator):
    end = np.linspace(-1, -2, 37)
    run = my.solve(oscillator, {"w": w}, start={"x": np.cos(w), "v": 0.0}, time=(0, end), rtol=1e-10)
    np.testing.assert_array_equal(run.t_last, end)
    np.testing.assert_allclose(run["x"], np.cos(w) * np.cos(w * end), atol=1e-7)


def test_records_by_phase(oscillator):
    run = my.solve(oscillator, {"w": w}, start=start, time=(0, 50), phases=5, phase_length=2, rtol=1e-10,
                   record=dict(from_phase=2, states=["x"], time=True))
    assert run["x"].shape == (37, 3)
    np.testing.assert_allclose(run["x"], np.cos(w[:, None] * run["t"]), atol=1e-7)
    np.testing.assert_array_equal(run["t"], np.tile([6.0, 8.0, 10.0], (37, 1)))
    assert run["v"].shape == (37,)
    np.testing.assert_array_equal(run["x"][:, -1], run.states["x"])


def test_phases_may_begin_with_the_step_of_the_last_one(oscillator):
    call = dict(start=start, time=(0, 0.5), phases=40, step=1e-4, rtol=1e-8)
    each = my.solve(oscillator, {"w": w}, **call)
    carried = my.solve(oscillator, {"w": w}, carry_on_step=True, **call)
    assert carried.report.accepted_steps < 0.75 * each.report.accepted_steps  # each begins with step
    for run in (each, carried):
        np.testing.assert_allclose(run["x"], np.cos(20 * w), atol=1e-5)


def test_samples(oscillator):
    run = my.solve(oscillator, {"w": w}, start=start, time=(0, 4), samples=9, rtol=1e-10)
    assert run["x"].shape == (37, 9)
    np.testing.assert_allclose(run.t_sample, np.tile(np.linspace(0, 4, 9), (37, 1)))
    np.testing.assert_allclose(run["x"], np.cos(w[:, None] * run.t_sample), atol=1e-6)
    own = np.sort(np.random.default_rng(1).uniform(0, 4, (37, 3)), axis=1)
    run = my.solve(oscillator, {"w": w}, start=start, time=(0, 4), rtol=1e-10, samples=dict(states=["v"], times=own))
    np.testing.assert_array_equal(run.stored_samples, 3)
    np.testing.assert_allclose(run["v"], -w[:, None] * np.sin(w[:, None] * own), atol=1e-6)
    assert list(run.samples) == ["v"]


def test_single_precision_and_fixed_steps(oscillator):
    run = my.solve(oscillator, {"w": w}, start=start, time=(0, 1), step=1e-2, method="runge_kutta_4", precision="float")
    assert run["x"].dtype == np.float32
    np.testing.assert_allclose(run["x"], np.cos(w), atol=1e-5)
    assert (run.accepted_steps == 100).all()


def test_control_and_tolerances_per_instance(oscillator):
    coarse_to_fine = np.geomspace(1e3, 1, 37)
    run = my.solve(oscillator, {"w": np.ones(37)}, start=start, time=(0, 10), rtol=1e-10, atol={"x": 1e-10, "v": 1e-9},
                   control=("pi_control", "tolerance_per_instance"), tolerance_scale=coarse_to_fine)
    steps = run.accepted_steps
    assert steps[0] < steps[18] < steps[36]


def test_events_hooks_and_accessories(ball):
    loss = np.linspace(0.5, 0.9, 8)
    run = my.solve(ball, {"loss": loss, "g": 2.0}, start={"height": 1, "speed": 0}, time=(0, 2.5), rtol=1e-10)
    fall = 1.0  # sqrt(2 h / g)
    impact = np.sqrt(2 * 2.0 * 1.0)
    later = 2.5 - fall
    again = 2 * loss * impact / 2.0  # until the second impact
    once = again > later
    np.testing.assert_array_equal(run["bounces"] == 1, once)
    assert once.any() and not once.all()
    np.testing.assert_allclose(run["height"][once], (loss * impact * later - later**2)[once], atol=1e-7)
    np.testing.assert_allclose(run["top"][once], (loss[once] * impact)**2 / 4, atol=1e-7)
    assert run["bounces"].dtype == np.int32
    stopped = my.solve(ball, {"loss": loss, "g": 2.0}, start={"height": 1, "speed": 0}, time=(0, 9),
                       events={"impact": dict(stop_after=1)})
    assert stopped.report.by_status == {"stopped_by_event": 8}
    np.testing.assert_allclose(stopped.t_last, 1, atol=1e-6)


def test_failures_have_statuses(oscillator):
    bad = w.copy()
    bad[5] = np.nan
    run = my.solve(oscillator, {"w": bad}, start=start, time=(0, 1), invalid="mark")
    assert run.report.by_status == {"success": 36, "invalid_input": 1}
    assert np.flatnonzero(run.failed).tolist() == [5]
    assert run.status[5] == "invalid_input"
    run = my.solve(oscillator, {"w": w}, start=start, time=(0, 1000), max_steps=50)
    assert run.report.by_status == {"max_steps": 37}
    assert "first failure: instance 0 ended as max_steps" in str(run.report)


def test_xarray_and_pandas(oscillator):
    run = my.solve(oscillator, {"w": w}, start=start, time=(0, 2), phases=3, record=dict(from_phase=1, states=["x"]))
    data = run.to_xarray()
    assert data.x.dims == ("instance", "phase") and data.phase.values.tolist() == [1, 2]
    np.testing.assert_array_equal(data.x, run["x"])
    np.testing.assert_array_equal(data.w, w)
    assert (data.status == "success").all()
    frame = run.to_pandas()
    assert len(frame) == 2 * 37 and set(frame) == {"instance", "phase", "w", "x", "status"}
    np.testing.assert_array_equal(frame[frame.phase == 2].x, run["x"][:, 1])
    table = my.solve(oscillator, {"w": w}, start=start, time=(0, 2)).to_pandas()
    assert len(table) == 37 and (table.status == "success").all()


def test_progress_is_told(oscillator):
    told = []
    my.solve(oscillator, {"w": w}, start=start, time=(0, 10), progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (37, 37)


def test_arrays_outlive_the_run(oscillator):
    x = my.solve(oscillator, {"w": w}, start=start, time=(0, 1), record=["x"])["x"]
    np.testing.assert_allclose(x[:, 0], np.cos(w), atol=1e-6)


def test_a_grid_is_unstacked_to_its_axes(oscillator):
    speeds, places = np.array([1.0, 1.5, 2.0]), np.array([0.5, 1.0])
    run = my.solve(oscillator, my.grid({"w": speeds, "x": places}), start={"v": 0}, time=(0, 1), rtol=1e-10,
                   phases=2, record=["x"])
    assert run.shape == (3, 2) and run["x"].shape == (6, 2)
    data = run.to_xarray()
    assert data.x.dims == ("w", "x_start", "phase") and data.v_end.dims == ("w", "x_start")
    np.testing.assert_array_equal(data.w, speeds)
    np.testing.assert_array_equal(data.x_start, places)
    np.testing.assert_allclose(data.x.sel(w=1.5, x_start=0.5)[0], 0.5 * np.cos(1.5), atol=1e-8)


def test_shared_values_of_a_grid_and_a_zip(ball):
    run = my.solve(ball, my.grid(my.zip(loss=[0.5, 0.6], height=[1.0, 2.0]), g=2.0), start={"speed": 0},
                   time=(0, 0.1))
    data = run.to_xarray()
    assert data.height_end.dims == ("instance",) and float(data.g) == 2.0
    np.testing.assert_array_equal(data.height_start, [1.0, 2.0])
    np.testing.assert_array_equal(data.loss, [0.5, 0.6])
    with pytest.raises(my.Error, match="'g' is shared by all instances and has 2 values"):
        my.solve(ball, my.grid(g=[1.0, 2.0], loss=0.5), start={"height": 1, "speed": 0}, time=(0, 1))


def test_traced_models_have_the_bits_of_written_ones(oscillator):
    x, v = my.states("x v")
    speed = my.parameter("w")
    traced = my.model({x: v, v: -speed * speed * x})
    call = dict(start=start, time=(0, 10), phases=2, record=["x"])
    written = my.solve(oscillator, {"w": w}, **call)
    assert my.solve(traced, {speed: w}, **call)["x"].tobytes() == written["x"].tobytes()


def test_samples_are_as_accurate_as_the_steps(oscillator):
    run = my.solve(oscillator, {"w": [1.0]}, start={"x": 1, "v": 0}, time=(0, 6), samples=200, rtol=1e-7, atol=1e-7)
    error = np.abs(run["x"] - np.cos(run.t_sample)).max()
    assert error < 1e-6  # 4e-6 with cash_karp


@pytest.mark.parametrize("schedule", ["automatic", "dynamic", "by_cost"])
def test_a_time_limit_ends_what_takes_for_ever(oscillator, schedule):
    end = np.ones(50)
    end[20] = 1e12
    call = dict(start=start, max_steps=2_000_000_000, phases=2, schedule=schedule)
    run = my.solve(oscillator, {"w": 1}, time=(0, end), time_limit=0.3, **call)
    assert run.report.by_status == {"success": 49, "interrupted": 1} and run.report.seconds < 8
    assert run.status[20] == "interrupted" and 0 < run.t_last[20] < 1e12 and np.isfinite(run["x"]).all()
    assert "interrupted: time_limit = 0.3 s was over" in run.report.notes and "note: interrupted" in str(run.report)
    for wrong in (-1, float("nan"), "soon"):
        with pytest.raises(my.Error, match="time_limit"):
            my.solve(oscillator, {"w": 1}, start=start, time=(0, 1), time_limit=wrong)


def test_notes_say_what_ended_instances(oscillator):
    few = my.solve(oscillator, {"w": w}, start=start, time=(0, 1000), max_steps=50)
    assert any(note.startswith("max_steps: 50 trial steps did not take") for note in few.report.notes)
    coarse = my.solve(oscillator, {"w": 1e3}, start=start, time=(1e6, 1e6 + 100), precision="float")
    assert coarse.report.by_status == {"step_underflow": 1}
    assert any(note.startswith("step_underflow: time, which single precision resolves to 0.0625")
               for note in coarse.report.notes)


def test_the_default_first_step_follows_from_the_slope(oscillator):
    run = my.solve(oscillator, {"w": 100}, start=start, time=(0, 10), max_steps=1)
    np.testing.assert_allclose(run.t_last, 2 * 1e-8**0.2 / 1e4)  # of v, whose slope is -10 000


def test_the_default_first_step_is_one_that_time_resolves(oscillator):
    for begin, precision in ((1e6, "float"), (-1e6, "float"), (1e15, "double")):
        run = my.solve(oscillator, {"w": 1e-3}, start=start, time=(begin, begin + 1000), precision=precision, rtol=1e-5)
        assert run.report.by_status == {"success": 1} and abs(run["x"][0] - np.cos(1)) < 1e-3
