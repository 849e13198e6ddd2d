// SPDX-License-Identifier: MIT
// One step of linearly_implicit_euler_maruyama, against its linear system solved by hand.
#include "myriad/kernel/methods/linearly_implicit_euler_maruyama.hpp"

#include <cmath>

#include <myriad/model.hpp>

#include "myriad/kernel/stepper/stochastic_step.hpp"
#include "tests/catch.hpp"

namespace {

using myriad::vec;

struct curved {
    enum state { x, z, n_state };
    enum noise { first, n_noise };

    template <class R>
    MYRIAD_FUNCTION static vec<R, n_state> rhs(auto t, const vec<R, n_state>& y, const auto&) {
        return {y[x] * y[z] - y[x] * t, t * t * y[x] - y[z] * y[z]};
    }
    template <class R>
    MYRIAD_FUNCTION static vec<vec<R, n_noise>, n_state> diffusion(auto t, const vec<R, n_state>& y, const auto&) {
        return {vec<R, n_noise>{y[z]}, vec<R, n_noise>{t}};
    }
};

vec<double, 2> stepped(double t, double h, const vec<double, 2>& y, double increment) {
    const myriad::inputs<curved, double> p{};
    const myriad::detail::noisy_equation<curved, double> equation{p, {increment}, {}};
    return myriad::linearly_implicit_euler_maruyama::step(equation, t, h, t + h, y, equation.drift(t, y));
}

}  // namespace

TEST_CASE("a step of linearly_implicit_euler_maruyama solves its linear system, forwards and backwards") {
    const double t = 0.4, x = 0.7, z = -1.1, increment = 0.3;
    for (const double h : {0.25, -0.125}) {
        // of x = h (f + h df/dt + J x) + g dW, by Cramer's rule
        const double of_x = h * (x * z - x * t - h * x) + z * increment,
                     of_z = h * (t * t * x - z * z + h * 2 * t * x) + t * increment;
        const double a = 1 - h * (z - t), b = -h * x, c = -h * t * t, d = 1 + h * 2 * z, determinant = a * d - b * c;
        const auto found = stepped(t, h, {x, z}, increment);
        CHECK(found[0] == Approx(x + (d * of_x - b * of_z) / determinant).epsilon(1e-14));
        CHECK(found[1] == Approx(z + (a * of_z - c * of_x) / determinant).epsilon(1e-14));
    }
}

TEST_CASE("a step of linearly_implicit_euler_maruyama whose matrix is singular is not a number") {
    const auto found = stepped(0, 0.5, {1.0, 2.0}, 0.1);  // 1 - h z is zero
    CHECK(std::isnan(found[0]));
    CHECK(std::isnan(found[1]));
}
