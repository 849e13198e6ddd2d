// SPDX-License-Identifier: MIT
// CVODE's solution of any model, hooks included, by the model's own functions; and the sensitivity of that solution.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <vector>

#include <myriad/kernel/model/lane.hpp>
#include <myriad/model.hpp>

#include "cvode.hpp"
#include "problem.hpp"

namespace validation {

/// One instance of a model, followed by CVODE: root finding for events, and a restart after each action that changes
/// the state. A copy continues from the same point.
template <class Model>
class trajectory {
public:
    static constexpr int n = myriad::detail::n_state<Model>, m = myriad::detail::n_event<Model>;

    trajectory(const problem& p, const instance& i) : problem_(&p) {
        for (int c = 0; c < n; ++c) at_.y[c] = i.state[static_cast<std::size_t>(c)];
        for (int c = 0; c < myriad::detail::n_parameter<Model>; ++c)
            at_.parameter[c] = i.parameter[static_cast<std::size_t>(c)];
        for (int c = 0; c < myriad::detail::n_accessory<Model>; ++c) at_.accessory[c] = unknown;
        for (int c = 0; c < myriad::detail::n_integer_accessory<Model>; ++c) at_.integer_accessory[c] = 0;
        for (int j = 0; j < m; ++j) at_.event_count[j] = 0;
        at_.shared = p.shared.data();
        at_.shared_integer = nullptr;
        at_.t = at_.t_begin = 0;
        at_.t_end = i.t_end;
        at_.h = at_.h_next = 0;
        at_.index = 0;
        at_.phase = 0;
        if constexpr (myriad::detail::has_initialise<Model>) {
            myriad::lane<Model, double> view(at_);
            Model::initialise(view);
        }
    }

    double& y(int c) { return at_.y[c]; }
    bool over() const { return over_; }
    std::vector<double> state() const { return {&at_.y[0], &at_.y[0] + n}; }
    std::vector<double> accessories() const {
        std::vector<double> values;
        for (int c = 0; c < myriad::detail::n_accessory<Model>; ++c) values.push_back(at_.accessory[c]);
        return values;
    }
    std::vector<int> counts() const {
        std::vector<int> values;
        for (int c = 0; c < myriad::detail::n_integer_accessory<Model>; ++c) values.push_back(at_.integer_accessory[c]);
        return values;
    }

    /// Follows the solution over the given times, and calls `visit(k)` at each until it ends. Returns evaluations of
    /// rhs.
    template <class Visit>
    long follow(const std::vector<double>& times, double tolerance, Visit&& visit) {
        const auto load = [](const double* y) {
            myriad::vec<double, n> values;
            std::copy(y, y + n, &values[0]);
            return values;
        };
        cvode solver(
            static_cast<std::size_t>(n),
            [&](double t, const double* y, double* dy) {
                const auto slope = Model::template rhs<double>(t, load(y), static_cast<const inputs&>(at_));
                std::copy(&slope[0], &slope[0] + n, dy);
            },
            tolerance, tolerance, problem_->stiff ? multistep::bdf : multistep::adams);
        if constexpr (m > 0) {
            std::vector<int> directions(static_cast<std::size_t>(m), 0);
            for (std::size_t j = 0; j < problem_->events.size(); ++j)
                directions[j] = static_cast<int>(problem_->events[j].direction);
            solver.watch(directions, [&](double t, const double* y, double* g) {
                const auto values = Model::template events<double>(t, load(y), static_cast<const inputs&>(at_));
                std::copy(&values[0], &values[0] + m, g);
            });
        }
        solver.start(at_.t, state());
        for (std::size_t k = 0; k < times.size() && !over_; ++k) {
            while (at_.t < times[k] && !over_) {
                const bool root = solver.advance(times[k], times.back());
                at_.t = solver.t();
                for (int c = 0; c < n; ++c) at_.y[c] = solver.y(static_cast<std::size_t>(c));
                if constexpr (m > 0)
                    if (root) act(solver);
            }
            if (!over_) visit(k);
        }
        return solver.evaluations();
    }

private:
    using inputs = myriad::inputs<Model, double>;

    void act(cvode& solver) {
        const auto found = solver.found();
        const auto before = state();
        for (int j = 0; j < m; ++j) {
            if (found[static_cast<std::size_t>(j)] == 0) continue;
            ++at_.event_count[j];
            if constexpr (myriad::detail::has_after_event<Model>) {
                myriad::lane<Model, double> view(at_);
                if constexpr (std::is_void_v<decltype(Model::after_event(j, view))>) {
                    Model::after_event(j, view);
                } else {
                    over_ = over_ || Model::after_event(j, view) != myriad::action::proceed;
                }
            }
            const auto stop = problem_->events[static_cast<std::size_t>(j)].stop_after;
            over_ = over_ || (stop > 0 && at_.event_count[j] >= stop);
        }
        if (state() != before && !over_) solver.start(at_.t, state());
    }

    const problem* problem_;
    myriad::detail::lane_data<Model, double> at_;
    bool over_ = false;
};

inline std::vector<double> evenly(double t_end, std::int64_t count) {
    std::vector<double> times;
    for (std::int64_t k = 0; k < count; ++k)
        times.push_back(k + 1 == count ? t_end : t_end * static_cast<double>(k) / static_cast<double>(count - 1));
    return times;
}

template <class Model>
solution solve_by_cvode(const problem& p, const instance& i, const accuracy& how) {
    const auto begin = std::chrono::steady_clock::now();
    trajectory<Model> path(p, i);
    solution s;
    const bool sampling = how.samples > 0 && !p.sampled.empty();
    s.evaluations = path.follow(sampling ? evenly(i.t_end, how.samples) : std::vector<double>{i.t_end}, how.tolerance,
                                [&](std::size_t) {
                                    if (!sampling) return;
                                    std::vector<double> sample;
                                    for (const int c : p.sampled) sample.push_back(path.y(c));
                                    s.samples.push_back(sample);
                                });
    s.end = path.state();
    s.accessory = path.accessories();
    s.count = path.counts();
    s.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return s;
}

/// Perturbs every component at several times by a small part of max(1, |y|), follows both solutions to the end, and
/// divides. The perturbation is far above CVODE's errors and small enough to be linear.
template <class Model>
conditioning conditions_of(const problem& p, const instance& i) {
    constexpr int moments = 6;
    constexpr double small = 1e-5, tolerance = 1e-11;
    std::vector<double> times;
    for (int k = 1; k <= moments; ++k) times.push_back(i.t_end * k / moments);

    trajectory<Model> path(p, i);
    std::vector<trajectory<Model>> from = {path};
    std::vector<std::vector<double>> states;
    path.follow(times, tolerance, [&](std::size_t) {
        from.push_back(path);
        states.push_back(path.state());
    });
    conditioning c;
    c.accessory.assign(path.accessories().size(), 0);
    const auto distance = [](const std::vector<double>& a, const std::vector<double>& b) {
        double largest = 0;
        for (std::size_t k = 0; k < a.size(); ++k)
            if (std::abs(a[k] - b[k]) > largest) largest = std::abs(a[k] - b[k]);
        return largest;
    };
    for (std::size_t k = 0; k < from.size() && k < moments; ++k) {
        double end = 0, invariant = 0;
        std::vector<double> along(moments, 0), accessory(c.accessory.size(), 0);
        for (int j = 0; j < trajectory<Model>::n; ++j) {
            trajectory<Model> other = from[k];
            other.y(j) += small * std::max(1.0, std::abs(other.y(j)));
            if (p.invariants) invariant += distance(p.invariants(i, other.state()), p.invariants(i, from[k].state()));
            std::size_t now = k;
            other.follow({times.begin() + static_cast<std::ptrdiff_t>(k), times.end()}, tolerance, [&](std::size_t) {
                if (now < states.size()) along[now] += distance(other.state(), states[now]);
                ++now;
            });
            end += distance(other.state(), path.state());
            const auto seen = other.accessories(), expected = path.accessories();
            for (std::size_t a = 0; a < accessory.size(); ++a)
                if (std::isfinite(seen[a] - expected[a])) accessory[a] += std::abs(seen[a] - expected[a]);
        }
        c.end = std::max(c.end, end / small);
        c.path = std::max(c.path, *std::max_element(along.begin(), along.end()) / small);
        c.invariant = std::max(c.invariant, invariant / small);
        for (std::size_t a = 0; a < accessory.size(); ++a)
            c.accessory[a] = std::max(c.accessory[a], accessory[a] / small);
    }
    c.path = std::max({c.path, c.end, 1.0});  // an error counts at least as itself
    return c;
}

}  // namespace validation
