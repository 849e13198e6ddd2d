#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Times gradients of a loss in JAX: `jax.jit(jax.vmap(jax.grad(loss)))` over the four rates of the equations of Lotka
and Volterra, the loss being half the sum of squares at 20 times, with a solution by Myriad and by diffrax.

Both are in double precision, by Tsitouras' method 5(4) with equal tolerances. diffrax's gradients go backwards through
its steps (its default, RecursiveCheckpointAdjoint) or forwards (ForwardMode, by `jax.jacfwd`). Sets and gradients stay
where JAX has them. Seconds are by the clock, medians of several calls after two, of which the first compiles; errors
are against Myriad at 1e-11, in parts of the gradient's largest component, the median and the largest over the sets of
rates.

Usage: gradients.py [--sets N] [--calls N] [--device DEVICE] [--without-diffrax]

With `--device cuda` both integrate on the GPU. Writes rows "program,sets,seconds,median error,largest error"."""

import argparse
import time

import numpy as np

import myriad_ode as my

END, TIMES = 20.0, np.arange(1.0, 21.0)
START, RATES = (30.0, 4.0), np.array([0.5, 0.025, 0.9, 0.028])
RTOL, ATOL = 1e-6, 1e-6


def simulated(device, rtol=RTOL, atol=ATOL):
    """Prey and predators at the times, as a function of the rates."""
    prey, predator = my.states("prey predator")
    birth, hunt, death, growth = rates = my.parameters("birth hunt death growth")
    model = my.model({prey: birth * prey - hunt * prey * predator,
                      predator: growth * prey * predator - death * predator}, name="lotka_volterra")
    return my.batched(model, free=rates, of=[prey, predator], start=dict(zip((prey, predator), START)), time=(0, END),
                      samples=TIMES, method="tsitouras_5", rtol=rtol, atol=atol, device=device)


def by_myriad(data, device):
    import jax
    import jax.numpy as jnp

    solve = simulated(device).to_jax()
    return jax.jit(jax.vmap(jax.grad(lambda rates: 0.5 * jnp.sum((solve(rates) - data)**2))))


def by_diffrax(data, forward):
    import diffrax
    import jax
    import jax.numpy as jnp

    def slope(_, y, rates):
        birth, hunt, death, growth = rates
        return jnp.array([birth * y[0] - hunt * y[0] * y[1], growth * y[0] * y[1] - death * y[1]])

    def loss(rates):
        done = diffrax.diffeqsolve(diffrax.ODETerm(slope), diffrax.Tsit5(), 0.0, END, None, jnp.array(START), rates,
                                   stepsize_controller=diffrax.PIDController(rtol=RTOL, atol=ATOL),
                                   saveat=diffrax.SaveAt(ts=jnp.asarray(TIMES)), max_steps=1024,
                                   adjoint=diffrax.ForwardMode() if forward else diffrax.RecursiveCheckpointAdjoint())
        return 0.5 * jnp.sum((done.ys - data)**2)

    return jax.jit(jax.vmap((jax.jacfwd if forward else jax.grad)(loss)))


def measured(gradients, sets, calls):
    """(median of the seconds, gradients)."""
    import jax

    sets = jax.block_until_ready(jax.numpy.asarray(sets))
    for _ in range(2):
        found = jax.block_until_ready(gradients(sets))
    seconds = []
    for _ in range(calls):
        begin = time.perf_counter()
        jax.block_until_ready(gradients(sets))
        seconds.append(time.perf_counter() - begin)
    return np.median(seconds), np.asarray(found)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sets", type=int, default=100_000)
    parser.add_argument("--calls", type=int, default=5)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--without-diffrax", action="store_true")
    options = parser.parse_args()

    import jax

    jax.config.update("jax_enable_x64", True)
    if not options.device.startswith("cuda"):
        jax.config.update("jax_platforms", "cpu")
    random = np.random.default_rng(1)
    sets = RATES * random.uniform(0.8, 1.25, (options.sets, 4))
    data = simulated("cpu")(RATES)

    reference = []
    for rows in np.array_split(sets, max(options.sets // 20_000, 1)):
        values, slopes = simulated(options.device, 1e-11, 1e-11).with_jacobian(rows)
        reference.append(np.einsum("stq,stqi->si", values - data, slopes))
    reference = np.concatenate(reference)

    programs = {"Myriad": lambda: by_myriad(data, options.device)}
    if not options.without_diffrax:
        programs["diffrax, backwards"] = lambda: by_diffrax(data, forward=False)
        programs["diffrax, forwards"] = lambda: by_diffrax(data, forward=True)
    print("program,sets,seconds,median error,largest error")
    for name, program in programs.items():
        seconds, found = measured(program(), sets, options.calls)
        error = np.abs(found - reference).max(axis=1) / np.abs(reference).max(axis=1)
        print(f"{name},{options.sets},{seconds:.4g},{np.median(error):.2g},{error.max():.2g}", flush=True)


if __name__ == "__main__":
    main()
