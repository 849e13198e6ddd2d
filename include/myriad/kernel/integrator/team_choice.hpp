// SPDX-License-Identifier: MIT
// Which models a team of a GPU's threads integrates, and of how many.
#pragma once

#include <type_traits>

#include "myriad/kernel/methods/controller_policies.hpp"
#include "myriad/kernel/methods/dense.hpp"
#include "myriad/kernel/model/part_of_units.hpp"
#include "myriad/kernel/stepper/rosenbrock.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Whether it is `coupled_units` itself, all of whose functions are those of its units.
template <class Model>
inline constexpr bool is_of_units = false;
template <class Unit, int units>
inline constexpr bool is_of_units<coupled_units<Unit, units>> = true;

/// Most bytes of shared memory, of the 227 KiB that a block has, that a team takes for its instance where each unit may
/// have a value of the past for each of the others, in double precision.
inline constexpr int most_bytes_of_team = 200 << 10;
/// Whether a team can integrate a model by a method. Others are integrated by one thread per instance.
template <class Model, class Method>
constexpr bool runs_in_teams() {
    if constexpr (!is_of_units<Model> || rosenbrock_method<Method>) {
        return false;
    } else if constexpr (stochastic_method<Method>) {
        // Others evaluate factors of one process after the other, or find events by factors of all.
        constexpr bool by_states = Method::strong_order != 0 && !uses_jacobian<Method>;
        return by_states && !has_events<Model> && !has_summaries<Model>;
    } else if constexpr (has_delays<Model>) {
        return !has_changing_lags_of_units<typename Model::unit_type> &&
               team_layout<Model>::end * static_cast<int>(sizeof(double)) <= most_bytes_of_team;
    } else {
        return true;
    }
}

/// Most states that one thread takes. Lorenz 96 by tsitouras_5, 131 072 instances, NVIDIA H100, ms for one thread and
/// for a team of 4: in double precision 16 states 0.64 and 1.25, 20 states 8.0 and 1.6, 32 states 29.5 and 2.6; in
/// single precision 32 states 2.36 and 0.76, where one thread spills. At 24 it does not, but has a stack of 736 bytes;
/// these have not been measured.
template <class R>
inline constexpr int most_states_of_one_thread = sizeof(R) == sizeof(double) ? 16 : 24;
/// Most states that a thread of a team takes while the team is smaller than a warp, and the smallest team. Lorenz 96 by
/// tsitouras_5, 131 072 instances, NVIDIA H200, ms in double and in single precision:
///
///     states   8 threads    16           32
///     32       2.27, 0.69   2.58, 0.93
///     64       4.85, 1.38   4.47, 1.26   4.83, 1.66
///     128                   9.25, 2.55   8.72, 2.39
inline constexpr int most_states_of_team_thread = 4, smallest_chosen_team = 8;
/// The same for states of which the past is looked up. 64 of Kuramoto's oscillators with a delay to t = 20 by
/// dormand_prince_5 at 1e-6, NVIDIA H200, ms by one thread, 16 and 32: 1024 instances 117, 4.3 and 1.6; 8192 248, 24.7
/// and 11.6.
inline constexpr int most_delayed_states_of_team_thread = 2;
/// A warp with up to so many bytes of the state in each thread is faster than several warps, which wait for each other
/// at barriers of the block. Beyond, it has not enough registers, and a block has about 32 bytes in each thread. The
/// same in double precision, except for the last line, in single:
///
///     states   instances   32 threads   64     128    256
///     256      131 072     18.0         23.4   24.8
///     384      131 072     28.0         33.6   34.0
///     512      32 768      13.8         12.3   10.9   12.4
///     1024     32 768                   35.0   23.7   23.3
///     1024     32 768                   6.9    6.1    6.9
inline constexpr int most_bytes_of_warp_thread = 96, bytes_of_block_thread = 32;

/// The number of threads that integrate an instance: as units declare it, `static constexpr int threads_per_instance =
/// 16;`, or by the number of states.
template <class Model, class Method, class R>
constexpr int threads_per_instance() {
    if constexpr (!runs_in_teams<Model, Method>()) {
        return 1;
    } else if constexpr (declared_team<typename Model::unit_type>() > 0) {
        return declared_team<typename Model::unit_type>();
    } else if constexpr (n_state<Model> <= most_states_of_one_thread<R>) {
        return 1;
    } else {
        constexpr int states = n_state<Model>, bytes = states * static_cast<int>(sizeof(R));
        constexpr int most = has_delays<Model> ? most_delayed_states_of_team_thread : most_states_of_team_thread;
        int threads = smallest_chosen_team;
        while (threads < 32 && states > threads * most) threads *= 2;
        if (bytes > 32 * most_bytes_of_warp_thread)
            while (threads < most_threads_of_team && bytes > threads * bytes_of_block_thread) threads *= 2;
        while (threads / 2 >= Model::n_unit) threads /= 2;  // more have nothing to do
        return threads;
    }
}

/// What a thread integrates: the whole model or a part of it.
template <class Model, class Method, class R>
struct thread_model {
    static constexpr int threads = threads_per_instance<Model, Method, R>();
    using type = std::conditional_t<(threads > 1), part_of_units<Model, threads>, Model>;
};
template <class Model, class Method, class R>
using model_of_thread = typename thread_model<Model, Method, R>::type;

}  // namespace myriad::detail::inline MYRIAD_TARGET
