// SPDX-License-Identifier: MIT
// The weak order of dri1, without sampling: its numbers take finitely many values, and so means over all outcomes of a
// step, and moments of linear equations over many steps, are sums.
#include "myriad/kernel/methods/dri1.hpp"

#include <array>
#include <cmath>

#include <myriad/model.hpp>

#include "myriad/kernel/stepper/stochastic_step.hpp"
#include "tests/catch.hpp"
#include "tests/support/noisy.hpp"

namespace {

using myriad::vec;

/// dx = a x dt + b x dW.
struct geometric {
    enum state { x, n_state };
    static constexpr double a = -0.6, b = 0.8;

    template <class R>
    MYRIAD_FUNCTION static vec<R, n_state> rhs(auto, const vec<R, n_state>& y, const auto&) {
        return vec<R, n_state>{a * y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static vec<R, n_state> diffusion(auto, const vec<R, n_state>& y, const auto&) {
        return vec<R, n_state>{b * y[x]};
    }
};

struct wiener {
    enum state { w, n_state };

    template <class R>
    MYRIAD_FUNCTION static vec<R, n_state> rhs(auto, const vec<R, n_state>&, const auto&) {
        return vec<R, n_state>{R(0)};
    }
    template <class R>
    MYRIAD_FUNCTION static vec<R, n_state> diffusion(auto, const vec<R, n_state>&, const auto&) {
        return vec<R, n_state>{R(1)};
    }
};

/// Two states that share three processes whose noise does not commute; nothing is linear, and all depends on time.
struct curved {
    enum state { x, z, n_state };
    enum noise { first, second, third, n_noise };

    template <class R>
    MYRIAD_FUNCTION static vec<R, n_state> rhs(auto t, const vec<R, n_state>& y, const auto&) {
        return {0.5 * cos(y[x]) - 0.25 * y[z] * (1 + t), y[x] * y[z] / 3 + 0.5 * t * t + 0.2};
    }
    template <class R>
    MYRIAD_FUNCTION static vec<vec<R, n_noise>, n_state> diffusion(auto t, const vec<R, n_state>& y, const auto&) {
        return {vec<R, n_noise>{0.4 * y[z] + 0.2 * y[x] * t, 0.5 * sin(y[x]) + 0.25, 0.3 * y[x] * y[z] + t / 3},
                vec<R, n_noise>{y[x] / 3 + 0.25 * cos(y[z]), 0.2 * y[z] * y[z] - 0.5 * t, 0.5 + y[x] / 7}};
    }
};

/// One step from (t, y) by h with these increments.
template <class Model>
auto stepped(double t, double h, const vec<double, Model::n_state>& y,
             const vec<double, myriad::detail::n_wiener<Model>>& increments) {
    const myriad::inputs<Model, double> p{};
    const myriad::detail::noisy_equation<Model, double> equation{p, increments, {}};
    return myriad::dri1::step(equation, t, h, t + h, y, equation.drift(t, y));
}

/// Calls `take(probability, increments)` for all outcomes of a step: six for each process, of which all that the method
/// takes is in which interval an increment lies.
template <int m, class Take>
void for_each_outcome(double h, Take&& take) {
    constexpr std::array place{-2.0, -1.2, -0.5, 0.5, 1.2, 2.0};
    constexpr std::array probability{1.0 / 12, 1.0 / 12, 1.0 / 3, 1.0 / 3, 1.0 / 12, 1.0 / 12};
    int count = 1;
    for (int j = 0; j < m; ++j) count *= 6;
    for (int outcome = 0; outcome < count; ++outcome) {
        double all = 1;
        vec<double, m> increments;
        for (int j = 0, rest = outcome; j < m; ++j, rest /= 6) {
            const auto one = static_cast<std::size_t>(rest % 6);
            all *= probability[one];
            increments[j] = place[one] * std::sqrt(std::fabs(h));
        }
        take(all, increments);
    }
}

}  // namespace

TEST_CASE("the numbers of dri1 have their probabilities") {
    // where the result changes as the increment grows
    const auto change = [](double from, double to, auto&& result) {
        const double before = result(from);
        for (int k = 0; k < 60; ++k) (result((from + to) / 2) == before ? from : to) = (from + to) / 2;
        return from;
    };
    const double h = 0.25;
    const auto three_point = [&](double z) { return stepped<wiener>(0, h, {0.0}, {z * std::sqrt(h)})[0]; };
    CHECK(three_point(0.5) == 0);
    CHECK(three_point(2) == Approx(std::sqrt(3 * h)).epsilon(1e-14));
    CHECK(three_point(-1.2) == -three_point(2));
    const double beyond = change(0.5, 1.2, three_point);
    CHECK(std::erfc(beyond / std::sqrt(2)) == Approx(1.0 / 3).epsilon(1e-14));
    const auto sign = [&](double z) {
        return stepped<noisy::sharing>(0, h, {1.0, 1.0}, {z * std::sqrt(h), std::sqrt(h)})[1];
    };
    CHECK(std::erfc(change(1.2, 2, sign) / std::sqrt(2)) == Approx(1.0 / 6).epsilon(1e-14));
    CHECK(std::fabs(change(-0.5, 0.5, sign)) < 1e-14);
}

TEST_CASE("dri1 has weak order two in a step of an equation whose noise does not commute") {
    // E u = u + h L u + h^2 / 2 L L u + O(h^3), with the generator L. L u and L L u of each moment u are by SymPy.
    constexpr int moments = 9;
    const auto moments_of = [](const vec<double, 2>& y) {
        const double x = y[0], z = y[1];
        return std::array<double, moments>{x,         z,         x * x,         x * z,        z * z,
                                           x * x * x, x * x * z, z * z * z * z, x * x * x * z};
    };
    constexpr std::array<double, moments> once{0.5124210936422442,   0.15166666666666667, 1.0588780600460346,
                                               -0.21141524699367326, 0.46751431174521324, 1.4703849184425735,
                                               -0.5068934240365662,  0.5264670726087382,  -0.7016741107294228},
        twice{-0.17964324093875003, 0.2295282510021089,  0.4187137240194073, 0.1801040746186044, 0.518447045328358,
              2.652749864696508,    -0.4877654955494978, 1.7361793751634074, -2.044819794249743};
    const vec<double, 2> start{0.7, -0.4};
    const auto errors = [&](double h) {
        std::array<double, moments> error{};
        for_each_outcome<3>(h, [&](double probability, const vec<double, 3>& increments) {
            const auto found = moments_of(stepped<curved>(0.3, h, start, increments));
            for (std::size_t k = 0; k < moments; ++k) error[k] += probability * found[k];
        });
        for (std::size_t k = 0; k < moments; ++k) error[k] -= moments_of(start)[k] + h * once[k] + h * h / 2 * twice[k];
        return error;
    };
    const auto coarse = errors(1.0 / 80), fine = errors(1.0 / 160);
    for (std::size_t k = 0; k < moments; ++k) {
        CAPTURE(k);
        CHECK(std::log2(coarse[k] / fine[k]) == Approx(3).margin(0.05));
    }
}

TEST_CASE("dri1 has weak order two for a linear equation, in reversed time too") {
    const auto moments = [](double h, int steps) {
        std::array<double, 2> of_step{};
        for_each_outcome<1>(h, [&](double probability, const vec<double, 1>& increments) {
            const double x = stepped<geometric>(0, h, {1.0}, increments)[0];
            of_step[0] += probability * x;
            of_step[1] += probability * x * x;
        });
        return std::array{std::pow(of_step[0], steps), std::pow(of_step[1], steps)};
    };
    for (const double end : {1.0, -1.0}) {
        const std::array exact{std::exp(geometric::a * end),
                               std::exp(2 * geometric::a * end + geometric::b * geometric::b)};
        const auto coarse = moments(end / 64, 64), fine = moments(end / 128, 128);
        CHECK(std::log2((coarse[1] - exact[1]) / (fine[1] - exact[1])) == Approx(2).margin(0.05));
        // the mean is that of the method for the drift alone, of order three
        CHECK(std::log2((coarse[0] - exact[0]) / (fine[0] - exact[0])) == Approx(3).margin(0.05));
    }
}

TEST_CASE("dri1 has weak order two where two states share noise that does not commute") {
    // A step is linear, so that x^2, x z and z^2 have means that a step multiplies by a matrix.
    constexpr double end = 3;
    using moments = std::array<double, 3>;
    const auto found = [](int steps) {
        const double h = end / steps;
        std::array<moments, 3> matrix{};
        for_each_outcome<2>(h, [&](double probability, const vec<double, 2>& increments) {
            const auto of_x = stepped<noisy::sharing>(0, h, {1.0, 0.0}, increments);
            const auto of_z = stepped<noisy::sharing>(0, h, {0.0, 1.0}, increments);
            const auto add = [&](std::size_t row, int a, int b) {
                matrix[row][0] += probability * of_x[a] * of_x[b];
                matrix[row][1] += probability * (of_x[a] * of_z[b] + of_z[a] * of_x[b]);
                matrix[row][2] += probability * of_z[a] * of_z[b];
            };
            add(0, 0, 0);
            add(1, 0, 1);
            add(2, 1, 1);
        });
        moments all{1, 1, 1};
        for (int k = 0; k < steps; ++k) {
            const moments before = all;
            for (std::size_t i = 0; i < 3; ++i)
                all[i] = matrix[i][0] * before[0] + matrix[i][1] * before[1] + matrix[i][2] * before[2];
        }
        return all;
    };
    const moments exact{std::exp(-end), std::exp(-2 * end), (149 * std::exp(-2.5 * end) + std::exp(-end)) / 150};
    const auto coarse = found(128), fine = found(256);
    for (std::size_t k = 0; k < 3; ++k) {
        CAPTURE(k);
        CHECK(std::log2((coarse[k] - exact[k]) / (fine[k] - exact[k])) == Approx(2).margin(0.05));
        CHECK(fine[k] == Approx(exact[k]).epsilon(2e-4));
    }
}
