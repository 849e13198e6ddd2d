// SPDX-License-Identifier: MIT
// Sets, integrates and reduces instances of a study on a GPU.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "myriad/host/core/error.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/chunk_solver.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

/// As many as the notes of `solve` look at.
constexpr std::int64_t most_looked_at = 1024;

detail::value_type type_of(element type) {
    constexpr detail::value_type types[] = {detail::value_type::f64, detail::value_type::f32, detail::value_type::i64,
                                            detail::value_type::i32, detail::value_type::u8};
    return types[static_cast<int>(type)];
}

}  // namespace

bool can_be_on_device(const study_request& asked, bool endless) {
    double begin = 0, end = 0;
    bool varies = false;
    for (const axes::entry& e : asked.axes.entries()) {
        if (e.what.kind != component_kind::t_begin && e.what.kind != component_kind::t_end) continue;
        varies = varies || e.dimension || e.values.random();
        (e.what.kind == component_kind::t_begin ? begin : end) = e.values.random() ? 0 : e.values[0];
    }
    // `solve` looks at every instance's domain for these, and may refuse the call.
    const options& o = asked.options;
    const bool looked_at = !o.samples.empty() || o.phase_length > 0 || o.phase_time != phase_time::restart;
    return !(varies && looked_at) && std::isfinite(begin) && (std::isfinite(end) || endless || o.phase_length > 0);
}

template <class R>
void device_solver_of<R>::start() {
    if (instances_ != nullptr) return;
    instances_ = make_(std::min(plan_.content.instances(), most_looked_at));
    how_ = describe();
}

template <class R>
std::shared_ptr<const cuda::generation> device_solver_of<R>::describe() {
    using enum component_kind;
    using valid = cuda::generated_component::valid;
    const axes& all = plan_.asked.axes;
    const auto& arrays = instances_->arrays();
    const auto& data = instances_->looked_at().data();
    auto made = std::make_shared<cuda::generation>();
    made->seed = all.seed();
    made->calls_model = calls_model_;
    rules_.clear();
    for (const axes::entry& e : all.entries()) rules_.push_back(all.rule(e));
    const auto set = [&](component_kind kind, const void* array, int components, double unset, valid must_be) {
        for (int c = 0; c < components; ++c) {
            detail::axis_rule rule{.first = unset, .last = unset};
            for (std::size_t e = 0; e < rules_.size(); ++e)
                if (all.entries()[e].what == component{kind, c}) rule = rules_[e];
            // A t_end of infinity for all was found valid before.
            const bool endless = kind == t_end && std::isinf(rule.first);
            made->components.push_back({array, c, rule, endless ? valid::not_nan : must_be});
        }
    };
    const double unset = static_cast<double>(host::ensemble_data<R>::unset);
    // What the model's `generate` is to set is checked after it.
    const valid finite = calls_model_ ? valid::any : valid::finite;
    set(state, arrays.state, data.state.components(), unset, finite);
    set(parameter, arrays.parameter, data.parameter.components(), unset, finite);
    set(accessory, arrays.accessory, data.accessory.components(), unset, valid::any);
    set(integer_accessory, arrays.integer_accessory, data.integer_accessory.components(), 0, valid::any);
    if (arrays.t_begin != nullptr) {
        set(t_begin, arrays.t_begin, 1, unset, valid::finite);
        set(t_end, arrays.t_end, 1, unset, valid::finite);
    }
    if (arrays.tolerance_scale != nullptr)
        made->components.push_back({arrays.tolerance_scale, 0, {.first = 1, .last = 1}});
    return made;
}

template <class R>
std::int64_t device_solver_of<R>::most_at_a_time() {
    start();
    return std::max(instances_->affordable(), std::int64_t{1});
}

template <class R>
void device_solver_of<R>::prepare(std::int64_t first, std::int64_t count) {
    start();
    first_ = first;
    count_ = count;
    model_instances<R>& few = instances_->looked_at();
    set_instances(few, plan_.asked.axes, first);
    instances_->check(std::min<std::int64_t>(few.data().size, count));
    instances_->generate(how_, first, count);
}

template <class R>
solved device_solver_of<R>::integrate(const device&, const std::function<void(std::int64_t done)>& progress) {
    instances_->integrate([&] { progress(0); });
    solved how;
    const std::vector<std::int64_t> found = instances_->reduce({}, {detail::reduction_kind::statuses});
    std::copy(found.begin(), found.end(), how.by_status.begin());
    if (!std::exchange(noted_, true))
        how.notes = instances_->notes(std::min<std::int64_t>(instances_->looked_at().data().size, count_));
    progress(count_);
    return how;
}

template <class R>
cuda::device_values device_solver_of<R>::values_of(const quantity& what) const {
    const auto& arrays = instances_->arrays();
    const result_arrays& results = instances_->results();
    const component& c = what.what;
    const auto number = static_cast<std::size_t>(c.number);
    cuda::device_values made;
    made.type = type_of(what.as.type);
    made.inner = what.as.values_per_item();
    const auto at = [&](const void* array, std::int64_t component = 0) {
        made.array = array;
        made.component = component;
    };
    switch (what.from) {
        case origin::axis:
            for (std::size_t e = 0; e < rules_.size(); ++e)
                if (plan_.asked.axes.entries()[e].what == c) made.rule = &rules_[e];
            made.seed = plan_.asked.axes.seed();
            break;
        case origin::record:
            if (c.kind == component_kind::integer_accessory) {
                at(results.record_integers, results.integers[number] * made.inner);
                made.ends_with_phases = true;
                made.from_phase = static_cast<std::int32_t>(plan_.asked.options.record.from_phase);
            } else {
                const auto& columns = c.kind == component_kind::state ? results.states : results.accessories;
                at(results.records, columns[number] * made.inner);
            }
            break;
        case origin::record_time:
            at(results.records, results.time * made.inner);
            break;
        case origin::sample:
            at(results.samples, results.sampled[number] * made.inner);
            break;
        case origin::sample_time:
            at(results.sample_times);
            break;
        case origin::samples_stored:
            at(results.samples_stored);
            break;
        case origin::end:
            at(c.kind == component_kind::state       ? static_cast<const void*>(arrays.state)
               : c.kind == component_kind::parameter ? static_cast<const void*>(arrays.parameter)
               : c.kind == component_kind::accessory ? static_cast<const void*>(arrays.accessory)
                                                     : static_cast<const void*>(arrays.integer_accessory),
               c.number);
            break;
        case origin::end_time:
            at(arrays.t);
            break;
        case origin::status:
            at(arrays.status);
            break;
        case origin::phases_done:
            at(arrays.phase);
            break;
        case origin::accepted_steps:
            at(arrays.accepted);
            break;
        case origin::rejected_steps:
            at(arrays.rejected);
            break;
        case origin::located_steps:
            at(arrays.located);
            break;
        case origin::rhs_evaluations:
            at(arrays.evaluations);
            break;
    }
    return made;
}

template <class R>
void device_solver_of<R>::copy(const quantity& what, std::byte* to) const {
    const cuda::device_values values = values_of(what);
    if (values.array == nullptr && values.rule == nullptr) {  // counters of what there is nothing to count of
        std::memset(to, 0, static_cast<std::size_t>(count_) * size_of(what.as.type));
        return;
    }
    instances_->fetch(values, to);
}

template <class R>
bool device_solver_of<R>::reduce(std::size_t number, reduction_state& to) {
    const reduction_plan& plan = plan_.reductions[number];
    if (!plan.on_device) return false;
    const std::string& name = plan_.asked.reductions[number].definition().inputs.front();
    const auto input = std::find_if(plan_.quantities.begin(), plan_.quantities.end(),
                                    [&](const quantity& q) { return q.as.name == name; });
    to.add_words(instances_->reduce(values_of(*input), *plan.on_device));
    return true;
}

template <class R>
void device_solver_of<R>::clear() {
    instances_.reset();
}

template class device_solver_of<double>;
template class device_solver_of<float>;

}  // namespace myriad::studies::inline MYRIAD_ABI
