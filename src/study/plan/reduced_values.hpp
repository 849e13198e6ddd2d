// SPDX-License-Identifier: MIT
// What all reductions need: the values that they reduce, and variables for their results.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "myriad/study/plan/reduction.hpp"

namespace myriad {

using studies::element;
using studies::reduction_plan;
using studies::reduction_state;
using studies::variable;
using inputs = std::vector<const variable*>;

/// Calls `visit(j, value)` for value j of each instance that has not failed; what was not computed is NaN.
template <class Visit>
void for_each_value(const chunk_columns& chunk, const std::string& name, Visit&& visit) {
    const auto visit_all = [&]<class T>(T) {
        const std::span<const T> all = chunk.values<T>(name);
        const std::size_t inner = chunk.size() > 0 ? all.size() / static_cast<std::size_t>(chunk.size()) : 0;
        const T* next = all.data();
        T unset{};
        studies::fill(studies::element_of<T>, &unset, 1);  // for real types NaN, which equals nothing
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        for (std::int64_t i = 0; i < chunk.size(); ++i, next += inner) {
            if (is_failure(chunk.status(i))) continue;
            for (std::size_t j = 0; j < inner; ++j) visit(j, next[j] == unset ? none : static_cast<double>(next[j]));
        }
    };
    studies::with_type(chunk.find(name).what->type, visit_all);
}

inline variable result(std::string name, element type, std::vector<studies::dimension> inner,
                       std::vector<studies::attribute> attributes = {}) {
    return {std::move(name), type, std::move(inner), std::move(attributes), studies::along::nothing};
}

/// A reduction for each point of the axes that are not named, whose results have these axes in front. Throws `error` if
/// a named axis is not there, or named twice.
reduction_plan reduced_over(const studies::reduction_definition& what, const reduction_plan& all,
                            const std::vector<axes::dimension>& axes);

}  // namespace myriad
