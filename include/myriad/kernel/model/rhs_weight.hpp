// SPDX-License-Identifier: MIT
// How heavy a right-hand side is, and whether a kernel has one copy of it, which the stages of a method call.
#pragma once

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/team.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/jacobian_pattern.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Whether a model says how heavy its right-hand side is. A model with tangents inherits what is said of the original.
template <class Model>
inline constexpr bool declares_rhs_weight = requires {
    Model::rhs_weight;
};

template <class Model>
constexpr int find_rhs_weight() {
    if constexpr (n_tangent < Model >> 0) {
        return find_rhs_weight<original_of<Model>>() * (n_state<Model> / Model::n_original);
    } else if constexpr (declares_rhs_weight<Model>) {
        return static_cast<int>(Model::rhs_weight);
    } else if constexpr (team_size < Model >> 1) {
        return 0;
    } else if constexpr (traceable<Model>) {
        return slope_dependences_of<Model>.instructions;
    } else {
        return 0;
    }
}
/// About how many instructions the right-hand side takes: as the model declares it, or counted by calling it; of
/// tangents as many each as of the state. Zero if it is not known.
template <class Model>
inline constexpr int rhs_weight = find_rhs_weight<Model>();

#if MYRIAD_FOR_GPU
/// GPUs: a call moves state and slopes between registers, and what waits for it is not computed meanwhile; copies
/// outgrow the cache of instructions, some 128 kB. dormand_prince_5, NVIDIA H100, ms with copies and with calls:
/// Kuramoto's oscillators (37 instructions each), 2, 4, 8, 16 and 32 of them in double precision 0.166 and 0.186, 0.297
/// and 0.314, 0.589 and 0.610, 1.67 and 1.35, 17.2 and 7.2; in single precision (H100) 8, 16 and 32 of them 0.146 and
/// 0.145, 0.297 and 0.303, 1.11 and 0.70. Hodgkin and Huxley's axon (53 for each of four states) 20.8 and 19.6, in
/// single precision 1.75 and 1.95; a bubble (133 in all) by cash_karp 234 and 320.
template <class Model, class S>
constexpr bool finds_rhs_heavy() {
    constexpr int weight = rhs_weight<Model>, n = n_state<Model>;
    if constexpr (sizeof(real_of<S>) == sizeof(double)) {
        return (weight > 350 && weight > 12 * n) || (weight > 200 && weight > 45 * n);
    } else {
        return weight > 250 && weight > 12 * n;
    }
}
#else
/// CPUs: about as many instructions cost the same either way, and calls compile in half of the time or less. Networks
/// of sines and cosines, g++ 12, AVX-512, ns per evaluation with copies and calls: 3.6 and 5.9 (two oscillators); 11.0
/// and 10.9 (four, 192 instructions); 18.2 and 14.1 (six); 65 and 37 (twelve, which then compile in 7 s instead of 66).
/// With AVX2, Hodgkin and Huxley's axon took 0.95 of the time with calls, 8 of Kuramoto's oscillators 0.97 and 16 of
/// them 1.27: where the model does not say how heavy it is, more states are left to the compiler.
template <class Model, class S>
constexpr bool finds_rhs_heavy() {
    constexpr int most_copied = 150, most_states = 8;
    if constexpr (requires { Model::large_rhs; }) {
        return large_rhs<Model>;
    } else if constexpr (n_tangent < Model >> 0) {
        return finds_rhs_heavy<original_of<Model>, S>();
    } else {
        return rhs_weight<Model> > most_copied && (declares_rhs_weight<Model> || n_state<Model> <= most_states);
    }
}
#endif
/// Whether a kernel has one copy of the right-hand side, which is called wherever it is evaluated, with numbers S.
template <class Model, class S>
inline constexpr bool calls_rhs = finds_rhs_heavy<Model, S>();

}  // namespace myriad::detail::inline MYRIAD_TARGET
