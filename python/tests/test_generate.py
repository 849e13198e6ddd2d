# SPDX-License-Identifier: MIT
"""Models that generate the instances of their studies, against the same instances laid out on the host."""

import concurrent.futures
import pickle

import numpy as np
import pytest

import myriad_ode as my

x, y, z = my.states("x y z")
rho, beta = my.parameter("rho"), my.shared("beta")
n, a, y_0 = my.integer_accessory("n"), my.accessory("a"), my.accessory("y_0")


def lorenz(**more):
    return my.model({x: 10 * (y - x), y: x * (rho - z) - y, z: x * y - beta * z}, **more)


random_starts = {x: my.uniform(-10, 10), y: my.normal(0, 5), z: my.uniform(15, 35)}
everything = {**random_starts, rho: 28 + my.instance // 7 * 0.5, n: my.instance % 3, a: my.instance / 4}
kept = ["x_end", "y_end", "z_end", "rho_end", "n_end", "a_end"]
call = dict(time=(0, 0.1), method="runge_kutta_4", step=0.01, keep=[x, y, z, rho, n, a])


def generated(draws=500, model=None, **more):
    return my.study(model or lorenz(generate=everything), {beta: 8 / 3}, draws=draws, **{**call, **more})


def starts(draws=500, **more):
    """What is generated, by name, as the states at the begin are kept in accessories."""
    names = [my.accessory(f"{s.value[1]}_0") for s in (x, y, z)]
    model = lorenz(generate=everything, initialise=dict(zip(names, (x, y, z))))
    found = generated(draws, model, **{**more, "keep": [*names, rho, n, a]}).run(device="cpu")
    return {**dict(zip((x, y, z), (found[f"{s.value[1]}_end"] for s in names))),
            rho: found["rho_end"], n: found["n_end"], a: found["a_end"]}


def listed(start, **more):
    """The study of the same instances, laid out on the host."""
    return my.study(lorenz(accessories={n: n, a: a}), {beta: 8 / 3, rho: start[rho]},
                    start={k: start[k] for k in (x, y, z, n, a)}, **{**call, **more})


@pytest.mark.parametrize("more", [{}, dict(interpreted=True), dict(precision="float"), dict(seed=7)])
def test_generated_instances_have_the_bits_of_those_that_the_host_lays_out(more):
    start = starts(**more)
    result, expected = generated(**more).run(device="cpu", chunk=64), listed(start, **more).run(device="cpu")
    assert result.complete and result.by_status == {"success": 500}
    for name in kept:
        np.testing.assert_array_equal(result[name], expected[name].reshape(500), name)


def test_random_numbers_are_those_of_the_cpp_library():
    """Philox 4x32-10 of (instance, number of the draw) in the phase of generators, -2, with the seed as the key."""
    def words(seed, index, draw):
        counter, key = [index, 0, (1 << 32) - 2, draw], [seed & 0xffffffff, seed >> 32]
        for _ in range(10):
            p, q = 0xd2511f53 * counter[0], 0xcd9e8d57 * counter[2]
            counter = [q >> 32 ^ counter[1] ^ key[0], q & 0xffffffff, p >> 32 ^ counter[3] ^ key[1], p & 0xffffffff]
            key = [(key[0] + 0x9e3779b9) & 0xffffffff, (key[1] + 0xbb67ae85) & 0xffffffff]
        return counter

    def uniform(seed, index, draw):
        bits = words(seed, index, draw)
        return ((bits[1] << 32 | bits[0]) >> 11 | 1) / 2**53

    start = starts(20, seed=3 << 33)
    for i in range(20):
        assert abs(start[x][i] - (-10 + 20 * uniform(3 << 33, i, 0))) <= 2e-15
        assert abs(start[z][i] - (15 + 20 * uniform(3 << 33, i, 2))) <= 8e-15
    assert len(set(starts(seed=4)[x]) & set(starts()[x])) == 0
    np.testing.assert_array_equal(start[rho], 28 + np.arange(20) // 7 * 0.5)
    np.testing.assert_array_equal(start[n], np.arange(20) % 3)
    np.testing.assert_array_equal(start[a], np.arange(20) / 4)


def test_normal_numbers_have_their_distribution():
    from scipy import stats
    values = starts(20_000)[y]
    assert stats.kstest(values, stats.norm(0, 5).cdf).pvalue > 1e-3


def test_each_call_is_a_draw_and_a_variable_is_one():
    u, v = my.uniform(), my.uniform()
    drawn = {name: my.accessory(name) for name in ("first", "second", "sum", "twice")}
    model = my.model({x: -x}, generate={x: 1, **dict(zip(drawn.values(), (u, v, u + v, 2 * u)))})
    result = my.study(model, draws=9, time=(0, 1), keep=list(drawn)).run(device="cpu")
    first, second, total, twice = (result[f"{name}_end"] for name in drawn)
    assert len({*first, *second}) == 18
    np.testing.assert_array_equal(total, first + second)
    np.testing.assert_array_equal(twice, 2 * first)
    assert model.cpp().count("random.uniform") == 2


def test_the_block_is_written_as_in_cpp():
    assert """
    MYRIAD_FUNCTION static void generate(auto& instance) {
        using R = typename std::remove_cvref_t<decltype(instance)>::real;
        instance.y[x] = instance.random.uniform(-10, 10);
        instance.y[y] = instance.random.normal(0, 5);
        instance.y[z] = instance.random.uniform(15, 35);
        instance.parameter[rho] = 28 + R(instance.index / 7) * R(0.5);
        instance.integer_accessory[n] = instance.index % 3;
        instance.accessory[a] = R(instance.index) / 4;
    }
};
""" in lorenz(generate=everything).cpp()
    assert lorenz(generate=everything).hash != lorenz(generate={**everything, x: my.uniform(-10, 11)}).hash
    assert lorenz(generate=everything).hash == lorenz(generate=dict(everything)).hash


@pytest.mark.parametrize("interpreted", [False, True])
def test_whole_numbers_are_those_of_python(interpreted):
    i, k = my.instance, my.shared_integer("k")
    values = [my.minimum(i, 5), my.maximum(3, i), my.where(i < 20_000_000_000, i, 3), (i // 3 + 2 * i) % 5,
              (i + 3_000_000_000) // 1_000_000_000, i**2, i % k, -i // 2]
    numbers = np.arange(12)
    expected = [np.minimum(numbers, 5), np.maximum(3, numbers), numbers, (numbers // 3 + 2 * numbers) % 5,
                np.full(12, 3), numbers**2, numbers % 4, -numbers // 2]
    for first in (0, 4):  # the interpreter has six accessories
        symbols = [my.accessory(f"a{c}") for c in range(4)]
        model = my.model({x: -x}, generate={x: 1, **dict(zip(symbols, values[first:]))})
        given = {k: 4} if first else {}
        result = my.study(model, given, draws=12, time=(0, 1), keep=symbols, interpreted=interpreted).run(device="cpu")
        for c, _ in enumerate(symbols):
            np.testing.assert_array_equal(result[f"a{c}_end"], expected[first + c], str(values[first + c]))


@pytest.mark.parametrize("more", [{}, dict(interpreted=True), dict(precision="float")])
def test_real_numbers_beside_that_of_the_instance_are_not_cut(more):
    i, drawn = my.instance, my.uniform(0, 1)
    curve = my.interpolate(i, [0.5, 1.5, 2.5], [1, 3, 9])
    values = [my.minimum(i, 2.5), my.maximum(0.25 * i, -0.5 - i), my.minimum(drawn, i + 1), drawn, curve]
    symbols = [my.accessory(f"a{c}") for c in range(5)]
    model = my.model({x: -x}, generate={x: 1, **dict(zip(symbols, values))},
                     initialise={y_0: my.minimum(my.instance, 2.5)})
    result = my.study(model, draws=9, time=(0, 0.1), keep=[*symbols, y_0], **more).run(device="cpu")
    n = np.arange(9)
    limited, quarter, least, uniform, line = (result[f"a{c}_end"] for c in range(5))
    np.testing.assert_array_equal(limited, np.minimum(n, 2.5))
    np.testing.assert_array_equal(quarter, 0.25 * n)
    np.testing.assert_array_equal(least, uniform)
    np.testing.assert_allclose(line, np.interp(n, [0.5, 1.5, 2.5], [1, 3, 9]), rtol=1e-6)
    np.testing.assert_array_equal(result["y_0_end"], np.minimum(n, 2.5))


def test_places_counted_from_behind_are_exact_in_single_precision():
    i, first = my.instance, 100_000_001
    values = [(i - first) % 3, (first - i) % 7, -(i + first) // 10 + 10_000_000, (5 * (i - first) - 2) // 4 + 2**27]
    symbols = [my.accessory(f"a{c}") for c in range(4)]
    model = my.model({x: -x}, generate={x: 1, **dict(zip(symbols, values))})
    result = my.study(model, draws=12, time=(0, 0.1), precision="float", keep=symbols).run(device="cpu")
    n = np.arange(12)
    expected = [(n - first) % 3, (first - n) % 7, -(n + first) // 10 + 10_000_000, (5 * (n - first) - 2) // 4 + 2**27]
    for c, _ in enumerate(symbols):
        np.testing.assert_array_equal(result[f"a{c}_end"], expected[c], str(values[c]))


def test_places_of_a_grid_are_exact_in_single_precision():
    last = my.accessory("last")
    model = my.model({x: -x}, generate={x: 1, last: (my.instance + 5_000_000_001) % 10})
    result = my.study(model, draws=10, time=(0, 0.1), precision="float", keep=[last]).run(device="cpu")
    np.testing.assert_array_equal(result["last_end"], (np.arange(10) + 1) % 10)


@pytest.mark.parametrize("interpreted", [False, True])
def test_a_block_reads_axes_tables_and_shared_values(interpreted):
    table, k = my.table("T", np.arange(18.0).reshape(2, 9)), my.parameter("k")
    curve = my.interpolate(my.instance, [0, 1, 4], [1, 3, 9], name="curve")
    products = table @ np.array([k, *np.ones(8)], object)
    model = my.model({x: -k * x}, generate={x: beta * k + table[1, 2], y_0: products[1], a: curve})
    study = my.study(model, my.grid({k: my.linspace(1, 2, 5)}, {beta: 3}), draws=2, time=(0, 1), keep=[x, y_0, a],
                     interpreted=interpreted, rtol=1e-11)
    result = study.run(device="cpu")
    assert result.shape == (5, 2)
    k_values = np.repeat(np.linspace(1, 2, 5)[:, None], 2, axis=1)
    np.testing.assert_allclose(result["x_end"], (3 * k_values + 11) * np.exp(-k_values), rtol=1e-8)
    np.testing.assert_allclose(result["y_0_end"], 9 * k_values + sum(range(10, 18)), rtol=1e-12)
    np.testing.assert_allclose(result["a_end"].ravel(), np.interp(np.arange(10), [0, 1, 4], [1, 3, 9]), rtol=1e-12)


def test_a_study_with_axes_and_a_block_has_reductions_and_a_store(tmp_path):
    edges = my.linspace(-20, 20, 41)
    study = generated(400, reduce=[my.reduce.histogram("x_end", edges), my.reduce.mean("x_end")])
    result = study.run(tmp_path / "store", device="cpu", chunk=32)
    counted, _ = np.histogram(result["x_end"], np.linspace(-20, 20, 41))
    np.testing.assert_array_equal(result["x_end_histogram"], counted)
    assert result.description["generator"].startswith("x = uniform(-10, 10); y = normal(0, 5)")
    assert result.description["axes"]["seed"] == 0


def test_a_generated_study_goes_on_with_the_same_bits(tmp_path):
    def stop(done, total):
        if done >= 100:
            raise KeyboardInterrupt

    try:
        generated(5000).run(tmp_path / "store", device="cpu:1", chunk=50, progress=stop)
    except my.Interrupted as interrupted:
        assert not interrupted.run.complete
    result = generated(5000).run(tmp_path / "store", device="cpu:1", chunk=50)
    whole = generated(5000).run(device="cpu")
    assert result.complete
    for name in kept:
        np.testing.assert_array_equal(result[name], whole[name], name)


def test_a_store_of_another_block_is_refused_with_what_differs(tmp_path):
    generated(10).run(tmp_path / "store", device="cpu")
    other = lorenz(generate={**everything, x: my.uniform(-10, 11)})
    with pytest.raises(my.Error, match=r'generator: "x = uniform\(-10, 10\).*in the store, "x = uniform\(-10, 11\)'):
        generated(10, other).run(tmp_path / "store", device="cpu")
    with pytest.raises(my.Error, match="seed: 0 in the store, 1 here"):
        generated(10, seed=1).run(tmp_path / "store", device="cpu")
    assert generated(10, lorenz(generate=pickle.loads(pickle.dumps(everything)))).run(
        tmp_path / "store", device="cpu").complete


def test_workers_of_an_executor_generate_their_chunks():
    whole = generated(100).run(device="cpu")
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        result = generated(100).run(executor=pool, chunk=7)
    np.testing.assert_array_equal(result["x_end"], whole["x_end"])


def test_instances_that_are_not_finite_are_marked():
    model = lorenz(generate={**everything, x: my.where(my.instance % 5 == 0, 1.0, 0.0) / (my.instance % 5)})
    assert generated(50, model).run(device="cpu").by_status == {"success": 40, "invalid_input": 10}


def test_text_and_sympy_name_the_instance_and_draw():
    sympy = pytest.importorskip("sympy")
    by_text = {"x": "uniform(-10, 10)", "y": "normal(0, 5)", "z": "uniform(15, 35)", "rho": "28 + instance // 7 * 0.5",
               "n": "instance % 3", "a": sympy.Symbol("instance") / 4}
    written = lorenz(accessories={"a": None}, generate={n if key == "n" else key: value
                                                        for key, value in by_text.items()})
    ours, theirs = generated(50, written).run(device="cpu"), generated(50).run(device="cpu")
    for name in kept:
        np.testing.assert_array_equal(ours[name], theirs[name], name)


@pytest.mark.parametrize("given, message", [
    (dict(generate={my.t_end: 1}), "generate assigns t_end.*give my.study the time domain"),
    (dict(generate={beta: 1}), "generate assigns beta.*what all instances share"),
    (dict(generate={x: my.time}), "generate reads time.*before there is any"),
    (dict(generate={x: 1, y: 2 * x}), "generate reads x.*which it sets itself"),
    (dict(generate={x: 1, "x": 2}), "x is assigned twice in generate"),
    (dict(generate={x: my.linspace(0, 1, 3)}), "generate sets x to linspace.*write it with my.instance"),
    (dict(generate={n: my.instance / 2}), "generate gives the whole number n the real value `instance / 2`"),
    (dict(generate={"w": 1}), "generate.*'w' is unknown"),
    (dict(generate={my.state("w"): 1}), "the state w.*has no equation"),
    (dict(generate={x: "sin(instances)"}), "generate.*'instances' is unknown"),
    (dict(initialise={rho: my.uniform()}), "`uniform.0, 1.`.*random numbers are for generate="),
])
def test_messages_of_blocks(given, message):
    with pytest.raises(my.Error, match=message):
        lorenz(**given)


def test_an_instance_is_no_index_and_no_complex_number():
    with pytest.raises(my.Error, match="`instance` is not a number yet"):
        lorenz(generate={x: [1, 2][my.instance]})
    with pytest.raises(my.Error, match="is complex.*a model is real"):
        lorenz(generate={x: 1j * my.instance})


def test_a_model_in_cpp_generates_too():
    text, struct = lorenz(generate=everything).source()
    written = my.CppModel(text, struct, "x y z", "rho", "beta", accessories="a", integer_accessories="n",
                          generates="x y z rho n a")
    ours, theirs = generated(100).run(device="cpu"), generated(100, written).run(device="cpu")
    for name in kept:
        np.testing.assert_array_equal(ours[name], theirs[name], name)
    with pytest.raises(my.Error, match="value of 'x', 'y', 'z' is missing"):
        generated(5, my.CppModel(text, struct, "x y z", "rho", "beta", accessories="a", integer_accessories="n"))
    with pytest.raises(my.Error, match="the model's struct has no generate"):
        plain, name = lorenz().source()
        generated(5, my.CppModel(plain, name, "x y z", "rho", "beta", generates="x y z rho"), keep=[x]).run(
            device="cpu")


def test_components_may_have_the_names_that_the_block_uses():
    instance, drawn, u = my.parameter("instance"), my.accessory("uniform"), my.uniform()
    model = my.model({x: -instance * x}, generate={x: u, drawn: 2 * u, instance: my.instance})
    result = my.study(model, draws=5, time=(0, 1), keep=[x, instance, drawn], rtol=1e-11).run(device="cpu")
    np.testing.assert_array_equal(result["parameter_instance_end"], np.arange(5))
    np.testing.assert_allclose(result["x_end"], result["uniform_end"] / 2 * np.exp(-np.arange(5)), rtol=1e-6)
    with pytest.raises(my.Error, match="'generate' has a meaning of its own in a C.. model"):
        my.state("generate")


def test_work_is_counted_where_it_is_kept():
    result = generated(20, keep=dict(end=[x], work=True)).run(device="cpu")
    np.testing.assert_array_equal(result["accepted_steps"], np.full(20, 10))
    assert "accepted_steps" not in generated(20).run(device="cpu").names


def test_messages_of_studies():
    model = lorenz(generate=random_starts)
    for sweep, more, message in (
            ({beta: 1, rho: 28, x: my.linspace(0, 1, 5)}, {}, "'x' is given to the study, and generate= of the model"),
            ({beta: 1, rho: 28}, dict(start={y: 1}, draws=3), "'y' is given to the study, and generate="),
            (my.grid({rho: [28, 29], z: [1, 2]}, {beta: 1}), {}, "'z' is given to the study, and generate="),
            ({beta: 1, rho: 28}, {}, "nothing says how many: give draws="),
            ({rho: 28}, dict(draws=3), "value of 'beta' is missing: give it in the sweep$"),
            ({beta: 1}, dict(draws=3), "value of 'rho' is missing")):
        with pytest.raises(my.Error, match=message):
            my.study(model, sweep, time=(0, 1), **more)
    with pytest.raises(my.Error, match="'x', 'y', 'z' is missing: give it in start=, as generate= sets instances of "
                                       "studies alone"):
        my.solve(model, {beta: 1, rho: 28}, time=(0, 1))
    run = my.solve(model, {beta: 1, rho: 28}, start={x: 1, y: 1, z: 1}, time=(0, 1), device="cpu")
    assert run.report.by_status == {"success": 1}


def test_tangents_leave_no_instance_ungenerated():
    model = my.with_tangents(lorenz(accessories={n: n, a: a}, generate=everything), 1)
    with_tangents, without = generated(50, model).run(device="cpu"), generated(50).run(device="cpu")
    for name in ("rho_end", "n_end", "a_end"):
        np.testing.assert_array_equal(with_tangents[name], without[name], name)
    np.testing.assert_allclose(with_tangents["x_end"], without["x_end"], rtol=1e-12)


@pytest.mark.parametrize("draws, values, message", [
    (2**31 + 1, {n: my.instance}, "n values from 0 to 2147483648 in a study of 2147483649.*32 bits: use an acc"),
    (2**31 + 2, {n: -my.instance}, "n values from -2147483649 to 0"),
    (2**32 + 1, {n: my.instance // 2}, "n values from 0 to 2147483648"),
    (2**27, {a: my.instance**2 % 1000}, "computes `instance . instance`.*from 0 to 18014398241046529.*exact up to"),
    (9, {a: (my.instance * 6364136223846793005 + 1) % 1000}, "computes `6364136223846793005`.*begin with a real"),
    (9, {a: my.shared_integer("k") * my.shared_integer("k")}, "computes `k . k`.*from 2500000000 to 2500000000"),
])
def test_whole_numbers_of_large_studies_are_not_cut_silently(draws, values, message):
    given = {"k": 50_000} if "k . k" in message else {}
    with pytest.raises(my.Error, match=message):
        my.study(my.model({x: -x}, generate={x: 1, **values}), given, draws=draws, time=(0, 1))


@pytest.mark.parametrize("draws, value", [
    (2**31, my.instance), (2**40, my.instance % 7), (2**40, my.minimum(my.instance, 5) * my.maximum(3, -my.instance)),
    (2**26, my.instance * my.instance % 10), (2**32, abs(my.instance // 2 - 5)),
    (2**31, my.where(my.instance > 3, my.instance, -my.instance)),
])
def test_whole_numbers_that_fit_are_taken(draws, value):
    my.study(my.model({x: -x}, generate={x: 1, n: value}), draws=draws, time=(0, 1))


@pytest.mark.parametrize("what", ["generate", "initialise", "after_step", "finalise", "accessories"])
def test_assignments_in_a_list_are_refused_with_a_message(what):
    with pytest.raises(my.Error, match=f"{what} is a list.*give a dict, as in"):
        my.model({x: -x}, **{what: [n]})
