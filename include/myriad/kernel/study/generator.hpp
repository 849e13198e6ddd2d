// SPDX-License-Identifier: MIT
// The function `generate` of a model, which sets the instances of a study where they are integrated: its argument, and
// the call.
#pragma once

#include <concepts>
#include <cstdint>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/lane.hpp"
#include "myriad/kernel/model/random.hpp"
#include "myriad/kernel/scalar/lanes.hpp"
#include "myriad/kernel/state/instance_arrays.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"
#include "myriad/kernel/study/axis_rule.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// The argument of a model's `generate`: one instance of a study, in which axes and values are set already. What they
/// do not set is NaN, and integer accessories are 0.
template <class Model, class R>
struct generated_instance {
    using real = R;  ///< double or float

    std::int64_t index;                                                        ///< its number in the study
    vec<R, detail::n_state<Model>>& y;                                         ///< the initial state
    vec<R, detail::n_parameter<Model>>& parameter;                             ///< the parameters
    vec<R, detail::n_accessory<Model>>& accessory;                             ///< the model's own storage
    vec<std::int32_t, detail::n_integer_accessory<Model>>& integer_accessory;  ///< its integers
    shared_values<Model, R> shared;                                            ///< values that all instances share
    shared_values<Model, std::int32_t> shared_integer;                         ///< integers that all share
    /// Random numbers of this instance by the study's seed, which neither axes nor hooks draw.
    random_numbers<R> random;
};

}  // namespace myriad::inline MYRIAD_TARGET

namespace myriad::detail::inline MYRIAD_TARGET {

/// Whether a model has a `generate` that sets instances.
template <class Model, class R>
inline constexpr bool generates = requires(generated_instance<Model, R>& i) {
    { Model::generate(i) } -> std::same_as<void>;
};

/// Calls the model's `generate` for instance i of the arrays. Returns whether states and parameters are finite then.
template <class Model, class R>
MYRIAD_FUNCTION bool generate_instance(const instance_arrays<array_pointer, R>& arrays, const instance_range& range,
                                       const shared_parameters<R>& shared, std::uint64_t seed, std::int64_t i) {
#define MYRIAD_DECLARE_VALUES(kind, plural, words, type) vec<type, n_##kind<Model>> kind;
    MYRIAD_INSTANCE_KINDS(MYRIAD_DECLARE_VALUES)
#undef MYRIAD_DECLARE_VALUES
    const auto each = [&](auto&& visit) MYRIAD_LAMBDA {
        const auto visit_all = [&](auto& values, auto* array, int count) MYRIAD_LAMBDA {
            for (int c = 0; c < count; ++c) visit(values[c], array[c * range.size + i]);
        };
#define MYRIAD_VISIT_KIND(kind, ...) visit_all(kind, arrays.kind, MYRIAD_LENGTH(n_##kind<Model>));
        MYRIAD_INSTANCE_KINDS(MYRIAD_VISIT_KIND)
#undef MYRIAD_VISIT_KIND
    };
    each([](auto& value, auto& stored) MYRIAD_LAMBDA { value = stored; });
    const std::int64_t index = range.first_index + i;
    generated_instance<Model, R> instance{index,
                                          state,
                                          parameter,
                                          accessory,
                                          integer_accessory,
                                          {shared.real},
                                          {shared.integer},
                                          random_numbers<R>(seed, index, phase_of_generator)};
    Model::generate(instance);
    each([](auto& value, auto& stored) MYRIAD_LAMBDA { stored = value; });
    bool finite = all_finite(state);
    if constexpr (n_parameter < Model >> 0) finite = finite && all_finite(parameter);
    return finite;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
