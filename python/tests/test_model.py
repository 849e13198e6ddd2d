# SPDX-License-Identifier: MIT
"""Models as they are recorded: what users may write, what it means, and what is refused."""

import concurrent.futures
import copy
import inspect
import itertools
import math
import pickle

import numpy as np
import pytest

import example_models
import myriad_ode as my
from myriad_ode.kernels import nvrtc
from myriad_ode.symbolic.evaluate import evaluate
from myriad_ode.symbolic.node import walk

x, v = my.states("x v")
k, B = my.parameter("k"), my.shared("B")
a, n = my.accessory("a"), my.integer_accessory("n")


def value_of(expression, **values):
    """The value of an expression, by NumPy."""
    known = {symbol: values[symbol.value[1]] for symbol in walk([expression]) if symbol.op == "symbol"}
    return evaluate([expression], known)[0]


# ----------------------------------------------------------------------------------------------------------------------
# Expressions
# ----------------------------------------------------------------------------------------------------------------------


def test_equal_expressions_are_one_object():
    assert x + v is x + v and my.sin(x) is my.sin(x) and my.state("x") is x
    assert x + v is not v + x and x - 1 is x - 1.0 and my.parameter("x") is not x


def test_whole_powers_are_products_and_a_half_is_a_root():
    assert str(x**3) == "x * x * x" and str(x**0.5) == "sqrt(x)" and x**1 is x and str(x**-2) == "1 / (x * x)"
    assert str(x**3.0) == str(x**3) and (x**0).value == 1 and str(x**1.5) == "pow(x, 1.5)"
    assert value_of(x**13, x=1.7) == pytest.approx(1.7**13, rel=1e-14)


def test_quotients_of_whole_numbers_are_not_rounded():
    assert value_of(x * (1 / 3), x=1.0) == 1 / 3
    assert value_of(my.model("x' = 1/3").rhs[0]) == 1 / 3
    assert value_of(n / 2, n=3) == 1.5


@pytest.mark.parametrize("expression, expected", [
    (lambda x, v: -x**2 + v, lambda x, v: -x**2 + v),
    (lambda x, v: x - (v - (x - v)) - 2 * (x - v), lambda x, v: x - (v - (x - v)) - 2 * (x - v)),
    (lambda x, v: x / v / x / (v / x) * (x / (v * x)), lambda x, v: x / v / x / (v / x) * (x / (v * x))),
    (lambda x, v: 2**x + x % v + x // v + abs(-v), lambda x, v: 2**x + x % v + x // v + abs(-v)),
    (lambda x, v: my.where((x > v) | (v < 0) & ~(x <= 1), x, -v), lambda x, v: x if x > v or v < 0 and x > 1 else -v),
    (lambda x, v: my.maximum(x, v, 0.5) - my.minimum(x, v), lambda x, v: max(x, v, 0.5) - min(x, v)),
    (lambda x, v: np.sin(x) * np.exp(v) + np.float64(2) * x, lambda x, v: math.sin(x) * math.exp(v) + 2 * x),
    (lambda x, v: np.where(x > v, x, v) + np.clip(x, 0, 1), lambda x, v: max(x, v) + min(max(x, 0), 1)),
    (lambda x, v: my.atan2(x, v) + my.hypot(x, v) + my.copysign(x, -v),
     lambda x, v: math.atan2(x, v) + math.hypot(x, v) + math.copysign(x, -v)),
])
def test_expressions_have_the_values_of_python(expression, expected):
    for one, other in itertools.product((-1.3, 0.4, 2.5), (-0.7, 1.1)):
        assert value_of(expression(x, v), x=one, v=other) == pytest.approx(expected(one, other), rel=1e-15)


def test_arrays_of_expressions_multiply_like_arrays():
    A = np.array([[1.0, 2.0], [3.0, 4.0]])
    first, second = A @ np.array([x, v])
    assert value_of(first, x=5.0, v=6.0) == 17
    assert value_of(second, x=5.0, v=6.0) == 39
    assert [str(e) for e in np.array([2.0, 3.0]) * x] == ["2 * x", "3 * x"]


def test_a_long_sum_is_recorded_and_written():
    total = x
    for i in range(5000):
        total = total + v * (i + 0.5)
    model = my.model({x: total, v: 0})
    assert model.derivatives(0.0, [0.0, 1.0])[0] == sum(i + 0.5 for i in range(5000))
    assert all(len(line) <= 120 for line in model.cpp().splitlines())


def test_deeply_nested_expressions_are_written_in_several_statements():
    nested = x
    for _ in range(2000):
        nested = my.sin(nested * v)
    model = my.model({x: nested, v: 0})
    assert max(line.count("(") for line in model.cpp().splitlines()) < 60
    assert 0 < model.derivatives(0.0, [1.0, 1.1])[0] < 1


# ----------------------------------------------------------------------------------------------------------------------
# Models
# ----------------------------------------------------------------------------------------------------------------------


def of_dictionary():
    return my.model({x: v, v: x - x**3 - k * v + B * my.cos(my.time)}, name="duffing")


def duffing(t, y, k, B):
    x, v = y
    return [v, x - x**3 - k * v + B * np.cos(t)]


def of_sympy():
    sympy = pytest.importorskip("sympy")
    sx, sv, sk, sB, t = sympy.symbols("x v k B t")
    return my.model({sx: sv, sv: sx - sx**3 - sk * sv + sB * sympy.cos(t)}, parameters="k", shared="B", name="duffing")


@pytest.mark.parametrize("make", [
    lambda: my.model(duffing, states="x v", shared="B"),
    lambda: my.model("x' = v; v' = x - x^3 - k*v + B*cos(t)", parameters="k", shared="B", name="duffing"),
    lambda: my.model("dx/dt = v  # a comment\n force = B*cos(t)\n v' = x - x**3 - k*v + force", parameters="k",
                     shared="B", name="duffing"),
    lambda: my.model({"x": "v", "v": "x - x**3 - k*v + B*cos(t)"}, parameters="k", shared="B", name="duffing"),
])
def test_a_model_is_the_same_as_dictionary_function_and_text(make):
    assert make().cpp() == of_dictionary().cpp() and make().hash == of_dictionary().hash


def test_a_model_of_sympy_computes_the_same():
    model, other = of_sympy(), of_dictionary()
    at = dict(t=0.7, y=[np.array([0.3, 1.4]), np.array([-0.2, 0.8])], k=0.25, B=0.3)
    assert model.states == ["x", "v"] and model.parameters == ["k"] and model.shared == ["B"]
    np.testing.assert_allclose(model.derivatives(**at), other.derivatives(**at), rtol=1e-14)


def test_sympy_functions_are_translated():
    sympy = pytest.importorskip("sympy")
    sx, sv, sk = sympy.symbols("x v k")
    e = (sympy.Piecewise((sx**2, sx > sv), (sympy.sqrt(sx), True)) + sympy.Max(sx, sv) - sx / (3 * sv)
         + sympy.exp(-sx) * sympy.Rational(2, 3) + sympy.atan2(sv, sx) + abs(sv) + sympy.pi + sx**sk)
    model = my.model({sx: e, sv: -sympy.Heaviside(sx, 0)}, parameters="k")
    for one, other in ((1.2, 0.4), (0.5, 2.0)):
        expected = float(e.subs({sx: one, sv: other, sk: 1.3}))
        assert model.derivatives(0.0, [one, other], k=1.3)[0] == pytest.approx(expected, rel=1e-14)
        assert model.derivatives(0.0, [one, other], k=1.3)[1] == -1


def test_derivatives_can_be_integrated_by_scipy():
    integrate = pytest.importorskip("scipy.integrate")
    model = my.model("x' = v; v' = -k*x", parameters="k")
    solution = integrate.solve_ivp(lambda t, y: model.derivatives(t, y, k=1.0), (0, math.pi), [1.0, 0.0], rtol=1e-10,
                                   atol=1e-12)
    assert solution.y[0, -1] == pytest.approx(-1, abs=1e-8)


def test_assignments_take_effect_together():
    lines = my.model({x: v, v: x}, finalise={x: v, v: x}).cpp()
    assert "const auto next_v = lane.y[x];" in lines
    statements = ["next_v = lane.y[x]", "lane.y[x] = lane.y[v];", "lane.y[v] = next_v;"]
    assert sorted(statements, key=lines.index) == statements


def test_accessories_that_equations_read_are_no_outputs():
    assert my.model({x: v, v: -x}, accessories={a: x}).accessories_are_outputs
    assert not my.model({x: v * a, v: -x}, accessories={a: x}).accessories_are_outputs
    assert not my.model({x: v, v: my.where(n == 1, x, v)}, after_step={n: n + 1}).accessories_are_outputs


def test_components_keep_the_order_in_which_they_are_declared():
    q, r = my.shared("q r")
    model = my.model({v: r * x + q, x: v}, shared=(q, r), states="x v")
    assert model.states == ["x", "v"] and model.shared == ["q", "r"]
    assert my.model({v: r * x + q, x: v}).states == ["v", "x"]


def test_names_of_a_models_components_do_not_clash_with_those_of_arguments():
    names = "t y p R lane"
    model = my.model({s: 1.5 * my.time for s in my.states(names)}, finalise={my.state("y"): 0.5})
    assert "rhs(auto time, const myriad::vec<S, n_state>&, const auto&)" in model.cpp()
    assert "instance.y[y] = S(0.5);" in model.cpp()


def test_the_text_of_a_model_depends_only_on_the_model():
    texts = {make().cpp() for make in [example_models.relief_valve] * 3}
    assert len(texts) == 1
    changed = my.model({x: v, v: x - x**3 - k * v + 2 * B * my.cos(my.time)})
    assert changed.hash != of_dictionary().hash


def test_a_function_gives_the_model_its_name_where_it_can():
    def rhs(t, y):
        return [y[0]]

    assert my.model(duffing, states="x v").name == "duffing"
    assert my.model(rhs, states="x").name == my.model(lambda t, y: [y[0]], states="x").name == "model"
    assert my.model({my.state("model"): 1}).name == "traced"


def test_models_can_be_pickled():
    model = example_models.relief_valve()
    copied = pickle.loads(pickle.dumps(model))
    assert copied.hash == model.hash and copied.rhs[0] is model.rhs[0] and copy.deepcopy(x) is x
    states = my.states([f"y{i}" for i in range(12)])
    model = my.model(dict(zip(states, my.table("W", np.ones((12, 12))) @ states)))
    assert pickle.loads(pickle.dumps(model)).cpp() == model.cpp()


def test_threads_record_the_same_nodes():
    def record(_):
        return [my.sin(x * (i + 0.125)) for i in range(300)]

    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        made = list(pool.map(record, range(8)))
    assert all(a is b for other in made for a, b in zip(made[0], other))


# ----------------------------------------------------------------------------------------------------------------------
# What is refused
# ----------------------------------------------------------------------------------------------------------------------


def branching(t, y):
    return [y[1], 1.0 if y[0] > 0 else -1.0]


def of_wrong_shape(t, y, A=np.ones((3, 3))):  # noqa: B008, a constant
    return A @ y


@pytest.mark.parametrize("make, message", [
    # names
    (lambda: my.state("new"), "'new' is a keyword of C.*call it 'new_'"),
    (lambda: my.parameter("n_state"), "'n_state' has a meaning of its own"),
    (lambda: my.states("rhs v"), "'rhs' has a meaning of its own"),
    (lambda: my.state("\u03bc"), "no name for a state"),
    (lambda: my.state("2x"), "no name for a state"),
    (lambda: my.state("x__y"), "single underscores"),
    (lambda: my.states("x x"), "'x' is given twice"),
    (lambda: my.states(""), "no names are given"),
    (lambda: my.model({x: my.parameter("x")}), "'x' names both a state and a parameter"),
    (lambda: my.model({x: v, v: x}, events=[my.event(x, name="v")]), "'v' names both a state and an event"),
    (lambda: my.model({x: v, v: x}, events=[my.event(x, name="e"), my.event(v, name="e")]), "name of two components"),
    (lambda: my.model({x: 1}, name="x"), "name of its state 'x'"),
    # equations
    (lambda: my.model({x: v}), "the state v .*has no equation"),
    (lambda: my.model({k: 1}), "k is no state but a parameter"),
    (lambda: my.model({}), "give a dictionary"),
    (lambda: my.model(3), "give a dictionary"),
    (lambda: my.model({x: [1, 2]}), "has 2 values"),
    (lambda: my.model({x: np.ones(3)}), "has 3 values"),
    (lambda: my.model({x: "k * x"}), "'k' is unknown: name it in parameters="),
    (lambda: my.model("x' = k"), "'k' is unknown"),
    (lambda: my.model("x' = v +"), "is no expression"),
    (lambda: my.model("x' = foo(x)"), "no function of myriad"),
    (lambda: my.model("x' = sin(x, x)"), "another number than sin takes"),
    (lambda: my.model("x' = 1; x' = 2"), "has an equation already"),
    (lambda: my.model("x = 1"), "has no equation of a state"),
    (lambda: my.model("x' = 1; x = 2"), "has a meaning already"),
    (lambda: my.model("x' = y.z", parameters="y"), "is not understood"),
    (lambda: my.model({x: my.phase * 1.0}), "only hooks and actions see it"),
    (lambda: my.model({x: x * n}), "mixes whole and real numbers"),
    (lambda: my.model({x: my.powr(2, x)}), "has no derivative by its exponent"),
    # numbers
    (lambda: x * float("nan"), "a constant is NaN"),
    (lambda: x + 1j, "is complex"),
    (lambda: x + "1", "is not an expression"),
    (lambda: my.sin(np.ones(3)), r"array of shape \(3,\)"),
    (lambda: my.model("x' = 1 / 0"), "1 is divided by zero"),
    (lambda: x * 10**400, "too large for double precision"),
    (lambda: math.sin(x), "my.sin, not math.sin"),
    (lambda: float(x), "is not a number yet"),
    (lambda: bool(x > 0), "use my.where"),
    (lambda: 0 < x < 1, "use my.where"),
    (lambda: x if x > 0 else v, "use my.where"),
    (lambda: list(x), "cannot be iterated"),
    (lambda: my.where(x, 1, 2), "is a number and not a condition"),
    (lambda: (x > 0) & 1, "is a number and not a condition"),
    (lambda: my.sin(x > 0), "is a condition and not a number"),
    (lambda: np.spacing(x), "numpy.spacing cannot be applied"),
    # functions
    (lambda: my.model(branching, states="x v"), "use my.where"),
    (lambda: my.model(of_wrong_shape, states="x v"), r"of_wrong_shape failed .*y has shape \(2,\)"),
    (lambda: my.model(duffing), "states of duffing have no names"),
    (lambda: my.model(duffing, states="x v", parameters="c"), "'c' is no argument of duffing"),
    (lambda: my.model(lambda t, y: [1], states="x v"), r"returns values of shape \(1,\)"),
    (lambda: my.model(lambda t, y: None, states="x v"), "returns nothing"),
    (lambda: my.model(lambda t: [1], states="x"), "first two are time and state"),
    (lambda: my.model(lambda t, y, *args: [1], states="x"), r"takes \*args"),
    # events, accessories and hooks
    (lambda: my.event(x, direction="up"), "choose \"rising\""),
    (lambda: my.event(x, tolerance=-1), "the tolerance of an event is -1"),
    (lambda: my.event(x, stop_after=-1), "stop_after is -1"),
    (lambda: my.model({x: 1}, events=[x]), "make it by my.event"),
    (lambda: my.model({x: 1}, events=[my.event(x, do={B: 1})]), "assigns B.*which no hook may"),
    (lambda: my.model({x: 1}, events=[my.event(x, do={"x": 0, x: 1})]), "x is assigned twice in event event_1"),
    (lambda: my.model({x: 1}, accessories={a: 0}, initialise={a: 1}), "a is assigned twice in initialise"),
    (lambda: my.model({x: 1}, accessories={x: 0}), "x is no accessory but a state"),
    (lambda: my.model({}), "a model has no equation .*: give a dictionary"),
    (lambda: my.model({x: 1}, accessories={n: 0.5}), "gives the whole number n the real value"),
    (lambda: my.model({x: 1}, accessories={n: my.integral(x)}), "make it by my.accessory"),
    (lambda: my.model({x: 1}, accessories={a: my.time_of_maximum(x)}), "add one with my.phase_maximum"),
    (lambda: my.model({x: 1}, initialise={my.end_phase: True}), "only after_step and events can end a phase"),
    (lambda: my.model({x: 1}, after_step={my.end_phase: 1}), "is a number and not a condition"),
    (lambda: my.model({x: 1}, after_step={a: my.event_count("e")}), "names no event: there are none"),
    (lambda: my.model({x: 1}, finalise={my.time: 0}), "assigns time"),
    (lambda: my.model({x: 1}, finalise={x + 1: 0}), "stands where a component is assigned"),
    (lambda: of_dictionary().derivatives(0.0, [1, 2], k=1), "needs a value of B"),
])
def test_wrong_models_are_refused(make, message):
    with pytest.raises(my.Error, match=message):
        make()


def test_messages_name_the_users_line():
    with pytest.raises(my.Error, match=r"test_model.py:\d+"):
        my.model({x: v})
    with pytest.raises(my.Error, match=r"test_model.py:\d+"):
        x * float("nan")


def test_conditions_are_compared_and_not_their_identity():
    one, other = x > 0, my.time > -1
    equal, differ = my.where(one == other, 1.0, 2.0), my.where(one != other, 1.0, 2.0)
    for values in ([1.0, 0.0], [-1.0, 0.0], [1.0, -2.0], [-1.0, -2.0]):
        known = {x: values[0], my.time: values[1]}
        same = (values[0] > 0) == (values[1] > -1)
        assert evaluate([equal, differ], known) == ([1.0, 2.0] if same else [2.0, 1.0])
    assert (one == True) is one and (one ^ True) is ~one and (one == one).value  # noqa: E712


def test_copies_of_symbols_are_the_symbols():
    for copied in (copy.copy, copy.deepcopy, lambda it: pickle.loads(pickle.dumps(it))):
        assert copied(x) is x and copied([x * 2])[0] is x * 2


def test_sympys_derivatives():
    sympy = pytest.importorskip("sympy")
    t = sympy.Symbol("t")
    x, v = (sympy.Function(name)(t) for name in "xv")
    assert my.model({x.diff(t): v, v.diff(t): -x * t}).cpp("it") == my.model("x' = v; v' = -(t * x)").cpp("it")
    for wrong, message in (({x.diff(t, 2): -x}, "derivative of order 2"),
                           ({x: v, v: -x - x.diff(t)}, "is a derivative within an expression")):
        with pytest.raises(my.Error, match=message):
            my.model(wrong)


def test_numpys_functions_of_the_vector_of_states():
    def f(t, y):
        slope = np.zeros_like(y)
        slope[0] = np.where(y > 0, y, 0.5)[1]
        slope[1] = -np.clip(y, -1, 1)[0]
        slope *= 2
        return slope + np.array([[1.0, 2.0], [3.0, 4.0]]) @ np.sin(y)

    found = my.model(f, states="x v").derivatives(0.0, [3.0, -2.0])
    assert np.allclose(found, [1 + np.sin(3) - 2 * np.sin(2), -2 + 3 * np.sin(3) - 4 * np.sin(2)])

    def in_numbers(t, y):
        slope = np.zeros(2)
        slope[0] = y[1]
        return slope

    with pytest.raises(my.Error, match=r"np.zeros_like\(y\)"):
        my.model(in_numbers, states="x v")


def test_names_of_arguments_that_are_all_taken():
    model = my.model({"y": "s + u + state_", "s": "y", "u": "y", "state_": "1"})
    assert "y_1[s] + y_1[u] + y_1[state_]" in model.cpp()


def test_every_kind_of_component_has_names_in_every_model_and_a_symbol():
    from myriad_ode.base import component_kinds as kinds
    from myriad_ode.models import any_model
    plurals = [kind.plural for kind in kinds.every.values()]
    assert sorted(plurals) == sorted(any_model.ComponentNames.__annotations__)
    assert set(plurals) <= set(inspect.signature(my.CppModel).parameters)
    assert all(getattr(my, kind)(f"one_{kind}").value == (kind, f"one_{kind}") for kind in kinds.valued)


def test_a_gpu_takes_exact_functions_in_single_precision_where_a_model_asks_for_them():
    def source(model):
        written, struct = model.device_source("cash_karp", "float")
        return nvrtc.source_of(written, struct, "myriad::cash_karp", "float", "constant_bank")

    def pendulum(**options):
        x, v = my.states("x v")
        return my.model({x: v, v: -my.sin(x)}, **options)

    def ring(**options):
        x, v = (units := my.units(40)).states("x v")
        return my.model({x: v, v: -units.parameter("k") * np.roll(x, 1)}, **options)

    in_cpp = my.CppModel("#define MYRIAD_EXACT_FLOAT\n" + pendulum().cpp("pendulum"), "pendulum", "x v")
    with_tangents = my.with_tangents(pendulum(exact_float=True))
    for model in (pendulum(exact_float=True), with_tangents, ring(exact_float=True), in_cpp):
        assert source(model).startswith("#define MYRIAD_EXACT_FLOAT\n#include")  # before all of the library
    for model in (pendulum(), ring()):
        assert "EXACT_FLOAT" not in source(model)
