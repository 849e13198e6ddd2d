# SPDX-License-Identifier: MIT
"""The posterior of an epidemic's rates: by NUTS of NumPyro, by emcee's ensemble, and from simulations alone, by
rejection and by sbi. Packages that are not installed are left out."""

import importlib.util
# snippet: model
import time

import numpy as np
from scipy import stats

import myriad_ode as my

susceptible, infected = my.states("susceptible infected")
contact, recovery = rates = my.parameters("contact recovery")
pupils = 763
new = contact * susceptible * infected / pupils
epidemic = my.model({susceptible: -new, infected: new - recovery * infected}, name="epidemic")

# boys in bed on each day (anonymous, British Medical Journal, 4 March 1978, p. 587)
in_bed = np.array([3, 8, 26, 76, 225, 298, 258, 233, 189, 128, 68, 29, 14, 4])
days = np.arange(1, 15)
simulate = my.batched(epidemic, free=rates, of=infected, start={susceptible: pupils - 1, infected: 1}, time=(0, 14),
                      samples=days, rtol=1e-6, atol=1e-6, invalid="mark")
# end of snippet
found: dict[str, tuple[np.ndarray, np.ndarray]] = {}


def summary(name, samples):
    """Prints and keeps mean and standard deviation of the rates."""
    found[name] = np.mean(samples, axis=0), np.std(samples, axis=0)
    print(f"{name}: " + ", ".join(f"{rate.value[1]} {mean:.2f} +- {deviation:.2f}"
                                  for rate, mean, deviation in zip(rates, *found[name])))


if importlib.util.find_spec("numpyro"):
    # snippet: nuts
    import jax
    import jax.numpy as jnp
    import numpyro
    import numpyro.distributions as dist
    from numpyro.infer import MCMC, NUTS

    jax.config.update("jax_enable_x64", True)
    in_jax = simulate.to_jax()

    def outbreak():
        """Priors, and the likelihood of the counts."""
        of_contact = numpyro.sample("contact", dist.TruncatedNormal(2.0, 1.0, low=0.0))
        of_recovery = numpyro.sample("recovery", dist.TruncatedNormal(0.4, 0.5, low=0.0))
        spread = numpyro.sample("spread", dist.Exponential(5.0))
        expected = in_jax(jnp.stack([of_contact, of_recovery]))[:, 0]
        numpyro.sample("in_bed", dist.NegativeBinomial2(expected, 1 / spread), obs=in_bed)

    sampler = MCMC(NUTS(outbreak), num_warmup=500, num_samples=1000, progress_bar=False)
    sampler.run(jax.random.key(1))
    draws = sampler.get_samples()
    # end of snippet
    summary("NUTS", np.stack([draws["contact"], draws["recovery"]], axis=1))

if importlib.util.find_spec("emcee"):
    # snippet: emcee
    import emcee

    def log_posterior(rows):
        """Of contact, recovery and spread in rows: all of them are one call of the integrator."""
        expected = simulate(rows[:, :2])[:, :, 0]
        spread = rows[:, 2:]
        with np.errstate(all="ignore"):  # of rows that the priors refuse
            likelihood = stats.nbinom.logpmf(in_bed, 1 / spread, 1 / (1 + spread * expected)).sum(axis=1)
            prior = stats.norm.logpdf(rows[:, :2], [2.0, 0.4], [1.0, 0.5]).sum(axis=1) - 5 * rows[:, 2]
            return np.where((rows > 0).all(axis=1), np.nan_to_num(likelihood + prior, nan=-np.inf), -np.inf)

    np.random.seed(2)  # which emcee's own random numbers begin with
    walkers = np.array([1.7, 0.5, 0.2]) * np.random.default_rng(2).uniform(0.8, 1.2, (64, 3))
    ensemble = emcee.EnsembleSampler(64, 3, log_posterior, vectorize=True)  # which moves half of them at a time
    ensemble.run_mcmc(walkers, 400)
    chain = ensemble.get_chain(discard=150, flat=True)
    # end of snippet
    summary("emcee", chain[:, :2])

# snippet: simulator
random = np.random.default_rng(3)


def prior(count):
    """Contact, recovery and spread in rows: normal ones that are positive, and an exponential one."""
    return np.column_stack([stats.truncnorm.rvs(-2.0, np.inf, 2.0, 1.0, count, random_state=random),
                            stats.truncnorm.rvs(-0.8, np.inf, 0.4, 0.5, count, random_state=random),
                            random.exponential(0.2, count)])


def simulator(rows):
    """Counts for each row, as sbi asks for them: a row of days for each."""
    expected, spread = np.maximum(simulate(rows[:, :2])[:, :, 0], 1e-9), rows[:, 2:]
    return random.poisson(random.gamma(1 / spread, spread * expected))
# end of snippet


# snippet: rejection
batches, size, kept = 4, 50_000, 200
begin = time.perf_counter()
best = []
for _ in range(batches):  # so that memory holds one batch
    tried = prior(size)
    distance = np.square(np.sqrt(simulator(tried)) - np.sqrt(in_bed)).sum(axis=1)
    best.append(np.column_stack([distance, tried])[np.argsort(distance)[:kept]])
nearest = np.concatenate(best)
nearest = nearest[np.argsort(nearest[:, 0])[:kept]]
# end of snippet
print(f"{batches * size} simulations: {time.perf_counter() - begin:.1f} s")
summary("rejection", nearest[:, 1:3])

if importlib.util.find_spec("sbi"):
    # snippet: sbi
    import torch
    from sbi.inference import NPE

    sets = prior(20_000)
    inference = NPE()
    inference.append_simulations(torch.as_tensor(np.log(sets)).float(),
                                 torch.as_tensor(np.sqrt(simulator(sets))).float()).train()
    estimate = inference.build_posterior()
    samples = estimate.sample((1000,), x=torch.as_tensor(np.sqrt(in_bed)).float()).exp().numpy()
    # end of snippet
    summary("sbi", samples[:, :2])

for name, (means, deviations) in found.items():
    wide = name in ("rejection", "sbi")  # which approximate
    np.testing.assert_allclose(means, [1.73, 0.54], atol=0.15 if wide else 0.03, err_msg=name)
    np.testing.assert_array_less(deviations, 0.4 if wide else 0.08, err_msg=name)
