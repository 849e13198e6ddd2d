# SPDX-License-Identifier: MIT
"""Doses, compared with sums of closed forms."""

from pathlib import Path

import numpy as np
import pytest

import myriad_ode as my

gut, blood = my.states("gut blood")
absorption, elimination, dose, interval, length, lag, part = my.parameters(
    "absorption elimination dose interval length lag part")
drug = my.model({gut: -absorption * gut, blood: absorption * gut - elimination * blood}, name="drug")
rates = {absorption: 1.0, elimination: 0.2}
file = Path(__file__).parent.parent / "examples" / "doses.xml"


def solved(model, values, time=(0, 30), **options):
    options = dict(start={gut: 0, blood: 0}, rtol=1e-10, atol=1e-10, interpreted=True) | options
    return my.solve(model, {**rates, **values}, time=time, **options)


def swallowed(times, amounts, t=30.0):
    """What is in the blood, by Bateman's function."""
    since = np.maximum(t - np.asarray(times, float), 0)
    return np.sum(np.asarray(amounts) / 0.8 * (np.exp(-0.2 * since) - np.exp(-since)))


def infused(begins, ends, rate, t=30.0):
    """The same of what goes into the blood at a rate."""
    begins, ends = np.minimum(begins, t), np.minimum(ends, t)
    return rate / 0.2 * np.sum(np.exp(-0.2 * (t - ends)) - np.exp(-0.2 * (t - begins)))


def test_doses_at_equal_intervals_come_as_often_as_there_are():
    model = drug.with_doses(my.doses(gut, dose, at=1, every=interval, count=3, lag=lag, bioavailability=part))
    run = solved(model, {dose: 100.0, interval: [4.0, 8.0, 20.0], lag: 0.5, part: 0.7})
    expected = [swallowed([1.5 + k * every for k in range(3) if 1.5 + k * every <= 30], 70.0) for every in (4, 8, 20)]
    np.testing.assert_allclose(run[blood], expected, rtol=1e-8)


def test_doses_end_with_the_last_that_is_not_later_than_until():
    model = drug.with_doses(my.doses(gut, 10, every=interval, until=lag))
    run = solved(model, {interval: [0.1, 0.1, 0.3, 7.0], lag: [2.4, 2.39, 0.9, 6.9]})  # 2.4 / 0.1 is 23.999999999999996
    expected = [swallowed(every * np.arange(count), 10.0) for every, count in ((0.1, 25), (0.1, 24), (0.3, 4), (7, 1))]
    np.testing.assert_allclose(run[blood], expected, rtol=1e-8)


def test_doses_at_given_times_have_amounts_of_their_own():
    run = solved(drug.with_doses(my.doses(gut, [30, dose, 30, 2 * dose], at=[0, 2, 5, lag])), {dose: 7.0, lag: 11.0})
    np.testing.assert_allclose(run[blood], swallowed([0, 2, 5, 11], [30, 7, 30, 14]), rtol=1e-8)


def test_a_list_of_times_has_one_amount_if_one_is_given():
    run = solved(drug.with_doses(my.doses(gut, 5, at=np.array([1, 1, 4]))), {}, size=1)
    np.testing.assert_allclose(run[blood], swallowed([1, 1, 4], [5, 5, 5]), rtol=1e-8)


def test_times_that_parameters_give_may_come_in_any_order():
    model = drug.with_doses(my.doses(gut, [30, 7], at=[lag, interval]))
    run = solved(model, {lag: [3.0, 11.0, 4.0], interval: [8.0, 8.0, 4.0]})
    expected = [swallowed(times, [30, 7]) for times in ([3, 8], [11, 8], [4, 4])]
    np.testing.assert_allclose(run[blood], expected, rtol=1e-8)


def test_times_may_be_a_range():
    run = solved(drug.with_doses(my.doses(gut, 5, at=range(0, 24, 6))), {}, size=1)
    np.testing.assert_allclose(run[blood], swallowed([0, 6, 12, 18], [5] * 4), rtol=1e-8)


def test_a_number_of_doses_may_be_a_quotient():
    run = solved(drug.with_doses(my.doses(gut, 5, every=6, count=24 / 6)), {}, size=1)
    np.testing.assert_allclose(run[blood], swallowed([0, 6, 12, 18], [5] * 4), rtol=1e-8)


def test_infusions_may_overlap():
    run = solved(drug.with_doses(my.doses(blood, dose, every=5, count=4, duration=length)),
                 {dose: 60.0, length: [2.0, 5.0, 12.0]})
    begins = 5.0 * np.arange(4)
    np.testing.assert_allclose(run[blood], [infused(begins, begins + d, 60 / d) for d in (2, 5, 12)], rtol=1e-8)


def test_what_is_available_makes_infusions_of_a_rate_shorter_and_those_of_a_duration_slower():
    of_rate = drug.with_doses(my.doses(blood, 60, at=[1, 9], rate=20, bioavailability=part))
    np.testing.assert_allclose(solved(of_rate, {part: 0.5})[blood],
                               infused(np.array([1, 9]), np.array([2.5, 10.5]), 20), rtol=1e-8)
    of_duration = drug.with_doses(my.doses(blood, 60, at=[1, 9], duration=3, bioavailability=part))
    np.testing.assert_allclose(solved(of_duration, {part: 0.5})[blood],
                               infused(np.array([1, 9]), np.array([4, 12]), 10), rtol=1e-8)


@pytest.mark.parametrize("given", [dict(), dict(duration=7)])
def test_doses_go_on_over_phases(given):
    model = drug.with_doses(my.doses(blood, 100, every=5, **given))
    whole = solved(model, {}, size=1, time=(0, 40))
    parts = solved(model, {}, size=1, time=(0, 40), phases=8, phase_length=5)
    np.testing.assert_allclose(parts[blood], whole[blood], rtol=1e-9)


def test_doses_have_derivatives():
    model = drug.with_doses(my.doses(gut, dose, every=interval, count=3, lag=lag, bioavailability=part),
                            my.doses(blood, dose, at=[1, 2.5], duration=length, lag=lag))
    values = {dose: 100.0, interval: 8.0, lag: 0.5, part: 0.7, length: 3.0}
    run = solved(model, values, free=list(values), interpreted=None)
    for name, value in values.items():
        change = 1e-5 * value * np.array([1, -1])
        ends = solved(model, {**values, name: value + change})[blood]
        np.testing.assert_allclose(run.sensitivity[blood, name], (ends[0] - ends[1]) / (change[0] - change[1]),
                                   rtol=1e-6)


def test_doses_go_into_models_from_files():
    pytest.importorskip("libsbml")
    read = my.read_sbml(file)
    times = dict(time=(0, 60), samples=21, rtol=1e-9, atol=1e-9, interpreted=True)
    own = my.solve(read, {"dose": 100.0}, **times)
    given = my.solve(read.with_doses(my.doses("gut", 100, every=12)), {"dose": 0.0}, **times)
    np.testing.assert_allclose(given["drug"][0, 1:], own["drug"][0, 1:], rtol=1e-6)
    xpp = my.read_xpp("par k=.5\nx'=-k*x\n").with_doses(my.doses("x", dose, at=[0, 1]))
    run = my.solve(xpp, {dose: 2.0}, time=(0, 2), interpreted=True, rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(run["x"], 2 * (np.exp(-1) + np.exp(-0.5)), rtol=1e-8)


def test_a_model_stays_as_it_is_where_one_with_doses_is_made_of_it():
    acts = my.accessory("acts")
    given = my.model({blood: my.where(my.time > interval, 1, 0) - elimination * blood}, accessories={acts: None},
                     initialise={acts: 0}, stops=my.stop(3, do={interval: interval + 4, acts: acts + 1}),
                     triggers=my.trigger(blood > 1, do={interval: interval + 1}))
    text = given.cpp()
    model = given.with_doses(my.doses(blood, 5, at=1)).with_doses(my.doses(blood, 7, at=2))
    assert given.cpp() == text
    at_once = given.with_doses(my.doses(blood, 5, at=1), my.doses(blood, 7, at=2))
    assert at_once.cpp() == model.cpp() != text


def test_doses_at_the_ends_of_the_time_domain_count():
    run = solved(drug.with_doses(my.doses(gut, 3, at=[0, 30])), {}, size=1)
    np.testing.assert_allclose(run[gut], 3 + 3 * np.exp(-30.0))


def test_doses_go_into_one_of_several_units():
    x, = my.units(3).states("x")
    model = my.model({x: -elimination * x}, name="units").with_doses(my.doses(x[1], 2, at=1),
                                                                     my.doses("x_2", 6, duration=3))
    run = my.solve(model, {elimination: [0.2]}, start={one: 0 for one in x}, time=(0, 5), interpreted=True, rtol=1e-10)
    np.testing.assert_allclose([run[f"x_{i}"][0] for i in range(3)],
                               [0, 2 * np.exp(-0.8), infused(np.array([0]), np.array([3]), 2, 5.0)], rtol=1e-8)


def test_an_infusion_is_multiplied_by_the_mass_of_its_state():
    model = my.model({gut: -absorption * gut, blood: 0.5 * (absorption * gut - elimination * blood)},
                     mass_matrix={blood: 0.5}).with_doses(my.doses(blood, dose, duration=2))
    slopes = model.derivatives(1.0, [0, 0], absorption=1.0, elimination=0.2, dose=3.0)
    np.testing.assert_allclose(np.linalg.solve(model.mass_matrix, slopes), [0, 1.5])


def test_a_state_without_a_derivative_gets_no_doses():
    model = my.model({gut: -absorption * gut, blood: gut - blood}, mass_matrix={blood: 0})
    with pytest.raises(my.Error, match="blood .*, whose derivative is in no equation: choose one of gut"):
        model.with_doses(my.doses(blood, 1))


def test_species_of_a_conserved_sum_get_no_doses():
    pytest.importorskip("libsbml")
    from sbml_models import compartment, document, parameter, reaction, species
    parts = [compartment("c", 1), species("S", concentration=3), species("P", concentration=0), parameter("k", 1),
             reaction("make", "S -> P", "c * k * S")]
    whole, reduced = (my.read_sbml(document(parts), reduce=reduce) for reduce in (False, True))
    run = my.solve(whole.with_doses(my.doses("S", 2, at=1)), time=(0, 3), interpreted=True, rtol=1e-10)
    np.testing.assert_allclose(run["S"] + run["P"], 5)
    with pytest.raises(my.Error, match="conserved sum conserved_P would stay as it is: read .* without reduce=True"):
        reduced.with_doses(my.doses("S", 2, at=1))


@pytest.mark.parametrize("wrong, message", [
    (lambda: my.doses(gut, [1, 2], at=[0, 1, 2]), "2 amounts at 3 times.*: give one amount, or one for each time"),
    (lambda: my.doses(gut, 1, at=[]), "1 amounts at 0 times|0 amounts at 0 times"),
    (lambda: my.doses(gut, 1, at=[3, 2]), "decrease"),
    (lambda: my.doses(gut, 1, at=[1, 2], every=3), "give one time, of the first dose, with every="),
    (lambda: my.doses(gut, 1, count=3), "count= but no interval.*: give every="),
    (lambda: my.doses(gut, 1, every=1, count=3, until=4), "give one of them"),
    (lambda: my.doses(gut, 1, rate=1, duration=2), "give one of them"),
    (lambda: drug.with_doses("gut"), "with_doses gets a str.*: make it by my.doses"),
    (lambda: drug.with_doses(my.doses(dose, 1)), "doses go into dose.*, which is no state.*: choose one of gut, blood"),
    (lambda: my.doses(gut, 1, rate=0), "rate=0 .*: give a number above zero, or leave it out for doses at once"),
    (lambda: my.doses(gut, 1, duration=-1.5), "duration=-1.5 .*: give a number above zero"),
    (lambda: my.doses(gut, 1, every=0), "every=0 .*: give a number above zero$"),
    (lambda: my.doses(gut, 1, every=2, count=2.5), "count=2.5 .*: give a whole number"),
    (lambda: drug.with_doses(my.doses("stomach", 1)), "stomach .*, which is no state .*: choose one of gut, blood"),
    (lambda: drug.with_doses(my.doses(gut, 1, at=gut)), "depend on gut: they are made of parameters"),
    (lambda: drug.with_doses(my.doses(gut, blood, duration=2)), "depend on blood: they are made of parameters"),
    (lambda: drug.with_doses(my.doses(gut, "amount")), r"amount of doses \([^(]*\): 'amount' is unknown"),
    (lambda: my.CppModel("struct m {};", "m", "x").with_doses(my.doses("x", 1)), "is not recorded"),
    (lambda: my.with_sensitivities(drug, [absorption]).with_doses(my.doses(gut, 1)), "is not recorded"),
])
def test_what_does_not_fit_is_refused(wrong, message):
    with pytest.raises(my.Error, match=message):
        wrong()


# Tables

subjects = dict(ID=[1, 1, 1, 2, 2, 3, 3], TIME=[0, 4, 12, 0, 10, 1, 2], AMT=[100, 0, 50, 80, ".", 20, 30],
                ADDL=[0, 0, 2, 0, 0, 0, 0], II=[0, 0, 6, 0, 0, 0, 0], CMT=[1, 1, 1, 1, 2, 1, 2],
                RATE=[0, 0, 0, 0, 0, 0, 10], DV=[".", 3.0, ".", ".", 5.0, ".", "."], WT=[70, 70, 70, 80, 80, 60, 60])
of_subjects = [swallowed([0, 12, 18, 24], [100, 50, 50, 50]), swallowed([0], [80]),
               swallowed([1], [20]) + infused(np.array([2.0]), np.array([5.0]), 10)]


@pytest.mark.parametrize("interpreted", [True, False])
def test_a_table_gives_each_subject_its_doses(interpreted):
    records = my.dose_table(subjects, {1: gut, 2: blood})
    run = solved(drug.with_doses(records), records.sweep, interpreted=interpreted)
    np.testing.assert_allclose(run[blood], of_subjects, rtol=1e-8)


def test_a_table_tells_covariates_observations_and_times():
    records = my.dose_table(subjects, {1: gut, 2: blood})
    assert records.ids == [1, 2, 3] and [list(end) for end in records.time] == [[0, 0, 1], [12, 10, 2]]
    np.testing.assert_array_equal(records.covariates["wt"], [70, 80, 60])
    np.testing.assert_array_equal(records.observed_times, [[4], [10], [np.nan]])
    np.testing.assert_array_equal(records.observed, [[3], [5], [np.nan]])


def test_a_table_comes_from_a_file_or_a_data_frame(tmp_path):
    pandas = pytest.importorskip("pandas")
    path = tmp_path / "subjects.csv"
    pandas.DataFrame(subjects).to_csv(path, index=False)
    of_file = my.dose_table(path, {"1": gut, "2": blood})
    of_frame = my.dose_table(pandas.DataFrame(subjects), {1: gut, 2: blood})
    assert of_file.ids == ["1", "2", "3"] and of_frame.ids == [1, 2, 3]
    for one in (of_file, of_frame):
        np.testing.assert_allclose(solved(drug.with_doses(one), one.sweep)[blood], of_subjects, rtol=1e-8)


def test_doses_of_a_table_may_come_later_and_in_part():
    records = my.dose_table(dict(time=[0, 3], amt=[10, 20]), gut, lag=lag, bioavailability=part)
    run = solved(drug.with_doses(records), {**records.sweep, lag: 0.5, part: 0.25})
    np.testing.assert_allclose(run[blood], swallowed([0.5, 3.5], [2.5, 5]), rtol=1e-8)


def test_infusions_of_a_table_may_overlap_and_go_on_over_phases():
    records = my.dose_table(dict(time=[0, 5, 6, 20], amt=[70, 70, 7, 30], dur=[7, 7, 0, 3]), blood)
    expected = infused(np.array([0, 5]), np.array([7, 12]), 10) + infused(np.array([20]), np.array([23]), 10)
    expected += 7 * np.exp(-0.2 * 24)
    for phases in (dict(), dict(phases=6, phase_length=5)):
        run = solved(drug.with_doses(records), records.sweep, **phases)
        np.testing.assert_allclose(run[blood], expected, rtol=1e-8)


def test_infusions_of_a_table_go_on_where_the_time_domain_begins_within_them():
    records = my.dose_table(dict(id=[1, 1, 2], time=[0, 6, 3], amt=[100, 20, 30], dur=[10, 2, 5]), blood, lag=lag)
    listed = drug.with_doses(my.doses(blood, 100, duration=10, lag=lag), my.doses(blood, 20, at=6, duration=2, lag=lag))
    model = drug.with_doses(records)
    for begin in (0.0, 0.5, 5.0, 6.5, 7.5, 10.5, 11.0):
        run = solved(model, {**records.sweep, lag: 0.5}, time=(begin, 12))
        alone = solved(listed, {lag: [0.5]}, time=(begin, 12))
        np.testing.assert_allclose(run[blood][0], alone[blood][0], rtol=1e-8)


def test_subjects_of_a_table_are_an_axis_of_a_grid():
    records = my.dose_table(dict(id=["a", "b"], time=[0, 3], amt=[10, 20]), gut)
    sweep = my.grid({**records.sweep, lag: [0.0, 2.0], **rates})
    model = drug.with_doses(my.doses(blood, 1, at=lag), records)
    run = my.solve(model, sweep, start={gut: 0, blood: 0}, time=(0, 30), interpreted=True, rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(sweep.unstack(run[blood]), [[swallowed([time], [amount]) + np.exp(-0.2 * (30 - late))
                                                            for late in (0, 2)] for time, amount in ((0, 10), (3, 20))],
                               rtol=1e-8)


def test_compartments_of_a_table_may_be_one_state():
    records = my.dose_table(dict(time=[0, 0, 5], amt=[1, 2, 4], cmt=["1", 2.0, "depot"]), {1: gut, "2": gut,
                                                                                         "depot": blood})
    np.testing.assert_allclose(solved(drug.with_doses(records), records.sweep)[blood],
                               swallowed([0], [3]) + 4 * np.exp(-0.2 * 25), rtol=1e-8)

def settled(interval, amount, t):
    """What is in the blood at times after a dose of many at equal intervals, by the formula of accumulation."""
    return amount / 0.8 * (np.exp(-0.2 * t) / (1 - np.exp(-0.2 * interval)) - np.exp(-t) / (1 - np.exp(-interval)))


def settled_infusion(interval, length, rate, t):
    """The same of infusions into the blood, until the next one begins."""
    before = rate / 0.2 * (np.exp(0.2 * length) - 1) * np.exp(-0.2 * interval) / (1 - np.exp(-0.2 * interval))
    during = rate / 0.2 * (1 - np.exp(-0.2 * np.minimum(t, length))) * np.exp(-0.2 * np.maximum(t - length, 0))
    return before * np.exp(-0.2 * t) + during


@pytest.mark.parametrize("interpreted", [True, False])
def test_a_dose_in_a_steady_state_comes_after_many_others(interpreted):
    records = my.dose_table(dict(id=[1, 1, 2, 2], time=[5, 9, 0, 6], amt=[100, ".", 40, "."], ii=[8, ".", 12, "."],
                                 ss=[1, 0, 1, "."], dv=[".", 1, ".", 1]), gut)
    run = solved(drug.with_doses(records), records.sweep, time=records.time, interpreted=interpreted,
                 samples=records.first[:, None] + np.array([0.5, 1.0, 4.0]))
    expected = [settled(every, amount, np.array([0.5, 1.0, 4.0])) for every, amount in ((8, 100), (12, 40))]
    np.testing.assert_allclose(run.samples["blood"], expected, rtol=1e-6)
    np.testing.assert_allclose(run["blood_end"], [settled(8, 100, 4.0), settled(12, 40, 6.0)], rtol=1e-6)
    assert list(records.first) == [5, 0] and list(records.time[0]) == [5 - 800, -1200]


def test_doses_in_a_steady_state_may_be_late_in_part_and_go_on():
    records = my.dose_table(dict(time=[0], amt=[100], ii=[8], ss=[1], addl=[1]), gut, lag=lag, bioavailability=part)
    run = solved(drug.with_doses(records), {**records.sweep, lag: 2.0, part: 0.5}, time=(records.time[0], 20.0))
    extra = swallowed([10.0], [50.0], 20.0)
    expected = settled(8, 50, 18.0) + extra
    np.testing.assert_allclose(run[blood], expected, rtol=1e-6)


@pytest.mark.parametrize("length", [3.0, 8.0, 20.0])
def test_infusions_in_a_steady_state_go_on_from_those_before(length):
    records = my.dose_table(dict(time=[0], amt=[10 * length], rate=[10], ii=[8], ss=[1]), blood)
    run = solved(drug.with_doses(records), records.sweep, time=(records.time[0], 4.0), samples=np.array([[1.0, 4.0]]))
    times = np.array([1.0, 4.0])
    np.testing.assert_allclose(run.samples["blood"][0], [
        sum(infused(np.array([-8.0 * k]), np.array([-8.0 * k + length]), 10, t) for k in range(101)) for t in times],
        rtol=1e-6)
    if length < 8:
        np.testing.assert_allclose(run.samples["blood"][0], settled_infusion(8, length, 10, times), rtol=1e-6)


def test_what_has_not_settled_is_no_steady_state():
    records = my.dose_table(dict(time=[0], amt=[100], ii=[1], ss=[1]), gut, steady_after=20)
    model = drug.with_doses(records)
    for rate, status in ((0.2, "not_finite"), (1.5, "success")):
        run = my.solve(model, {**records.sweep, absorption: 2.0, elimination: rate}, start={gut: 0, blood: 0},
                       time=(records.time[0], 1.0), interpreted=True)
        assert run.status[0] == status
    total = my.state("total")
    grows = my.model({**drug.equations, total: elimination * blood}).with_doses(records)
    run = my.solve(grows, {**records.sweep, absorption: 2.0, elimination: 1.5}, start={gut: 0, blood: 0, total: 0},
                   time=(records.time[0], 1.0), interpreted=True)
    assert run.status[0] == "not_finite"


def test_a_steady_state_may_be_one_of_a_model_that_is_not_linear():
    most, half = 20.0, 10.0  # elimination by Michaelis and Menten
    x = my.state("x")
    model = my.model({x: -most * x / (half + x)}).with_doses(records := my.dose_table(
        dict(time=[0], amt=[30], ii=[4], ss=[1]), x))
    run = my.solve(model, records.sweep, start={x: 0}, time=(records.time[0], 0.0), interpreted=True, rtol=1e-10,
                   atol=1e-10)
    high = run[x][0]  # half log(high / low) + high - low = most 4, of the implicit solution
    assert half * np.log(high / (high - 30)) + 30 == pytest.approx(most * 4, rel=1e-6)


def test_a_steady_state_has_derivatives():
    records = my.dose_table(dict(time=[0], amt=[100], ii=[8], ss=[1]), gut)
    run = solved(drug.with_doses(records), records.sweep, time=(records.time[0], 4.0), free=[elimination],
                 interpreted=None)
    change = 1e-6
    formula = [100 / (1 - ke) * (np.exp(-ke * 4) / (1 - np.exp(-ke * 8)) - np.exp(-4.0) / (1 - np.exp(-8.0)))
               for ke in (0.2 - change, 0.2 + change)]
    np.testing.assert_allclose(run.sensitivity[blood, elimination], (formula[1] - formula[0]) / (2 * change), rtol=1e-5)


def test_what_follows_a_reset_or_begins_with_a_steady_state_is_a_record_of_its_own():
    table = dict(id=["a", "a", "b", "a", "a", "b", "b"], time=[0, 4, 0, 6, 2, 3, 9], amt=[10, 0, 7, 0, 5, 20, 0],
                 evid=[1, 0, 1, 3, 1, 4, 0], dv=[".", 1.5, ".", ".", ".", ".", 2.5], wt=[60, 60, 80, 60, ".", 80, 80],
                 ss=[0] * 7, ii=[0] * 7)
    with pytest.raises(my.Error, match="row 5 .* has the time 2.0 after 6.0"):
        my.dose_table(table, gut)
    table["time"][4] = 8
    records = my.dose_table(table, gut)
    assert records.ids == ["a", "a", "b", "b"] and list(records.of_subject) == [0, 0, 1, 1]
    assert records.names == ["a from 0", "a from 6", "b from 0", "b from 3"]
    assert [list(end) for end in records.time] == [[0, 6, 0, 3], [4, 8, 0, 9]]
    np.testing.assert_array_equal(records.covariates["wt"], [60, 60, 80, 80])
    run = solved(drug.with_doses(records), records.sweep, time=(records.time[0], 30.0))
    np.testing.assert_allclose(run[blood], [swallowed([0], [10]), swallowed([8], [5]), swallowed([0], [7]),
                                            swallowed([3], [20])], rtol=1e-8)
    assert [one.name for one in my.experiments_from_table(records, of=blood)] == ["a from 0", "b from 3"]


def test_time_may_begin_again_at_a_reset():
    records = my.dose_table(dict(time=[0, 5, 0, 4], amt=[10, 0, 20, 0], evid=[1, 0, 4, 2]), gut)
    assert [list(end) for end in records.time] == [[0, 0], [5, 4]]
    run = solved(drug.with_doses(records), records.sweep, time=records.time)
    np.testing.assert_allclose(run[blood], [swallowed([0], [10], 5.0), swallowed([0], [20], 4.0)], rtol=1e-8)


def test_an_infusion_and_further_doses_end_with_a_reset():
    records = my.dose_table(dict(time=[0, 0, 7], amt=[30, 5, 0], dur=[20, 0, 0], addl=[0, 9, 0], ii=[0, 2, 0],
                                 evid=[1, 1, 3]), blood)
    run = solved(drug.with_doses(records), records.sweep, time=(records.time[0], 30.0), start={gut: 0, blood: 3})
    assert run[blood][1] == pytest.approx(3 * np.exp(-0.2 * 23), rel=1e-8)


# Covariates

weight = my.accessory("weight")
heavy = my.model({gut: -absorption * gut, blood: absorption * gut - elimination * weight * blood}, name="heavy")
changing = dict(id=[1, 1, 1, 2, 2], time=[0, 4, 10, 0, 3], amt=[0, 0, 0, 0, 0], WT=[1.0, ".", 3.0, ".", 2.0])


@pytest.mark.parametrize("carried, exponents", [
    ("forward", [1.0 * 10 + 3.0 * 20, 2.0 * 30]), ("backward", [1.0 * 4 + 3.0 * 26, 2.0 * 30])])
@pytest.mark.parametrize("phases", [dict(), dict(phases=6, phase_length=5)])
def test_covariates_that_change_are_carried(carried, exponents, phases):
    records = my.dose_table(changing, gut, over_time={weight: "wt"}, carried=carried)
    run = solved(heavy.with_doses(records), records.sweep, start={gut: 0, blood: 1.0}, atol=1e-20, **phases)
    np.testing.assert_allclose(np.log(run[blood]), -0.2 * np.array(exponents), rtol=1e-8)


def test_covariates_change_beside_doses_that_come_late():
    table = dict(time=[0, 6, 20], amt=[10, 5, 0], wt=[1, 2, 0.5])
    records = my.dose_table(table, blood, over_time={"weight": "WT"}, lag=lag)
    run = solved(heavy.with_doses(records), {**records.sweep, lag: 2.0})
    expected = 10 * np.exp(-0.2 * (4 + 2 * 14 + 0.5 * 10)) + 5 * np.exp(-0.2 * (2 * 12 + 0.5 * 10))
    np.testing.assert_allclose(run[blood], expected, rtol=1e-8)


def test_a_covariate_is_what_it_is_first_before_a_steady_state():
    table = dict(time=[0, 8], amt=[100, 0], ii=[8, 0], ss=[1, 0], wt=[2, 5])
    records = my.dose_table(table, blood, over_time={weight: "wt"})
    run = solved(heavy.with_doses(records), records.sweep, time=(records.time[0], 0.0))
    np.testing.assert_allclose(run[blood], 100 / (1 - np.exp(-0.4 * 8)), rtol=1e-6)


def test_covariates_that_cannot_be_followed_are_refused():
    with pytest.raises(my.Error, match="over_time has dose .*, which is no accessory: .* my.accessory"):
        my.dose_table(changing, gut, over_time={dose: "wt"})
    with pytest.raises(my.Error, match="no column 'age' for over_time=, but id, time, amt, wt"):
        my.dose_table(changing, gut, over_time={weight: "age"})
    with pytest.raises(my.Error, match="the subject 2 of the table of doses .* has nothing in the column 'wt'"):
        my.dose_table({**changing, "WT": [1, 1, 1, ".", "."]}, gut, over_time={weight: "wt"})
    with pytest.raises(my.Error, match="carried is 'nocb' .*: give \"forward\" or \"backward\""):
        my.dose_table(changing, gut, over_time={weight: "wt"}, carried="nocb")
    with pytest.raises(my.Error, match="steady_after is 3 .*: give the number of doses before a steady state"):
        my.dose_table(changing, gut, steady_after=3)


def test_time_does_not_go_backwards_with_doses():
    given, records = my.doses(gut, 5, at=1), my.dose_table(dict(time=[0], amt=[1]), gut)
    for one in (given, records):
        model = drug.with_doses(one)
        with pytest.raises(my.Error, match="has doses, and time goes from 30 to 0: .* let time go forwards"):
            solved(model, {"subject": 0.0} if one is records else {}, size=1, time=(np.array([30.0]), 0))
        with pytest.raises(my.Error, match="has doses, and time goes from 30 to 0"):
            my.study(model, {**rates, gut: 0, blood: 0, **records.sweep} if one is records else
                     {**rates, gut: 0, blood: 0}, time=(30, 0), interpreted=True)


def test_a_table_is_not_changed_by_a_model_that_reads_it():
    records = my.dose_table(dict(time=[0], amt=[10]), gut, bioavailability="absorption")
    for bioavailability in (my.parameter("absorption"), my.shared("absorption")):
        other = my.model({gut: -bioavailability * gut}).with_doses(records)
        run = my.solve(other, {**records.sweep, bioavailability: 0.5}, start={gut: 0}, time=(0, 1), interpreted=True)
        np.testing.assert_allclose(run[gut], 5 * np.exp(-0.5), rtol=1e-6)


def test_what_a_table_adds_for_infusions_is_no_result():
    records = my.dose_table(dict(time=[0], amt=[10], dur=[2]), gut)
    run = solved(drug.with_doses(records), records.sweep)
    assert [name for name in run if name.endswith("_end") and name != "t_end"] == ["gut_end", "blood_end"]


def test_missing_values_of_pandas_are_missing():
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame(dict(time=[0.0, 1.0], amt=pandas.array([5, None], dtype="Int64"), dv=[None, 2.0]))
    records = my.dose_table(table, gut)
    assert records.observed.tolist() == [[2.0]]
    np.testing.assert_allclose(solved(drug.with_doses(records), records.sweep)[blood], swallowed([0], [5]), rtol=1e-8)


def test_the_doses_of_a_table_are_counted_by_a_letter_that_no_component_has():
    n = my.state("n")
    model = my.model({n: -n}).with_doses(my.dose_table(dict(time=[0], amt=[10]), n))
    stop = next(line for line in model.latex().split("\n") if "stop" in line)
    assert "+ i < " in stop and r", \; i = 0, 1, \ldots \; \Rightarrow \; n \leftarrow n + " in stop


def test_tables_with_other_rows_need_no_other_kernel():
    first, second = (my.dose_table(dict(id=[1, 1, 2], time=[0, k, 3], amt=[k, 20, 5]), gut) for k in (1, 2))
    assert drug.with_doses(first).cpp() == drug.with_doses(second).cpp()


def test_a_subject_may_have_no_dose():
    records = my.dose_table(dict(id=["b", "a"], time=[0, 0], amt=[0, 8], dv=[1, "."]), gut)
    np.testing.assert_allclose(solved(drug.with_doses(records), records.sweep)[blood], [0, swallowed([0], [8])],
                               rtol=1e-8)


# What must hold of the order of rows, of records and of names


@pytest.mark.parametrize("begin", [0.0, -6.0, 594.0])
def test_an_observation_sees_the_doses_above_it_at_its_time_and_not_those_below(begin):
    table = dict(time=begin + np.array([0, 0, 6, 6, 6, 12, 12]), amt=[10, 0, 0, 5, 0, 7, 0],
                 dv=[".", 1, 1, ".", 1, ".", 1])
    records = my.dose_table(table, blood)
    run = solved(drug.with_doses(records), records.sweep, time=records.time, samples=records.observed_times)
    at_6 = 10 * np.exp(-1.2)
    expected = [10, at_6, at_6 + 5, (at_6 + 5) * np.exp(-1.2) + 7]
    np.testing.assert_allclose(run.samples["blood"][0], expected, rtol=1e-8)
    np.testing.assert_allclose(records.observed_times[0], begin + np.array([0, 6, 6, 12]), rtol=0, atol=1e-9)


def test_an_observation_at_the_only_time_of_a_record_sees_the_dose_above_it():
    records = my.dose_table(dict(time=[0, 0], amt=[10, 0], dv=[".", 1]), blood)
    run = solved(drug.with_doses(records), records.sweep, time=records.time, samples=records.observed_times)
    np.testing.assert_allclose(run.samples["blood"], [[10]], rtol=1e-8)


def test_an_observation_sees_the_dose_in_a_steady_state_above_it():
    records = my.dose_table(dict(time=[0, 0], amt=[10, 0], ii=[8, 0], ss=[1, 0], dv=[".", 1]), blood)
    run = solved(drug.with_doses(records), records.sweep, time=records.time, samples=records.observed_times)
    np.testing.assert_allclose(run.samples["blood"], [[10 / (1 - np.exp(-1.6))]], rtol=1e-6)


@pytest.mark.parametrize("begin", [0.0, -3.0])
@pytest.mark.parametrize("carried", ["forward", "backward"])
def test_a_dose_has_the_covariates_of_its_own_row(carried, begin):
    table = dict(time=[0, 10, 20, 25], amt=[10, 10, 10, 0], wt=[1, 2, 3, 4])
    records = my.dose_table(table, blood, bioavailability=weight, over_time={weight: "wt"}, carried=carried)
    model = drug.with_doses(records)
    for phases in (dict(), dict(phases=4, phase_length=5 - begin / 4)):
        run = solved(model, records.sweep, time=(begin, 20), **phases)
        expected = 10 * (np.exp(-0.2 * 20) + 2 * np.exp(-0.2 * 10) + 3)
        np.testing.assert_allclose(run[blood], expected, rtol=1e-8)


@pytest.mark.parametrize("carried", ["forward", "backward"])
def test_doses_have_the_covariates_of_their_row_whichever_are_added_first(carried):
    acts = my.model({blood: -elimination * weight * blood}, stops=my.stop(2, do={blood: blood + weight}))
    records = my.dose_table(dict(time=[0, 2, 4], amt=[0, 0, 0], wt=[1, 2, 3]), blood, over_time={weight: "wt"},
                            carried=carried)
    given = my.doses(blood, weight, at=[0, 2])
    runs = [my.solve(model, {"subject": 0.0, elimination: 0.2}, start={blood: 0}, time=(0, 3), interpreted=True,
                     rtol=1e-10)[blood] for model in (
        acts.with_doses(records, given), acts.with_doses(given, records), acts.with_doses(records).with_doses(given),
        acts.with_doses(given).with_doses(records))]
    first, second = (1, 2) if carried == "forward" else (2, 3)
    np.testing.assert_allclose(runs, (np.exp(-0.4 * first) + 4) * np.exp(-0.2 * second) + np.zeros((4, 1)), rtol=1e-8)


def test_a_lag_that_changes_over_time_is_refused():
    table = dict(time=[0, 10, 12], amt=[10, 10, 0], wt=[1, 5, 1])
    records = my.dose_table(table, blood, lag=0.1 * weight, over_time={weight: "wt"})
    with pytest.raises(my.Error, match="the lag of doses .* depends on weight, which changes over time, .*: let it"):
        heavy.with_doses(records)
    covariates = my.dose_table(table, gut, over_time={weight: "wt"})
    for first, second in ((my.dose_table(table | dict(wt=[1, 1, 1]), blood, lag=weight), covariates),
                          (covariates, my.doses(blood, 1, lag=weight))):
        with pytest.raises(my.Error, match="the lag of doses .* depends on weight"):
            heavy.with_doses(first, second)
    late = heavy.with_doses(my.dose_table(table | dict(wt=[1, 1, 1]), blood, lag=weight))
    with pytest.raises(my.Error, match="the lag of doses .* depends on weight"):
        late.with_doses(covariates)
    acts = my.model({blood: -elimination * blood}, stops=my.stop(3, do={lag: 2.0}))
    with pytest.raises(my.Error, match="the lag of doses .* depends on lag, which changes over time"):
        acts.with_doses(my.dose_table(dict(time=[0], amt=[1]), blood, lag=lag))


@pytest.mark.parametrize("rows", [dict(), dict(dur=[0, 2, 0, 3])])
def test_an_instance_whose_number_no_record_has_is_no_success(rows):
    records = my.dose_table(dict(id=[1, 1, 2, 3], time=[0, 3, 1, 0], amt=[10, 5, 20, 7], **rows), blood)
    numbers = [0.0, 1.0, 2.0, 3.0, 4.0, 101.0, -1.0, 0.5]
    run = solved(drug.with_doses(records), {"subject": numbers})
    assert list(run.status) == ["success"] * 3 + ["not_finite"] * 5


def test_a_record_that_is_not_there_has_no_covariates():
    records = my.dose_table(changing, gut, over_time={weight: "wt"})
    run = solved(heavy.with_doses(records), {"subject": [0.0, 1.0, 2.0]}, start={gut: 0, blood: 1})
    assert list(run.status) == ["success", "success", "not_finite"]


def test_a_state_that_the_model_sets_at_the_start_gets_the_doses_of_a_table():
    begins = my.model({blood: -elimination * blood}, initialise={blood: 3.0})
    for tables in (1, 2):
        records = [my.dose_table(dict(time=[1], amt=[10]), blood) for _ in range(tables)]
        run = my.solve(begins.with_doses(*records), {elimination: 0.2, **records[0].sweep}, start={blood: 0},
                       time=(0, 5), interpreted=True, rtol=1e-10)
        np.testing.assert_allclose(run[blood], 3 * np.exp(-1) + tables * 10 * np.exp(-0.8), rtol=1e-8)


@pytest.mark.parametrize("begin, status", [
    (-800.0, "success"), (-900.0, "success"), (-799.0, "not_finite"), (-401.0, "not_finite"), (-399.0, "not_finite"),
    (-8.0, "not_finite"), (-5.0, "not_finite"), (0.0, "not_finite")])
def test_a_steady_state_needs_a_time_domain_with_the_doses_before_it(begin, status):
    records = my.dose_table(dict(time=[0], amt=[10], ii=[8], ss=[1]), blood)
    run = solved(drug.with_doses(records), records.sweep, time=(begin, 4))
    assert run.status[0] == status
    if status == "success":
        np.testing.assert_allclose(run[blood], 10 * np.exp(-0.8) / (1 - np.exp(-1.6)), rtol=1e-6)


def test_a_component_subject_of_the_models_own_is_refused():
    number = my.parameter("subject")
    own = my.model({blood: -number * blood}, name="own")
    records = my.dose_table(dict(time=[0], amt=[10]), blood)
    with pytest.raises(my.Error, match="own has a component 'subject'.* needs for the number of its record: rename"):
        own.with_doses(records)
    both = drug.with_doses(records).with_doses(my.dose_table(dict(time=[1], amt=[5]), gut))
    run = solved(both, records.sweep)
    np.testing.assert_allclose(run[blood], 10 * np.exp(-6) + swallowed([1], [5]), rtol=1e-8)


def test_an_accessory_over_time_that_the_model_has_not_is_refused():
    records = my.dose_table(changing, gut, over_time={my.accessory("wieght"): "wt"})
    with pytest.raises(my.Error, match="over_time has wieght.*no accessory of the model heavy: name one that it reads"):
        heavy.with_doses(records)


def test_steady_states_at_one_time_have_names_of_their_own():
    records = my.dose_table(dict(time=[0, 0, 9], amt=[100, 60, 0], cmt=[1, 2, "."], ss=[1, 1, 0], ii=[6, 6, 0]),
                            {1: gut, 2: blood})
    assert records.names == ["1 from 0", "1 from 0, 2"]


@pytest.mark.parametrize("columns, message", [
    (dict(amt=[1]), "no column 'time'"),
    (dict(time=[0, 1], amt=[1]), "have 1 or 2 rows"),
    (dict(time=[], amt=[]), "have 0 rows"),
    (dict(time=0, amt=[1]), "is no table.*: give a data frame, a dict with a list for each column"),
    (dict(time=[0], TIME=[1], amt=[1]), "two columns of one name"),
    ("no_such.csv", "'no_such.csv', the file of the table of doses .*, cannot be read"),
    (dict(id=[1, None], time=[0, 0], amt=[1, 1]), "row 2 .* has no id"),
    (dict(time=[0, "."], amt=[1, 1]), "row 2 .* has the time nan: give a finite number"),
    (dict(time=[0, 2, 1], amt=[1, 1, 1]), r"row 3 .* has the time 1.0 after 2.0: sort the rows"),
    (dict(time=[0], amt=["much"]), "row 1 .* has 'much' in the column 'amt'"),
    (dict(time=[0], amt=[1], ss=[2], ii=[12]), "ss 2, a sum .* which only linear models have: give the doses"),
    (dict(time=[0], amt=[1], ss=[5], ii=[12]), "ss 5: 0 and 1 are known"),
    (dict(time=[0], amt=[1], ss=[1]), "ss 1 and ii 0: give the interval of doses in ii"),
    (dict(time=[0], amt=[0], rate=[5], ss=[1]), "a constant infusion .*: give as the amount the rate times ii"),
    (dict(time=[0], amt=[1], evid=[7]), "evid 7: 0 to 4 are known"),
    (dict(time=[0], amt=[0], evid=[1]), "a dose of 0: give an amount above zero"),
    (dict(time=[0, 0, 0], amt=[5, 0, 5], dv=[".", 1, "."]), "row 3 .* is a dose below an observation that has another"),
    (dict(time=[0], amt=[5], evid=[0]), "row 1 .* has evid 0, which is no dose, and the amount 5: give evid 1, or"),
    (dict(time=[0], amt=[-1]), "a dose of -1: give an amount above zero"),
    (dict(time=[0], amt=[np.inf]), "a dose of inf: give an amount above zero"),
    (dict(time=[0], amt=[1], dur=[np.inf]), "infinite"),
    (dict(time=[0], amt=[1], addl=[-1], ii=[2]), "addl -1: give the number of further doses"),
    (dict(time=[0], amt=[1], addl=[1.5], ii=[2]), "addl 1.5: give the number of further doses"),
    (dict(time=[0], amt=[1], sex=["f"]), "'f' in the column 'sex': give a number, or leave the column out"),
    (dict(time=[0], amt=[1], rate=[-2]), "the rate -2, below zero, which parameters would decide: write it"),
    (dict(time=[0], amt=[1], rate=[2], dur=[2]), "both rate and dur"),
    (dict(time=[0], amt=[1], addl=[3]), "addl 3 and ii 0: give the interval of doses in ii"),
    (dict(time=[0, 1], amt=[1, 1], age=[50, 51]), "'age' .* changes .* '1', from 50 to 51: name it in over_time="),
])
def test_rows_that_cannot_be_read_are_refused_by_their_number(columns, message):
    with pytest.raises(my.Error, match=message):
        my.dose_table(columns, gut)


def test_a_dose_into_an_unknown_compartment_is_refused():
    for unknown in (3, "gut", None):
        with pytest.raises(my.Error, match=f"row 2 .* has cmt {unknown!r}: `into` has 1, 2"):
            my.dose_table(dict(time=[0, 1], amt=[1, 1], cmt=[1, unknown]), {1: gut, 2: blood})


@pytest.mark.parametrize("into", [[gut, blood], {}])
def test_a_table_needs_states(into):
    with pytest.raises(my.Error, match=r"give one state, or a dict \{cmt: state\}"):
        my.dose_table(dict(time=[0], amt=[1]), into)


def test_a_table_with_infusions_has_no_bioavailability():
    with pytest.raises(my.Error, match="has the bioavailability"):
        my.dose_table(dict(time=[0], amt=[1], dur=[1]), gut, bioavailability=part)


def test_the_observations_of_a_table_are_fitted_with_the_doses_of_each_subject():
    times, generator = np.array([1.0, 3.0, 8.0, 13.0, 20.0, 30.0]), np.random.default_rng(1)
    rows = {name: [] for name in ("id", "time", "amt", "cmt", "rate", "dv")}
    for subject, (amounts, rate) in enumerate((([100.0, 50.0], 0.0), ([80.0, 80.0], 20.0), ([30.0, 60.0], 0.0))):
        given = sorted([(at, amount, np.nan) for at, amount in zip((0.0, 12.0), amounts)] +
                       [(at, np.nan, True) for at in times], key=lambda row: row[0])
        for at, amount, seen in given:
            value = sum(infused(np.array([t]), np.array([t + a / rate]), rate, at) if rate else swallowed([t], [a], at)
                        for t, a in zip((0.0, 12.0), amounts) if t < at)
            dv = value * np.exp(0.01 * generator.standard_normal()) if seen is True else np.nan
            row = (f"S{subject}", at, amount, 2 if rate else 1, rate if amount > 0 else np.nan, dv)
            for name, cell in zip(rows, row):
                rows[name].append(cell)
    records = my.dose_table(rows, {1: gut, 2: blood})
    experiments = my.experiments_from_table(records, of=blood)
    fit = my.fit(drug.with_doses(records), experiments, start={gut: 0, blood: 0}, starts=8, seed=1,
                 free={absorption: (0.1, 10, "log"), elimination: (0.01, 1, "log")},
                 sigma=my.noise_models.proportional(0.01))
    np.testing.assert_allclose([fit.best["absorption"], fit.best["elimination"]], [1.0, 0.2], rtol=0.02)


def test_observations_of_a_table_need_a_name():
    records = my.dose_table(subjects, {1: gut, 2: blood})
    with pytest.raises(my.Error, match="give of=x"):
        my.experiments_from_table(records)
    with pytest.raises(my.Error, match="no observations.*in a column dv"):
        my.experiments_from_table(my.dose_table(dict(time=[0], amt=[1]), gut), of=blood)
