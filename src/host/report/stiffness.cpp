// SPDX-License-Identifier: MIT
// Whether stability limited the steps of an explicit method: the fastest decay by power iteration, and trial steps of a
// stiff method.
#include "myriad/host/report/stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "myriad/kernel/methods/controller_policies.hpp"
#include "myriad/kernel/methods/rodas_5p.hpp"

namespace myriad::host::inline MYRIAD_ABI {

namespace {

using column = std::vector<double>;

/// One instance: its right-hand side, in R, for states in double precision.
template <class R>
class instance_rhs {
public:
    instance_rhs(const single_instances<R>& all, std::int64_t i, int n)
        : all_(all), i_(i), at_(static_cast<std::size_t>(n)), slopes_(at_.size()) {}

    void operator()(double t, const column& y, column& slopes) {
        for (std::size_t c = 0; c < at_.size(); ++c) at_[c] = static_cast<R>(y[c]);
        all_.call.rhs(all_.arguments, i_, static_cast<R>(t), at_.data(), slopes_.data());
        for (std::size_t c = 0; c < at_.size(); ++c) slopes[c] = static_cast<double>(slopes_[c]);
    }
    column operator()(double t, const column& y) {
        column slopes(at_.size());
        (*this)(t, y, slopes);
        return slopes;
    }

private:
    const single_instances<R>& all_;
    std::int64_t i_;
    std::vector<R> at_, slopes_;
};

template <class R>
column state_of(const ensemble_data<R>& e, std::int64_t i) {
    column y(static_cast<std::size_t>(e.shape->n_state));
    for (std::size_t c = 0; c < y.size(); ++c) y[c] = static_cast<double>(e.state.component(static_cast<int>(c))[i]);
    return y;
}

/// The step that an instance would take next, with its sign: no longer than its domain.
template <class R>
double step_of(const ensemble_data<R>& e, std::int64_t i) {
    const double h = static_cast<double>(e.next_steps().data()[i]);
    const double domain = std::abs(static_cast<double>(e.t_end_of(i)) - static_cast<double>(e.t_begin_of(i)));
    return std::copysign(std::min(std::abs(h), domain), h);
}

double length(const column& x) {
    double sum = 0;
    for (const double component : x) sum += component * component;
    return std::sqrt(sum);
}

/// h lambda of the fastest mode of an instance for its next step, if that mode decays, and faster than it rotates;
/// otherwise 0.
template <class R>
double fastest_decay(const ensemble_data<R>& e, std::int64_t i, const single_instances<R>& all) {
    const column y = state_of(e, i);
    const std::size_t n = y.size();
    instance_rhs<R> rhs(all, i, e.shape->n_state);
    const double t = static_cast<double>(e.t.data()[i]);
    const double root = std::sqrt(static_cast<double>(std::numeric_limits<R>::epsilon()));
    const column f = rhs(t, y);
    column v(n), moved(n), f_moved(n), product(n);
    for (std::size_t c = 0; c < n; ++c) v[c] = 1 / static_cast<double>(c + 1);  // unlikely to be orthogonal to any mode
    // Power iteration with a difference quotient for the Jacobian; a geometric mean, because complex pairs rotate the
    // vector.
    constexpr int settling = 12, iterations = 24;
    double logarithms = 0, along = 0;
    for (int k = 0; k < iterations; ++k) {
        const double scale = 1 / length(v);
        double step = std::numeric_limits<double>::infinity();  // no component changes by more than `root` of its size
        for (std::size_t c = 0; c < n; ++c) {
            v[c] = static_cast<double>(static_cast<R>(v[c] * scale));
            const double size = y[c] == 0 ? 1 : std::abs(y[c]);
            if (std::abs(v[c]) > 1e-6) step = std::min(step, root * size / std::abs(v[c]));
        }
        for (std::size_t c = 0; c < n; ++c) moved[c] = static_cast<double>(static_cast<R>(y[c] + step * v[c]));
        rhs(t, moved, f_moved);
        along = 0;
        for (std::size_t c = 0; c < n; ++c) {
            // The difference in R, as the slopes are.
            const double change = static_cast<double>(static_cast<R>(f_moved[c]) - static_cast<R>(f[c]));
            product[c] = static_cast<double>(static_cast<R>(change / step));
            along += product[c] * v[c];
        }
        std::swap(v, product);
        if (k >= settling) logarithms += std::log(length(v));
        if (!(length(v) > 0)) return 0;
    }
    const double rate = std::exp(logarithms / (iterations - settling));
    const double h = step_of(e, i);
    const bool decays = h * along < 0 && std::abs(along) > 0.7 * rate;
    return decays ? std::abs(h) * rate : 0;
}

/// LU factors of a matrix of any size, with partial pivoting.
class dense_lu {
public:
    explicit dense_lu(std::size_t n) : n_(n), a_(n * n), pivot_(n) {}

    double& operator()(std::size_t i, std::size_t j) { return a_[i * n_ + j]; }
    /// Returns false if the matrix is singular, or not finite.
    bool factorise() {
        dense_lu& a = *this;
        for (std::size_t k = 0; k < n_; ++k) {
            std::size_t pivot = k;
            for (std::size_t i = k + 1; i < n_; ++i)
                if (std::abs(a(i, k)) > std::abs(a(pivot, k))) pivot = i;
            pivot_[k] = pivot;
            if (a(pivot, k) == 0 || !std::isfinite(a(pivot, k))) return false;
            if (pivot != k)
                for (std::size_t j = 0; j < n_; ++j) std::swap(a(k, j), a(pivot, j));
            for (std::size_t i = k + 1; i < n_; ++i) {
                const double multiplier = a(i, k) / a(k, k);
                a(i, k) = multiplier;
                for (std::size_t j = k + 1; j < n_; ++j) a(i, j) -= multiplier * a(k, j);
            }
        }
        return true;
    }
    /// Replaces b by the solution of A x = b.
    void solve(column& b) {
        dense_lu& a = *this;
        for (std::size_t k = 0; k < n_; ++k) std::swap(b[k], b[pivot_[k]]);
        for (std::size_t i = 0; i < n_; ++i)
            for (std::size_t j = 0; j < i; ++j) b[i] -= a(i, j) * b[j];
        for (std::size_t i = n_; i-- > 0;) {
            for (std::size_t j = i + 1; j < n_; ++j) b[i] -= a(i, j) * b[j];
            b[i] /= a(i, i);
        }
    }

private:
    std::size_t n_;
    std::vector<double> a_;
    std::vector<std::size_t> pivot_;
};

/// Trial steps of rodas_5p from one instance, with derivatives by differences, so that only `rhs` in R is needed. Slow,
/// but good enough to find how long a step the tolerances would allow.
template <class R>
class stiff_trial {
public:
    stiff_trial(const ensemble_data<R>& e, std::int64_t i, const single_instances<R>& all)
        : rhs_(all, i, e.shape->n_state), begin_(static_cast<double>(e.t_begin_of(i))),
          t0_(static_cast<double>(e.t.data()[i])), t_(t0_), y_(state_of(e, i)) {}

    /// Takes a step of length h and returns the largest ratio of error to tolerance over all components; infinite if
    /// the step cannot be taken.
    double step(double h, const options& o, double scale) {
        constexpr auto w = rodas_5p::tableau();
        const std::size_t n = y_.size();
        const double root = std::sqrt(static_cast<double>(std::numeric_limits<R>::epsilon()));
        const column f = rhs(t_, y_);
        dense_lu lu(n);
        for (std::size_t j = 0; j < n; ++j) {
            column moved = y_;
            moved[j] = static_cast<double>(static_cast<R>(y_[j] + root * (y_[j] == 0 ? 1 : std::abs(y_[j]))));
            const column there = rhs(t_, moved);
            for (std::size_t i = 0; i < n; ++i) lu(i, j) = -(there[i] - f[i]) / (moved[j] - y_[j]);
            lu(j, j) += 1 / (h * w.gamma);
        }
        if (!lu.factorise()) return std::numeric_limits<double>::infinity();
        const double later = static_cast<double>(static_cast<R>(t_ + root * h));
        const column f_later = rhs(later, y_);

        std::vector<column> u;
        column y1 = y_, error(n);
        for (std::size_t s = 0; s < rodas_5p::stages; ++s) {
            const auto row = static_cast<int>(s);
            column argument = y_;
            for (std::size_t j = 0; j < s; ++j)
                for (std::size_t c = 0; c < n; ++c) argument[c] += w.weight(row, static_cast<int>(j)) * u[j][c];
            column slope = rhs(t_ + w.c[s] * h, argument);
            for (std::size_t c = 0; c < n; ++c) {
                if (later != t_) slope[c] += h * w.d[s] * (f_later[c] - f[c]) / (later - t_);
                for (std::size_t j = 0; j < s; ++j) slope[c] += w.coupling[s][j] / h * u[j][c];
            }
            lu.solve(slope);
            for (std::size_t c = 0; c < n; ++c) {
                y1[c] += w.m[s] * slope[c];
                error[c] += w.e[s] * slope[c];
            }
            u.push_back(std::move(slope));
        }
        double worst = 0;
        for (std::size_t c = 0; c < n; ++c) {
            const double relative = std::max(o.relative_tolerance[c], static_cast<double>(least_relative_tolerance<R>));
            const double size = std::max(std::abs(y_[c]), std::abs(y1[c]));
            const double ratio = std::abs(error[c]) / (scale * std::max(o.absolute_tolerance[c], relative * size));
            worst = ratio <= worst ? worst : ratio;  // NaN propagates
        }
        t_ += h;
        y_ = std::move(y1);
        return worst;
    }

private:
    /// Time runs backwards, into the domain, as a forcing may be undefined beyond its end; backwards it varies as fast.
    column rhs(double t, const column& y) {
        const double back = t0_ - (t - t0_), seen = begin_ < t0_ ? std::max(back, begin_) : std::min(back, begin_);
        return rhs_(seen, y);
    }

    instance_rhs<R> rhs_;
    double begin_, t0_, t_;
    column y_;
};

/// Whether accuracy would allow a stiff method far longer steps than h, the next one of instance i. What the explicit
/// method has left of the fast modes, and what reversing time excites, decays in first steps of the same length.
template <class R>
bool accuracy_allows_more(const ensemble_data<R>& e, std::int64_t i, double h, const options& o,
                          const single_instances<R>& rhs) {
    const double scale = e.scales_tolerances() ? static_cast<double>(e.tolerance_scale.data()[i]) : 1;
    stiff_trial<R> trial(e, i, rhs);
    double error = trial.step(h, o, scale);
    while (!(error <= 1)) {  // still decaying as long as each step halves it
        const double before = error;
        error = trial.step(h, o, scale);
        if (!(error <= 0.5 * before)) return false;
    }
    // A single long step may skip what a shorter one would have resolved, and a calm stretch of a hundred steps does
    // not last.
    for (const double share : {0.1, 0.3, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0})
        if (!(trial.step(share * worthwhile_stretch * h, o, scale) <= 1)) return false;
    return true;
}

}  // namespace

template <class R>
stiffness find_stiffness(const ensemble_data<R>& e, const options& o, double limit, const single_instances<R>& rhs) {
    stiffness found;
    for (std::int64_t i = 0; i < e.size; i += examined_stride(e.size)) {
        const double h = std::abs(step_of(e, i));
        if (!std::isfinite(h) || h >= o.maximum_step) continue;
        ++found.looked_at;
        const double share = fastest_decay(e, i, rhs) / limit;
        if (!(share > 0.5) || !accuracy_allows_more(e, i, step_of(e, i), o, rhs)) continue;
        ++found.limited;
        found.share = std::max(found.share, share);
    }
    return found;
}

template <class R>
void note_stiffness(report_of<R>& r, const ensemble_data<R>& e, const options& o, const single_instances<R>& of) {
    if (!examines_stiffness<R>(r, e.size, o, of.call)) return;
    add_note(r.notes, find_stiffness(e, o, of.call.stability_limit(), of));
}

template stiffness find_stiffness(const ensemble_data<double>&, const options&, double,
                                  const single_instances<double>&);
template stiffness find_stiffness(const ensemble_data<float>&, const options&, double, const single_instances<float>&);
template void note_stiffness(report_of<double>&, const ensemble_data<double>&, const options&,
                             const single_instances<double>&);
template void note_stiffness(report_of<float>&, const ensemble_data<float>&, const options&,
                             const single_instances<float>&);

}  // namespace myriad::host::inline MYRIAD_ABI
