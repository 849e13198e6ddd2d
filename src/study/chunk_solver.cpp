// SPDX-License-Identifier: MIT
// Fills ensembles from axes, and copies what is kept of them.
#include "myriad/study/chunk_solver.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "myriad/host/threads/parallel.hpp"
#include "myriad/kernel/core/abi.hpp"

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

template <class R>
void set_instances(model_instances<R>& instances, const axes& all, std::int64_t first) {
    instances.restart();
    auto& data = instances.data();
    data.t.fill_instances(0, data.size, host::ensemble_data<R>::unset);  // which restart leaves as it was
    data.first_index = first;
    using enum component_kind;
    const auto entry_of = [&](component_kind kind, int number) -> const axes::entry* {
        for (const axes::entry& e : all.entries())
            if (e.what == component{kind, number}) return &e;
        return nullptr;
    };
    // What no axis sets is what a new ensemble has, since the last integration has changed it.
    const auto set = [&](component_kind kind, auto& array, auto unset) {
        for (int c = 0; c < array.components(); ++c) {
            const axes::entry* const e = entry_of(kind, c);
            if (e == nullptr) {
                array.fill_component(c, unset);
            } else {
                all.fill(*e, first, array.length(), array.component(c));
            }
        }
    };
    const R unset = host::ensemble_data<R>::unset;
    set(state, data.state, unset);
    set(parameter, data.parameter, unset);
    set(accessory, data.accessory, unset);
    set(integer_accessory, data.integer_accessory, std::int32_t{0});
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
    instances.generate(first, all.seed());
}
template void set_instances(model_instances<double>&, const axes&, std::int64_t);
template void set_instances(model_instances<float>&, const axes&, std::int64_t);

template <class R>
void chunk_solver_of<R>::prepare(std::int64_t first, std::int64_t count) {
    if (instances_ != nullptr && instances_->data().size != count) instances_.reset();
    if (instances_ == nullptr) instances_ = make_(count);
    first_ = first;
    set_instances(*instances_, plan_.asked.axes, first);
}

template <class R>
solved chunk_solver_of<R>::integrate(const device& where, const std::function<void(std::int64_t done)>& progress) {
    options o = plan_.asked.options;
    o.progress = [&progress](std::int64_t done, std::int64_t) { progress(done); };
    report_of<R> report = instances_->solve(where, o);
    return {report.by_status, std::move(report.notes)};
}

template <class R>
void chunk_solver_of<R>::copy(const quantity& what, std::byte* to) const {
    auto& data = instances_->data();
    const std::int64_t size = data.size, inner = what.as.values_per_item();
    const component& c = what.what;
    switch (what.from) {
        case origin::axis: {
            const auto& entries = plan_.asked.axes.entries();
            const auto e =
                std::find_if(entries.begin(), entries.end(), [&](const axes::entry& entry) { return entry.what == c; });
            return plan_.asked.axes.fill(*e, first_, size, reinterpret_cast<R*>(to));
        }
        case origin::record:
            if (c.kind == component_kind::integer_accessory) {
                transpose(instances_->recorded_integers(c.number), size, inner, to);
                return mark_missing_phases(data.phase.data(), plan_.asked.options.record.from_phase, size, inner, to);
            }
            return transpose(instances_->recorded(c.kind, c.number), size, inner, to);
        case origin::record_time:
            return transpose(instances_->record_times(), size, inner, to);
        case origin::sample:
            return transpose(instances_->sampled(c.number), size, inner, to);
        case origin::sample_time:
            return transpose(instances_->sample_times(), size, inner, to);
        case origin::samples_stored:
            return transpose(instances_->samples_stored(), size, 1, to);
        case origin::end:
            switch (c.kind) {
                case component_kind::state:
                    return transpose(data.state.component(c.number), size, 1, to);
                case component_kind::parameter:
                    return transpose(data.parameter.component(c.number), size, 1, to);
                case component_kind::accessory:
                    return transpose(data.accessory.component(c.number), size, 1, to);
                default:
                    return transpose(data.integer_accessory.component(c.number), size, 1, to);
            }
        case origin::end_time:
            return transpose(data.t.data(), size, 1, to);
        case origin::status:
            return transpose(data.status.data(), size, 1, to);
        case origin::phases_done:
            return transpose(data.phase.data(), size, 1, to);
        case origin::accepted_steps:
            return copy_or_zero(data.counters()[0], size, to);
        case origin::rejected_steps:
            return copy_or_zero(data.counters()[1], size, to);
        case origin::located_steps:
            return copy_or_zero(data.counters()[2], size, to);
        case origin::rhs_evaluations:
            return copy_or_zero(data.counters()[3], size, to);
    }
}

template class chunk_solver_of<double>;
template class chunk_solver_of<float>;

}  // namespace myriad::studies::inline MYRIAD_ABI
