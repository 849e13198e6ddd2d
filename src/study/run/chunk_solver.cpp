// SPDX-License-Identifier: MIT
// Fills ensembles from axes, and copies what is kept of them.

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "myriad/host/threads/default_arithmetic.hpp"
#include "myriad/host/threads/parallel.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/plan/kinds.hpp"
#include "myriad/study/run/studied_model.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

constexpr std::int64_t grain = 16'384;  // values worth a thread

/// From one component after the other, as the library has them, to one instance after the other.
template <class T>
void transpose(const T* from, std::int64_t instances, std::int64_t inner, std::byte* bytes) {
    auto* const to = reinterpret_cast<T*>(bytes);
    host::in_parallel(instances, std::max(grain / inner, std::int64_t{64}), [=](std::int64_t first, std::int64_t last) {
        constexpr std::int64_t block = 64;  // instances whose rows stay in the cache
        for (std::int64_t begin = first; begin < last; begin += block) {
            const std::int64_t end = std::min(begin + block, last);
            for (std::int64_t j = 0; j < inner; ++j)
                for (std::int64_t i = begin; i < end; ++i) to[i * inner + j] = from[j * instances + i];
        }
    });
}
template <class T>
void copy_or_zero(const T* from, std::int64_t instances, std::byte* to) {
    if (from != nullptr) return transpose(from, instances, 1, to);
    std::memset(to, 0, static_cast<std::size_t>(instances) * sizeof(T));
}

/// Writes the fill value where a phase did not end, since records have 0 there, which may also be a result.
void mark_missing_phases(const std::int32_t* phases_done, std::int64_t from_phase, std::int64_t instances,
                         std::int64_t recorded, std::byte* bytes) {
    auto* const values = reinterpret_cast<std::int32_t*>(bytes);
    host::in_parallel(
        instances, std::max(grain / recorded, std::int64_t{64}), [=](std::int64_t first, std::int64_t last) {
            for (std::int64_t i = first; i < last; ++i) {
                const std::int64_t there = std::clamp<std::int64_t>(phases_done[i] - from_phase, 0, recorded);
                fill(element::i32, values + i * recorded + there, static_cast<std::size_t>(recorded - there));
            }
        });
}

}  // namespace

void solved::add(const solved& more) {
    constexpr std::size_t most = 16;
    for (std::size_t s = 0; s < by_status.size(); ++s) by_status[s] += more.by_status[s];
    for (const statement& note : more.notes)
        if (notes.size() < most && std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
}

template <class R>
void host_instances<R>::set(const axes& all, std::int64_t first, bool calls_users_function) {
    auto& data = this->data();
    if (!data.untouched) samples().clear();
    data.restart();
    data.t.fill_instances(0, data.size, host::ensemble_data<R>::unset);  // which restart leaves as it was
    data.first_index = first;
    using enum component_kind;
    const auto entry_of = [&](component_kind kind, int number) -> const axes::entry* {
        for (const axes::entry& e : all.entries())
            if (e.what == component{kind, number}) return &e;
        return nullptr;
    };
    // What no axis sets is what a new ensemble has, since the last integration has changed it.
    const auto set_all = [&]<class T>(component_kind kind, host::component_array<T>& array) {
        for (int c = 0; c < array.components(); ++c) {
            const axes::entry* const e = entry_of(kind, c);
            if (e == nullptr) {
                array.fill_component(c, detail::unset_value<T>);
            } else {
                all.fill(*e, first, array.length(), array.component(c));
            }
        }
    };
    for (const component_kind kind : instance_kinds) with_array(kind, data, [&](auto& array) { set_all(kind, array); });
    const R unset = host::ensemble_data<R>::unset;
    R begin = unset, end = unset;
    bool varies = false;
    for (const axes::entry& e : all.entries()) {
        if (e.what.kind == shared) data.shared.data()[e.what.number] = static_cast<R>(e.values[0]);
        if (e.what.kind == shared_integer)
            data.shared_integer.data()[e.what.number] = static_cast<std::int32_t>(e.values[0]);
        if (e.what.kind != t_begin && e.what.kind != t_end) continue;
        varies = varies || e.dimension || e.values.random();
        (e.what.kind == t_begin ? begin : end) = static_cast<R>(e.values[0]);
    }
    data.set_domain(begin, end);
    if (varies) {
        auto& own = data.own_domains();
        for (const axes::entry& e : all.entries()) {
            if (e.what.kind == t_begin) all.fill(e, first, data.size, own.t_begin.data());
            if (e.what.kind == t_end) all.fill(e, first, data.size, own.t_end.data());
        }
    }
    if (calls_users_function || !model_.sets_others()) model_.set_others(*memory_, first);
    if (!model_.generates_itself()) return;
    const host::called_model<R> model = model_.called_for(where_, {});
    // A GPU's kernel that was compiled at run time has no part for the host.
    if (where_.which() == device::kind::cpu || model.functions.generate != nullptr) model.generate(data, all.seed());
}

template <class R>
report_of<R> host_instances<R>::solve(const device& where, const options& o) {
    const detail::default_arithmetic here;
    const host::called_model<R> model = model_.called_for(where, o);
    report_of<R> made;
    host::solve_call<R> call({where}, o, model, data(), samples(), records_);
    call.integrate(made);
    call.add_notes(made);
    return made;
}

template class host_instances<double>;
template class host_instances<float>;

namespace {

/// The solver of instances in the host's memory. Plan and model must outlive it.
template <class R>
class host_solver final : public chunk_solver {
public:
    host_solver(const study_plan& plan, const studied_model<R>& model, const device& where)
        : plan_(plan), model_(model), where_(where) {}

    void prepare(std::int64_t first, std::int64_t count) override;
    solved integrate(const device& where, const std::function<void(std::int64_t done)>& progress) override;
    void copy(const quantity& what, std::byte* to) const override;
    void clear() override { instances_.reset(); }

private:
    const study_plan& plan_;
    const studied_model<R>& model_;
    device where_;
    std::unique_ptr<host_instances<R>> instances_;
    std::int64_t first_ = 0;
};

template <class R>
void host_solver<R>::prepare(std::int64_t first, std::int64_t count) {
    if (instances_ != nullptr && instances_->data().size != count) instances_.reset();
    if (instances_ == nullptr) instances_ = std::make_unique<host_instances<R>>(model_, where_, count);
    first_ = first;
    instances_->set(plan_.asked.axes, first);
}

template <class R>
solved host_solver<R>::integrate(const device& where, const std::function<void(std::int64_t done)>& progress) {
    options o = model_.options_for(where, plan_.asked.options);
    o.progress = [&progress](std::int64_t done, std::int64_t) { progress(done); };
    report_of<R> report = instances_->solve(where, o);
    return {report.by_status, std::move(report.notes)};
}

template <class R>
void host_solver<R>::copy(const quantity& what, std::byte* to) const {
    auto& data = instances_->data();
    const std::int64_t size = data.size, inner = what.as.values_per_item();
    const component& c = what.what;
    const host::record_data<R>& r = instances_->records();
    const host::sample_data<R>& s = instances_->samples();
    switch (what.from) {
        case origin::axis: {
            const auto& entries = plan_.asked.axes.entries();
            const auto e =
                std::find_if(entries.begin(), entries.end(), [&](const axes::entry& entry) { return entry.what == c; });
            return plan_.asked.axes.fill(*e, first_, size, reinterpret_cast<R*>(to));
        }
        case origin::record:
            with_columns(r, c.kind, [&](const auto& values, const std::vector<std::int16_t>& columns) {
                transpose(values.component(columns[static_cast<std::size_t>(c.number)]), size, inner, to);
            });
            if (is_integer(c.kind))
                mark_missing_phases(data.phase.data(), plan_.asked.options.record.from_phase, size, inner, to);
            return;
        case origin::record_time:
            return transpose(r.values.component(r.time), size, inner, to);
        case origin::sample:
            return transpose(s.component(c.number), size, inner, to);
        case origin::sample_time:
            return transpose(s.time.data(), size, inner, to);
        case origin::stored_samples:
            return transpose(s.stored.data(), size, 1, to);
        case origin::end:
            return with_array(c.kind, data,
                              [&](const auto& array) { transpose(array.component(c.number), size, 1, to); });
        case origin::end_time:
            return transpose(data.t.data(), size, 1, to);
        case origin::status:
            return transpose(data.status.data(), size, 1, to);
        case origin::phases_done:
            return transpose(data.phase.data(), size, 1, to);
#define MYRIAD_COPY_COUNTER(name, array, words) \
    case origin::name:                          \
        return copy_or_zero(data.array.data(), size, to);
            MYRIAD_COUNTERS(MYRIAD_COPY_COUNTER)
#undef MYRIAD_COPY_COUNTER
    }
}

}  // namespace

template <class R>
std::unique_ptr<chunk_solver> solver_on_host(const study_plan& plan, const studied_model<R>& model,
                                             const device& where) {
    return std::make_unique<host_solver<R>>(plan, model, where);
}
template std::unique_ptr<chunk_solver> solver_on_host(const study_plan&, const studied_model<double>&, const device&);
template std::unique_ptr<chunk_solver> solver_on_host(const study_plan&, const studied_model<float>&, const device&);

}  // namespace myriad::studies::inline MYRIAD_ABI
