# SPDX-License-Identifier: MIT
"""Notes of reports and checks before a call, which are those of the C++ library."""

import numpy as np
import pytest

import myriad_ode as my

x, v = my.states("x v")
k = my.parameter("k")


@pytest.fixture(scope="module", params=[None, True], ids=["compiled", "interpreted"])
def interpreted(request):
    return request.param


def follow(rate, interpreted=None, tolerance=1e-6, **options):
    """x' = rate (sin t - x) + cos t from its solution, sin t."""
    model = my.model({x: k * (my.sin(my.time) - x) + my.cos(my.time)}, name="prothero_robinson")
    return my.solve(model, {k: np.full(40, rate)}, start={x: 0}, time=(0, 1), rtol=tolerance,
                    atol=tolerance, interpreted=interpreted, device="cpu", **options)


def test_a_stiff_sweep_by_an_explicit_method_has_a_note(interpreted):
    report = follow(1e4, interpreted).report
    note, = report.notes
    assert note.startswith("stability, not accuracy, limits the step in 40 of 40 instances") and "rodas_5p" in note
    assert f"note: {note}" in str(report)


def test_no_advice_is_given_to_those_who_want_none(interpreted):
    assert follow(1e4, interpreted, advice=False).report.notes == []


def test_smooth_and_stiff_methods_are_advised_nothing(interpreted):
    assert follow(1.0, interpreted).report.notes == []
    if not interpreted:
        assert follow(1e4, method="rodas_5p").report.notes == []


def test_stiffness_is_found_in_single_precision():
    report = follow(1e4, precision="float", tolerance=1e-3).report
    assert any("rodas_5p" in note for note in report.notes)


def test_a_note_has_the_names_of_python():
    model = my.model({x: v, v: -x})
    report = my.solve(model, start={x: 1, v: 0}, time=(0, 1), rtol=1e-18, atol=1e-300, device="cpu").report
    note, = report.notes
    assert note.startswith("rtol 1e-18 is below what the precision can reach")
    assert str(report).count("is below what the precision can reach") == 1


def test_a_stiff_study_has_a_note():
    model = my.model({x: k * (my.sin(my.time) - x) + my.cos(my.time)}, name="prothero_robinson")
    result = my.study(model, {k: np.full(40, 1e4)}, start={x: 0}, time=(0, 1), rtol=1e-6, atol=1e-6).run(device="cpu")
    assert any("rodas_5p" in note for note in result.notes)


def test_phases_that_are_too_long_for_exponents_have_a_note():
    y, z = my.states("y z")
    lorenz = my.model({x: 10 * (y - x), y: x * (28 - z) - y, z: x * y - 8 / 3 * z}, name="lorenz")

    def notes(length):
        return my.solve(my.with_tangents(lorenz, 3), {}, start={x: 1, y: 1, z: 1}, time=(0, length), phases=20,
                        rtol=1e-8, atol=1e-8, device="cpu").report.notes

    assert any(note.startswith("phases may be too long for the smallest exponent in 1 of 1") for note in notes(2.0))
    assert notes(0.1) == []


def test_an_event_tolerance_below_rounding_is_refused(interpreted):
    event = my.event(x - 1e6, name="summit", tolerance=1e-14)
    model = my.model({x: v, v: 0 * x - 1}, events=[event])
    with pytest.raises(my.Error, match="the tolerance of event 'summit' is 1e-14, but rounding changes its function"):
        my.solve(model, start={x: 999_999, v: 10}, time=(0, 1), device="cpu", interpreted=interpreted)
    my.solve(model, start={x: 999_999, v: 10}, time=(0, 1), device="cpu", events={"summit": dict(tolerance=1e-8)})
