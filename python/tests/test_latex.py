# SPDX-License-Identifier: MIT
"""Models as LaTeX, and what notebooks show of models, studies and fits."""

import html.parser
import re

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode.symbolic.evaluate import evaluate
from myriad_ode.symbolic.expression import make
from myriad_ode.symbolic.latex import expressions_latex, name_latex, names_latex, plain
from myriad_ode.symbolic.operations import operations

x, y, z = my.states("x y z")
k = my.parameter("k")


def latex(expression):
    (written,), parts = expressions_latex([expression], lambda symbol: name_latex(symbol.value[1]), "w")
    assert not parts
    return written.text


@pytest.mark.parametrize("name, written", [
    ("x", "x"), ("k_on", r"k_{\mathrm{on}}"), ("alpha", r"\alpha"), ("omega_0", r"\omega_{0}"), ("x1", "x_{1}"),
    ("height", r"\mathrm{height}"), ("Gamma_a_b", r"\Gamma_{a,b}"), ("beta2_x", r"\beta_{2,x}"),
    ("lambda_", r"\lambda"), ("Omega_max", r"\Omega_{\mathrm{max}}")])
def test_names(name, written):
    assert name_latex(name) == written


def test_different_names_look_different():
    names = ["x1", "x_1", "x1_", "alpha", "alpha_"]
    assert len(set(names_latex(names).values())) == len(names)
    assert names_latex(names)["x_1"] == r"\mathrm{x\_1}"


@pytest.mark.parametrize("expression, written", [
    (x + y - z, "x + y - z"), (x - (y - z), r"x - \left(y - z\right)"), (x - (y + z), r"x - \left(y + z\right)"),
    (x + (-y), "x - y"), (x - (-y), r"x - \left(-y\right)"), ((x + y) * z, r"\left(x + y\right) \, z"),
    (x * x * x, "x^{3}"), (x**5 * 2, r"2 \, x^{5}"), ((x + y)**2, r"\left(x + y\right)^{2}"), (-x**2, "-x^{2}"),
    ((-x)**2, r"\left(-x\right)^{2}"), (x / (y + 1), r"\frac{x}{y + 1}"), ((x / y)**2, r"\left(\frac{x}{y}\right)^{2}"),
    (x**k, "x^{k}"), ((x * y)**k, r"\left(x \, y\right)^{k}"), (my.sqrt(x), r"\sqrt{x}"), (my.exp(-x), "e^{-x}"),
    (my.exp(x)**2, r"\left(e^{x}\right)^{2}"), (my.sin(x) * my.log(y), r"\sin\left(x\right) \, \ln\left(y\right)"),
    (1e-5 * x, r"10^{-5} \, x"), (2.5e300 + x, r"2.5 \cdot 10^{300} + x"), (-2 * x, r"-2 \, x"),
    (2 * (3 * x), r"2 \cdot 3 \, x"), (x * -3.0, r"-3 \, x"), (my.pi * x, r"\pi \, x"),
    (my.where(x > 1, y, -y), r"\begin{cases} y & \text{if } x > 1 \\ -y & \text{otherwise} \end{cases}"),
    ((x < 1) & (y >= 2) | (z != 0), r"\left(x < 1 \land y \ge 2\right) \lor z \ne 0"),
    (~(x <= 1), r"\lnot \left(x \le 1\right)"), (my.abs(x), r"\left|x\right|"),
    (x // y, r"\left\lfloor \frac{x}{y} \right\rfloor"), (x % y, r"x \bmod y"),
    (my.minimum(x, y), r"\min\left(x, y\right)"), (my.fma(x, y, z), r"x \, y + z")])
def test_expressions(expression, written):
    assert latex(expression) == written


def inner(text, start):
    """The place behind the brace that closes the one at `start`."""
    depth = 0
    for place in range(start, len(text)):
        depth += {"{": 1, "}": -1}.get(text[place], 0)
        if depth == 0:
            return place + 1
    raise AssertionError(f"a brace is not closed: {text}")


def as_python(text):
    """LaTeX of sums, products, fractions and powers as Python, with the rules of mathematics: a minus before a product
    is of the product, and a power of its base alone."""
    while (start := text.find(r"\frac{")) >= 0:
        middle = inner(text, start + 5)
        end = inner(text, middle)
        text = f"{text[:start]}(({text[start + 6:middle - 1]})/({text[middle + 1:end - 1]})){text[end:]}"
    text = text.replace(r"\left(", "(").replace(r"\right)", ")").replace(r"\,", "*").replace(r"\cdot", "*")
    while (start := text.find("^{")) >= 0:
        end = inner(text, start + 1)
        text = f"{text[:start]}**({text[start + 2:end - 1]}){text[end:]}"
    assert not re.search(r"[\\{}]", text), text
    return text


def test_the_text_means_what_the_expression_is():
    random = np.random.default_rng(1)
    values = {x: 1.3, y: 0.7, z: 2.1}

    def grown(depth):
        if depth == 0:
            return [x, y, z, make("constant", value=float(random.integers(-3, 4) or 2))][random.integers(4)]
        a, b = grown(depth - 1), grown(depth - random.integers(1, depth + 1))
        return [lambda: a + b, lambda: a - b, lambda: a * b, lambda: make("divide", (a, b)),
                lambda: make("negate", (a,)), lambda: a**2, lambda: make("fma", (a, b, x))][random.integers(7)]()

    compared = 0
    for _ in range(400):
        expression = grown(random.integers(1, 5))
        with np.errstate(all="ignore"):
            expected = evaluate([expression], values)[0]
        if not np.isfinite(expected):
            continue
        found = eval(as_python(latex(expression)), {}, {"x": 1.3, "y": 0.7, "z": 2.1})
        assert found == pytest.approx(expected, rel=1e-9, abs=1e-9), (expression, latex(expression))
        compared += 1
    assert compared > 300


def test_every_operation_has_a_text():
    for op in operations:
        if op in ("dot", "find_interval"):  # which have a table
            continue
        count = 3 if op in ("fma", "select") else 2 if op in (
            "add", "subtract", "multiply", "divide", "hypot", "atan2", "fmod", "floor_mod", "floor_divide", "quotient",
            "remainder", "copysign", "min", "max", "pow", "powr", "less", "less_equal", "greater", "greater_equal",
            "equal", "not_equal", "and", "or") else 1
        arguments = ((x < y) if op == "select" else x, y, z)[:count]
        written = latex(make(op, arguments))
        assert written.count("{") == written.count("}") and written.count(r"\left") == written.count(r"\right")
        assert all(name in re.sub(r"\\[a-z]+", "", written) for name in "xyz"[:count]), (op, written)


def test_long_equations_name_their_parts():
    value = x
    for _ in range(200):
        value = my.sin(value * value + value)
    written = my.model({x: value}, parameters=[my.parameter("w_1")]).latex()
    assert len(written) < 20_000 and r"u_{1} &= \sin\left(x^{2} + x\right)" in written
    assert my.model({x: x**100_000}).latex().count("\n") == 2


def test_a_model_has_all_its_parts():
    t, n, peak = my.time, my.integer_accessory("n"), my.accessory("peak")
    model = my.model({x: y, y: -k * x}, accessories={peak: my.phase_maximum(x * y), n: 0},
                     events=my.event(x - 1, name="hit_a", direction="rising", stop_after=3, do={y: -0.5 * y}),
                     stops=my.stop(0, every=24, count=5, do={x: x + 1}), finalise={my.t_end: my.t_end + 1},
                     triggers=my.trigger((x > 1) & (t < 5), do={y: 0, my.end_phase: n == 5}, delay=k, name="late"))
    lines = model.latex().split("\n")
    assert lines == [
        r"\begin{aligned}", r"\frac{\mathrm{d} x}{\mathrm{d} t} &= y \\",
        r"\frac{\mathrm{d} y}{\mathrm{d} t} &= -k \, x \\",
        r"\mathrm{peak} &= \max_{\mathrm{phase}} \left(x \, y\right) \\",
        r"\text{at the start of a phase:} & \; n \leftarrow 0 \\",
        r"\text{at the end of a phase:} & \; t_{\mathrm{end}} \leftarrow t_{\mathrm{end}} + 1 \\",
        r"\text{event hit\_a:} & \; x - 1 = 0\text{ (rising), the phase ends after 3} \; \Rightarrow \; y \leftarrow "
        r"-0.5 \, y \\",
        r"\text{stop stop\_1:} & \; t = 0 + i \left(24\right), \; i = 0, 1, \ldots, \; i < 5 \; \Rightarrow \; x "
        r"\leftarrow x + 1 \\",
        r"\text{trigger late:} & \; x > 1 \land t < 5\text{, after } k \; \Rightarrow \; y \leftarrow 0, \; "
        r"\text{end phase} \leftarrow n = 5", r"\end{aligned}"]


def test_mass_matrices_and_jumps_are_as_they_were_given():
    assert r"0 &= x - 1" in my.model({x: x - 1, y: x}, mass_matrix={x: 0}).latex()
    text = my.model({x: -x, y: x - y}, mass_matrix=[[2, -1], [0, 1e-5]]).latex()
    assert r"2 \, \frac{\mathrm{d} x}{\mathrm{d} t} - \frac{\mathrm{d} y}{\mathrm{d} t} &= -x" in text
    assert r"1 \cdot 10^{-5} \, \frac{\mathrm{d} y}{\mathrm{d} t} &= x - y" in text
    jumping = my.model({x: my.where(my.time < 1, 1.0, 0.0)}).latex()
    assert r"\begin{cases} 1 & \text{if } t < 1 \\ 0 & \text{otherwise} \end{cases}" in jumping
    assert jumping.count("\n") == 2  # without the stop that makes steps end there


def test_a_component_called_t_is_not_the_time():
    t = my.state("t")
    assert r"\frac{\mathrm{d} \mathrm{t}}{\mathrm{d} t} &= t - \mathrm{t}" in my.model({t: my.time - t}).latex()


def test_tables_are_named():
    A = my.table("A_1", np.arange(400.0).reshape(20, 20))
    assert latex(A[1, 2] * x) == r"\mathrm{A\_1}_{1,2} \, x"
    assert latex((A @ np.array([x] * 19 + [y], object))[3]).startswith(r"\mathrm{A\_1}_{3} \cdot \left(x, x, ")
    looked_up = latex(my.interpolate(x, [0, 1, 3.0], [1, 2, 5.0], name="data"))
    assert r"\operatorname{interval}_{\mathrm{data}}\left(" in looked_up


def test_any_text_is_plain():
    assert plain(r"50% of a_b & {c} \ $") == r"50\% of a\_b \& \{c\} \backslash  \$"


# Notebooks


class Reader(html.parser.HTMLParser):
    """The texts and tags of HTML, all of which are closed."""

    def __init__(self, text):
        super().__init__()
        self.open, self.texts, self.tags = [], [], set()
        self.feed(text)
        self.close()
        assert not self.open

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)
        self.tags.add(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append(data)


def test_notebooks_show_models():
    model = my.model({x: my.where(x < 1, y, -y), y: -x}, name="spring")
    shown = Reader(model._repr_html_())
    assert f"$${model.latex()}$$" in "".join(shown.texts) and shown.tags == {"p"}
    big = my.model({my.state(f"s_{i}"): i - my.state(f"s_{i}") for i in range(60)})
    assert "and 20 lines more: model.latex()" in "".join(Reader(big._repr_html_()).texts)


def test_notebooks_show_studies(tmp_path):
    study = my.study(my.model({x: -k * x}), my.grid({k: [1.0, 2.0], x: [1.0, 2.0, 3.0]}), time=(0, 1), interpreted=True)
    assert "6 instances" in Reader(study._repr_html_()).texts
    result = study.run(tmp_path / "<b>a & b", device="cpu")
    shown = Reader(result._repr_html_())
    assert shown.tags == {"table", "tr", "th", "td", "p"}
    assert "6 instances: k (2) x x_start (3)" in "".join(shown.texts)
    assert str(tmp_path / "<b>a & b") in "".join(shown.texts)


def test_notebooks_show_fits_and_profiles():
    model = my.model({x: -k * x})
    times = np.linspace(0.5, 3, 8)
    fit = my.fit(model, {"t": times, x: 2 * np.exp(-0.7 * times) + 0.01 * np.cos(9 * times)}, free={k: (0.01, 10)},
                 start={x: 2}, starts=2)
    fit.notes.append("<script> & more")
    for shown, of in ((fit._repr_html_(), fit), (fit.profile()._repr_html_(), fit.profile())):
        read = Reader(shown)
        assert {f"{fit.best['k']:.6g}", "k"} <= set(read.texts)
        assert read.tags <= {"table", "tr", "th", "td", "p"}
        for number in re.findall(r"\[(\S+), (\S+)\]", str(of))[0]:
            assert number in read.texts
    assert "note: <script> & more" in "".join(Reader(fit._repr_html_()).texts)
