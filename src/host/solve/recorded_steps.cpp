// SPDX-License-Identifier: MIT
// The recorded steps of a group of instances, and the adjoint of them.
#include "myriad/host/solve/recorded_steps.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>

#include "myriad/host/core/error.hpp"

namespace myriad::host::inline MYRIAD_ABI {

namespace {

constexpr std::int64_t bytes_of_records = std::int64_t{1} << 23;  // of a group, for each thread

/// The addresses of all components of an array.
std::vector<const double*> all_of(const component_array<double>& array) {
    std::vector<const double*> all;
    for (int c = 0; c < array.components(); ++c) all.push_back(array.component(c));
    return all;
}

template <class T>
void copy_rows(const component_array<T>& from, std::int64_t first, component_array<T>& to) {
    for (int c = 0; c < to.components(); ++c) std::copy_n(from.component(c) + first, to.length(), to.component(c));
}

}  // namespace

void check_adjoint_call(const ensemble_data<double>& e, const std::vector<double>& times, const options& o) {
    e.require_present();
    require(o.phases == 1 && !(o.phase_length > 0) && o.phase_time == phase_time::restart, named_option("phases"),
            ": an adjoint is of one phase, from t_begin to t_end", cure,
            "leave out phases, phase_length and phase_time");
    require(o.samples.empty() && o.record.empty(), named_option("samples"), ": an adjoint keeps samples of its own",
            cure, "leave out samples and record, and give the times of the loss to the call");
    require(!e.scales_tolerances(), "the ensemble has tolerance_scale, which an adjoint does not take");
    require(e.untouched, "the ensemble has been integrated, and an adjoint starts at the beginning", cure,
            "call its restart(), and set the initial states");
    if (times.empty()) return;
    require(e.has_common_domain(),
            "the instances have time domains of their own, and the times of a loss are the same "
            "for all",
            cure, "set them by time_domain, or leave out the times for a loss of the states at the end");
    const double sign = e.common_begin <= e.common_end ? 1 : -1;
    for (std::size_t i = 0; i < times.size(); ++i) {
        const double t = times[i];
        require(sign * e.common_begin <= sign * t && sign * t <= sign * e.common_end, "time ", i, " of the loss, ", t,
                ", is not in the time domain from ", e.common_begin, " to ", e.common_end);
        require(i == 0 || sign * times[i - 1] < sign * t, "time ", i, " of the loss, ", t,
                ", does not follow the one before, ", times[i == 0 ? 0 : i - 1], ", in the direction of integration");
    }
}

void copy_inputs(const ensemble_data<double>& from, std::int64_t first, ensemble_data<double>& to) {
    copy_rows(from.state, first, to.state);
    copy_rows(from.parameter, first, to.parameter);
    std::copy_n(from.shared.data(), from.shared.components(), to.shared.data());
    std::copy_n(from.shared_integer.data(), from.shared_integer.components(), to.shared_integer.data());
    to.first_index = from.first_index + first;
    if (from.has_common_domain()) return to.set_domain(from.common_begin, from.common_end);
    to.own_domains();
    copy_rows(from.t_begin, first, to.t_begin);
    copy_rows(from.t_end, first, to.t_end);
}

std::int64_t recorded_steps::most_instances() const {
    const auto bytes_of_instance = static_cast<std::int64_t>(sizeof(double)) * (n_state_ + 1) * room_;
    return std::max<std::int64_t>(1, threads_ * bytes_of_records / bytes_of_instance);
}

options recorded_steps::options_for(const options& o) const {
    options made = o;
    std::vector<int> all;
    for (int c = 0; c < n_state_; ++c) all.push_back(c);
    made.samples.states = all;
    made.samples.every = 1;
    made.samples.capacity = room_;
    made.counting = counting::off;
    made.advice = advice::off;
    return made;
}

bool recorded_steps::keep(const ensemble_data<double>& group, const sample_data<double>& samples, int threads) {
    group_ = &group;
    samples_ = &samples;
    const std::int64_t longest = *std::max_element(samples.stored.data(), samples.stored.data() + samples.size);
    const bool all_there = longest < room_;
    // Where there was no room, the number of steps is not known. Groups hardly grow, since larger ones gain nothing.
    room_ = all_there ? longest + longest / 8 + 1 : 2 * room_;
    threads_ = std::max(threads, threads_);
    return all_there;
}

void recorded_steps::run(const cpu_adjoint& adjoint, const std::vector<double>& times, double* values,
                         const double* weights, double* gradient) const {
    require(
        adjoint != nullptr, "the program has no adjoint of this model and method", cure,
        "add MYRIAD_INSTANTIATE_ADJOINT(model, method), from <myriad/instantiate_adjoint.hpp>, to the model's file");
    std::vector<const double*> states;
    for (int c = 0; c < n_state_; ++c) states.push_back(samples_->component(c));
    const std::vector<const double*> parameters = all_of(group_->parameter);
    const detail::adjoint_call call{.size = group_->size,
                                    .stored = samples_->stored.data(),
                                    .time = samples_->time.data(),
                                    .state = states.data(),
                                    .acted = nullptr,
                                    .acted_in_all = nullptr,
                                    .parameter = parameters.data(),
                                    .shared = group_->shared.data(),
                                    .shared_integer = group_->shared_integer.data(),
                                    .sample_time = times.empty() ? nullptr : times.data(),
                                    .samples = static_cast<std::int64_t>(std::max<std::size_t>(times.size(), 1)),
                                    .values = values,
                                    .weights = weights,
                                    .gradient = gradient};
    std::exception_ptr failure;
    detail::run_options watched;
    watched.failure = &failure;
    watched.caught = [](void* kept) { *static_cast<std::exception_ptr*>(kept) = std::current_exception(); };
    const detail::run_statistics used = adjoint(call, watched);
    require(used.computed_as_written, "the model's file ", detail::not_as_written);
    require(used.least_stack >= used.stack, "a thread has ", used.least_stack,
            " bytes of stack, and the adjoint of this model and method takes about ", used.stack, cure,
            "set OMP_STACKSIZE to more, such as 8M");
    if (failure) std::rethrow_exception(failure);
}

}  // namespace myriad::host::inline MYRIAD_ABI
