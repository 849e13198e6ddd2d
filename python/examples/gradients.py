#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A model as a function with derivatives: in SciPy, JAX and PyTorch, for emcee and for inference from simulations."""

import importlib.util

import numpy as np
from scipy import optimize

import myriad_ode as my

# snippet: function
prey, predator = my.states("prey predator")
birth, hunt, death, growth = rates = my.parameters("birth hunt death growth")
model = my.model({prey: birth * prey - hunt * prey * predator, predator: growth * prey * predator - death * predator},
                 name="lotka_volterra")

simulate = my.batched(model, free=rates, of=[prey, predator], start={prey: 30, predator: 4}, time=(0, 20),
                      samples=np.arange(1, 21))

theta = np.array([0.5, 0.025, 0.9, 0.028])  # in the order of free=
values, slopes = simulate.with_jacobian(theta)  # [time, quantity] and [time, quantity, rate]
many = simulate(theta * np.linspace(0.9, 1.1, 500)[:, None])  # [set, time, quantity]: one call of solve
# end of snippet
assert values.shape == (20, 2) and slopes.shape == (20, 2, 4) and many.shape == (500, 20, 2)
near = np.array([simulate(theta * np.where(np.arange(4) == i, 1 + d, 1)) for i in range(4) for d in (1e-4, -1e-4)])
differences = (near[0::2] - near[1::2]) / (2e-4 * theta[:, None, None])
np.testing.assert_allclose(np.moveaxis(slopes, -1, 0), differences, rtol=1e-3, atol=1e-3 * abs(differences).max())

true = np.array([0.48, 0.0248, 0.926, 0.0275])
data = simulate(true) + np.random.default_rng(1).normal(size=(20, 2))

# snippet: scipy
def loss(logarithms):
    """Half the sum of squares, and its derivatives by the logarithms of the rates."""
    rates = np.exp(logarithms)
    values, slopes = simulate.with_jacobian(rates)
    residuals = values - data
    return 0.5 * np.sum(residuals**2), np.einsum("tq,tqi->i", residuals, slopes) * rates

found = optimize.minimize(loss, np.log(theta), jac=True, method="BFGS")
# end of snippet
np.testing.assert_allclose(np.exp(found.x), true, rtol=0.02)

# snippet: adjoint
by_adjoint = my.batched(model, free=rates, of=[prey, predator], start={prey: 30, predator: 4}, time=(0, 20),
                        samples=np.arange(1, 21), adjoint=True)

# the results, and the derivatives of half the sum of squares, whose derivatives by the results are the residuals
results, gradient = by_adjoint.vjp(theta, lambda results: results - data)
# end of snippet
np.testing.assert_allclose(gradient, np.einsum("tq,tqi->i", simulate(theta) - data, slopes), rtol=1e-5)

# snippet: emcee
def log_probability(rows):
    """Of the logarithms of the rates in rows: all walkers of half an ensemble are one call."""
    return np.nan_to_num(-0.5 * np.sum((simulate(np.exp(rows)) - data)**2, axis=(1, 2)), nan=-np.inf)

# with emcee: emcee.EnsembleSampler(32, 4, log_probability, vectorize=True).run_mcmc(walkers, 1000)
# end of snippet
walkers = found.x + 1e-3 * np.random.default_rng(2).normal(size=(32, 4))
assert log_probability(walkers).shape == (32,)
if importlib.util.find_spec("emcee"):
    import emcee

    sampler = emcee.EnsembleSampler(32, 4, log_probability, vectorize=True)
    sampler.run_mcmc(walkers, 200)
    chain = sampler.get_chain(discard=100, flat=True)
    assert (abs(np.mean(chain, axis=0) - np.log(true)) < 5 * np.std(chain, axis=0)).all()

# snippet: simulator
random = np.random.default_rng(3)

def simulator(rows):
    """Measurements for rates in rows, as sbi and BayesFlow ask for them."""
    return (simulate(rows) + random.normal(size=(len(rows), 20, 2))).reshape(len(rows), -1)
# end of snippet
assert simulator(np.array([theta, true])).shape == (2, 40)

if importlib.util.find_spec("jax"):
    # snippet: jax
    import jax

    jax.config.update("jax_enable_x64", True)
    in_jax = simulate.to_jax()

    def squares(rates):
        return 0.5 * jax.numpy.sum((in_jax(rates) - data)**2)

    gradient = jax.jit(jax.grad(squares))(theta)
    sets = theta * np.linspace(0.9, 1.1, 100)[:, None]
    gradients = jax.vmap(jax.grad(squares))(sets)  # one call of solve for all sets
    jacobian = jax.jacfwd(in_jax)(theta)           # [time, quantity, rate]
    # end of snippet
    np.testing.assert_allclose(gradient, np.einsum("tq,tqi->i", values - data, slopes), rtol=1e-10)
    np.testing.assert_allclose(jacobian, slopes, rtol=1e-12)
    assert gradients.shape == (100, 4)

if importlib.util.find_spec("torch"):
    # snippet: torch
    import torch

    in_torch = simulate.to_torch()
    sets = torch.tensor(np.tile(theta, (100, 1)), requires_grad=True)
    (in_torch(sets) - torch.tensor(data)).square().sum().backward()
    gradients = sets.grad  # [set, rate], from one call of solve
    # end of snippet
    np.testing.assert_allclose(sets.grad[0], 2 * np.einsum("tq,tqi->i", values - data, slopes), rtol=1e-10)
