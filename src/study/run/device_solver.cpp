// SPDX-License-Identifier: MIT
// Sets, integrates and reduces instances of a study on a GPU.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "myriad/host/core/error.hpp"
#include "myriad/host/threads/default_arithmetic.hpp"
#include "myriad/host/threads/polling_backoff.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/plan/kinds.hpp"
#include "myriad/study/run/studied_model.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

/// As many as the notes of `solve` look at.
constexpr std::int64_t most_looked_at = 1024;

detail::value_type type_of(element type) {
    constexpr detail::value_type types[] = {detail::value_type::f64, detail::value_type::f32, detail::value_type::i64,
                                            detail::value_type::i32, detail::value_type::u8};
    return types[static_cast<int>(type)];
}

/// Whether the inputs of a study can be left to a GPU. `endless`: something can end a phase before t_end.
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

}  // namespace

template <class R>
device_instances<R>::device_instances(const studied_model<R>& model, const device& where, const study_plan& plan,
                                      std::int64_t few)
    : options_(model.options_for(where, plan.asked.options)), model_(model.called_for(where, options_)),
      few_(model, where, few), call_(with_domains(plan.asked.axes), few_.samples(), records_, options_, model_.facts) {
    model_.check_kernel(where.which());
    engine_ = model_.on_gpus.front().take();
}
template <class R>
device_instances<R>::~device_instances() {
    if (fine_) model_.on_gpus.front().give(std::move(engine_));
}

template <class R>
void device_instances<R>::check(std::int64_t count) {
    const detail::default_arithmetic here;
    model_.check_uses(few_.data(), options_, count).require_for(0, options_.phases);
    model_.values_of(few_.data(), options_, count).run();
}
template <class R>
std::vector<statement> device_instances<R>::notes(std::int64_t count) {
    const detail::default_arithmetic here;
    report_of<R> found;
    if (model_.looks_at_results()) {
        use([&] { engine_->fetch_first(call_.arguments, count); });
        few_.data().untouched = false;
        if (options_.counting == counting::on)
            host::set_work(found, host::work_count{}, host::counted_work(few_.data(), count));
    }
    model_.add_notes(found, few_.data(), options_, call_.arguments);
    return found.notes;
}
template <class R>
std::int64_t device_instances<R>::affordable() const {
    constexpr std::int64_t more = 64;  // for what is drawn again, gathered and scheduled
    return engine_->affordable(2 * (detail::bytes_per_instance(call_.arguments) + more));
}
template <class R>
template <class Work>
void device_instances<R>::use(Work&& work) {
    const bool before = std::exchange(fine_, false);
    work();
    fine_ = before;
}
template <class R>
void device_instances<R>::generate(const std::shared_ptr<const cuda::generation>& how, std::int64_t first,
                                   std::int64_t count) {
    use([&] { engine_->generate(call_.arguments, how, first, count); });
}
template <class R>
void device_instances<R>::integrate(const std::function<void()>& watch) {
    use([&] {
        engine_->integrate(call_.arguments);
        try {
            for (host::polling_backoff waiting; !engine_->idle(); waiting.pause()) watch();
        } catch (...) {
            engine_->stop(detail::stop_request::end_now);
            engine_->wait();
            throw;
        }
        engine_->wait();
    });
}
template <class R>
void device_instances<R>::fetch(const cuda::device_values& what, std::byte* to) {
    use([&] { engine_->fetch(call_.arguments, what, to); });
}
template <class R>
std::vector<std::int64_t> device_instances<R>::reduce(const cuda::device_values& what,
                                                      const cuda::device_reduction& how) {
    std::vector<std::int64_t> found;
    use([&] { found = engine_->reduce(call_.arguments, what, how); });
    return found;
}
template class device_instances<double>;
template class device_instances<float>;

namespace {

/// The solver that sets, integrates and reduces instances on a GPU. Plan and model must outlive it.
template <class R>
class device_solver final : public chunk_solver {
public:
    device_solver(const study_plan& plan, const studied_model<R>& model, const device& where)
        : plan_(plan), model_(model), where_(where) {}

    void prepare(std::int64_t first, std::int64_t count) override;
    solved integrate(const device& where, const std::function<void(std::int64_t done)>& progress) override;
    void copy(const quantity& what, std::byte* to) const override;
    void clear() override { instances_.reset(); }
    bool on_device() const override { return true; }
    std::int64_t most_at_a_time() override;
    bool reduce(std::size_t number, reduction_state& to) override;

private:
    void start();
    std::shared_ptr<const cuda::generation> make_generation();
    cuda::device_values values_of(const quantity& what) const;

    const study_plan& plan_;
    const studied_model<R>& model_;
    device where_;
    std::vector<detail::axis_rule> rules_;  // of the entries of the axes
    std::shared_ptr<const cuda::generation> how_;
    std::unique_ptr<device_instances<R>> instances_;
    std::int64_t first_ = 0, count_ = 0;
    bool noted_ = false;
};

template <class R>
void device_solver<R>::start() {
    if (instances_ != nullptr) return;
    const std::int64_t few = std::min(plan_.content.instances(), most_looked_at);
    instances_ = std::make_unique<device_instances<R>>(model_, where_, plan_, few);
    how_ = make_generation();
}

template <class R>
std::shared_ptr<const cuda::generation> device_solver<R>::make_generation() {
    using enum component_kind;
    using valid = cuda::generated_component::valid;
    const axes& all = plan_.asked.axes;
    const auto& arrays = instances_->arguments();
    const auto& data = instances_->looked_at().data();
    auto made = std::make_shared<cuda::generation>();
    made->seed = all.seed();
    made->calls_model = model_.generates_itself();
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
    const valid finite = made->calls_model ? valid::any : valid::finite;
    for (const component_kind kind : instance_kinds) {
        const int components = with_array(kind, data, [](const auto& array) { return array.components(); });
        with_array(kind, arrays, [&]<class T>(T* array) {
            set(kind, array, components, static_cast<double>(detail::unset_value<std::remove_const_t<T>>),
                kind == state || kind == parameter ? finite : valid::any);
        });
    }
    if (arrays.t_begin != nullptr) {
        set(t_begin, arrays.t_begin, 1, unset, valid::finite);
        set(t_end, arrays.t_end, 1, unset, valid::finite);
    }
    if (arrays.tolerance_scale != nullptr)
        made->components.push_back({arrays.tolerance_scale, 0, {.first = 1, .last = 1}});
    return made;
}

template <class R>
std::int64_t device_solver<R>::most_at_a_time() {
    start();
    // A digit of an exact sum, of 64 bits, has room for 2^31 numbers of 32.
    constexpr std::int64_t summable = std::int64_t{1} << 30;
    return std::clamp(instances_->affordable(), std::int64_t{1}, summable);
}

template <class R>
void device_solver<R>::prepare(std::int64_t first, std::int64_t count) {
    start();
    first_ = first;
    count_ = count;
    host_instances<R>& few = instances_->looked_at();
    few.set(plan_.asked.axes, first);
    instances_->check(std::min<std::int64_t>(few.data().size, count));
    instances_->generate(how_, first, count);
}

template <class R>
solved device_solver<R>::integrate(const device&, const std::function<void(std::int64_t done)>& progress) {
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
cuda::device_values device_solver<R>::values_of(const quantity& what) const {
    const auto& arrays = instances_->arguments();
    const host::record_data<R>& records = instances_->records();
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
            with_columns(records, c.kind, [&](const auto&, const std::vector<std::int16_t>& columns) {
                at(is_integer(c.kind) ? static_cast<const void*>(arrays.record.integers) : arrays.record.values,
                   columns[number] * made.inner);
            });
            if (!is_integer(c.kind)) break;
            made.ends_with_phases = true;
            made.from_phase = static_cast<std::int32_t>(plan_.asked.options.record.from_phase);
            break;
        case origin::record_time:
            at(arrays.record.values, records.time * made.inner);
            break;
        case origin::sample:
            at(arrays.sample.values, instances_->looked_at().samples().column[number] * made.inner);
            break;
        case origin::sample_time:
            at(arrays.sample.time);
            break;
        case origin::stored_samples:
            at(arrays.sample.stored);
            break;
        case origin::end:
            with_array(c.kind, arrays, [&](const void* array) { at(array, c.number); });
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
#define MYRIAD_PLACE_OF_COUNTER(name, array, words) \
    case origin::name:                              \
        at(arrays.array);                           \
        break;
            MYRIAD_COUNTERS(MYRIAD_PLACE_OF_COUNTER)
#undef MYRIAD_PLACE_OF_COUNTER
    }
    return made;
}

template <class R>
void device_solver<R>::copy(const quantity& what, std::byte* to) const {
    const cuda::device_values values = values_of(what);
    if (values.array == nullptr && values.rule == nullptr) {  // counters of what there is nothing to count of
        std::memset(to, 0, static_cast<std::size_t>(count_) * size_of(what.as.type));
        return;
    }
    instances_->fetch(values, to);
}

template <class R>
bool device_solver<R>::reduce(std::size_t number, reduction_state& to) {
    const reduction_plan& plan = plan_.reductions[number];
    if (!plan.on_device) return false;
    const std::string& name = plan_.asked.reductions[number].definition().inputs.front();
    const auto input = std::find_if(plan_.quantities.begin(), plan_.quantities.end(),
                                    [&](const quantity& q) { return q.as.name == name; });
    to.add_words(instances_->reduce(values_of(*input), *plan.on_device));
    return true;
}

}  // namespace

template <class R>
std::unique_ptr<chunk_solver> solver_on_device(const study_plan& plan, const studied_model<R>& model,
                                               const device& where) {
    const options o = model.options_for(where, plan.asked.options);
    if (!can_be_on_device(plan.asked, model.called_for(where, o).may_end_early(o))) return nullptr;
    return std::make_unique<device_solver<R>>(plan, model, where);
}
template std::unique_ptr<chunk_solver> solver_on_device(const study_plan&, const studied_model<double>&, const device&);
template std::unique_ptr<chunk_solver> solver_on_device(const study_plan&, const studied_model<float>&, const device&);

}  // namespace myriad::studies::inline MYRIAD_ABI
