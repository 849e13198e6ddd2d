# SPDX-License-Identifier: MIT
"""One model as a dictionary, a function, text and SymPy's expressions."""

import numpy as np
import sympy

import myriad_ode as my

# snippet: dictionary
x, v = my.states("x v")
k, B = my.parameter("k"), my.shared("B")
duffing = my.model({x: v, v: x - x**3 - k * v + B * my.cos(my.time)}, name="duffing")
# end of snippet


# snippet: function
def oscillator(t, y, k, B):
    x, v = y
    return [v, x - x**3 - k * v + B * np.cos(t)]


of_function = my.model(oscillator, states="x v", shared="B", name="duffing")
# end of snippet

# snippet: text
of_text = my.model("""
    force = B*cos(t)               # for the lines below
    x' = v
    v' = x - x^3 - k*v + force     # or dv/dt = ...
""", parameters="k", shared="B", name="duffing")
# end of snippet

# snippet: sympy
sx, sv, sk, sB, t = sympy.symbols("x v k B t")
energy = sv**2 / 2 - sx**2 / 2 + sx**4 / 4
of_sympy = my.model({sx: sympy.diff(energy, sv), sv: -sympy.diff(energy, sx) - sk * sv + sB * sympy.cos(t)},
                    parameters="k", shared="B", name="duffing")
# end of snippet

assert duffing.cpp() == of_function.cpp() == of_text.cpp()
assert np.allclose(of_sympy.derivatives(0.7, [0.3, -0.2], k=0.25, B=0.3),
                   duffing.derivatives(0.7, [0.3, -0.2], k=0.25, B=0.3), rtol=1e-14)
