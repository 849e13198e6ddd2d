// SPDX-License-Identifier: MIT
// Sensitivities against those of CVODES, which integrates variational equations by other methods: its right-hand sides
// are central differences in extended precision along the solution, exact for these polynomials but for rounding, and
// so share nothing with Myriad's dual numbers. Prints a table; exit status 1 if a derivative is beyond its limit.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <iomanip>
#include <iostream>
#include <vector>

#include <myriad/myriad.hpp>

#include "validation/cvodes.hpp"
#include "validation/sensitivities/models.hpp"

namespace {

bool all_right = true;

/// A component that derivatives are by: parameter or state.
struct component {
    bool is_state;
    int number;
};

/// What of a model the reference integrates, and where the instances are.
struct setting {
    const char* name;
    std::vector<double> start;
    std::vector<std::vector<double>> parameters;  // of each instance
    std::vector<component> by;
    std::vector<double> ends;
    bool stiff;
    double limit;  // of the largest error
};

/// Parameters in extended precision, as a model reads them.
struct extended_parameters {
    std::vector<long double> values;
    long double operator[](int k) const { return values[static_cast<std::size_t>(k)]; }
};

template <class Model>
validation::sensitivity_problem reference(const setting& s, const std::vector<double>& parameters) {
    constexpr int n = Model::n_state;
    using vector = myriad::vec<long double, n>;
    validation::sensitivity_problem p;
    p.y = s.start;
    p.stiff = s.stiff;
    const extended_parameters at = {{parameters.begin(), parameters.end()}};
    for (const component c : s.by) {
        const auto number = static_cast<std::size_t>(c.number);
        p.s.emplace_back(s.start.size(), 0.0);
        if (c.is_state) p.s.back()[number] = 1;
        p.scale.push_back(std::abs(c.is_state ? s.start[number] : parameters[number]));
    }
    p.f = [at](double t, const double* y, double* slope) {
        vector state;
        std::copy(y, y + n, &state[0]);
        const vector f = Model::template rhs<long double>(static_cast<long double>(t), state, at);
        for (int c = 0; c < n; ++c) slope[c] = static_cast<double>(f[c]);
    };
    p.g = [at, by = s.by](int i, double t, const double* y, const double* along, double* slope) {
        const component direction = by[static_cast<std::size_t>(i)];
        // a step of which every component is about a thousandth of its own size, or of 1
        long double size = 1e-30L;
        for (int c = 0; c < n; ++c) size = std::max(size, std::abs(along[c]) / (1e-3L + std::abs(y[c])));
        if (!direction.is_state) size = std::max(size, 1 / std::abs(at[direction.number]));
        const long double d = 1e-3L / size;
        const auto moved = [&](long double by_much) {
            vector state;
            for (int c = 0; c < n; ++c) state[c] = y[c] + by_much * along[c];
            extended_parameters there = at;
            if (!direction.is_state) there.values[static_cast<std::size_t>(direction.number)] += by_much;
            return Model::template rhs<long double>(static_cast<long double>(t), state, there);
        };
        const vector far = moved(2 * d), near = moved(d), back = moved(-d), far_back = moved(-2 * d);
        for (int c = 0; c < n; ++c)
            slope[c] = static_cast<double>((8 * (near[c] - back[c]) - (far[c] - far_back[c])) / (12 * d));
    };
    return p;
}

template <class WithSensitivities, class Method, class Model>
void compare(const setting& s) {
    using W = WithSensitivities;
    constexpr int n = Model::n_state;
    const auto directions = s.by.size();
    const auto size = s.parameters.size() * s.ends.size();
    std::vector<validation::sensitivity_problem> known, rough;
    myriad::ensemble<W> e(static_cast<Eigen::Index>(size));
    for (const auto& parameters : s.parameters) {
        for (const double end : s.ends) {
            const auto i = static_cast<Eigen::Index>(known.size());
            for (int c = 0; c < n; ++c) e.state(c)[i] = s.start[static_cast<std::size_t>(c)];
            for (std::size_t k = 0; k < parameters.size(); ++k) e.parameter(static_cast<int>(k))[i] = parameters[k];
            e.t_begin()[i] = 0;
            e.t_end()[i] = end;
            known.push_back(reference<Model>(s, parameters));
            rough.push_back(known.back());
            validation::integrate_by_cvodes(known.back(), end, 1e-12, 1e-22);
            validation::integrate_by_cvodes(rough.back(), end, 1e-11, 1e-21);
        }
    }
    myriad::initial_sensitivities(e);
    myriad::options o;
    o.relative_tolerance = 1e-10;
    std::vector<double> absolute(static_cast<std::size_t>(W::n_state), 0.0);
    std::vector<double> largest(static_cast<std::size_t>(W::n_state), 0.0);
    for (int c = 0; c < n; ++c) {
        const auto place = static_cast<std::size_t>(c);
        double typical = 1e-20;
        for (const auto& p : known) typical = std::max(typical, std::abs(p.y[place]));
        absolute[place] = 1e-10 * typical;
        for (std::size_t d = 0; d < directions; ++d) {
            const auto of = static_cast<std::size_t>(W::sensitivity(c, static_cast<int>(d)));
            absolute[of] = 1e-10 * typical / known.front().scale[d];
            for (const auto& p : known) largest[of] = std::max(largest[of], std::abs(p.s[d][place]));
        }
    }
    o.absolute_tolerance = absolute;
    const auto report = myriad::solve<Method>(myriad::device::cpu(1), e, o);
    double error = 0, of_reference = 0;
    for (std::size_t i = 0; i < size; ++i) {
        for (int c = 0; c < n; ++c) {
            for (std::size_t d = 0; d < directions; ++d) {
                const int place = W::sensitivity(c, static_cast<int>(d));
                const double right = known[i].s[d][static_cast<std::size_t>(c)];
                const double scale = std::abs(right) + 1e-3 * largest[static_cast<std::size_t>(place)];
                if (scale == 0) continue;
                const double off = std::abs(e.state(place)[static_cast<Eigen::Index>(i)] - right) / scale;
                error = std::isfinite(off) ? std::max(error, off) : off;
                of_reference =
                    std::max(of_reference, std::abs(rough[i].s[d][static_cast<std::size_t>(c)] - right) / scale);
            }
        }
    }
    const bool right = report.count(myriad::status::success) == e.size() && error <= s.limit;
    all_right = all_right && right;
    std::cout << "| " << s.name << " | " << n << " | " << directions << " | " << std::setprecision(2) << error << " | "
              << s.limit << " | " << of_reference << " |" << (right ? "" : " WRONG") << '\n';
}

}  // namespace

int main() {
    using namespace validation;
    constexpr component first_parameter = {false, 0}, first_state = {true, 0};
    std::cout << "| problem | states | directions | error | limit | CVODES at ten times its tolerance |\n"
                 "|---|---|---|---|---|---|\n";
    compare<robertson_by, myriad::rodas_5p, robertson>({"Robertson",
                                                        {1, 0, 0},
                                                        {{0.04, 3e7}, {0.02, 3e7}},
                                                        {first_parameter, {false, 1}, first_state},
                                                        {0.4, 4, 40},
                                                        true,
                                                        1e-8});
    compare<pollution_by, myriad::rodas_5p, pollution>({"pollution",
                                                        {pollution::start, pollution::start + pollution::n_state},
                                                        {{0.35}, {0.1}},
                                                        {first_parameter},
                                                        {6, 60},
                                                        true,
                                                        1e-8});
    compare<hires_by, myriad::rodas_5p, hires>(
        {"HIRES", {hires::start, hires::start + hires::n_state}, {{}}, {first_state}, {1, 30, 300}, true, 1e-8});
    compare<van_der_pol_by, myriad::tsitouras_5, van_der_pol>(
        {"van der Pol", {2, 0}, {{0.5}, {1.5}}, {first_parameter, first_state}, {1, 5, 20}, false, 1e-8});
    compare<lorenz_by, myriad::tsitouras_5, lorenz>(
        {"Lorenz", {1, 0, 0}, {{10}, {21}}, {first_parameter, first_state}, {0.5, 2, 5}, false, 1e-8});
    return all_right ? EXIT_SUCCESS : EXIT_FAILURE;
}
