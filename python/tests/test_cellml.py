# SPDX-License-Identifier: MIT
"""Models from files of CellML: what they mean in each version, and what is refused."""

import sys

import numpy as np
import pytest

import myriad_ode as my

pytest.importorskip("libcellml", reason="models of CellML are read by the package libcellml")

mathml = "http://www.w3.org/1998/Math/MathML"
x, y, t = "<ci>x</ci>", "<ci>y</ci>", "<ci>t</ci>"


def number(value, units="dimensionless", **attributes):
    given = "".join(f' {name}="{text}"' for name, text in attributes.items())
    return f'<cn cellml:units="{units}"{given}>{value}</cn>'


def apply(operation, *arguments):
    return f"<apply><{operation}/>{''.join(arguments)}</apply>"


def slope(state, value, time="t", more=""):
    return apply("eq", f"<apply><diff/><bvar><ci>{time}</ci>{more}</bvar><ci>{state}</ci></apply>", value)


def variable(name, units="dimensionless", start=None, interface=None):
    given = f' initial_value="{start}"' if start is not None else ""
    return f'<variable name="{name}" units="{units}"{given}{interface or ""}/>'


def component(name, *variables, math=""):
    found = [v if v.startswith("<") else variable(v) for v in variables]
    return f'<component name="{name}">{"".join(found)}' + (
        f'<math xmlns="{mathml}">{math}</math>' if math else "") + "</component>"


def model(*parts, version="2.0", head=""):
    space = f"http://www.cellml.org/cellml/{version}#"
    return (f'<?xml version="1.0"?>{head}<model name="m" xmlns="{space}" xmlns:cellml="{space}" '
            f'xmlns:xlink="http://www.w3.org/1999/xlink">{"".join(parts)}</model>')


def one(*variables, math, **options):
    return model(component("c", "t", *variables, math=math), **options)


def solved(text, *arguments, time=(0, 2), samples=21, **options):
    options = dict(interpreted=True, device="cpu", method="dormand_prince_5", rtol=1e-10, atol=1e-12) | options
    found = text if not isinstance(text, str) else my.read_cellml(text)
    return my.solve(found, *arguments, time=time, samples=samples, **options)


def refused(text, match):
    with pytest.raises(my.Error, match=match):
        my.read_cellml(text)


decay = slope("x", apply("times", apply("minus", "<ci>k</ci>"), x))
out, into = ' public_interface="out"', ' public_interface="in"'
public = ' interface="public"'
volts = ('<units name="mV"><unit prefix="milli" units="volt"/></units>'
         '<units name="ms"><unit prefix="milli" units="second"/></units>'
         '<units name="mV_per_ms"><unit units="mV"/><unit units="ms" exponent="-1"/></units>'
         '<units name="V_per_s"><unit units="volt"/><unit units="second" exponent="-1"/></units>')


# -- What it means -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("version", ["1.0", "1.1", "2.0"])
def test_states_constants_and_computed_variables(version):
    text = one(variable("x", start="2"), variable("k", start="0.5"), "half",
               math=decay + apply("eq", "<ci>half</ci>", apply("divide", x, number(2))), version=version)
    found = my.read_cellml(text)
    assert (found.states, found.parameters, found.name) == (["x"], ["k"], "m")
    assert found.start() == {"x": 2.0, "k": 0.5}
    run = solved(found, {"k": [0.5, 1.0]})
    exact = 2 * np.exp(-np.outer([0.5, 1.0], np.linspace(0, 2, 21)))
    np.testing.assert_allclose(run["x"], exact, rtol=1e-8)
    np.testing.assert_allclose(run["half"], exact / 2, rtol=1e-8)
    np.testing.assert_allclose(run["c.half"], run["half"])


def test_constants_that_are_not_named_are_written_into_the_equations():
    text = one(variable("x", start="2"), variable("k", start="0.5"), variable("l", start="3"),
               math=slope("x", apply("times", "<ci>k</ci>", "<ci>l</ci>")))
    assert my.read_cellml(text, parameters="l").parameters == ["l"]
    np.testing.assert_allclose(solved(my.read_cellml(text, parameters="c.l"), {"l": 4})["x"][0, -1], 2 + 2 * 0.5 * 4)
    with pytest.raises(my.Error, match="parameters= names 'q', which is no constant of the file: there are k, l"):
        my.read_cellml(text, parameters="q")


def test_names_that_several_components_have_get_the_component_before_them():
    part = "".join(component(c, "t", variable("x", start=s), math=slope("x", number(s)))
                   for c, s in (("a", 1), ("b", 2)))
    maps = '<map_variables variable_1="t" variable_2="t"/>'
    text = model(part, f'<connection component_1="a" component_2="b">{maps}</connection>')
    text = text.replace('name="t" units="dimensionless"', f'name="t" units="dimensionless"{public}')
    run = solved(text)
    np.testing.assert_allclose([run["a.x"][0, -1], run["b_x"][0, -1]], [1 + 2, 2 + 4])


@pytest.mark.parametrize("name", ["double", "a__b", "_x"])
def test_names_that_no_model_can_have_are_still_those_of_results(name):
    found = my.read_cellml(one(variable(name, start="1"), math=slope(name, number(3))))
    assert found.states != [name]
    np.testing.assert_allclose(solved(found)[name][0, -1], 7)


def connected(version):
    """dV/dt = 5 mV/ms in one component, which another reads in volts and seconds."""
    one, two = (public, public) if version == "2.0" else (out, into)
    source = component("a", variable("t", "ms", None, one), variable("V", "mV", "-65", one),
                       math=slope("V", number(5, "mV_per_ms")))
    reader = component("b", variable("t", "second", None, two), variable("V", "volt", None, two),
                       variable("W", "volt", "1"), variable("twice", "volt"), variable("now", "second"),
                       math=apply("eq", "<ci>twice</ci>", apply("times", number(2), "<ci>V</ci>")) +
                       apply("eq", "<ci>now</ci>", t) + slope("W", apply("divide", "<ci>V</ci>", number(1, "second"))))
    maps = "".join(f'<map_variables variable_1="{n}" variable_2="{n}"/>' for n in ("t", "V"))
    both = 'component_1="a" component_2="b"'
    link = (f"<connection {both}>{maps}</connection>" if version == "2.0" else
            f"<connection><map_components {both}/>{maps}</connection>")
    return model(volts, source, reader, link, version=version)


@pytest.mark.parametrize("version", ["1.0", "1.1", "2.0"])
def test_connected_variables_of_other_units_are_converted(version):
    found = my.read_cellml(connected(version))
    assert found.units["V"] == "mV" and found.units["twice"] == "V"
    assert found.time_unit in ("ms", "s")
    ms = 1.0 if found.time_unit == "ms" else 1e-3
    run = solved(found, time=(0, 10 * ms))
    time = np.linspace(0, 10, 21)
    np.testing.assert_allclose(run["V"][0], -65 + 5 * time, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(run["twice"][0], 2e-3 * (-65 + 5 * time), rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(run["now"][0], time * 1e-3, atol=1e-15)
    np.testing.assert_allclose(run["W"][0], 1 + 1e-6 * (-65 * time + 2.5 * time**2), rtol=1e-10)


def test_initial_values_in_other_units_and_by_other_variables():
    first = component("a", variable("t", "second", None, public), variable("V", "mV", None, public),
                      math=slope("V", number(0, "mV_per_ms")).replace("mV_per_ms", "mV_per_s"))
    second = component("b", variable("V", "volt", "V0", public), variable("V0", "volt", "2"))
    text = model(volts, '<units name="mV_per_s"><unit units="mV"/><unit units="second" exponent="-1"/></units>', first,
                 second, '<connection component_1="a" component_2="b"><map_variables variable_1="V" variable_2="V"/>'
                 "</connection>")
    found = my.read_cellml(text)
    in_volts = 1.0 if found.units["V"] == "V" else 1e3
    assert found.start()["V"] == pytest.approx(2 * in_volts)
    assert found.start({"V0": 3})["V"] == pytest.approx(3 * in_volts)


def test_pieces_are_chosen_by_their_conditions_and_are_nan_without_one():
    pieces = (f"<piecewise><piece>{number(1)}{apply('lt', x, number(1))}</piece><piece>{number(2)}"
              f"{apply('and', apply('geq', x, number(1)), apply('lt', x, number(2)))}</piece>")
    text = one(variable("x", start="0"), "a", "b", math=slope("x", number(1)) + apply(
        "eq", "<ci>a</ci>", f"{pieces}<otherwise>{number(3)}</otherwise></piecewise>") + apply(
        "eq", "<ci>b</ci>", f"{pieces}</piecewise>"))
    run = solved(text, time=(0, 3), samples=[0.5, 1.5, 2.5])
    np.testing.assert_allclose(run["a"][0], [1, 2, 3])
    np.testing.assert_allclose(run["b"][0], [1, 2, np.nan])


functions = {
    "power": (apply("power", x, number(3)), 0.7**3), "square root": (apply("root", x), 0.7**0.5),
    "root": (f"<apply><root/><degree>{number(3)}</degree>{x}</apply>", 0.7 ** (1 / 3)),
    "log": (apply("log", x), np.log10(0.7)),
    "base": (f"<apply><log/><logbase>{number(2)}</logbase>{x}</apply>", np.log2(0.7)),
    "arcsin": (apply("arcsin", x), np.arcsin(0.7)), "sech": (apply("sech", x), 1 / np.cosh(0.7)),
    "arccoth": (apply("arccoth", number(2)), np.arctanh(0.5)), "rem": (apply("rem", number(7), number(4)), 3),
    "min": (apply("min", x, number(0.2), number(0.5)), 0.2), "minus": (apply("minus", x), -0.7),
    "floor": (apply("floor", x), 0), "e": ("<exponentiale/>", np.e), "exponent": (number("7e-7"), 7e-7),
    "notation": (number("7<sep/>-7", type="e-notation"), 7e-7),
}


@pytest.mark.parametrize("name", functions)
def test_functions(name):
    formula, expected = functions[name]
    found = my.read_cellml(one(variable("x", start="0.7"), "f", version="1.0",
                               math=slope("x", number(0)) + apply("eq", "<ci>f</ci>", formula)))
    np.testing.assert_allclose(np.ravel(solved(found, samples=3)["f"])[0], expected, rtol=1e-14)


def test_an_exponential_that_overflows_leaves_the_derivatives_of_a_fraction_finite():
    gate = apply("divide", number(1), apply("plus", number(1), apply("exp", apply("times", number(-1000), x))))
    run = solved(one(variable("x", start="-1"), math=slope("x", apply("plus", number(1), gate))), method="rodas_5p",
                 time=(0, 0.9))
    np.testing.assert_allclose(run["x"][0, -1], -0.1, rtol=1e-8)


def test_a_sum_of_thousands_of_terms_is_read():
    many = apply("plus", *[x] * 3000)
    assert solved(one(variable("x", start="0"), math=slope("x", apply("plus", number(1), many))), time=(0, 1e-6))


def test_what_no_equation_reads_or_gives_is_left_out():
    found = my.read_cellml(one(variable("x", start="1"), "unused", math=slope("x", number(1))))
    assert "unused" not in found.outputs and found.parameters == []


def test_a_model_without_derivatives_has_its_computed_variables():
    found = my.read_cellml(model(component("c", variable("k", start="2"), "y", math=apply(
        "eq", y, apply("times", "<ci>k</ci>", number(3))))))
    np.testing.assert_allclose(solved(found, {"k": [2, 5]}, samples=2)["y"], [6, 15])


def test_spellings_of_older_versions():
    units = ('<units name="u"><unit prefix="deka" units="liter" offset="0.0"/></units>'
             '<rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"/>')
    local = '<units name="v"><unit units="u"/></units>'
    parts = [component(c, variable("t", start="0"), variable("x", "v", "1"),
                       math=slope("x", number(1, "v"), more=f"<degree>{number(1)}</degree>"))
             .replace(f'<component name="{c}">', f'<component name="{c}">{local}') for c in "ab"]
    parts[0] = parts[0].replace('"t" units', f'"t"{out} units')
    parts[1] = parts[1].replace(' initial_value="0"', into)
    link = ('<connection><map_components component_1="a" component_2="b"/>'
            '<map_variables variable_1="t" variable_2="t"/></connection>')
    found = my.read_cellml(model(units, *parts, link, version="1.0"))
    assert found.states == ["a_x", "b_x"] and found.units["a_x"] == found.units["b_x"] == "10 l"


# -- Imports -----------------------------------------------------------------------------------------------------------


def importing(name, version="1.1"):
    return model(f'<import xlink:href="{name}"><component name="c" component_ref="inner"/></import>', version=version)


inner = component("inner", "t", variable("x", start="1"), variable("k", start="2"), math=decay)


@pytest.mark.parametrize("version", ["1.1", "2.0"])
def test_imports_beside_the_file_and_below_are_read(tmp_path, version):
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "inner.cellml").write_text(model(inner, version=version))
    chain = model('<import xlink:href="inner.cellml"><component name="inner" component_ref="inner"/></import>',
                  version=version)
    (tmp_path / "parts" / "chain.cellml").write_text(chain)
    (tmp_path / "m.cellml").write_text(importing("parts/chain.cellml", version))
    found = my.read_cellml(tmp_path / "m.cellml")
    assert found.states == ["x"] and found.start() == {"x": 1.0, "k": 2.0}


@pytest.mark.parametrize("name, match", [
    ("../outside.cellml", "leads out of the folder of the model"), ("https://a.b/c.cellml", "not of a file beside"),
    ("file:///etc/hostname", "not of a file beside"), ("/etc/hostname", "not of a file beside"),
    ("missing.cellml", "line 1: the import of 'missing.cellml': there is no such file"),
    ("m.cellml", "'m.cellml' imports itself")])
def test_nothing_but_files_beside_is_opened(tmp_path, name, match):
    (tmp_path / "outside.cellml").write_text(model(inner, version="1.1"))
    (tmp_path / "models").mkdir()
    (tmp_path / "models" / "m.cellml").write_text(importing(name))
    refused(tmp_path / "models" / "m.cellml", match)


def test_a_text_imports_nothing():
    refused(importing("inner.cellml"), "from a text, beside which there is no file")


def test_links_that_lead_out_of_the_folder_are_not_followed(tmp_path):
    (tmp_path / "outside.cellml").write_text(model(inner, version="1.1"))
    (tmp_path / "models").mkdir()
    (tmp_path / "models" / "link.cellml").symlink_to(tmp_path / "outside.cellml")
    (tmp_path / "models" / "m.cellml").write_text(importing("link.cellml"))
    refused(tmp_path / "models" / "m.cellml", "leads out of the folder")


# -- What is refused ---------------------------------------------------------------------------------------------------


def test_resets_are_refused():
    text = one(variable("x", start="1"), math=slope("x", number(1))).replace("<math", '<reset variable="x"/><math')
    refused(text, "line 1: <reset> in component 'c' is a reset, .*: make it an event")


def test_reactions_are_refused():
    text = one(variable("x", start="1"), math=slope("x", number(1)), version="1.0")
    refused(text.replace("<math", "<reaction/><math"), "<reaction> in component 'c' .*: write its rates as equations")


def test_equations_that_have_to_be_solved_are_refused():
    text = one(variable("x", start="1"), "y", math=slope("x", y) + apply(
        "eq", apply("plus", y, apply("power", y, number(3))), x))
    refused(text, r"variable 'y' in component 'c' \(line 1\) is the unknown .*: write it, or its derivative, alone")


def test_derivatives_by_two_variables_are_refused():
    text = one("s", variable("x", start="1"), variable("y", start="1"), math=slope("x", number(1)) + slope(
        "y", number(1), "s"))
    refused(text, "variable '[st]' in component 'c' .*cannot both be the variable of integration")


def test_partial_and_higher_derivatives_are_refused():
    refused(one(variable("x", start="1"), math=slope("x", number(1), more=f"<degree>{number(2)}</degree>")),
            "line 1: a derivative of a higher degree: give the first derivative a variable of its own")
    refused(one(variable("x", start="1"), math=slope("x", number(1)).replace("diff", "partialdiff")),
            "<partialdiff> in component 'c' is a partial derivative")


def test_symbols_from_elsewhere_are_refused():
    refused(one(variable("x", start="1"), math=slope("x", '<csymbol definitionURL="a">u</csymbol>')),
            "<csymbol> in component 'c' .*random values are for generate= of my.study")


def test_what_has_no_value_is_refused():
    refused(one(variable("x", start="1"), "y", math=slope("x", y)),
            r"variable 'y' in component 'c' \(line 1\): nothing gives its value: write an initial_value")
    refused(one("x", math=slope("x", number(1))), "variable 'x' in component 'c' .* it is not initialised")


def test_names_that_no_variable_has_are_refused_with_the_component():
    refused(one(variable("x", start="1"), math=slope("x", "<ci>z</ci>")),
            r"'z' which does not correspond .* \(component 'c' begins in line 1\)")


def test_values_that_depend_on_themselves_are_refused():
    refused(one(variable("x", start="y"), variable("y", start="x"), math=slope("x", number(1))),
            "the initial value of variable '[xy]' in component 'c' .* depends on itself: give it a number")


def test_units_with_an_offset_and_connections_of_other_kinds_are_refused():
    refused(model('<units name="u"><unit units="kelvin" offset="3"/></units>', version="1.0"),
            "a unit of 'kelvin' with the offset 3, .*: leave the offset out, and add it in an equation")
    refused(connected("2.0").replace('name="V" units="volt"', 'name="V" units="metre"'), "non-matching units")


def test_what_is_no_cellml_is_refused():
    refused("<model/>", "the first element is <model>, and not <model> of CellML")
    refused("<model>", "line 1: this is no XML: no element found")
    refused("there.cellml", "there is no file 'there.cellml'")


# -- What bad input gets -----------------------------------------------------------------------------------------------


def test_entities_are_refused():
    laughs = '<!DOCTYPE model [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;">]>'
    refused(one(variable("x", start="1"), math=decay, head=laughs), "line 1: it declares the entity 'a'")
    outside = '<!DOCTYPE model [<!ENTITY a SYSTEM "file:///etc/hostname">]>'
    refused(one(variable("x", start="1"), math=decay, head=outside), "line 1: it declares the entity 'a'")


def test_a_document_type_elsewhere_is_not_fetched():
    outside = '<!DOCTYPE model SYSTEM "http://localhost:1/cellml.dtd">'
    assert my.read_cellml(one(variable("x", start="1"), variable("k", start="1"), math=decay, head=outside))


def test_deep_and_long_formulas_are_refused():
    deep = "<apply><minus/>" * 20_000 + x + "</apply>" * 20_000
    refused(one(variable("x", start="1"), math=slope("x", deep)), "nested more than 250 deep: write formulas in parts")
    refused(one(variable("x", start="1"), math=slope("x", apply("plus", *[x] * 20_000))), "more than 5000 arguments")
    both = x
    for _ in range(60):
        both = apply("plus", *[x] * 100, both)
    refused(one(variable("x", start="1"), math=slope("x", both)), "more than 5000 arguments, with those in each other")


def test_units_that_are_made_of_themselves_or_of_thousands_are_refused():
    circle = "".join(f'<units name="{a}"><unit units="{b}"/></units>' for a, b in ("ab", "bc", "ca"))
    refused(model(circle), "the units 'a' are made of themselves, by way of a, b, c")
    tower = "".join(f'<units name="u{i}"><unit units="u{i + 1}"/><unit units="u{i + 1}"/></units>' for i in range(60))
    refused(model(tower, '<units name="u60"><unit units="second"/></units>'), "a product of more than 1000 others")


def test_components_that_are_inside_themselves_are_refused():
    group = ('<group><relationship_ref relationship="encapsulation"/><component_ref component="a"><component_ref '
             'component="b"/></component_ref><component_ref component="b"><component_ref component="a"/>'
             "</component_ref></group>")
    refused(model(component("a"), component("b"), group, version="1.0"), "is inside itself")


def test_without_libcellml_the_message_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "libcellml", None)
    with pytest.raises(my.Error, match="pip install libcellml"):
        my.read_cellml(one(variable("x", start="1"), math=decay))
