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

/// Whether a team can integrate a model by a method. Others are integrated by one thread per instance.
template <class Model, class Method>
constexpr bool runs_in_teams() {
    return is_of_units<Model> && !rosenbrock_method<Method>;
}

/// Most states that one thread takes. Lorenz 96 by tsitouras_5, 131 072 instances, NVIDIA H100, ms for one thread and
/// for a team of 4: in double precision 16 states 0.64 and 1.25, 20 states 8.0 and 1.6, 32 states 29.5 and 2.6; in
/// single precision 32 states 2.36 and 0.76, where one thread spills. At 24 it does not, but has a stack of 736 bytes;
/// these have not been measured.
template <class R>
inline constexpr int most_states_of_one_thread = sizeof(R) == sizeof(double) ? 16 : 24;
/// Most bytes of the state that a thread of a team takes, and the smallest team. The same, for 4 and 8 states in each
/// thread: 64 states in double precision 4.51 and 4.81, in single precision 1.32 and 1.30; 128 states 8.78 and 9.20,
/// and 2.52 and 2.46. For 4, 8 and 16 threads, 32 states in double precision 2.65, 2.26 and 2.43, in single precision
/// 0.76, 0.72 and 0.81.
inline constexpr int most_state_bytes_of_thread = 32, smallest_chosen_team = 8;
/// Up to so many bytes in each of its threads, a warp is faster than several, which wait for each other at barriers of
/// the block: 256 states in double precision 18.0 ms with 32 threads, 23.4 with 64 and 24.8 with 128 (131 072
/// instances, NVIDIA H200). Beyond, a warp has not enough registers: 512 states 13.8 ms with 32, 12.3 with 64, 10.9
/// with 128 and 12.4 with 256, 1024 states 35.0 with 64, 23.7 with 128 and 23.3 with 256 (32 768 instances).
inline constexpr int most_state_bytes_in_warp = 32 * 64;

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
        constexpr int bytes = n_state<Model> * static_cast<int>(sizeof(R));
        constexpr int most = bytes > most_state_bytes_in_warp ? most_threads_of_team : 32;
        int threads = smallest_chosen_team;
        while (threads < most && bytes > threads * most_state_bytes_of_thread) threads *= 2;
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
