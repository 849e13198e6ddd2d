# SPDX-License-Identifier: MIT
# %% [markdown]
# # How often a neuron fires under noise
#
# A leaky integrate-and-fire neuron: its potential V follows the mean input mu, with the noise of very many synapses. At
# the threshold it fires, V is reset, and for an absolute refractory time nothing moves it. The mean rate is known
# (A. J. F. Siegert, Phys. Rev. 81 (1951) 617; D. J. Amit and M. V. Tsodyks, Network 2 (1991) 259).

# %%
import math

import numpy as np
from matplotlib import pyplot as plt

import myriad_ode as my

# %% [markdown]
# Times are in ms, potentials in mV above the one at rest. Spikes are events, located within steps by the law of the
# path; in another model they are looked for at the ends of steps. A phase ends with each spike.


# %%
# snippet: model
V, (mu, sigma) = my.state("V"), my.parameters("mu sigma")
holds, wakes = my.integer_accessory("holds"), my.accessory("wakes")
tau, threshold, reset, refractory = 20.0, 20.0, 10.0, 2.0

spike = {V: reset, holds: 1, wakes: my.time + refractory}


def membrane(**rules):
    return my.model({V: my.where(holds == 1, 0, (mu - V) / tau)},
                    noise={V: my.where(holds == 1, 0, sigma / math.sqrt(tau))},
                    accessories={holds: None, wakes: None},  # as the last phase left them, 0 in the first
                    stops=my.stop(wakes, do={holds: 0}), **rules)


neuron = membrane(name="neuron", events=my.event(V - threshold, direction="rising", stop_after=1, do=spike))

fires = V >= threshold
seen_at_ends = membrane(name="seen_at_ends", after_step={
    **{target: my.where(fires, value, target) for target, value in spike.items()}, my.end_phase: fires})
# end of snippet


# snippet: intervals
def intervals(model, inputs, paths, spikes, step, method="sra1", **more):
    """Times from each spike to the next: a row of paths * (spikes - 1) for each input."""
    run = my.solve(model, inputs, start={V: reset}, time=(0, np.inf), phases=spikes, carry_on=True,
                   record=dict(time=True), paths=paths, step=step, method=method, **more)
    assert run.report.failed == 0
    return np.diff(run["t"]).reshape(run.size // paths, -1)
# end of snippet


# %% [markdown]
# Siegert's formula, √π times the integral of exp(u²) (1 + erf(u)) from the reset to the threshold, written as an
# integral in which nothing overflows (N. Brunel and V. Hakim, Neural Comput. 11 (1999) 1621). Where the mean input is
# at the threshold the whole law of the intervals is known: V - mu is exp(-t / tau) times a Wiener process whose clock
# shows sigma² (exp(2 t / tau) - 1) / 2, and both are zero for the first time together.


# %%
# snippet: theory
def mean_interval(mu, sigma, threshold=threshold):
    """The mean time between spikes by Siegert's formula."""
    width = 5e-4
    z = (np.arange(40_000) + 0.5) * width
    low, high = (reset - mu) / sigma, (threshold - mu) / sigma
    return refractory + tau * width * ((np.exp(2 * high * z - z**2) - np.exp(2 * low * z - z**2)) / z).sum()


def law_at_threshold(time, sigma):
    """The probability of an interval up to these times where mu is the threshold."""
    clock = sigma**2 / 2 * np.expm1(2 * np.maximum(time - refractory, 1e-9) / tau)
    return np.array([math.erfc(ratio) for ratio in (threshold - reset) / np.sqrt(2 * clock)])
# end of snippet


# %% [markdown]
# Rates over the mean input for three amplitudes of the noise, each from two amplitudes below the threshold on.

# %%
# snippet: rates
amplitudes = np.array([1.0, 3.0, 6.0])
inputs = np.linspace(threshold - 2 * amplitudes, 34, 15).T  # a row for each amplitude
sweep = {mu: inputs.ravel(), sigma: np.repeat(amplitudes, 15)}
located = intervals(neuron, sweep, paths=32, spikes=65, step=0.5, seed=1)
late = intervals(seen_at_ends, sweep, paths=32, spikes=65, step=0.5, seed=1)
exact = np.array([mean_interval(*pair) for pair in zip(sweep[mu], sweep[sigma])])
# end of snippet
off = (located.mean(axis=1) - exact) / located.std(axis=1) * math.sqrt(located.shape[1])  # in standard errors
print(f"{located.size} intervals at {off.size} inputs: their means are off by {np.sqrt((off**2).mean()):.2f} standard "
      f"errors in the root mean square, by {np.abs(off).max():.1f} at most")
lower = (1 - exact / late.mean(axis=1)).reshape(3, 15)
print("seen at the ends of steps, rates are lower by",
      ", ".join(f"{100 * row.min():.1f} to {100 * row.max():.1f} %" for row in lower), "by amplitude")
assert (off**2).mean() < 1.5**2 and np.abs(off).max() < 4

# %% [markdown]
# The intervals of one neuron whose mean input is the threshold, and their mean by the length of steps. Seen at the ends
# of steps alone, spikes come late, as if the threshold were 0.5826 standard deviations of the noise in a step further
# off (M. Broadie, P. Glasserman and S. Kou, Math. Finance 7 (1997) 325).

# %%
# snippet: steps
critical = {mu: threshold, sigma: 6.0}
expected = mean_interval(threshold, 6.0)
steps = np.array([0.125, 0.25, 0.5, 1.0, 2.0])
ways = {"on the path, sra1": (neuron, "sra1"), "on the path, euler_maruyama": (neuron, "euler_maruyama"),
        "at the ends of steps, sra1": (seen_at_ends, "sra1")}
found = {way: [intervals(model, critical, 1000, 51, step, method, seed=3)[0] for step in steps]
         for way, (model, method) in ways.items()}
shifted = [mean_interval(threshold, 6.0, threshold + 0.5826 * 6.0 * math.sqrt(step / tau)) for step in steps]
# end of snippet
print(f"mean interval with mu at the threshold: {expected:.3f} ms; by steps of", *steps, "ms:")
for way, samples in found.items():
    print(f"  {way}:", *(f"{x.mean():.2f} ± {x.std() / math.sqrt(x.size):.2f}" for x in samples))
    if way.startswith("on the path, sra1"):
        assert all(abs(x.mean() - expected) < 4 * x.std() / math.sqrt(x.size) for x in samples)
print("  Siegert's formula with the threshold further off:", *(f"{x:.2f}" for x in shifted))
sample = np.sort(found["on the path, sra1"][2])
distance = np.abs(law_at_threshold(sample, 6.0) - (np.arange(sample.size) + 0.5) / sample.size).max()
print(f"{sample.size} intervals: Kolmogorov's distance from their law times the root of their number is "
      f"{distance * math.sqrt(sample.size):.2f}")
assert distance * math.sqrt(sample.size) < 1.95  # which is exceeded with the probability 0.001
assert np.abs(np.array([x.mean() for x in found["at the ends of steps, sra1"]]) / shifted - 1).max() < 0.02

# %%
figure, (left, middle, right) = plt.subplots(1, 3, figsize=(12, 3.8), layout="constrained")
for row, (amplitude, colour) in enumerate(zip(amplitudes, ("C0", "C1", "C2"))):
    here = slice(15 * row, 15 * row + 15)
    fine = np.linspace(inputs[row, 0], inputs[row, -1], 100)
    left.plot(fine, [1000 / mean_interval(m, amplitude) for m in fine], color=colour, lw=1,
              label=f"sigma = {amplitude:.0f} mV")
    left.plot(inputs[row], 1000 / located[here].mean(axis=1), "o", color=colour, ms=4)
    left.plot(inputs[row], 1000 / late[here].mean(axis=1), "o", color=colour, ms=4, mfc="none",
              label="seen at the ends of steps" if row == 2 else None)
left.axvline(threshold, color="grey", lw=0.8, ls=":")
left.set(xlabel="mean input mu in mV", ylabel="spikes per second")
left.legend()

edges = np.arange(0.5, 120, 2)  # between the whole milliseconds at which steps end
for way, look in (("on the path, sra1", dict(color="C0", alpha=0.4, histtype="stepfilled")),
                  ("at the ends of steps, sra1", dict(color="C3", histtype="step"))):
    middle.hist(found[way][3], edges, density=True, label=way.split(",")[0], **look)
fine = np.linspace(refractory, 120, 1000)
middle.plot((fine[1:] + fine[:-1]) / 2, np.diff(law_at_threshold(fine, 6.0)) / np.diff(fine), "k", lw=1, label="exact")
middle.set(xlabel="time between spikes in ms, steps of 1 ms", ylabel="probability per ms")
middle.legend()

for (way, samples), colour in zip(found.items(), ("C0", "C1", "C3")):
    means, errors = np.transpose([(x.mean(), x.std() / math.sqrt(x.size)) for x in samples])
    right.errorbar(steps, 100 * (means / expected - 1), 100 * errors / expected, fmt="o", ms=4, color=colour,
                   label=way)
right.plot(steps, 100 * (np.array(shifted) / expected - 1), "k--", lw=1, label="the threshold further off")
right.axhline(0, color="grey", lw=0.8)
right.set_xscale("log", base=2)
right.set_xticks(steps, [f"{step:g}" for step in steps])
right.set(xlabel="step in ms", ylabel="error of the mean interval in %")
right.legend(fontsize="small")
figure.savefig("neurons.png")
