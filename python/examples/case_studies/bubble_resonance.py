# SPDX-License-Identifier: MIT
# %% [markdown]
# # Resonances of a gas bubble in water
#
# A bubble of 10 µm radius is driven by ultrasound. The Keller-Miksis equation (J. Acoust. Soc. Am. 68 (1980) 628) is
# written here with the radius y in units of that at rest and time in periods of the sound. How far does the bubble
# expand, and how hard does it collapse, over the frequency of the sound and for several pressures?

# %%
import numpy as np
from matplotlib import pyplot as plt

import myriad_ode as my

# snippet: model
y, v = my.states("y v")
f, pressure = my.parameters("f pressure")  # of the sound, in Hz and Pa
y_max, y_min = my.accessory("y_max"), my.accessory("y_min")

R, rho, c = 10e-6, 997.06, 1497.25                      # radius at rest, density, speed of sound: SI units
sigma, mu, gamma = 0.072, 8.9e-4, 1.4                   # surface tension, viscosity, polytropic exponent
ambient = 1e5 - 3167                                    # pressure of the air above the water, less that of vapour


# end of snippet

# %% [markdown]
# Velocities are in units of U = R f and pressures in units of ρ U². The liquid is nearly incompressible: M = U / c is
# small.


# %%
# snippet: model
def constants(f, pressure):
    """Mach number, and the pressures of gas, surface tension, viscosity, air and sound."""
    U = R * f
    unit = rho * U * U
    return (U / c, (ambient + 2 * sigma / R) / unit, 2 * sigma / R / unit, 4 * mu / (rho * U * R), ambient / unit,
            pressure / unit)


M, G, S, V, A, P = constants(f, pressure)
sine, cosine = my.sincospi(2 * my.time)
gas = G * my.powr(y, -3 * gamma)
at_the_wall = (gas - (S + V * v) / y - A - P * sine) * (1 + M * v)
change = M * (v * ((S + V * v) / y - 3 * gamma * gas) - 2 * np.pi * y * P * cosine)
bubble = my.model({y: v, v: (at_the_wall + change - (1.5 - 0.5 * M * v) * v * v) / (y * (1 - M * v) + M * V)},
                  name="bubble", parameters=(f, pressure),
                  accessories={y_max: my.phase_maximum(y), y_min: my.phase_minimum(y)})
# end of snippet


# snippet: solve
def oscillations(sweep, transient, kept, **more):
    """The run of pressures and frequencies, with the extremes of each period of the sound after transient ones."""
    return my.solve(bubble, sweep, start={y: 1, v: 0}, time=(0, 1), phases=transient + kept, carry_on_step=True,
                    record=dict(from_phase=transient, accessories=[y_max, y_min]),
                    **{"rtol": 1e-8, "atol": 1e-8, "method": "tsitouras_5", **more})
# end of snippet


# %%
pressures = np.array([0.01, 0.2, 0.4, 0.6]) * 1e5
sweep = my.grid({pressure: pressures, f: np.geomspace(60e3, 800e3, 256)})
run = oscillations(sweep, transient=136, kept=8)
print(run.report)
expansion = sweep.unstack(run["y_max"].max(axis=1)) - 1           # a row for each pressure
compression = sweep.unstack((run["y_max"] / run["y_min"]).max(axis=1))

# %% [markdown]
# Small oscillations have a closed form: a damped spring, with the gas as the spring, the water as the mass, and both
# viscosity and sound that is radiated as the damper.

# %%
frequency = dict(sweep.axes)["f"]
M, G, S, V, A, P = constants(frequency, pressures[0])
stiffness = 3 * gamma * G - S
linear = P * np.hypot(1, 2 * np.pi * M) / np.hypot(stiffness - (2 * np.pi)**2 * (1 + M * V),
                                                   2 * np.pi * (V + M * stiffness))
eigenfrequency = np.interp(0, (2 * np.pi)**2 * (1 + M * V) - stiffness, frequency)

# %%
figure, (upper, lower) = plt.subplots(2, 1, figsize=(7, 6.4), sharex=True, layout="constrained", height_ratios=(3, 2))
colours = ("#000000", "#0072B2", "#E69F00", "#D55E00")
for p, grown, pressed, colour in zip(pressures, expansion, compression, colours):
    upper.loglog(frequency / 1e3, grown, color=colour, linewidth=1.3, label=f"{p / 1e5:g} bar")
    lower.loglog(frequency / 1e3, pressed, color=colour, linewidth=1.3)
upper.loglog(frequency / 1e3, linear, color="0.6", linewidth=3, zorder=0, label="0.01 bar, small oscillations")
for factor, name in ((2, "$2f_0$"), (1, "$f_0$"), (1 / 2, "$f_0/2$"), (1 / 3, "$f_0/3$"), (1 / 4, "$f_0/4$")):
    for axes in (upper, lower):
        axes.axvline(eigenfrequency * factor / 1e3, color="0.75", linewidth=0.8, linestyle=":", zorder=0)
    upper.annotate(name, (eigenfrequency * factor / 1e3, 1), xycoords=("data", "axes fraction"), xytext=(3, -12),
                   textcoords="offset points", color="0.4")
upper.set_ylabel("expansion $R_{max} / R_0 - 1$")
lower.set_ylabel("compression $R_{max} / R_{min}$")
lower.set_xlabel("frequency of the sound (kHz)")
for axis in (lower.xaxis, lower.yaxis, upper.yaxis):
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter("")
lower.set_xticks([60, 100, 200, 300, 500, 800])
lower.set_yticks([1, 2, 5, 10])
lower.set_xlim(60, 800)
upper.legend(frameon=False, loc="lower center", ncols=2, fontsize="small")
figure.savefig("bubble_resonance.png", dpi=150)

# %% [markdown]
# At 0.01 bar the bubble is the linear oscillator of the closed form. At higher pressures it is a softening spring: the
# resonance leans to lower frequencies, and jumps. And the bubble resonates at fractions of its frequency too, and at
# twice that, where it swings at half the frequency of the sound.

# %%
assert run.report.failed == 0
assert np.allclose(expansion[0], linear, rtol=0.12) and np.median(np.abs(expansion[0] / linear - 1)) < 0.02
peaks = frequency[expansion.argmax(axis=1)]
assert abs(peaks[0] / eigenfrequency - 1) < 0.01 and (np.diff(peaks) < 0).all(), peaks
near_half = np.abs(frequency / (eigenfrequency / 2) - 1) < 0.15
between = np.abs(frequency / (eigenfrequency / 1.5) - 1) < 0.05
assert expansion[1][near_half].max() > 1.2 * expansion[1][between].min()
assert compression[3].max() > 5
