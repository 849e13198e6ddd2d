# SPDX-License-Identifier: MIT
"""Problems of PEtab, written as files, compared with closed forms and with petab's own likelihood; what is not
supported is refused with its place in the tables."""

import numpy as np
import pytest

import myriad_ode as my

v1 = pytest.importorskip("petab.v1")
import sbml_models as sbml  # noqa: E402, which needs libsbml
from differences import by_differences  # noqa: E402

# A is lost at the rate k and made at the rate b: A = b / k + (A0 - b / k) exp(-k t).
K, SCALE, B, A0 = 0.7, 2.5, 0.2, 3.0
TIMES = np.linspace(0, 6, 13)
tight = {"rtol": 1e-11, "atol": 1e-11}


def level(t, k=K, b=B, a0=A0):
    return b / k + (a0 - b / k) * np.exp(-k * t)


def table(text):
    """A table whose columns are divided by spaces in the text; - is an empty cell."""
    return "\n".join("\t".join("" if cell == "-" else cell.replace("_of_", " ") for cell in line.split())
                     for line in text.strip().splitlines()) + "\n"


TABLES = {
    "parameters": table("""
parameterId parameterScale lowerBound upperBound nominalValue estimate
k           log10          0.01       10         0.5          1
scale       lin            0.1        20         1            1
b           lin            0          1          0.2          0"""),
    "conditions": table("conditionId A\nusual 3"),
    "observables": table("""
observableId observableFormula noiseFormula
seen         scale*A           noiseParameter1_seen
logged       log(A)            0.02"""),
}


def measurements(noise=0.0):
    random = np.random.default_rng(5)
    rows = ["observableId simulationConditionId time measurement noiseParameters"]
    few = TIMES[1::2]
    for name, times, values in (("seen", TIMES, SCALE * level(TIMES)), ("logged", few, np.log(level(few)))):
        values = values + noise * random.standard_normal(times.size)
        rows += [f"{name} usual {t} {v} {0.1 + 0.01 * t if name == 'seen' else '-'}" for t, v in zip(times, values)]
    return table("\n".join(rows))


def document(*elements, rate="k"):
    return sbml.document([sbml.compartment("c", 2.0), sbml.species("A", concentration=1.0), sbml.parameter(rate, 9.0),
                          sbml.parameter("b", 9.0), *elements, sbml.reaction("loss", "A ->", f"{rate} * A * c"),
                          sbml.reaction("making", "-> A", "b * c")])


def write(folder, model=None, **tables):
    """A problem's files; returns the path of its YAML."""
    (folder / "model.xml").write_text(model or document())
    for name, text in {**TABLES, "measurements": measurements(), **tables}.items():
        (folder / f"{name}.tsv").write_text(text)
    (folder / "problem.yaml").write_text("""format_version: 1
parameter_file: parameters.tsv
problems:
  - sbml_files: [model.xml]
    condition_files: [conditions.tsv]
    measurement_files: [measurements.tsv]
    observable_files: [observables.tsv]
""")
    return folder / "problem.yaml"


def petabs_likelihood(path, problem, values, **options):
    """petab's own logarithm of the likelihood, from a simulation of ours."""
    theirs = v1.Problem.from_yaml(str(path))
    theirs.parameter_df.loc[list(problem.free), "nominalValue"] = values
    with plain_numbers():
        return v1.calculate_llh(theirs.measurement_df, problem.simulate(values, **options), theirs.observable_df,
                                theirs.parameter_df)


def plain_numbers():
    """petab writes numbers into formulas by `repr`, which NumPy 2 writes with their types."""
    return np.printoptions(legacy="1.21")


def test_a_problem_is_fitted_to_what_made_its_measurements(tmp_path):
    problem = my.read_petab(write(tmp_path))
    assert problem.free == {"k": (0.01, 10.0, "log"), "scale": (0.1, 20.0)}
    assert problem.nominal == {"k": 0.5, "scale": 1.0}
    assert repr(problem) == "<myriad_ode.PetabProblem of 19 measurements, to estimate k, scale>"
    fit = problem.fit(starts=8, **tight)
    np.testing.assert_allclose([fit.best["k"], fit.best["scale"]], [K, SCALE], rtol=1e-7)
    assert fit.variance == 1 and fit.notes == []


def test_a_problem_is_read_fitted_profiled_and_a_function_for_others(tmp_path, monkeypatch):
    write(tmp_path, measurements=measurements(noise=0.02))
    monkeypatch.chdir(tmp_path)
    # snippet: petab
    problem = my.read_petab("problem.yaml")
    fit = problem.fit(starts=8)
    print(fit)                           # the best values with confidence intervals
    profile = fit.profile()              # profile likelihoods
    fit.waterfall()                      # the losses of all starts, as a picture

    objective = problem.likelihood()     # for other optimisers and samplers
    values = [fit.best[name] for name in objective.names]
    loss, gradient = objective.loss(values), objective.gradient(values)
    # end of snippet
    assert abs(loss / fit.loss[fit.index] - 1) < 1e-9 and np.abs(gradient * values).max() < 1e-2
    assert all(low < true < high for (low, high), true in zip(profile.intervals.values(), (K, SCALE)))


def test_known_noise_leaves_a_sum_of_squares_that_is_petabs(tmp_path):
    path = write(tmp_path, measurements=measurements(noise=0.1))
    problem = my.read_petab(path)
    theirs = v1.Problem.from_yaml(str(path))
    simulated = problem.simulate([0.6, 2.0], **tight)
    x = level(simulated["time"].to_numpy(), k=0.6)
    np.testing.assert_allclose(simulated["simulation"], np.where(simulated["observableId"] == "seen", 2.0 * x,
                                                                 np.log(x)), rtol=1e-9)
    with plain_numbers():
        chi2 = v1.calculate_chi2(theirs.measurement_df, simulated, theirs.observable_df, theirs.parameter_df)
    likelihood = problem.likelihood(**tight)
    residuals = likelihood.residuals([0.6, 2.0])
    assert residuals @ residuals == pytest.approx(chi2, rel=1e-9)
    assert likelihood.labels[0] == ("seen", "usual", 0.0) and len(likelihood.labels) == 19
    assert likelihood.log_likelihood([0.6, 2.0]) == pytest.approx(petabs_likelihood(path, problem, [0.6, 2.0], **tight),
                                                                  rel=1e-9)
    np.testing.assert_allclose(likelihood.jacobian([0.6, 2.0]),
                               by_differences(likelihood.residuals, np.array([0.6, 2.0])), rtol=1e-6, atol=1e-6)


# Two conditions, of which one sets a parameter to what is estimated and begins at an initial value that is.
SEVERAL = {
    "parameters": table("""
parameterId parameterScale lowerBound upperBound nominalValue estimate
k           log10          0.01       10         0.5          1
k_fast      log            0.01       10         1.5          1
begin       lin            0.1        20         2            1
gain        lin            0.1        20         1.5          1
offset      lin            0          1          0.3          0
error       log10          1e-3       10         0.2          1
share       lin            1e-3       1          0.1          1"""),
    "conditions": table("""
conditionId k_used A      b
slow        k      3      0.2
fast        k_fast begin  0.4"""),
    "observables": table("""
observableId observableFormula                                  noiseFormula               observableTransformation
seen         observableParameter1_seen*A+observableParameter2_seen noiseParameter1_seen+share      lin
logged       2*A+1                                              noiseParameter1_logged     log10
natural      A+time/10                                          error                      log"""),
}


def several(seed=7):
    random = np.random.default_rng(seed)
    rows = ["observableId simulationConditionId time measurement observableParameters noiseParameters"]
    for name, observable, noise in (("seen", "gain;offset", "error"), ("seen", "2;0", "0.3"), ("logged", "-", "0.1"),
                                    ("logged", "-", "error"), ("natural", "-", "-")):
        for condition, times in (("slow", [0, 1, 2.5, 6]), ("fast", [0.5, 1, 3])):
            rows += [f"{name} {condition} {t} {random.uniform(0.5, 4)} {observable} {noise}" for t in times]
    return table("\n".join(rows))


@pytest.fixture
def several_conditions(tmp_path):
    return write(tmp_path, document(rate="k_used"), measurements=several(), **SEVERAL)


def test_the_likelihood_of_conditions_overrides_and_estimated_noise_is_petabs(several_conditions):
    problem = my.read_petab(several_conditions)
    assert repr(problem) == ("<myriad_ode.PetabProblem of 35 measurements at 2 conditions, to estimate k, k_fast, "
                             "begin, gain, error, share>")
    simulated = problem.simulate(**tight)
    t, fast = simulated["time"].to_numpy(float), (simulated["simulationConditionId"] == "fast").to_numpy()
    a = np.where(fast, level(t, 1.5, 0.4, 2.0), level(t, 0.5, 0.2, 3.0))
    first = (simulated["observableParameters"] == "gain;offset").to_numpy()
    expected = {"seen": np.where(first, 1.5 * a + 0.3, 2 * a), "logged": 2 * a + 1, "natural": a + t / 10}
    np.testing.assert_allclose(simulated["simulation"], np.choose(
        [list(expected).index(o) for o in simulated["observableId"]], list(expected.values())), rtol=1e-9)
    likelihood = problem.likelihood(**tight)
    sets = np.array([list(problem.nominal.values()), [0.9, 0.8, 4.0, 0.7, 0.4, 0.05]])
    both = likelihood.log_likelihood(sets)
    for values, ours in zip(sets, both):
        assert ours == pytest.approx(petabs_likelihood(several_conditions, problem, values, **tight), rel=1e-9)
        assert likelihood.log_likelihood(values) == pytest.approx(ours, rel=1e-12)
        assert likelihood.loss(values) == pytest.approx(-ours, rel=1e-7)
    with pytest.raises(my.Error, match="the likelihood is no sum of squares"):
        likelihood.residuals(sets[0])


def test_the_gradient_of_the_likelihood_is_that_of_differences(several_conditions):
    likelihood = my.read_petab(several_conditions).likelihood(**tight)
    at = np.array([0.9, 0.8, 4.0, 0.7, 0.4, 0.05])
    np.testing.assert_allclose(likelihood.gradient(at), by_differences(likelihood.loss, at), rtol=1e-6)
    noise = [label for label in likelihood.labels if label[0] == "noise"]
    assert len(likelihood.labels) == likelihood.evaluate(at)[1].shape[1] == 35 + len(noise)
    assert len(noise) == 7 * 4  # of all but the 7 whose noise is the number 0.1


def test_a_fit_of_the_noise_is_where_the_gradient_of_petabs_likelihood_is_zero(several_conditions):
    problem = my.read_petab(several_conditions)
    fit = problem.fit(starts=10, **tight)
    best = np.array(list(fit.best.values()))
    inside = [i for i, name in enumerate(fit.best) if name not in fit.at_bound]
    slope = by_differences(lambda v: petabs_likelihood(several_conditions, problem, v, **tight), best)
    np.testing.assert_allclose((slope * best)[inside], 0, atol=1e-4)
    assert fit.status.count("converged") >= 8


def test_noise_may_depend_on_the_model(tmp_path):
    path = write(tmp_path, observables=TABLES["observables"].replace("0.02", "0.02+scale*A/10"))
    problem = my.read_petab(path)
    likelihood, at = problem.likelihood(**tight), np.array([0.6, 2.0])
    simulated = problem.simulate(at, **tight)
    a = level(simulated["time"].to_numpy(float), 0.6)
    r = (simulated["simulation"] - problem.measurements["measurement"]).to_numpy()
    deviation = np.where(simulated["observableId"] == "logged", 0.02 + 0.2 * a,
                         0.1 + 0.01 * simulated["time"].to_numpy(float))
    expected = np.sum(0.5 * (r / deviation)**2 + np.log(deviation * np.sqrt(2 * np.pi)))
    assert likelihood.loss(at) == pytest.approx(expected, rel=1e-7)
    np.testing.assert_allclose(likelihood.gradient(at), by_differences(likelihood.loss, at), rtol=1e-6)


def test_estimated_noise_is_the_root_mean_square_of_the_residuals(tmp_path):
    # Of n measurements sigma^2 = sum of r^2 / n, and its standard error is sigma / sqrt(2 n).
    path = write(tmp_path, measurements=measurements(noise=0.1),
                 parameters=TABLES["parameters"] + "error\tlog10\t0.001\t10\t1\t1\n",
                 observables=table("""
observableId observableFormula noiseFormula
seen         scale*A           error*noiseParameter1_seen/noiseParameter1_seen
logged       A                 1e9"""))
    problem = my.read_petab(path)
    fit = problem.fit(starts=6, **tight)
    simulated = problem.simulate(list(fit.best.values()), **tight)
    there = (simulated["observableId"] == "seen").to_numpy()
    r = (simulated["simulation"] - problem.measurements["measurement"]).to_numpy()[there]
    assert fit.best["error"] == pytest.approx(np.sqrt(np.mean(r**2)), rel=1e-6)
    assert fit.standard_errors["error"] == pytest.approx(fit.best["error"] / np.sqrt(2 * r.size), rel=1e-6)
    assert fit.iterations[fit.index] < 30 and fit.notes == []
    profile = fit.profile("error")  # the likelihood is not quadratic, and the interval not symmetric
    low, high = profile.intervals["error"]
    least = fit.loss[fit.index]
    for end in (low, high):  # log(s / s0) + (s0^2 / s^2 - 1) / 2 per measurement, and little of what else moves
        rise = r.size * (np.log(end / fit.best["error"]) + 0.5 * (fit.best["error"]**2 / end**2 - 1))
        assert rise == pytest.approx(0.5 * 1.959964**2, rel=1e-3)
    assert least == pytest.approx(-problem.likelihood(**tight).log_likelihood(list(fit.best.values())), rel=1e-7)


@pytest.mark.parametrize("kind, parameters, density", [
    ("normal", "0.9;0.2", lambda stats, k: stats.norm.logpdf(k, 0.9, 0.2)),
    ("parameterScaleNormal", "-0.1;0.05", lambda stats, k: stats.norm.logpdf(np.log10(k), -0.1, 0.05)),
    ("logNormal", "-0.2;0.3", lambda stats, k: stats.norm.logpdf(np.log(k), -0.2, 0.3) - np.log(k)),
    ("laplace", "0.9;0.2", lambda stats, k: stats.laplace.logpdf(k, 0.9, 0.2)),
    ("parameterScaleLaplace", "-0.1;0.05", lambda stats, k: stats.laplace.logpdf(np.log10(k), -0.1, 0.05)),
    ("logLaplace", "-0.2;0.3", lambda stats, k: stats.laplace.logpdf(np.log(k), -0.2, 0.3) - np.log(k)),
])
def test_a_prior_adds_the_logarithm_of_its_density(tmp_path, kind, parameters, density):
    stats = pytest.importorskip("scipy.stats")
    plain = my.read_petab(write(tmp_path)).likelihood(**tight)
    table_of = PARAMETERS.replace("0.5\t1\n", f"0.5\t1\t{kind}\t{parameters}\n")
    likelihood = my.read_petab(write(tmp_path, parameters=table_of)).likelihood(**tight)
    for k in (0.4, 0.7, 1.2):
        assert likelihood.loss([k, 2.0]) == pytest.approx(plain.loss([k, 2.0]) - density(stats, k), rel=1e-9)
    at = np.array([0.6, 2.0])
    np.testing.assert_allclose(likelihood.gradient(at), by_differences(likelihood.loss, at), rtol=1e-6)
    assert likelihood.labels[-1] == ("prior", "k")


@pytest.mark.parametrize("scale", ["lin", "log", "log10"])
def test_noise_of_laplaces_distribution_is_petabs(tmp_path, scale):
    observables = table(f"""observableId observableFormula noiseFormula noiseDistribution observableTransformation
seen scale*A noiseParameter1_seen laplace {scale}
logged log(A,2) 0.02 normal lin""")
    parameters = TABLES["parameters"] + "error\tlog10\t0.01\t10\t1\t1\n"
    rows = [row.rsplit("\t", 1)[0] + "\terror" if row.startswith("seen") else row
            for row in measurements(0.05).splitlines()]
    problem = my.read_petab(write(tmp_path, observables=observables, parameters=parameters,
                                  measurements="\n".join(rows)))
    likelihood, at = problem.likelihood(interpreted=True, **tight), np.array([0.65, 2.3, 0.14])
    simulated = problem.simulate(at, interpreted=True, **tight)
    np.testing.assert_allclose(simulated["simulation"][13:], np.log2(level(TIMES[1::2], k=0.65)), rtol=1e-8)
    expected = petabs_likelihood(tmp_path / "problem.yaml", problem, at, interpreted=True, **tight)
    assert likelihood.log_likelihood(at) == pytest.approx(expected, rel=1e-9)
    assert likelihood.loss(at) == pytest.approx(-expected, rel=1e-9)
    np.testing.assert_allclose(likelihood.gradient(at), by_differences(likelihood.loss, at, 1e-5), rtol=1e-6)


def test_a_fit_to_noise_of_laplaces_distribution_comes_near_the_median(tmp_path):
    # of several values of one quantity, whose most likely width is their mean distance from it; at the kink it is slow
    values = np.array([0.7, 0.8, 1.0, 1.3, 2.9])
    problem = my.read_petab(write(
        tmp_path, observables="observableId\tobservableFormula\tnoiseFormula\tnoiseDistribution\n"
        "level\tscale+0*A\twidth\tlaplace\n", parameters=table("""
parameterId parameterScale lowerBound upperBound nominalValue estimate
scale lin 0.1 20 5 1
width lin 0.01 9 1 1"""), measurements="observableId\tsimulationConditionId\ttime\tmeasurement\n" + "".join(
            f"level\tusual\t1\t{v}\n" for v in values)))
    fit = problem.fit(starts=4, interpreted=True)
    assert fit.best["scale"] == pytest.approx(1.0, abs=1e-3)
    assert fit.best["width"] == pytest.approx(np.abs(values - 1.0).mean(), rel=0.03)


def test_a_uniform_prior_is_a_bound(tmp_path):
    problem = my.read_petab(write(tmp_path, parameters=PARAMETERS.replace(
        "0.5\t1\n", "0.5\t1\tparameterScaleUniform\t-1;3\n").replace("1\t1\n", "1\t1\tuniform\t0;5\n")))
    assert problem.free == {"k": (0.1, 10.0, "log"), "scale": (0.1, 5.0)}


def test_a_condition_sets_parameters_and_compartments(tmp_path):
    problem = my.read_petab(write(tmp_path, conditions=table("conditionId A b c\nusual b 0.4 3"),
                                  parameters=TABLES["parameters"].replace("b\tlin\t0\t1\t0.2\t0\n", "")))
    simulated = problem.simulate([K, SCALE], **tight)["simulation"].to_numpy()
    np.testing.assert_allclose(simulated[:13], SCALE * level(TIMES, b=0.4, a0=0.4), rtol=1e-8)


def test_an_empty_cell_of_a_condition_leaves_the_value_of_the_file(tmp_path):
    rows = measurements().splitlines()
    problem = my.read_petab(write(tmp_path, conditions=table("conditionId A\nusual 3\nother -"),
                                  measurements="\n".join([*rows, *(r.replace("usual", "other") for r in rows[1:])])))
    simulated = problem.simulate([K, SCALE], **tight)["simulation"].to_numpy()
    np.testing.assert_allclose(simulated[:13], SCALE * level(TIMES), rtol=1e-8)
    np.testing.assert_allclose(simulated[19:32], SCALE * level(TIMES, a0=1), rtol=1e-8)
    assert problem.likelihood().run([K, SCALE]).size == 2


def test_initial_values_and_parameters_that_follow_from_what_is_estimated_have_its_derivatives(tmp_path):
    # b = k / 4, and A begins at 2 k + b.
    model = document(sbml.initially("b", "k / 4"), sbml.initially("A", "2 * k + b"))
    problem = my.read_petab(write(tmp_path, model, conditions="conditionId\nusual\n",
                                  parameters=TABLES["parameters"].replace("b\tlin\t0\t1\t0.2\t0\n", "")))
    likelihood = problem.likelihood(**tight)
    at = np.array([0.6, 2.0])
    np.testing.assert_allclose(problem.simulate(at, **tight)["simulation"].to_numpy()[:13],
                               2 * level(TIMES, 0.6, 0.15, 1.35), rtol=1e-8)
    np.testing.assert_allclose(likelihood.gradient(at), by_differences(likelihood.loss, at), rtol=1e-6)


def test_every_start_and_condition_is_an_instance_of_one_ensemble(several_conditions, monkeypatch):
    sizes = []
    monkeypatch.setattr("myriad_ode.gradients.forward.solve",
                        lambda *a, **o: sizes.append(o["size"]) or my.solve(*a, **o))
    likelihood = my.read_petab(several_conditions).likelihood()
    likelihood.loss(np.tile([0.9, 0.8, 4.0, 0.7, 0.4, 0.05], (5, 1)))
    assert sizes == [10] and likelihood.conditions == ["slow", "fast"]


def test_a_set_without_a_solution_has_no_likelihood(tmp_path):
    # A' = k A^2 has none after t = 1 / (3 k).
    model = sbml.document([sbml.compartment("c", 1.0), sbml.species("A", concentration=1.0), sbml.parameter("k", 9.0),
                           sbml.parameter("b", 9.0), sbml.reaction("growth", "-> A", "k * A * A * c", modifiers="A")])
    likelihood = my.read_petab(write(tmp_path, model)).likelihood()
    assert np.isnan(likelihood.loss([[0.5, 1.0], [0.01, 1.0]])).tolist() == [True, False]


PARAMETERS = TABLES["parameters"].replace("estimate\n", "estimate\tobjectivePriorType\tobjectivePriorParameters\n"
                                          ).replace("t\t0\n", "t\t0\t\t\n")


def with_column(name, values):
    """The measurements with one more column, the same values for each observable."""
    first, *rows = measurements().splitlines()
    return "\n".join([f"{first}\t{name}", *(f"{row}\t{values.get(row.split(chr(9))[0], '')}" for row in rows)]) + "\n"


@pytest.mark.parametrize("tables, message", [
    ({"conditions": table("conditionId A k\nusual 3 2")}, "'k'"),
    ({"conditions": table("conditionId A b\nusual 3 0.3")}, "'b'"),
    ({"conditions": table("conditionId A\nusual unknown")}, "unknown"),
    ({"conditions": table("conditionId A total\nusual 3 1"), "model": document(
        sbml.variable("total"), sbml.always("total", "2 * A"))}, "'total', which a rule of the model sets"),
    ({"conditions": table("conditionId loss\nusual 1")}, "'loss'"),
    ({"observables": TABLES["observables"].replace("log(A)", "log(Z)")}, "Z"),
    ({"observables": TABLES["observables"].replace("scale*A", "observableParameter1_seen*A")}, "observableParameter"),
    ({"observables": TABLES["observables"].replace("scale*A", "observableParameter1_seen*A"),
      "measurements": with_column("observableParameters", {"seen": "1;2"})}, "observableParameter|2 values"),
    ({"parameters": "parameterId\nk\n"}, "petab cannot read|no valid problem"),
])
def test_what_is_not_supported_is_refused_by_name(tmp_path, tables, message):
    path = write(tmp_path, **tables)
    with pytest.raises(my.Error, match=message):
        my.read_petab(path)


def test_several_models_in_a_problem_are_refused(tmp_path):
    path = write(tmp_path)
    text = path.read_text()
    path.write_text(text + text[text.index("  - sbml"):])
    with pytest.raises(my.Error, match="single model"):
        my.read_petab(path)


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(my.Error, match="there is no file '.*nothing.yaml'"):
        my.read_petab(tmp_path / "nothing.yaml")


def test_tables_of_version_1_are_no_problem_of_version_2(tmp_path):
    path = write(tmp_path)
    path.write_text(path.read_text().replace("format_version: 1", "format_version: 2.0.0"))
    with pytest.raises(my.Error, match="petab cannot read|no valid problem"):
        my.read_petab(path)
