#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Times NUTS by NumPyro for the posterior of an epidemic's two rates and the spread of its counts
(python/examples/how_to/posterior.py), with a solution by Myriad and by diffrax, on the CPU.

Both are in double precision, by Tsitouras' method 5(4) with equal tolerances; diffrax's gradients go backwards through
its steps (its default, RecursiveCheckpointAdjoint). "gradient" is the least time by the clock, in microseconds, of 1000
calls of `jax.jit(jax.value_and_grad(loss))` of a sum of squares of the 14 counts for one set of rates. The sampler runs
for some draws, for as many again, and for twenty times as many, and each run compiles its program anew: "first" is the
processor time of the first one in seconds, most of it that of XLA's compiler, and "step" that of a leapfrog step in
microseconds, from the difference of the last two.

Usage: nuts.py [--draws N] [--without-diffrax]

Writes rows "program,gradient,first,step,steps,contact,recovery", the last two the posterior means."""

import argparse
import time

import jax
import jax.numpy as jnp
import numpy as np
import numpyro
import numpyro.distributions as dist
from numpyro.infer import MCMC, NUTS

import myriad_ode as my

IN_BED = np.array([3, 8, 26, 76, 225, 298, 258, 233, 189, 128, 68, 29, 14, 4])
PUPILS, END, TIMES, RTOL, ATOL = 763.0, 14.0, np.arange(1.0, 15.0), 1e-6, 1e-6


def by_myriad():
    susceptible, infected = my.states("susceptible infected")
    contact, recovery = rates = my.parameters("contact recovery")
    new = contact * susceptible * infected / PUPILS
    model = my.model({susceptible: -new, infected: new - recovery * infected}, name="epidemic")
    solve = my.batched(model, free=rates, of=infected, start={susceptible: PUPILS - 1, infected: 1}, time=(0, END),
                       samples=TIMES, method="tsitouras_5", rtol=RTOL, atol=ATOL, invalid="mark", device="cpu").to_jax()
    return lambda rates: solve(rates)[:, 0]


def by_diffrax():
    import diffrax

    def slope(_, y, rates):
        new = rates[0] * y[0] * y[1] / PUPILS
        return jnp.array([-new, new - rates[1] * y[1]])

    def solve(rates):
        return diffrax.diffeqsolve(diffrax.ODETerm(slope), diffrax.Tsit5(), 0.0, END, None,
                                   jnp.array([PUPILS - 1, 1.0]), rates, throw=False,
                                   stepsize_controller=diffrax.PIDController(rtol=RTOL, atol=ATOL),
                                   saveat=diffrax.SaveAt(ts=jnp.asarray(TIMES))).ys[:, 1]

    return solve


def gradient_seconds(solve):
    gradient = jax.jit(jax.value_and_grad(lambda rates: jnp.sum((solve(rates) - IN_BED)**2)))
    at, least = jnp.array([1.7, 0.5]), np.inf
    jax.block_until_ready(gradient(at))
    for _ in range(1000):
        begin = time.perf_counter()
        jax.block_until_ready(gradient(at))
        least = min(least, time.perf_counter() - begin)
    return least


def sampled(solve, draws):
    """(processor time, leapfrog steps of the draws, posterior means of the rates)."""
    def outbreak():
        contact = numpyro.sample("contact", dist.TruncatedNormal(2.0, 1.0, low=0.0))
        recovery = numpyro.sample("recovery", dist.TruncatedNormal(0.4, 0.5, low=0.0))
        spread = numpyro.sample("spread", dist.Exponential(5.0))
        numpyro.sample("in_bed", dist.NegativeBinomial2(solve(jnp.stack([contact, recovery])), 1 / spread), obs=IN_BED)

    sampler = MCMC(NUTS(outbreak), num_warmup=500, num_samples=draws, progress_bar=False)
    begin = time.process_time()
    sampler.run(jax.random.key(1), extra_fields=("num_steps",))
    found = sampler.get_samples()
    means = [float(found[name].mean()) for name in ("contact", "recovery")]
    return time.process_time() - begin, int(sampler.get_extra_fields()["num_steps"].sum()), means


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--draws", type=int, default=2000)
    parser.add_argument("--without-diffrax", action="store_true")
    asked = parser.parse_args()
    jax.config.update("jax_enable_x64", True)
    print("program,gradient,first,step,steps,contact,recovery")
    for name, solver in [("myriad", by_myriad), *([] if asked.without_diffrax else [("diffrax", by_diffrax)])]:
        solve = solver()
        gradient = gradient_seconds(solve)  # and so kernels are compiled
        first, few, many = (sampled(solve, draws) for draws in (asked.draws, asked.draws, 20 * asked.draws))
        step = (many[0] - few[0]) / (many[1] - few[1])
        contact, recovery = many[2]
        print(f"{name},{1e6 * gradient:.0f},{first[0]:.1f},{1e6 * step:.0f},{many[1]},{contact:.3f},{recovery:.3f}")


if __name__ == "__main__":
    main()
