# SPDX-License-Identifier: MIT
"""Experiments from SED-ML and archives of COMBINE."""

import zipfile

import numpy as np
import pytest

import myriad_ode as my

pytest.importorskip("libsbml")

MODEL = """<?xml version="1.0" encoding="UTF-8"?>
<sbml xmlns="http://www.sbml.org/sbml/level3/version1/core" level="3" version="1">
  <model id="decay">
    <listOfCompartments><compartment id="c" size="1" constant="true" spatialDimensions="3"/></listOfCompartments>
    <listOfSpecies>
      <species id="S" compartment="c" initialConcentration="2" hasOnlySubstanceUnits="false" boundaryCondition="false"
               constant="false"/>
    </listOfSpecies>
    <listOfParameters><parameter id="k" value="0.5" constant="true"/></listOfParameters>
    <listOfReactions>
      <reaction id="r" reversible="false" fast="false">
        <listOfReactants><speciesReference species="S" stoichiometry="1" constant="true"/></listOfReactants>
        <kineticLaw><math xmlns="http://www.w3.org/1998/Math/MathML"><apply><times/><ci>k</ci><ci>S</ci></apply></math>
        </kineticLaw>
      </reaction>
    </listOfReactions>
  </model>
</sbml>
"""
COMBINE = "http://identifiers.org/combine.specifications/"
K = "/sbml:sbml/sbml:model/sbml:listOfParameters/sbml:parameter[@id='k']/@value"
S = "/sbml:sbml/sbml:model/sbml:listOfSpecies/sbml:species[@id='S']/@initialConcentration"
COURSE = """<uniformTimeCourse id="sim" initialTime="0" outputStartTime="1" outputEndTime="3" numberOfPoints="4">
  <algorithm kisaoID="KISAO:0000019"/></uniformTimeCourse>"""


def task(name="one", of="m", simulation="sim"):
    return f'<task id="{name}" modelReference="{of}" simulationReference="{simulation}"/>'


TASK = task()


def sedml(models, simulations=COURSE, tasks=TASK, head=""):
    return f"""<?xml version="1.0" encoding="UTF-8"?>{head}
<sedML xmlns="http://sed-ml.org/sed-ml/level1/version3" level="1" version="3"
       xmlns:sbml="http://www.sbml.org/sbml/level3/version1/core">
  <listOfSimulations>{simulations}</listOfSimulations>
  <listOfModels>{models}</listOfModels>
  <listOfTasks>{tasks}</listOfTasks>
</sedML>
"""


def model(name="m", source="decay.xml", changes=""):
    inner = f"<listOfChanges>{changes}</listOfChanges>" if changes else ""
    return f'<model id="{name}" language="urn:sedml:language:sbml" source="{source}">{inner}</model>'


def change(target, value):
    return f'<changeAttribute target="{target}" newValue="{value}"/>'


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "decay.xml").write_text(MODEL)
    return tmp_path


def courses(folder, text):
    (folder / "study.sedml").write_text(text)
    return my.read_sedml(folder / "study.sedml")


def test_a_uniform_time_course_is_a_run_with_its_times(folder):
    course = courses(folder, sedml(model()))["one"]
    assert (course.name, course.begin, course.algorithm) == ("one", 0, "KISAO:0000019")
    np.testing.assert_array_equal(course.times, [1, 1.5, 2, 2.5, 3])
    run = course.solve(rtol=1e-10)
    np.testing.assert_allclose(run["S_sample"][0], 2 * np.exp(-0.5 * course.times), rtol=1e-8)
    swept = course.solve({"k": [0.1, 0.2]}, rtol=1e-10)
    np.testing.assert_allclose(swept["S_sample"][:, -1], 2 * np.exp(-3 * np.array([0.1, 0.2])), rtol=1e-8)


def test_changes_are_made_in_the_order_of_models_that_are_made_of_others(folder):
    models = model() + model("fast", "#m", change(K, 2) + change(S, 5)) + model("less", "#fast", change(S, 1))
    tasks = "".join(task(m, m) for m in ("m", "fast", "less"))
    found = courses(folder, sedml(models, tasks=tasks))
    assert list(found) == ["m", "fast", "less"]
    for name, start, rate in (("m", 2, 0.5), ("fast", 5, 2), ("less", 1, 2)):
        run = found[name].solve(rtol=1e-10, atol=1e-12)
        np.testing.assert_allclose(run["S_sample"][0, -1], start * np.exp(-3 * rate), rtol=1e-7)


def archive(path, files, master="study.sedml", **options):
    contents = "".join(f'<content location="./{name}" format="{COMBINE}'
                       f'{"sed-ml" if name.endswith(".sedml") else "sbml"}" master="{str(name == master).lower()}"/>'
                       for name in files)
    with zipfile.ZipFile(path, "w", **options) as made:
        made.writestr("manifest.xml", f'<omexManifest xmlns="{COMBINE}omex-manifest">{contents}</omexManifest>')
        for name, text in files.items():
            made.writestr(name, text)
    return path


def test_an_archive_has_the_courses_of_its_documents_the_master_first(tmp_path):
    other = sedml(model(source="../models/decay.xml", changes=change(K, 1)), tasks=task("two"))
    path = archive(tmp_path / "study.omex", {"a/other.sedml": other, "study.sedml": sedml(model(
        source="models/decay.xml")), "models/decay.xml": MODEL})
    # snippet: courses
    courses = my.read_sedml(path)  # by the names of their tasks
    course = courses["two"]
    run = course.solve(rtol=1e-10)  # as it is described
    last = run["S_sample"][0, -1]  # at course.times[-1]
    swept = course.solve({"k": [0.1, 0.2, 0.5]})  # the same for three values of a parameter
    # end of snippet
    assert list(courses) == ["one", "two"] and swept.size == 3
    np.testing.assert_allclose(last, 2 * np.exp(-3), rtol=1e-8)


@pytest.mark.parametrize("text, message", [
    (sedml(model(source="http://example.org/decay.xml")), "the model 'm' is at http://example.org/decay.xml: put the"),
    (sedml(model(source="urn:miriam:biomodels.db:BIOMD0000000012")), "put the file beside the document"),
    (sedml(model(source="../decay.xml")), "is not in its folder, or one below: move it there"),
    (sedml(model(source="other.xml")), "the file 'other.xml' is not there"),
    (sedml(model("m", "#n") + model("n", "#m")), "is made of itself"),
    (sedml(model(changes=change(K.replace("'k'", "'q'"), 1))), "is no elements: name one attribute"),
    (sedml(model(changes=change(K.replace("[@id='k']", "[nonsense"), 1))), "is no elements: name one attribute"),
    (sedml(model(changes=change(S.replace("initialConcentration", "initialAmount"), 1))),
     "is an attribute that the element does not have: it has id"),
    (sedml(model(changes='<removeXML target="/sbml:sbml/sbml:model"/>')), "only <changeAttribute> is read"),
    (sedml(model(), tasks=task(of="q")), "the model 'q' is not there"),
    (sedml(model(), tasks=task(simulation="q")),
     "task 'one' names the simulation 'q', which is not there"),
    (sedml(model(), '<steadyState id="sim"><algorithm kisaoID="KISAO:0000407"/></steadyState>'),
     "is a <steadyState>, and only a <uniformTimeCourse> is read"),
    (sedml(model(), COURSE.replace('outputEndTime="3"', 'outputEndTime="1"')), "give initialTime <= outputStartTime <"),
    (sedml(model(), COURSE.replace('numberOfPoints="4"', '')), 'numberOfPoints of \'sim\' is "": give a'),
    ("<model/>", "the first element is <model>, and not <sedML>"),
    (sedml(model(), head='<!DOCTYPE x [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]>'), "it declares the entity 'a'"),
    ("<sedML", "this is no XML"),
])
def test_what_is_not_supported_or_not_there_is_named(folder, text, message):
    with pytest.raises(my.Error) as refused:
        courses(folder, text)
    assert message in str(refused.value)


def repeated(ranges, changes, attributes='range="r" resetModel="true"', tasks='<subTask task="one" order="1"/>'):
    return (f'<repeatedTask id="many" {attributes}><listOfRanges>{ranges}</listOfRanges><listOfChanges>{changes}'
            f"</listOfChanges><listOfSubTasks>{tasks}</listOfSubTasks></repeatedTask>")


def set_to(target, value="<ci> r </ci>"):
    return (f'<setValue target="{target}" modelReference="m" range="r">'
            f'<math xmlns="http://www.w3.org/1998/Math/MathML">{value}</math></setValue>')


EVEN = '<uniformRange id="r" start="0.1" end="0.4" numberOfPoints="3" type="linear"/>'
FEW = '<vectorRange id="s"><value>1</value><value> 2e0 </value><value>4</value><value>8</value></vectorRange>'


@pytest.mark.parametrize("ranges, rates", [
    (EVEN, [0.1, 0.2, 0.3, 0.4]), (EVEN.replace("numberOfPoints", "numberOfSteps"), [0.1, 0.2, 0.3, 0.4]),
    (EVEN.replace("linear", "log"), np.geomspace(0.1, 0.4, 4)), (FEW.replace('id="s"', 'id="r"'), [1, 2, 4, 8])])
def test_a_repeated_task_is_a_sweep(folder, ranges, rates):
    tasks = repeated(ranges, set_to(K)) + TASK  # also where what it repeats comes later
    found = courses(folder, sedml(model(), tasks=tasks))
    assert list(found) == ["many", "one"]
    run = found["many"].solve(rtol=1e-10, atol=1e-14)
    np.testing.assert_allclose(run["S_sample"], 2 * np.exp(-np.outer(rates, found["many"].times)), rtol=1e-7,
                               atol=1e-13)
    assert found["one"].solve().size == 1 and found["many"].solve({"k": [1.0, 2.0]}).size == 2


def test_a_repeated_task_sets_initial_values_and_several_things_at_once(folder):
    changes = set_to(K.removesuffix("/@value")) + set_to(S, "<ci>s</ci>")
    course = courses(folder, sedml(model(), tasks=TASK + repeated(EVEN + FEW, changes)))["many"]
    assert course.name == "many" and list(course.changes) == ["k", "S"]
    run = course.solve(rtol=1e-10, atol=1e-14)
    np.testing.assert_allclose(run["S_sample"][:, -1], np.array([1, 2, 4, 8]) * np.exp(-3 * np.linspace(0.1, 0.4, 4)),
                               rtol=1e-7)


@pytest.mark.parametrize("task_of, message", [
    (repeated(EVEN, set_to(K), 'range="r" resetModel="false"'), "goes on from where the last repetition ended"),
    (repeated(EVEN, set_to(K, "<apply><times/><ci>r</ci><cn>2</cn></apply>")), "to a formula: only values of a range"),
    (repeated(EVEN, set_to(K.replace("'k'", "'q'"))), "sets 'q', which is no parameter and no species"),
    (repeated(EVEN, set_to(K, "<ci>q</ci>")), "to a formula: only values of a range"),
    (repeated(EVEN, set_to(S.replace("Concentration", "Amount"))), "sets initialAmount of 'S': set initialConc"),
    (repeated(EVEN, set_to(K.replace("value", "constant"))), "sets constant of 'k': set value"),
    (repeated(EVEN, set_to(K).replace('"m"', '"n"')), "of another model than that of 'one'"),
    (repeated(EVEN, ""), "sets nothing"),
    (repeated(EVEN, set_to(K), 'range="q" resetModel="true"'), "sets nothing, or has"),
    (repeated(EVEN + FEW.replace("<value>4</value>", ""), set_to(K, "<ci>s</ci>")), "no range with a value for each"),
    (repeated(EVEN.replace('"3"', '"1e300"'), set_to(K)), "a range of 1e+300 steps"),
    (repeated(EVEN.replace('"0.4"', '"often"'), set_to(K)), 'end of \'r\' is "often": give a number'),
    (repeated('<functionalRange id="r" range="q"/>', set_to(K)), "has a <functionalRange>: only uniform and vector"),
    (repeated(EVEN, set_to(K), tasks='<subTask task="q"/>'), "repeats 'q': only one <task> can be repeated"),
    (repeated(EVEN, set_to(K), tasks='<subTask task="many"/>'), "repeats 'many': only one <task> can be repeated"),
    (repeated(EVEN.replace("linear", "log").replace("0.1", "-1"), set_to(K)), "a logarithmic range from -1 to 0.4"),
])
def test_repetitions_that_are_no_sweep_are_refused(folder, task_of, message):
    with pytest.raises(my.Error) as refused:
        courses(folder, sedml(model(), tasks=TASK + task_of))
    assert message in str(refused.value)


def test_archives_that_unpack_without_bound_or_have_no_manifest_are_refused(tmp_path):
    large = archive(tmp_path / "large.omex", {"study.sedml": "", "zeros": "0" * (300 << 20)},
                    compression=zipfile.ZIP_DEFLATED)
    with pytest.raises(my.Error, match="its files have more than 256 MiB: unpack it"):
        my.read_sedml(large)
    with zipfile.ZipFile(tmp_path / "plain.zip", "w") as made:
        made.writestr("a", "b")
    with pytest.raises(my.Error, match="it has no manifest.xml, and is no archive of COMBINE"):
        my.read_sedml(tmp_path / "plain.zip")
    with pytest.raises(my.Error, match="there is no file"):
        my.read_sedml(tmp_path / "none.omex")
    only_a_model = archive(tmp_path / "model.omex", {"decay.xml": MODEL})
    with pytest.raises(my.Error, match="its manifest names no document of SED-ML: unpack it, and read its model"):
        my.read_sedml(only_a_model)


def test_a_repeated_task_keeps_what_it_sets_beside_other_initial_values(folder):
    course = courses(folder, sedml(model(), tasks=TASK + repeated(FEW.replace('"s"', '"r"'), set_to(S))))["many"]
    own = course.solve()
    np.testing.assert_array_equal(course.solve(start={})["S_sample"], own["S_sample"])
    replaced = course.solve(start={"S": 2.0})["S_sample"]
    np.testing.assert_array_equal(replaced, np.broadcast_to(own["S_sample"][1], replaced.shape))
    with pytest.raises(my.Error, match="start is 2: give a dict by name"):
        course.solve(start=2)
