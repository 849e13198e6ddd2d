# SPDX-License-Identifier: MIT
"""Kuramoto's oscillators, whose coupling is an array: how far each network synchronises."""

import numpy as np

import myriad_ode as my

# snippet: table
size = 12
weights = np.random.default_rng(1).uniform(size=(size, size))  # whose pull each of them feels, and how much
weights /= weights.sum(axis=1, keepdims=True)
frequencies = np.linspace(-1, 1, size)

phi = np.array(my.states([f"phi_{i}" for i in range(size)]))
coupling, order = my.parameter("coupling"), my.accessory("order")
W, omega = my.table("W", weights), my.table("omega", frequencies)

sine, cosine = np.sin(phi), np.cos(phi)
pull = cosine * (W @ sine) - sine * (W @ cosine)  # sum of W_ij sin(phi_j - phi_i)
network = my.model(dict(zip(phi, omega[:] + coupling * pull)), name="network",
                   finalise={order: my.hypot(sine.sum(), cosine.sum()) / size})
# end of snippet

start = np.linspace(0, 6, size)
run = my.solve(network, {coupling: np.linspace(0, 5, 51)}, start=dict(zip(phi, start)), time=(0, 100), rtol=1e-8)

# Without coupling each turns at its own frequency; strongly coupled, all at one, close together.
assert np.isclose(run["order"][0], abs(np.exp(1j * (start + 100 * frequencies)).mean()), atol=1e-6)
assert run["order"][20:].min() > 0.9
