# SPDX-License-Identifier: MIT
"""The script that compares likelihoods of PEtab's problems with recorded simulations."""

import argparse
import pathlib
import sys

import pytest

import myriad_ode as my
from myriad_ode.formats.petab.likelihood import PetabLikelihood

pytest.importorskip("petab.v1")
from test_petab import measurements, table, write  # noqa: E402

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import petab_suite  # noqa: E402
OPTIONS = argparse.Namespace(method="rodas_5p", rtol=1e-8, atol=1e-10, time_limit=60.0, roadrunner=False,
                            gradients=False)


@pytest.fixture
def folder(tmp_path):
    write(tmp_path, measurements=measurements(noise=0.05))
    return tmp_path


def simulated(folder, **options):
    return my.read_petab(folder / "problem.yaml").simulate(interpreted=True, **options)


def record(folder, simulation):
    simulation.to_csv(folder / "simulatedData.tsv", sep="\t", index=False)


def outcome(folder):
    return petab_suite.check(folder, OPTIONS)[1]


def test_a_recorded_simulation_is_right_in_any_order_and_wrong_where_it_is_another(folder):
    assert outcome(folder) == "not recorded"
    simulation = simulated(folder, rtol=1e-9, atol=1e-9)
    record(folder, simulation)
    assert outcome(folder) == "right"
    record(folder, simulation.iloc[::-1])
    assert outcome(folder) == "right"
    record(folder, simulation.iloc[:5])
    assert petab_suite.check(folder, OPTIONS)[-1] == "the record has 5 of 19 values"
    record(folder, simulation.assign(simulation=1.1 * simulation["simulation"]))
    assert outcome(folder) == "wrong"
    measured = my.read_petab(folder / "problem.yaml").measurements["measurement"]
    record(folder, simulation.assign(simulation=measured))
    assert outcome(folder) == "copied"


def test_gradients_are_those_of_differences_and_are_told_where_they_are_not(folder, monkeypatch):
    options = argparse.Namespace(**{**vars(OPTIONS), "gradients": True, "rtol": 1e-10})
    name, found, *_, why = petab_suite.check(folder, options)
    assert found == "right" and why.startswith("2 free, 1 states: ")
    gradient = PetabLikelihood.gradient
    monkeypatch.setattr(PetabLikelihood, "gradient", lambda self, values: 1.001 * gradient(self, values))
    assert petab_suite.check(folder, options)[1] == "wrong"


def test_what_is_refused_is_told_so(folder):
    write(folder, conditions=table("conditionId loss\nusual 1"))
    assert outcome(folder) == "refused"


def test_libroadrunner_agrees(folder):
    pytest.importorskip("roadrunner")
    options = argparse.Namespace(**{**vars(OPTIONS), "roadrunner": True})
    assert petab_suite.check(folder, options)[1] == "right"
