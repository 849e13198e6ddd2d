# SPDX-License-Identifier: MIT
"""Problems of PEtab, written as files, with measurements in closed form; what is not supported is refused by name."""

import numpy as np
import pytest

import myriad as my

v1 = pytest.importorskip("petab.v1")
import sbml_models as sbml  # noqa: E402, which needs libsbml

# A is lost at the rate k and made at the rate b: A = b / k + (A0 - b / k) exp(-k t).
K, SCALE, B, A0 = 0.7, 2.5, 0.2, 3.0
TIMES = np.linspace(0, 6, 13)


def level(t, k=K, b=B, a0=A0):
    return b / k + (a0 - b / k) * np.exp(-k * t)


TABLES = {
    "parameters": """parameterId\tparameterScale\tlowerBound\tupperBound\tnominalValue\testimate
k\tlog10\t0.01\t10\t0.5\t1
scale\tlin\t0.1\t20\t1\t1
b\tlin\t0\t1\t0.2\t0
""",
    "conditions": "conditionId\tA\nusual\t3\n",
    "observables": """observableId\tobservableFormula\tnoiseFormula
seen\tscale * A\tnoiseParameter1_seen
logged\tlog(A)\t0.02
""",
}


def measurements(noise=0.0):
    random = np.random.default_rng(5)
    rows = ["observableId\tsimulationConditionId\ttime\tmeasurement\tnoiseParameters"]
    few = TIMES[1::2]
    for name, times, values in (("seen", TIMES, SCALE * level(TIMES)), ("logged", few, np.log(level(few)))):
        values = values + noise * random.standard_normal(times.size)
        rows += [f"{name}\tusual\t{t}\t{v}\t{0.1 + 0.01 * t if name == 'seen' else ''}" for t, v in zip(times, values)]
    return "\n".join(rows) + "\n"


def write(folder, **tables):
    """A problem's files; returns the path of its YAML."""
    (folder / "model.xml").write_text(sbml.document([
        sbml.compartment("c", 2.0), sbml.species("A", concentration=1.0), sbml.parameter("k", 9.0),
        sbml.parameter("b", 9.0), sbml.reaction("loss", "A ->", "k * A * c"),
        sbml.reaction("making", "-> A", "b * c")]))
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


def test_a_problem_is_fitted_to_what_made_its_measurements(tmp_path):
    problem = my.read_petab(write(tmp_path))
    assert problem.free == {"k": (0.01, 10.0, "log"), "scale": (0.1, 20.0)}
    assert problem.nominal == {"k": 0.5, "scale": 1.0}
    assert repr(problem) == "<myriad.PetabProblem of 19 measurements, to estimate k, scale>"
    fit = problem.fit(starts=8, rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose([fit.best["k"], fit.best["scale"]], [K, SCALE], rtol=1e-7)
    assert fit.variance == 1 and fit.notes == []


def test_the_loss_is_half_of_petabs_chi_squared(tmp_path):
    path = write(tmp_path, measurements=measurements(noise=0.1))
    problem = my.read_petab(path)
    loss = problem.least_squares(rtol=1e-10, atol=1e-10).loss([0.6, 2.0])
    theirs = v1.Problem.from_yaml(str(path))
    simulated = theirs.measurement_df.rename(columns={"measurement": "simulation"})
    x = level(simulated["time"].to_numpy(), k=0.6)
    simulated["simulation"] = np.where(simulated["observableId"] == "seen", 2.0 * x, np.log(x))
    chi2 = v1.calculate_chi2(theirs.measurement_df, simulated, theirs.observable_df, theirs.parameter_df)
    assert loss == pytest.approx(chi2 / 2, rel=1e-7)


def test_a_condition_sets_parameters_and_compartments(tmp_path):
    problem = my.read_petab(write(tmp_path, conditions="conditionId\tA\tb\tc\nusual\tb\t0.4\t3\n",
                                  parameters=TABLES["parameters"].replace("b\tlin\t0\t1\t0.2\t0\n", "")))
    run = problem.least_squares(rtol=1e-10, atol=1e-10).run([K, SCALE])
    np.testing.assert_allclose(run["seen"][0], SCALE * level(TIMES, b=0.4, a0=0.4), rtol=1e-8)


PARAMETERS = TABLES["parameters"].replace("estimate\n", "estimate\tobjectivePriorType\tobjectivePriorParameters\n")


@pytest.mark.parametrize("tables, message", [
    ({"measurements": measurements().replace("seen\tusual\t0.0", "seen\tother\t0.0"),
      "conditions": "conditionId\tA\nusual\t3\nother\t2\n"}, "several conditions, 'other', 'usual'"),
    ({"measurements": measurements().replace("\t6.0\t", "\tinf\t")}, "measurements of 'seen' in a steady state"),
    ({"observables": TABLES["observables"].replace("0.02", "0.02 * A")},
     r"the noise of observable 'logged' is 0.02 \* A"),
    ({"measurements": measurements().replace("\t0.1\n", "\tscale\n", 1)}, "the noise of observable 'seen' is scale"),
    ({"observables": """observableId\tobservableFormula\tnoiseFormula\tobservableTransformation
seen\tscale * A\tnoiseParameter1_seen\tlog10
logged\tlog(A)\t0.02\tlin
"""}, "observable 'seen' has the observableTransformation log10"),
    ({"observables": """observableId\tobservableFormula\tnoiseFormula\tnoiseDistribution
seen\tscale * A\tnoiseParameter1_seen\tnormal
logged\tlog(A)\t0.02\tlaplace
"""}, "observable 'logged' has the noiseDistribution laplace"),
    ({"parameters": PARAMETERS.replace("0.5\t1\n", "0.5\t1\tnormal\t1;2\n").replace("t\t0\n", "t\t0\t\t\n")},
     "a prior of 'k', normal"),
    ({"conditions": "conditionId\tA\tk\nusual\t3\t2\n"}, "'k'"),
    ({"observables": TABLES["observables"].replace("log(A)", "log(Z)")}, "Z"),
    ({"observables": TABLES["observables"].replace("scale *", "observableParameter1_seen *"),
      "measurements": "".join(line + ("\tobservableParameters\n" if line.startswith("obs") else
                                      "\tscale\n" if line.startswith("seen") else "\t\n")
                              for line in measurements().splitlines())}, "measurements of 'seen' have observableP"),
    ({"measurements": "".join(line + ("\tpreequilibrationConditionId\n" if line.startswith("obs") else "\tusual\n")
                              for line in measurements().splitlines())},
     "after preequilibration, at the condition 'usual'"),
    ({"parameters": "parameterId\nk\n"}, "petab cannot read|no valid problem"),
])
def test_what_is_not_supported_is_refused_by_name(tmp_path, tables, message):
    path = write(tmp_path, **tables)
    with pytest.raises(my.Error, match=message):
        my.read_petab(path)


def test_an_initial_value_that_is_estimated_is_refused_by_name(tmp_path):
    problem = my.read_petab(write(tmp_path, conditions="conditionId\tA\nusual\tscale\n"))
    with pytest.raises(my.Error, match="the initial value of 'A' follows from components"):
        problem.fit(starts=2)


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(my.Error, match="there is no file '.*nothing.yaml'"):
        my.read_petab(tmp_path / "nothing.yaml")


def test_version_2_of_petab_is_refused(tmp_path):
    path = write(tmp_path)
    path.write_text(path.read_text().replace("format_version: 1", "format_version: 2.0.0"))
    with pytest.raises(my.Error, match="petab cannot read .*ersion"):
        my.read_petab(path)
