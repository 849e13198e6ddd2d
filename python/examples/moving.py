# SPDX-License-Identifier: MIT
"""The sweep of the pages docs/moving: van der Pol's oscillator for 1024 values of mu, and its derivatives; beside it
what SciPy and diffrax compute, where these are installed."""

import importlib.util

# snippet: sweep
import numpy as np

import myriad_ode as my

x, v = my.states("x v")
mu = my.parameter("mu")
oscillator = my.model({x: v, v: mu * (1 - x**2) * v - x}, name="van_der_pol")

run = my.solve(oscillator, {mu: np.linspace(0.5, 4.0, 1024)}, start={x: 1, v: 0}, time=(0, 20), rtol=1e-8, atol=1e-8,
               method="dormand_prince_5")
run[x]  # at t = 20, one value for each mu
# end of snippet
assert run.report.failed == 0 and run[x].shape == (1024,)

# snippet: function
def van_der_pol(t, y, mu):
    return [y[1], mu * (1 - y[0]**2) * y[1] - y[0]]

same = my.model(van_der_pol, states="x v", parameters="mu")
# end of snippet
assert np.array_equal(my.solve(same, {"mu": run[mu]}, start={"x": 1, "v": 0}, time=(0, 20), rtol=1e-8, atol=1e-8,
                               method="dormand_prince_5")["x"], run[x])

# snippet: gradient
at_20 = my.batched(oscillator, free=mu, of=x, start={x: 1, v: 0}, time=(0, 20), rtol=1e-8, atol=1e-8)
values, slopes = at_20.with_jacobian(np.linspace(0.5, 4.0, 1024)[:, None])  # slopes[i, 0, 0]: of x by mu
# end of snippet
np.testing.assert_allclose(values[:, 0], run[x], atol=2e-5)
near = at_20(np.array([[1.0 + 1e-4], [1.0 - 1e-4]]))
np.testing.assert_allclose(at_20.with_jacobian([[1.0]])[1].ravel(), (near[0] - near[1]) / 2e-4, rtol=1e-3)

if importlib.util.find_spec("scipy"):
    from scipy.integrate import solve_ivp

    for i in (0, 500, 1023):
        theirs = solve_ivp(van_der_pol, (0, 20), [1, 0], args=(run[mu][i],), rtol=1e-8, atol=1e-8)
        assert abs(theirs.y[0, -1] - run[x][i]) < 1e-5

if importlib.util.find_spec("diffrax"):
    # snippet: diffrax
    import diffrax
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)

    def slope(t, y, mu):
        return jnp.array([y[1], mu * (1 - y[0]**2) * y[1] - y[0]])

    def at_end(mu):
        solution = diffrax.diffeqsolve(
            diffrax.ODETerm(slope), diffrax.Dopri5(), t0=0, t1=20, dt0=None, y0=jnp.array([1.0, 0.0]), args=mu,
            stepsize_controller=diffrax.PIDController(rtol=1e-8, atol=1e-8), max_steps=100_000)
        return solution.ys[-1, 0]

    values_of_mu = jnp.linspace(0.5, 4.0, 1024)
    ends = jax.jit(jax.vmap(at_end))(values_of_mu)
    slopes_of_ends = jax.jit(jax.vmap(jax.grad(at_end)))(values_of_mu)
    # end of snippet
    np.testing.assert_allclose(ends, run[x], atol=1e-5)
    np.testing.assert_allclose(slopes_of_ends, slopes[:, 0, 0], rtol=1e-4, atol=1e-4)
    # snippet: jax
    in_jax = at_20.to_jax()
    ours = jax.jit(jax.vmap(jax.grad(lambda mu: in_jax(mu[None])[0])))(values_of_mu)
    # end of snippet
    np.testing.assert_allclose(ours, slopes[:, 0, 0], rtol=1e-12)
