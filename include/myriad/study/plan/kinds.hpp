// SPDX-License-Identifier: MIT
// What studies do with each kind of components: whether it is set, recorded or shared, and where its values are.
#pragma once

#include <initializer_list>
#include <type_traits>

#include "myriad/host/core/error.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/component_kinds.hpp"
#include "myriad/study/plan/component_names.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

#define MYRIAD_LIST_KIND(kind, ...) component_kind::kind,
/// Those that records may have, which change in a call.
inline constexpr std::initializer_list<component_kind> recorded_kinds = {MYRIAD_RECORDED_KINDS(MYRIAD_LIST_KIND)};
/// Those of which each instance has values of its own.
inline constexpr std::initializer_list<component_kind> instance_kinds = {MYRIAD_INSTANCE_KINDS(MYRIAD_LIST_KIND)};
/// Those of a model.
inline constexpr std::initializer_list<component_kind> model_kinds = {MYRIAD_INSTANCE_KINDS(MYRIAD_LIST_KIND)
                                                                          MYRIAD_SHARED_KINDS(MYRIAD_LIST_KIND)};
/// Those that a study sets.
inline constexpr std::initializer_list<component_kind> settable_kinds = {
    MYRIAD_INSTANCE_KINDS(MYRIAD_LIST_KIND) MYRIAD_SHARED_KINDS(MYRIAD_LIST_KIND) component_kind::t_begin,
    component_kind::t_end};
#undef MYRIAD_LIST_KIND
/// Whether a kind is one of them.
constexpr bool among(std::initializer_list<component_kind> kinds, component_kind kind) {
    for (const component_kind one : kinds)
        if (one == kind) return true;
    return false;
}
/// Whether all instances have the same value.
constexpr bool is_shared(component_kind kind) { return among(model_kinds, kind) && !among(instance_kinds, kind); }
/// Whether its values are integers.
constexpr bool is_integer(component_kind kind) {
    using R = double;
    switch (kind) {
#define MYRIAD_TYPE_OF_KIND(kind, plural, words, type) \
    case component_kind::kind:                         \
        return std::is_integral_v<type>;
        MYRIAD_VALUE_KINDS(MYRIAD_TYPE_OF_KIND)
#undef MYRIAD_TYPE_OF_KIND
        default:
            return false;
    }
}
/// Calls `visit` with the array for a kind of which each instance has values.
template <class Arrays, class Visit>
decltype(auto) with_array(component_kind kind, Arrays& arrays, Visit&& visit) {
    switch (kind) {
#define MYRIAD_VISIT_KIND(kind, ...) \
    case component_kind::kind:       \
        return visit(arrays.kind);
        MYRIAD_INSTANCE_KINDS(MYRIAD_VISIT_KIND)
#undef MYRIAD_VISIT_KIND
        default:
            throw error(message("instances have no ", name_of(kind), " of their own"));
    }
}
/// Calls `visit` with the records of a kind that they may have, and its columns.
template <class R, template <class> class Records, class Visit>
void with_columns(const Records<R>& records, component_kind kind, Visit&& visit) {
    switch (kind) {
#define MYRIAD_VISIT_KIND(kind, plural, words, type) \
    case component_kind::kind:                       \
        return visit(records.template of_type<type>(), records.kind);
        MYRIAD_RECORDED_KINDS(MYRIAD_VISIT_KIND)
#undef MYRIAD_VISIT_KIND
        default:
            throw error(message("there are no records of ", name_of(kind)));
    }
}

}  // namespace myriad::studies::inline MYRIAD_ABI
