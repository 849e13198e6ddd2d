// SPDX-License-Identifier: MIT
// Initial values of systems with algebraic equations.
#include "myriad/host/checks/consistency.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "myriad/host/checks/algebraic_part.hpp"
#include "myriad/host/core/error.hpp"

namespace myriad::host::inline MYRIAD_ABI {

using detail::argument_head;
using detail::instance_functions;
using detail::single_instances;

namespace {

constexpr const char* higher_index =
    "the algebraic equations do not determine their states (an index above one, or a mistake in mass_matrix): "
    "differentiate equations until they do";

/// The algebraic equations of single instances.
template <class R>
class equations_of_instances {
public:
    equations_of_instances(const ensemble_data<R>& e, const single_instances<R>& of)
        : e_(e), of_(of), n_(static_cast<std::size_t>(e.shape->n_state)),
          part_(e.shape->n_state, {of.call.mass_matrix, of.call.mass_matrix + n_ * n_}), state_(n_), slopes_(n_),
          jacobian_(n_ * n_) {}

    int count() const { return part_.count; }
    /// Those of instance i at its initial state, which is `state()` then.
    algebraic_equations at(std::int64_t i) {
        for (std::size_t c = 0; c < n_; ++c) state_[c] = e_.state.component(static_cast<int>(c))[i];
        of_.call.linearise(of_.arguments, i, e_.t_begin_of(i), state_.data(), slopes_.data(), jacobian_.data());
        return {part_, {slopes_.begin(), slopes_.end()}, {jacobian_.begin(), jacobian_.end()}};
    }
    const std::vector<R>& state() const { return state_; }
    /// Equation k as text, such as "0 = f_z".
    std::string text(const algebraic_equations& of, int k) const {
        return of.text(k, [this](int c) {
            const component_label label = e_.shape->state(*e_.shape, c);
            return label.enumerator.empty() ? std::to_string(c) : std::string(label.enumerator);
        });
    }

private:
    const ensemble_data<R>& e_;
    const single_instances<R>& of_;
    std::size_t n_;
    algebraic_part part_;
    std::vector<R> state_, slopes_, jacobian_;
};

}  // namespace

template <class R>
void check_consistency(const ensemble_data<R>& e, const options& o, std::int64_t count, const single_instances<R>& of) {
    if (of.call.linearise == nullptr) return;
    equations_of_instances<R> all(e, of);
    if (all.count() == 0) return;
    const auto n = static_cast<std::size_t>(e.shape->n_state);
    std::vector<double> change;
    const std::int64_t stride = std::max<std::int64_t>(count / 1024, 1);
    for (std::int64_t i = 0; i < count; i += stride) {
        if (e.ended.data()[i] != 0 || e.phase.data()[i] != 0) continue;
        const algebraic_equations equations = all.at(i);
        for (int k = 0; k < all.count(); ++k) {
            const double residual = equations.residual[static_cast<std::size_t>(k)];
            double allowed = 0;
            for (std::size_t j = 0; j < n; ++j) {
                const double relative =
                    std::max(o.relative_tolerance[j], 16.0 * static_cast<double>(std::numeric_limits<R>::epsilon()));
                allowed += std::abs(equations.slope[static_cast<std::size_t>(k) * n + j]) *
                           (relative * std::abs(static_cast<double>(all.state()[j])) + o.absolute_tolerance[j]);
            }
            // what is not finite, such as a value that was not set, other checks refuse
            require(!(std::abs(residual) > allowed) || !std::isfinite(residual), "the initial values of instance ", i,
                    " do not satisfy the algebraic equation ", all.text(equations, k), ", whose right-hand side is ",
                    residual, " at them and may be ", allowed, " by the tolerances", cure, "set values that do, or ",
                    cures::make_consistent);
        }
        const bool finite = std::all_of(equations.slope.begin(), equations.slope.end(),
                                        [](double derivative) { return std::isfinite(derivative); });
        require(!finite || equations.solve(change), "at the initial values of instance ", i, ' ', higher_index);
    }
}
template void check_consistency(const ensemble_data<double>&, const options&, std::int64_t,
                                const single_instances<double>&);
template void check_consistency(const ensemble_data<float>&, const options&, std::int64_t,
                                const single_instances<float>&);

template <class R>
void project_initial_states(ensemble_data<R>& e, const instance_functions<R>& model) {
    e.require_present();
    const argument_head<R> inputs = inputs_in(e);
    const single_instances<R> instances{model, inputs};
    equations_of_instances<R> all(e, instances);
    constexpr double enough = 8.0 * static_cast<double>(std::numeric_limits<R>::epsilon());
    std::vector<double> change;
    for (std::int64_t i = 0; i < e.size; ++i) {
        bool done = all.count() == 0;
        for (int iteration = 0; iteration < 50 && !done; ++iteration) {
            const algebraic_equations equations = all.at(i);
            require(equations.solve(change), "at the initial values of instance ", i, ' ', higher_index);
            done = true;
            for (std::size_t c = 0; c < change.size(); ++c) {
                if (change[c] == 0) continue;
                const auto before = static_cast<double>(all.state()[c]);
                done = done && std::abs(change[c]) <= enough * std::abs(before);
                e.state.component(static_cast<int>(c))[i] = static_cast<R>(before + change[c]);
            }
        }
        require(done, "no values near the initial ones of instance ", i,
                " were found that satisfy the algebraic equations", cure, "give values closer to them");
    }
}
template void project_initial_states(ensemble_data<double>&, const instance_functions<double>&);
template void project_initial_states(ensemble_data<float>&, const instance_functions<float>&);

}  // namespace myriad::host::inline MYRIAD_ABI
