#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""First passages of noisy paths, located within steps by the law of the path or seen at the ends of steps, against
known means and variances.

Usage: noise_events.py [--device DEVICE] [--paths N] [--block N]

Prints two tables: the first passage of a Wiener process with a drift, of which all is known; and the mean of that of an
Ornstein-Uhlenbeck process by the length of steps, whose error is that of the method."""

import argparse

import numpy as np

import myriad_ode as my

x = my.state("x")
drift, pull, sigma, level = my.parameters("drift pull sigma level")
equation = dict(equations={x: drift - pull * x}, noise={x: sigma})
located = my.model(**equation, events=my.event(x - level, direction="rising", stop_after=1))
seen = my.model(**equation, after_step={my.end_phase: x >= level})


class Moments:
    """Means, variances and their standard errors of numbers that come in blocks, by their sums of powers."""

    def __init__(self):
        self.count, self.sums = 0, np.zeros(4)

    def add(self, values, about):
        """Adds values, whose powers are those of their distances from a number near their mean."""
        self.count += len(values)
        self.sums += [((values - about)**power).sum() for power in (1, 2, 3, 4)]
        self.about = about

    @property
    def of_values(self):
        """(mean, its error, variance, its error)"""
        m1, m2, m3, m4 = self.sums / self.count
        variance = m2 - m1**2
        fourth = m4 - 4 * m1 * m3 + 6 * m1**2 * m2 - 3 * m1**4
        return (self.about + m1, np.sqrt(variance / self.count), variance,
                np.sqrt((fourth - variance**2) / self.count))


def passages(model, values, step, about, arguments, method="euler_maruyama"):
    """Moments of the first passage times from 0."""
    moments = Moments()
    for seed, begin in enumerate(range(0, arguments.paths, arguments.block)):
        paths = min(arguments.block, arguments.paths - begin)
        run = my.solve(model, values, start={x: 0}, time=(0, 1e4), paths=paths, step=step, seed=seed, method=method,
                       device=arguments.device)
        assert np.isin(run.status, ["stopped_by_event", "stopped_by_user"]).all(), run.summary()
        moments.add(run.t_last, about)
    return moments.of_values


def drifting(arguments):
    """dx = mu dt + sigma dW from 0 to a: mean a / mu, variance a sigma^2 / mu^3."""
    values = {drift: 1.0, pull: 0.0, sigma: 1.0, level: 1.0}
    print("| step | events | mean | off, in standard errors | variance | off, in standard errors |\n"
          "|---|---|---|---|---|---|")
    for step in (1.0, 0.1):
        for model, name in ((located, "on the path"), (seen, "at the ends of steps")):
            mean, of_mean, variance, of_variance = passages(model, values, step, 1.0, arguments)
            print(f"| {step} | {name} | {mean:.5f} | {(mean - 1) / of_mean:+.1f} | {variance:.5f} | "
                  f"{(variance - 1) / of_variance:+.1f} |", flush=True)


def reverting(arguments):
    """dx = -x dt + dW from 0 to 1: the mean is sqrt(pi) times the integral of exp(u^2) (1 + erf(u)) from 0 to 1, where
    erf is by its series."""
    u = (np.arange(100_000) + 0.5) / 100_000
    erf, term = np.zeros_like(u), u * 2 / np.sqrt(np.pi)
    for k in range(1, 40):
        erf += term / (2 * k - 1)
        term = -term * u**2 / k
    exact = np.sqrt(np.pi) * (np.exp(u**2) * (1 + erf)).mean()
    print(f"\nMeans beside {exact:.4f}\n\n| step | euler_maruyama, at the ends | euler_maruyama | sra1 |\n"
          "|---|---|---|---|")
    values = {drift: 0.0, pull: 1.0, sigma: 1.0, level: 1.0}
    for step in (0.2, 0.1, 0.05, 0.025):
        found = [passages(model, values, step, exact, arguments, method)[:2]
                 for model, method in ((seen, "euler_maruyama"), (located, "euler_maruyama"), (located, "sra1"))]
        print(f"| {step} | " + " | ".join(f"{mean - exact:+.4f} ± {error:.4f}" for mean, error in found) + " |",
              flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="auto")
    parser.add_argument("--paths", type=int, default=1_000_000, help="of each line (default: %(default)s)")
    parser.add_argument("--block", type=int, default=1_000_000, help="paths at a time (default: %(default)s)")
    arguments = parser.parse_args()
    drifting(arguments)
    reverting(arguments)


if __name__ == "__main__":
    main()
