# SPDX-License-Identifier: MIT
"""Models from .ode files of XPPAUT: what their statements mean, and what is refused."""

import numpy as np
import pytest

import myriad_ode as my


def solved(text, *arguments, time=(0, 2), samples=21, **options):
    options = dict(interpreted=True, device="cpu", method="dormand_prince_5", rtol=1e-10, atol=1e-12) | options
    return my.solve(my.read_xpp(text), *arguments, time=time, samples=samples, **options)


hodgkin_huxley = """
# Hodgkin and Huxley, with a resting potential of -65 mV
par I0=10, gna=120, gk=36
par gl=.3 ena=50 ek=-77 el=-54.4
number c=1, phi = 1
init v=-65,m=.0529,h=.596
n(0)=.3177
am(v)=.1*(v+40)/(1-exp(-(v+40)/10))
bm(v)=4*exp(-(v+65)/18)
ah(v)=.07*exp(-(v+65)/20)
bh(v)=1/(1+exp(-(v+35)/10))
an(v)=.01*(v+55)/(1-exp(-(v+55)/10))
bn(v)=.125*exp(-(v+65)/80)
ina=gna*m^3*h*(v-ena)
ik=gk*n^4*(v-ek)
v'=(I0-ina-ik \\
  -gl*(v-el))/c
dm/dt=phi*(am(v)*(1-m)-bm(v)*m)
dh/dt=phi*(ah(v)*(1-h)-bh(v)*h)
dn/dt=phi*(an(v)*(1-n)-bn(v)*n)
aux power=v*(ina+ik)
@ total=50,dt=.02,meth=qualrk,xlo=0,xhi=50
done
what follows is not read
"""


def _hodgkin_huxley(t, y, current):
    v, m, h, n = y
    x, w = (v + 40) / 10, (v + 55) / 10
    ina, ik = 120 * m**3 * h * (v - 50), 36 * n**4 * (v + 77)
    return [current - ina - ik - 0.3 * (v + 54.4),
            x / (1 - np.exp(-x)) * (1 - m) - 4 * np.exp(-(v + 65) / 18) * m,
            0.07 * np.exp(-(v + 65) / 20) * (1 - h) - h / (1 + np.exp(-(v + 35) / 10)),
            0.1 * w / (1 - np.exp(-w)) * (1 - n) - 0.125 * np.exp(-(v + 65) / 80) * n]


def test_the_equations_of_hodgkin_and_huxley():
    integrate = pytest.importorskip("scipy.integrate")
    model = my.read_xpp(hodgkin_huxley)
    assert model.states == ["v", "m", "h", "n"]
    assert model.parameters == ["i0", "gna", "gk", "gl", "ena", "ek", "el"]
    assert model.time == (0, 50) and model.settings["meth"] == "qualrk" and model.settings["dt"] == 0.02
    currents = np.array([0.0, 10.0, 20.0])
    run = my.solve(model, {"I0": currents}, time=(0, 10), rtol=1e-10, atol=1e-12, interpreted=True)
    for i, current in enumerate(currents):
        right = integrate.solve_ivp(_hodgkin_huxley, (0, 10), [-65, 0.0529, 0.596, 0.3177], args=(current,), rtol=1e-11,
                                    atol=1e-12, method="DOP853").y[:, -1]
        np.testing.assert_allclose([run[name][i] for name in "vmhn"], right, rtol=1e-6)
        v, m, h, n = right
        ina, ik = 120 * m**3 * h * (v - 50), 36 * n**4 * (v + 77)
        np.testing.assert_allclose(run["ina"][i], ina, rtol=1e-5)
        np.testing.assert_allclose(run["power"][i], v * (ina + ik), rtol=1e-5)


def test_a_neuron_that_fires_and_is_reset():
    """dv/dt = I - v from 0 reaches 1 after log(I / (I - 1)), each time."""
    text = """
    p I=1.5 reset=0
    V'=I-V
    count'=0
    global 1 {v-1} {v=reset;count=count+1}
    @ total=10
    """
    currents = np.array([1.2, 1.5, 3.0])
    model = my.read_xpp(text)
    run = my.solve(model, {"I": currents}, time=model.time, rtol=1e-10, atol=1e-12, interpreted=True)
    period = np.log(currents / (currents - 1))
    np.testing.assert_array_equal(run["count"], np.floor(10 / period))
    np.testing.assert_allclose(run["V"], currents * (1 - np.exp(-np.mod(10, period))), rtol=1e-6)


def test_resets_follow_each_other_and_parameters_come_last():
    run = solved("par p=1\nx'=1\ny'=0\nz'=0\nglobal 1 {x-0.55} {x=10;y=x+1;p=5;z=p}\naux twice=2*p")
    np.testing.assert_allclose(run["x"][0, -1], 10 + 2 - 0.55)
    np.testing.assert_allclose([run["y"][0, -1], run["z"][0, -1]], [11, 1])


def test_signs_of_events_and_the_end_of_a_run():
    run = solved("x'=cos(t)\nup'=0\ndown'=0\nglobal 1 x-0.5 {up=up+1}\nglobal -1 {x-.5} {down=down+1}", time=(0, 6),
                 samples=None)
    assert run["up"][0] == 1 and run["down"][0] == 1
    run = solved("x'=1\nglobal 1 {x-0.7} {arret=1}", samples=None)
    assert run.status[0] == "stopped_by_user"
    np.testing.assert_allclose(run["x"], 0.7)


def _value(text, **given):
    lines = [f"par {name}={value}" for name, value in given.items()]
    return solved("\n".join([*lines, "x'=0", f"aux found={text}"]), samples=None)["found"][0]


@pytest.mark.parametrize("text, value", [
    ("2+3*4^2/8-1", 7), ("-a^2", -9), ("2^3^2", 64), ("a**2", 9), ("2*-a", -6), ("1e-1+.5+2.", 2.6), ("-(-a)", 3),
    ("a>2", 1), ("a>2+1", 2), ("a>(2+1)", 0), ("1+a<2", 1), ("(a>2)&(a<4)", 1), ("a<2|(a==3)", 1), ("not(a)", 0),
    ("not(a>5)", 1), ("a!=3", 0), ("(a>=3)+(a<=3)", 2), ("if(a>2)then(10)else(20)", 10),
    ("if(a>(2+4))then(10)else(if(a==3)then(5)else(6))", 5), ("heav(0)+heav(a)*10+heav(-a)*100", 11),
    ("sign(a)+10*sign(-a)+100*sign(0)", -9), ("mod(-a,2)", 1), ("mod(a,2)", 1), ("flr(-a/2)", -2),
    ("max(a,4)+min(a,4)", 7), ("ln(exp(a))+log(exp(1))+log10(100)", 6), ("sqrt(abs(-a*a))", 3),
    ("atan2(1,1)*4", np.pi), ("pi", np.pi), ("sum(1,3)of(i'*a)", 18), ("sum(0,1)of(sum(0,i')of(a))", 9),
    ("sinh(1)+cosh(1)", np.e), ("asin(1)+acos(1)+atan(1)", 0.75 * np.pi)])
def test_formulas_mean_what_they_mean_there(text, value):
    np.testing.assert_allclose(_value(text, a=3), value, rtol=1e-12, atol=1e-15)


def test_quantities_and_derived_parameters_follow_parameters():
    text = "!b=a^2\npar a=2\nc=b+x\nf(x,y)=x-y*b\nx'=f(c,a)\n"
    model = my.read_xpp("par a=2\n!b=a^2\nc=b+x\nf(x,y)=x-y*b\nx'=f(c,a)\n")
    run = my.solve(model, {"a": [2.0, 3.0]}, time=(0, 1), interpreted=True, rtol=1e-10, atol=1e-12)
    b, a = np.array([4.0, 9.0]), np.array([2.0, 3.0])
    forced = b - a * b  # x' = x + forced
    np.testing.assert_allclose(run["x"], forced * (np.e - 1), rtol=1e-8)
    np.testing.assert_allclose(run["c"], b + run["x"], rtol=1e-12)
    np.testing.assert_array_equal(run["b"], b)
    assert my.read_xpp(text).outputs.keys() == {"b", "c"}


def test_arrays_and_groups_are_written_out():
    run = solved("""
        par k=.5
        x[1..4]'=-k*x[j]+x[j-1]
        x0=0
        init x[1..4]=[j]
        %[1..2]
        y[j]'=[j]*x3
        aux z[j]=y[j]+x[2]
        %
        aux total=sum(0,3)of(shift(x1,i'))
        """, samples=None, time=(0, 1))
    x1 = np.exp(-0.5)
    x2 = (2 + 1) * np.exp(-0.5)
    np.testing.assert_allclose([run["x1"][0], run["x2"][0]], [x1, x2], rtol=1e-8)
    np.testing.assert_allclose(run["y2"], 2 * run["y1"], rtol=1e-8)
    np.testing.assert_allclose(run["z2"], run["y2"] + x2, rtol=1e-8)
    np.testing.assert_allclose(run["total"], sum(run[f"x{i}"] for i in (1, 2, 3, 4)), rtol=1e-12)


def test_tables_are_linear_and_go_on_beyond_their_ends(tmp_path):
    (tmp_path / "force.tab").write_text("3\n0\n2\n0\n1\n4\n")
    (tmp_path / "pairs.tab").write_text("xyvals\n3\n0 0\n0.5 1\n2 4\n")
    (tmp_path / "model.ode").write_text("table f force.tab\ntable g pairs.tab\ntable h % 3 0 2 t^2\n"
                                        "x'=1\naux a=f(x)\naux b=g(x)\naux c=h(x)\naux d=f(.5)\ninit x=-1\n")
    run = my.solve(my.read_xpp(tmp_path / "model.ode"), time=(0, 4), samples=[0.0, 1.5, 2.5, 4.0], interpreted=True)
    np.testing.assert_allclose(run["x"], [[-1, 0.5, 1.5, 3]], atol=1e-12)
    np.testing.assert_allclose(run["a"], [[-1, 0.5, 2.5, 7]], atol=1e-12)
    np.testing.assert_allclose(run["b"], [[-2, 1, 3, 6]], atol=1e-12)
    np.testing.assert_allclose(run["c"], run["a"], atol=1e-12)
    np.testing.assert_allclose(run["d"], 0.5)


def test_names_are_small_letters_and_those_of_the_file():
    text = "PAR Iapp=2,double=3\nV'=Iapp\nState'=double\nINIT V=1\nAUX Sum=v+STATE\nset fast {Iapp=20, v=5}\n"
    model = my.read_xpp(text)
    run = my.solve(model, {"Iapp": 4}, time=(0, 1), interpreted=True)
    np.testing.assert_allclose([run["V"][0], run["v"][0], run["State"][0], run["state"][0]], [5, 5, 3, 3])
    np.testing.assert_allclose([run["Sum"][0], run["sum"][0]], 8)
    fast = my.solve(model, model.sets["fast"], time=(0, 1), interpreted=True)
    np.testing.assert_allclose(fast["V"], 25)


def test_a_file_gives_its_name_to_the_model(tmp_path):
    (tmp_path / "van-der-pol.ode").write_text("par mu=1\nx'=y\ny'=mu*(1-x^2)*y-x\ninit x=1\nd\n")
    model = my.read_xpp(tmp_path / "van-der-pol.ode")
    assert model.name == "van_der_pol" and model.time == (0, 20)
    grid = my.solve(model, my.grid(mu=np.linspace(0.5, 2, 4), x=[1.0, 2.0]), time=model.time, interpreted=True)
    assert grid["x"].shape == (8,) and "struct van_der_pol" in model.cpp()
    with pytest.raises(my.Error, match="there is no file"):
        my.read_xpp(tmp_path / "missing.ode")


@pytest.mark.parametrize("line, said", [
    ("wiener w\ny'=w*w", "a sum of Wiener processes"),
    ("wiener w\ny'=if(w>0)then(1)else(2)", "a sum of Wiener processes"), ("wiener w\ny'=w\ninit y=w", "on noise"),
    ("wiener 3", "wiener name"), ("wiener w\n0=x+z+w\nsolv z=1", "an algebraic equation has noise"),
    ("wiener w\ny'=w\n0=x+z\nsolv z=1", "algebraic equations beside noise"),
    ("wiener x", "a second time"), ("markov z 2", "Markov"), ("y'=delay(x,-1)", "how long ago"),
    ("0=x+y", "1 algebraic equations, 0=, for 0 unknowns of solv"), ("solv y=1", "0 algebraic equations"),
    ("0=x+y\nsolv y=$", "`$` is not understood"), ("0=x+y\nsolve 3", "solv name=guess"), ("x(t+1)=2*x", "iterate it"),
    ("@ total=9,meth=discrete", "iterate it"), ("@ METHOD=Disc", "iterate it"),
    ("y(t)=int{exp(-t)#x}", "integrals over the past"), ("y'=int[.5]{exp(-t)#x}", "integrals over the past"),
    ("volterra y=1", "integrals over the past"), ("y'=int{exp(-t)#x}", "as an equation of its own"),
    ("y'=ran(1)", "random numbers"), ("special k=conv(even,11,3,w,x)", "networks"),
    ("export {x} {y}\n@ dll_lib=f.so", "is not called"),
    ("table f % 3 0 2 t*x", "of states"),
    ("table f % 3 0 2 a*t\npar a=2\ny'=f(x)", "looked up at what varies"),
    ("global 0 {x-1} {x=0}", "sign 0"), ("global 1 {x-1} {q=0}", "neither a state nor a parameter"),
    ("y'=q+1", "`q` is unknown"), ("early=late\nlate=early+x", "`early` depends on itself"),
    ("y'=f(x,2)\nf(x)=x", "2 arguments"),
    ("y'=x+", "it ends where"), ("y'=(x", "`)` is expected"), ("y'=x$2", "`$` is not understood"),
    ("par a=1\npar a=2", "a second time"), ("x'=2", "a second time"), ("init q=1", "has no equation"),
    ("table f missing.tab", "there is no file"), ("f(x)=f(x)\ny'=f(x)", "calls itself"), ("y'=besselj(0,x)", "unknown"),
    ("t=2", "meaning of its own"), ("what is this", "no statement")])
def test_what_is_not_supported_is_refused_with_its_line(line, said):
    with pytest.raises(my.Error) as error:
        my.read_xpp(f"# a comment\nx'=1\n{line}\n")
    assert said in str(error.value) and "line " in str(error.value)


def test_names_with_letters_outside_ascii_are_those_of_the_model_in_ascii_letters(tmp_path):
    (tmp_path / "modèle.ode").write_text("# é\npar Bêta=2, β=3, beta=5, 質=7\nx'=-Bêta*x+β\ny'=beta+質\naux ω=x*β\n")
    model = my.read_xpp(tmp_path / "modèle.ode")
    assert model.name == "modele" and set(model.parameters) == {"beta", "beta1", "beta2", "u8cea"}
    run = my.solve(model, {"β": [3.0, 4.0]}, start={"x": 1}, time=(0, 1), rtol=1e-9, atol=1e-9, interpreted=True)
    exact = np.array([3.0, 4.0]) / 2 + (1 - np.array([3.0, 4.0]) / 2) * np.exp(-2)
    np.testing.assert_allclose(run["x"], exact, rtol=1e-7)
    np.testing.assert_allclose(run["y"], 12.0, rtol=1e-12)
    np.testing.assert_allclose(run["ω"], exact * [3.0, 4.0], rtol=1e-7)


def test_of_an_option_that_is_given_twice_the_last_holds():
    model = my.read_xpp("x'=-x\n@ total=5,meth=discrete\n@ meth=qualrk,total=8\n")
    assert model.time == (0, 8) and model.settings["meth"] == "qualrk"


def test_auxiliary_quantities_may_have_points_in_their_names_and_statements_longer_words():
    model = my.read_xpp("x'=-x\ninitial x=1\ntabular f % 3 0 2 2*t\naux K.E.=f(x)\n")
    run = my.solve(model, time=(0, 1), rtol=1e-9, atol=1e-9, interpreted=True)
    np.testing.assert_allclose(run["k_e"], 2 * np.exp(-1), rtol=1e-7)


@pytest.mark.parametrize("end", ["d", "done", "DONE", "dnoe"])
def test_a_word_that_begins_with_d_ends_a_file(end):
    assert my.read_xpp(f"x'=-x\n{end}\nwhat is this\n").states == ["x"]


def test_the_number_of_equations_may_stand_first():
    assert my.read_xpp("# a comment\n2\nx'=y\ny'=-x\n").states == my.read_xpp("x'=y\ny'=-x\n").states
    with pytest.raises(my.Error, match="line 2, `2`"):
        my.read_xpp("x'=1\n2\n")


def test_what_wiener_names_is_noise_of_the_equations():
    model = my.read_xpp("wiener w z\npar s=.5, a=2\nx'=1-a*(x-noise)-.25*z\ny'=a*y*(3+w)\nv'=x\nnoise=s*w\n"
                        "aux twice=2*x\naux rough=x+w\n")
    x, y, v = my.states("x y v")
    s, a = my.parameters("s a")
    by_hand = my.model({x: 1 - a * x, y: 3 * a * y, v: x},
                       noise={x: {"w": a * s, "z": -0.25}, y: {"w": a * y}, v: {"w": 0}})
    options = dict(start={"x": 0, "y": 1, "v": 0}, time=(0, 1), paths=4, seed=7, step=2.0**-6, device="cpu")
    one, other = my.solve(model, **options), my.solve(by_hand, {"s": 0.5, "a": 2.0}, **options)
    for name in "xyv":
        np.testing.assert_allclose(one[name], other[name], rtol=1e-13)
    assert set(model.outputs) == {"twice"}  # what depends on noise has no values


def test_a_compiled_model_agrees():
    text = "p I=1.5\nv'=I-v\nu'=v/10\nglobal 1 {v-1} {v=u/5;u=u+.1}\naux w=u+v\n"
    runs = [solved(text, {"I": [1.2, 1.5]}, interpreted=interpreted) for interpreted in (True, False)]
    for name in ("v", "u", "w"):
        np.testing.assert_allclose(runs[0][name], runs[1][name], rtol=1e-9, atol=1e-9)


def test_a_pulse_in_time_is_not_passed_over():
    text = """p on=5,off=5.001,per=3,since=-100
x'=heav(t-on)-heav(t-off)
y'=mod(t,per)<.001
z'=(t>on)*(t<off)
w'=if((t-since)>2)then(if((t-since)<2.001)then(1)else(0))else(0)
global 1 {t-6} {since=t}
"""
    run = solved(text, time=(0, 10), samples=None, rtol=1e-6)
    for name, area in (("x", 0.001), ("y", 0.004), ("z", 0.001), ("w", 0.001)):
        np.testing.assert_allclose(run[name], area, rtol=1e-7)


def test_remainders_of_remainders_are_exact():
    run = solved("x'=mod(mod(t,24),6)\ny'=heav(sin(t)-1.5)\n", time=(0, 48), samples=None)
    np.testing.assert_allclose([run["x"][0], run["y"][0]], [144, 0], rtol=1e-9)


def test_a_function_of_t_is_no_integral_equation():
    run = solved("stim(t)=s0*if(t<1)then(t)else(0)\npar s0=2\nx'=stim(t)+stim(t-1)\nonly x\n")
    np.testing.assert_allclose(run["x"][0, -1], 1, rtol=1e-9)  # of 2t until 1, and of 2(t - 1)


def test_shift_is_known_of_quantities():
    run = solved("q[0..2]=[j]*t\nx'=sum(0,2)of(shift(q0,i'))\n")
    np.testing.assert_allclose(run["x"][0, -1], 3 * 2**2 / 2, rtol=1e-9)


def test_names_that_differ_in_underscores_are_not_mixed_up():
    run = solved("p k_=1,k=2\nx_'=k_\nx'=k\naux next_jump=heav(t-1)\ny'=heav(t-1)\n", {"k_": 5}, samples=None)
    for name, value in (("k_", 5), ("k", 2), ("x_", 10), ("x", 4), ("next_jump", 1), ("y", 1)):
        np.testing.assert_allclose(run[name], value, rtol=1e-9, err_msg=name)


def test_quantities_may_be_defined_below_what_uses_them_and_percent_begins_remarks():
    model = my.read_xpp("% a remark\nx'=-z\nz=y+1\ny=w*2\nw=x\n%\n")
    assert model.outputs["z"] is my.read_xpp("w=x\ny=w*2\nz=y+1\nx'=-z\n").outputs["z"]


def test_formulas_as_deep_as_files_have_them_are_read_and_functions_that_call_twice_take_no_longer():
    chain = "".join(f"q{i}=q{i + 1}*2\n" for i in range(400)) + "q400=x\n"
    assert "q0" in my.read_xpp(chain + "x'=" + "(" * 400 + "q0" + ")" * 400 + "\n").outputs
    calls = "f0(x)=x/2\n" + "".join(f"f{i}(x)=f{i - 1}(x)/2+f{i - 1}(x)/2\n" for i in range(1, 60))
    assert list(my.read_xpp(calls + "x'=f59(x)\n").states) == ["x"]


of_study = """
par p=2, stop=9
!q=p^2
x'=-p*x
y'=1
init x=1
global 1 {y-1.5} {p=3}
global 1 {y-stop} {arret=1}
aux Rate=p*x
aux t__y=t+y
aux state=x+y
"""


@pytest.mark.parametrize("interpreted", [True, False])
def test_outputs_have_their_names_and_values_in_studies(tmp_path, interpreted):
    model = my.read_xpp(of_study)
    sweep, call = my.grid(p=[1.0, 2.0, 4.0], stop=[1.0, 9.0]), dict(time=(0, 1), phases=3, carry_on=True,
                                                                    phase_length=0, interpreted=interpreted)
    run = my.solve(model, sweep, record=dict(states=["x", "y"], time=True), **call)
    study = my.study(model, sweep, **call).run(store=tmp_path / "study")
    for name in ("rate", "Rate", "q", "t__y", "state"):
        end = f"{name}_end"
        np.testing.assert_array_equal(study[end].ravel(), run[end], err_msg=name)
        np.testing.assert_array_equal(study.to_xarray()[end].values.ravel(), run[end])
        np.testing.assert_array_equal(my.open_study(tmp_path / "study")[name].ravel(), run[end])
    recorded = my.study(model, sweep, record=dict(states=["x", "y"], time=True), **call).run()
    for name in ("rate", "t__y", "state"):  # q follows from parameters alone, and is no record of a run either
        np.testing.assert_array_equal(recorded[name].reshape(run[name].shape), run[name], err_msg=name)
    assert "q" not in recorded
    some = my.study(model, sweep, keep=["rate", "x"], reduce=my.reduce.maximum("state_end"), **call).run()
    assert {"rate_end", "x_end", "state_end_maximum"} <= {*some} and "state_end" not in some
    assert some["state_end_maximum"] == run["state_end"].max()


def test_outputs_of_failed_instances_are_nan_in_studies():
    failed = my.study(my.read_xpp(of_study), time=(0, 1), max_steps=1, interpreted=True).run()
    assert failed.failed.all() and np.isnan(failed["rate_end"]).all()


def test_what_the_initial_value_problem_does_not_need_is_read_over():
    model = my.read_xpp("x'=v\nv'=0\nb x-1\nbndry v'\nbdry (x'-v)\nexport {x} {v}\nonly x\ninit v=2\n")
    assert model.boundary_conditions == ["x-1", "v'", "(x'-v)"]
    np.testing.assert_allclose(my.solve(model, time=(0, 3), interpreted=True)["x"], 6)


def test_a_table_of_a_formula_with_parameters_is_looked_up_at_numbers():
    text = "table w % 5 -2 2 a*exp(-abs(t)/s)\npar a=2,s=1\nx'=sum(-2,2)of(w(i'))\nq=w(.5)\np=w(3)\n"
    run = my.solve(my.read_xpp(text), {"a": [2.0, 5.0], "s": [1.0, 0.5]}, time=(0, 1), interpreted=True)
    a, s = np.array([2.0, 5.0]), np.array([1.0, 0.5])
    np.testing.assert_allclose(run["x"], a * (1 + 2 * np.exp(-1 / s) + 2 * np.exp(-2 / s)), rtol=1e-9)
    np.testing.assert_allclose(run["q"], a * (1 + np.exp(-1 / s)) / 2)
    np.testing.assert_allclose(run["p"], a * (2 * np.exp(-2 / s) - np.exp(-1 / s)))


def test_algebraic_equations_have_unknowns_that_are_states_of_a_mass_matrix():
    model = my.read_xpp("x'=-y\n0=y+y^3-a*x\nsolv y=1\npar a=2\naux rest=y+y^3-2*x\ninit x=1\n")
    assert model.states == ["x", "y"] and model.mass_matrix.tolist() == [[1, 0], [0, 0]]
    run = my.solve(model, time=(0, 1), method="rodas_5p", make_consistent=True, rtol=1e-10, atol=1e-12)
    y = run["y"][0]  # 2 t = log(y_0 / y) + 1.5 (y_0^2 - y^2), of dx = (1 + 3 y^2) dy / 2 and y_0 = 1
    assert np.log(1 / y) + 1.5 * (1 - y ** 2) == pytest.approx(2.0, rel=1e-8)
    np.testing.assert_allclose(run["rest"], 0, atol=1e-9)
