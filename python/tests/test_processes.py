# SPDX-License-Identifier: MIT
"""Threads, forks and signals."""

import concurrent.futures
import multiprocessing
import os
import signal
import threading
import time

import numpy as np
import pytest

import myriad_ode as my

w = np.linspace(1, 2, 200)


def solve(oscillator, device="cpu:2", end=20, **options):
    return my.solve(oscillator, {"w": w}, start={"x": 1, "v": 0}, time=(0, end), device=device, **options)


def test_several_threads_solve_at_once(oscillator):
    expected = solve(oscillator)["x"].tobytes()
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        for run in pool.map(lambda _: solve(oscillator), range(12)):
            assert run["x"].tobytes() == expected


def _solve_in_child(oscillator, results):
    results.put(solve(oscillator)["x"].tobytes())


def test_a_fork_after_use_solves_with_threads_of_its_own(oscillator):
    expected = solve(oscillator)["x"].tobytes()
    fork = multiprocessing.get_context("fork")
    results = fork.SimpleQueue()
    child = fork.Process(target=_solve_in_child, args=(oscillator, results))
    child.start()
    child.join(60)
    assert child.exitcode == 0
    assert results.get() == expected


def test_the_interpreter_runs_meanwhile(oscillator):
    """Another thread of Python works while a call integrates."""
    turns, over = 0, threading.Event()

    def count():
        nonlocal turns
        while not over.is_set():
            turns += 1
            time.sleep(0.001)

    counter = threading.Thread(target=count)
    solve(oscillator)
    counter.start()
    run = solve(oscillator, end=100_000, device="cpu:1")
    over.set()
    counter.join()
    assert run.report.seconds > 0.1 and turns > 5


def test_an_interrupt_ends_a_run_with_what_is_done(oscillator):
    begun = threading.Event()

    def interrupt():
        begun.wait(60)
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=interrupt).start()
    with pytest.raises(my.Interrupted) as raised:
        my.solve(oscillator, {"w": np.linspace(1, 2, 20_000)}, start={"x": 1, "v": 0}, time=(0, 10_000),
                 progress=lambda done, total: begun.set() if done else None)
    run = raised.value.run
    assert isinstance(raised.value, KeyboardInterrupt)
    assert 0 < run.done < 20_000 and run.report.by_status["not_started"] == 20_000 - run.done
    done = run.status == "success"
    assert done.sum() == run.done and (run.t_last[done] == 10_000).all()
    solve(oscillator)  # and the next one works


def test_an_exception_of_the_progress_function_arrives(oscillator):
    def refuse(done, total):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        solve(oscillator, progress=refuse)


@pytest.mark.parametrize("options", [
    dict(size=100, device="cpu:2"), dict(interpreted=True, method="runge_kutta_4", step=1e-5, end=1.5e4),
    dict(interpreted=True, phases=1_000_000_000, end=1e-3)], ids=["compiled", "fixed steps", "phases"])
def test_an_instance_that_takes_for_ever_ends_on_an_interrupt(oscillator, options):
    options = {"device": "cpu:1", **options}
    x, v, w = *my.states("x v"), my.parameter("w")
    model = my.model({x: v, v: -w * w * x}) if "interpreted" in options else oscillator
    end = np.ones(options.pop("size", 1))
    end[len(end) // 2] = options.pop("end", 1e12)
    options = dict(sweep={"w": 1}, start={"x": 1, "v": 0}, max_steps=2_000_000_000, rtol=1e-8, **options)
    my.solve(model, time=(0, 1e-3), **{**options, "phases": 1})  # compiles it
    began = time.perf_counter()
    interrupt = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    with pytest.raises(my.Interrupted) as raised:
        interrupt.start()
        my.solve(model, time=(0, end), **options)
    assert time.perf_counter() - began < 8
    run = raised.value.run
    assert run.report.by_status.pop("interrupted") == 1 and run.done == len(end) - 1
    endless = len(end) // 2
    assert run.status[endless] == "interrupted" and run.failed[endless]
    assert np.isfinite(run["x"]).all() and 0 <= run.t_last[endless] < 1e12
    assert f"instance {endless} ended as interrupted" in str(run.report)
