# SPDX-License-Identifier: MIT
# %% [markdown]
# # Chatter in turning, and where the tool leaves the workpiece
#
# A tool that turns a shaft cuts the surface that it left one revolution ago. If it vibrates, the chip is thicker here
# and thinner there, the force with it, and above a certain width of the cut the vibration grows: chatter (S. A. Tobias,
# Machine-Tool Vibration (1965)). It grows until the tool leaves the workpiece, and then cuts what it left two
# revolutions ago.

# %%
import numpy as np
from matplotlib import pyplot as plt

import myriad_ode as my

# %% [markdown]
# x is how far the force of the cut has bent the tool away, in units of the feed per revolution. The tool's own period
# is 2π. w is the width of the cut, in units of the tool's stiffness over that of the cut, and tau the time of a
# revolution. The chip is as thick as the feed, and what the tool left a revolution ago more than it leaves now.


# %%
# snippet: model
x, v = my.states("x v")
w, tau = my.parameters("w tau")
damping = 0.02  # of the tool
top = my.accessory("top")
leaves, returns = my.integer_accessory("leaves"), my.integer_accessory("returns")

chip = my.minimum(1 + my.delayed(x, tau), 2 + my.delayed(x, 2 * tau)) - x
force = w * my.maximum(chip, 0)
turning = my.model(
    {x: v, v: force - 2 * damping * v - x}, name="turning", parameters=(w, tau), history={x: w},
    accessories={top: my.phase_maximum((x - w)**2 + v**2), leaves: 0, returns: 0},
    events=[my.event(chip, name="leaving", direction="falling", do={leaves: leaves + 1}),  # steps end where the force
            my.event(chip, name="returning", direction="rising", do={returns: returns + 1})])  # has a kink
# end of snippet


# snippet: solve
def vibrations(sweep, phases=40, **more):
    """The run of widths and times of a revolution: the tool cuts steadily and is struck at t = 0."""
    return my.solve(turning, sweep, start={v: 0.05}, time=(0, np.inf), phases=phases, phase_length=2 * np.pi,
                    record=dict(accessories=[top, leaves]), method="dormand_prince_5", history_steps=1024,
                    **{"rtol": 1e-6, "atol": 1e-8, **more})
# end of snippet


# %% [markdown]
# Near the border, where the steady cut is x = w, the equation is linear, and its solutions exp(iωt) give the border in
# closed form: lobes, one for each number of vibrations in a revolution.


# %%
# snippet: lobes
def lobes(omega, number):
    """Times of a revolution and widths at the border, for frequencies above 1."""
    excess = omega**2 - 1
    width = (excess**2 + (2 * damping * omega)**2) / (2 * excess)
    return 2 / omega * (number * np.pi - np.arctan(excess / (2 * damping * omega))), width
# end of snippet


# %%
# snippet: map
speeds = np.linspace(0.22, 1.2, 70)  # revolutions in a period of the tool
widths = np.linspace(0.02, 0.3, 42)
run = vibrations(my.grid(tau=2 * np.pi / speeds, w=widths))
tops = run["top"].reshape(70, 42, -1)
grown = (tops[..., -1] > tops[..., 10]) | (tops[..., -1] > 0.1)  # the strike has grown, or has done so long ago
leaving = run["leaves"].reshape(70, 42, -1)[..., -5:].any(axis=-1)  # within the last five periods
# end of snippet
assert run.report.failed == 0

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
axes.pcolormesh(speeds, widths, (grown.astype(float) + leaving).T, cmap="Oranges", shading="nearest", vmax=3)
omega = 1 + np.geomspace(1e-3, 2, 2000)
for number in range(1, 8):
    time, width = lobes(omega, number)
    inside = time > 0
    axes.plot(2 * np.pi / time[inside], width[inside], color="black", lw=0.8)
axes.set(xlim=(speeds[0], speeds[-1]), ylim=(widths[0], widths[-1]), xlabel="revolutions per period of the tool",
         ylabel="width of the cut w")
figure.savefig("turning.png")


# %% [markdown]
# The lowest border over all lobes, beside what the integration finds: the width at which a small vibration neither
# grows nor decays, where the logarithm of its growth is zero.


# %%
# snippet: border
def border(speed):
    """The least width at the border at a speed."""
    time, width = np.concatenate([lobes(1 + np.geomspace(1e-4, 3, 200_000), n) for n in range(1, 9)], axis=1)
    near = np.flatnonzero(np.diff(np.sign(time - 2 * np.pi / speed)))
    return min(width[i] for i in near if abs(time[i + 1] - time[i]) < 0.1)


errors = []
for speed in (0.3, 0.52, 0.9):
    expected = border(speed)
    near = expected * np.linspace(0.97, 1.03, 7)
    tops = vibrations({w: near, tau: 2 * np.pi / speed}, phases=160, rtol=1e-8, atol=1e-10)["top"]
    growth = np.log(tops[:, -1] / tops[:, 100])
    errors.append(np.interp(0, growth, near) / expected - 1)
# end of snippet
print("relative errors of the borders:", *(f"{error:.1e}" for error in errors))
assert np.abs(errors).max() < 1e-3
plt.close("all")
