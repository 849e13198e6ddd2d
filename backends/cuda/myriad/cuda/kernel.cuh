// SPDX-License-Identifier: MIT
// The CUDA kernel: one thread, or a team of threads, takes one instance through the loop, or several in succession.
// Variants differ only in where shared parameters are stored.
#pragma once

#include <cstdint>
#include <type_traits>

#include "myriad/cuda/launch_traits.hpp"
#include "myriad/cuda/local_memory.cuh"
#include "myriad/kernel/core/stop_request.hpp"
#include "myriad/kernel/integrator/integrate.hpp"
#include "myriad/kernel/integrator/team_choice.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Whether instances may differ in cost: if steps are adaptive, or events or hooks can end phases. Other kernels take
/// them in order.
template <class Model, class Method>
inline constexpr bool costs_differ =
    is_adaptive<Method> || has_events<Model> || has_after_step<Model> || has_stops<Model>;

/// What the host asks of a kernel that is running: a `stop_request` in device memory, or null. It is read out of line
/// in kernels with adaptive steps or events: nvcc takes a loop whose end depends on a value in memory for one that
/// waits for it, and yields in every turn. Beside a call, kernels of fixed steps without events would need more
/// registers. A team follows what its leading thread reads.
template <bool out_of_line, int threads>
class request_of_host {
public:
    __device__ __forceinline__ explicit request_of_host(const std::uint32_t* stop) : stop_(stop) {}

    /// Whether instances under way are to end.
    __device__ __forceinline__ bool gives_up() const { return read() >= stop_request::end_now; }
    /// The same between two phases of an instance, of which so many are left: asks after some.
    __device__ __forceinline__ bool gives_up_before(std::int32_t phases_left) const {
        constexpr std::int32_t now_and_then = 64;
        return phases_left % now_and_then == 0 && gives_up();
    }
    /// Whether the instance given last is to be left as it is.
    __device__ __forceinline__ bool is_over() const { return last_ == stop_request::end_all; }

protected:
    /// Whether instances may be given: to be begun, or to be left.
    __device__ __forceinline__ bool gives_more() {
        last_ = read();
        return last_ == stop_request::none || last_ == stop_request::end_all;
    }

private:
    __device__ __forceinline__ stop_request read() const {
        const std::uint32_t* stop = stop_;
        MYRIAD_OPTIMISATION_BARRIER(stop);  // else the address stays in registers through the loop
        if constexpr (out_of_line) {
            return of_team(read_out_of_line(stop));
        } else {
            return of_team(read(stop));
        }
    }
    static __device__ __forceinline__ stop_request of_team(stop_request read) {
        return static_cast<stop_request>(thread_team<threads>::of_leader(static_cast<unsigned>(read)));
    }
    static __device__ __noinline__ stop_request read_out_of_line(const std::uint32_t* stop) { return read(stop); }
    static __device__ __forceinline__ stop_request read(const std::uint32_t* stop) {
        return stop != nullptr ? static_cast<stop_request>(*static_cast<const volatile std::uint32_t*>(stop))
                               : stop_request::none;
    }

    const std::uint32_t* stop_;
    stop_request last_ = stop_request::none;
};

/// Which instance a thread, or its team, takes first. The threads of a block take neighbours, whose values lie side by
/// side. Of teams, only those of a warp do, and a block's warps take instances that lie far apart: expensive ones are
/// often neighbours, and all multiprocessors should have a share of them.
template <int threads>
__device__ __forceinline__ std::int64_t first_instance() {
    std::int64_t block = blockIdx.x;
    MYRIAD_OPTIMISATION_BARRIER(block);  // else the address stays in registers through the loop
    if constexpr (threads == 1) {
        return block * blockDim.x + threadIdx.x;
    } else if constexpr (thread_team<threads>::is_block) {
        return block;
    } else {
        constexpr int lanes = gpu::warp_size, teams = lanes / threads;
        return (static_cast<std::int64_t>(threadIdx.x / lanes) * gridDim.x + block) * teams +
               threadIdx.x % lanes / threads;
    }
}

/// A source of one instance, that of the number of the thread, or of the team.
template <int threads>
class own_instance : public request_of_host<false, threads> {
public:
    __device__ __forceinline__ own_instance(const std::int64_t size, const std::uint32_t*, unsigned long long*,
                                            const std::uint32_t* stop)
        : request_of_host<false, threads>(stop), index_(first_instance<threads>()) {
        if (index_ >= size) index_ = -1;
    }

    __device__ __forceinline__ std::int64_t next() {
        if (!this->gives_more()) return -1;
        const std::int64_t given = index_;
        index_ = -1;
        return given;
    }
    /// Whether the first instance is also the last.
    __device__ __forceinline__ bool gives_only_one() const { return true; }

private:
    std::int64_t index_;
};

/// A source of that instance and, if there is a queue, of further ones from the queue.
template <int threads>
class queued_instances : public request_of_host<true, threads> {
public:
    __device__ __forceinline__ queued_instances(std::int64_t size, const std::uint32_t* order,
                                                unsigned long long* queue, const std::uint32_t* stop)
        : request_of_host<true, threads>(stop), size_(size), order_(order), queue_(queue) {}

    __device__ __forceinline__ std::int64_t next() {
        if (!this->gives_more()) return -1;
        std::int64_t place = first_instance<threads>();
        if (has_begun_) {
            if (queue_ == nullptr) return -1;
            const unsigned long long taken = thread_team<threads>::leads() ? atomicAdd(queue_, 1ull) : 0;
            place = static_cast<std::int64_t>(gridDim.x) * blockDim.x / threads +
                    static_cast<std::int64_t>(thread_team<threads>::of_leader(taken));
        }
        has_begun_ = true;
        if (place >= size_) return -1;
        return order_ != nullptr ? order_[place] : place;
    }
    __device__ __forceinline__ bool gives_only_one() const { return queue_ == nullptr; }

private:
    std::int64_t size_;
    const std::uint32_t* order_;
    unsigned long long* queue_;
    bool has_begun_ = false;
};

template <class Model, class R>
inline constexpr int shared_parameter_bytes =
    n_shared<Model>* static_cast<int>(sizeof(R)) + n_shared_integer<Model>* static_cast<int>(sizeof(std::int32_t));

/// Most threads per block; a model may set it by `static constexpr int max_block_size = 512;`. Up to 256, a thread can
/// have as many registers as the hardware can address. nvcc trades registers for resident blocks of this size
/// (docs/gpu.md).
template <class Model>
constexpr int max_block_size() {
    if constexpr (team_for<Model>::is_block) {
        return team_size<Model>;
    } else if constexpr (requires { Model::max_block_size; }) {
        return Model::max_block_size;
    } else {
        return 192;
    }
}

/// Whether nvcc is to shorten the waits of each thread first, with more registers, instead of letting more threads run.
/// Measured with and without, NVIDIA H200, ms. It gains in double precision: dormand_prince_8 with PI control, 8192
/// bubbles 184 and 232, 307 200 bubbles 777 and 778; tsitouras_5 at 1e-8, 524 288 instances of Lorenz, 0.625 and 0.645.
/// It costs time in kernels with events, whose rare code is large (768 000 valves 304 and 288), in teams (Lorenz 96
/// with 32 states 2.43 and 2.26), with fixed steps (768 000 instances of Lorenz by runge_kutta_4 2.24 and 2.23), and in
/// single precision (Lorenz 96 with 16 states 0.182 and 0.173). Stop times were not measured.
template <class Model, class Method, class R>
constexpr bool prefers_latency = sizeof(R) == sizeof(double) && is_adaptive<Method>&& team_size<Model> == 1 &&
                                 !has_events<Model> && !has_stops<Model>;

/// Blocks of that size that nvcc keeps registers for; with 0 as it finds best (docs/gpu.md). Adaptive steps of models
/// with delays wait for memory: Lorenz with a delay, dormand_prince_5 at 1e-8, 262 144 instances on an NVIDIA H200, ms:
/// 34.6 with three blocks of 192 threads and 38.6 without, when steps of the past were not yet prefetched. In teams
/// that was not measured; they would spill.
template <class Model, class Method, class R>
constexpr int least_blocks() {
    if (has_delays<Model> && is_adaptive<Method> && !has_events<Model> && team_size<Model> == 1)
        return max_block_size<Model>() < 3 * 192 ? 3 * 192 / max_block_size<Model>() : 1;
    return fills_registers<Method, Model, R>() || prefers_latency<Model, Method, R> ? 1 : 0;
}

/// A kernel's launch parameters. For the constant bank, they include the shared parameters.
template <class Model, class R, shared_placement placement>
struct launch_arguments {
    kernel_arguments<Model, R> ensemble;
    unsigned long long* queue;  // number of instances taken beyond each thread's first one; null: no queue
    const std::uint32_t* stop;  // what the host asks meanwhile; null: nothing
};
template <class Model, class R>
struct launch_arguments<Model, R, shared_placement::constant_bank> {
    kernel_arguments<Model, R> ensemble;
    unsigned long long* queue;
    const std::uint32_t* stop;
    R shared[at_least_one(n_shared<Model>)];
    std::int32_t shared_integer[at_least_one(n_shared_integer<Model>)];
};

/// Bytes of shared memory that a block, and each of its threads, take.
template <class Model, class R>
constexpr int find_bytes_of_block() {
    if constexpr (team_size < Model >> 1) {
        return as_part<Model>::template bytes_of_block<R>;
    } else {
        return 0;
    }
}
template <class Model, class R>
inline constexpr int bytes_of_block = find_bytes_of_block<Model, R>();
template <class Model, class Method, class R>
constexpr int find_bytes_of_thread() {
    if constexpr (team_size < Model >> 1) {
        static_assert(shared_step_bytes<Method, Model, R> == 0, "a team has the shared memory for itself");
        return as_part<Model>::template bytes_of_thread<R>;
    } else {
        return shared_step_bytes<Method, Model, R>;
    }
}
template <class Model, class Method, class R>
inline constexpr int bytes_of_thread = find_bytes_of_thread<Model, Method, R>();

/// What launches depend on. Launch parameters are put where these have them.
template <class Model, class Method, class R>
inline constexpr cuda::kernel_traits traits_of{numbers_of<whole_of<Model>>,
                                               shared_parameter_bytes<Model, R>,
                                               max_block_size<Model>(),
                                               costs_differ<Model, Method>,
                                               bytes_of_thread<Model, Method, R>,
                                               bytes_of_block<Model, R>,
                                               team_size<Model>};
template <class Model, class R, shared_placement placement>
constexpr bool is_laid_out = sizeof(launch_arguments<Model, R, placement>) ==
                             cuda::launch_offsets<R>(numbers_of<whole_of<Model>>).bytes(placement);

/// Copies the shared parameters to the block's shared memory, behind what it and its threads take, with all its
/// threads.
template <class Model, class Method, class R>
__device__ __forceinline__ shared_parameters<R> stage_shared(const shared_parameters<R>& from) {
    R* const real = static_cast<R*>(memory_of_block()) + bytes_of_block<Model, R> / sizeof(R) +
                    blockDim.x * (bytes_of_thread<Model, Method, R> / sizeof(R));
    auto* const integer = reinterpret_cast<std::int32_t*>(real + n_shared<Model>);
    for (int i = static_cast<int>(threadIdx.x); i < n_shared<Model>; i += static_cast<int>(blockDim.x))
        real[i] = from.real[i];
    for (int i = static_cast<int>(threadIdx.x); i < n_shared_integer<Model>; i += static_cast<int>(blockDim.x))
        integer[i] = from.integer[i];
    __syncthreads();
    return {real, integer};
}

/// The kernel's body: integrates the instances from this thread's source.
template <class Model, class Method, class R, shared_placement placement>
__device__ __forceinline__ void integrate_thread(const launch_arguments<Model, R, placement>& arguments) {
    static_assert(is_laid_out<Model, R, placement>);
    static_assert(bytes_of_step<Model, Method, R> <= most_local_memory,
                  "a step of this method with so many states takes more than the 512 KiB of local memory that a thread "
                  "of a GPU has: integrate on the CPU, by an explicit method, or declare a sparse jacobian_pattern");
    static_assert(bytes_of_past<Model, R> <= most_local_memory && bytes_of_tables<Model> <= most_constant_memory / 2,
                  "so many delayed values take more memory than a thread of a GPU has: integrate on the CPU, or let "
                  "units publish what they were, so that a sum looks up one value for each of them and not one for "
                  "each pair");
    shared_parameters<R> shared = arguments.ensemble.shared;
    if constexpr (placement == shared_placement::constant_bank) shared = {arguments.shared, arguments.shared_integer};
    if constexpr (placement == shared_placement::shared_memory) shared = detail::stage_shared<Model, Method, R>(shared);
    constexpr int threads = team_size<Model>;
    if constexpr (threads > 1) {
        as_part<Model>::stage_tolerances(arguments.ensemble, static_cast<int>(threadIdx.x),
                                         static_cast<int>(blockDim.x));
        __syncthreads();
    }
    using supply = std::conditional_t<costs_differ<Model, Method>, queued_instances<threads>, own_instance<threads>>;
    supply instances(arguments.ensemble.size, arguments.ensemble.order, arguments.queue, arguments.stop);
    detail::integrate<Model, Method, R>(arguments.ensemble, shared, instances);
}

template <class Model, class Method, class R, shared_placement placement>
__global__ void __launch_bounds__(max_block_size<Model>(), (least_blocks<Model, Method, R>()))
    integrate_ensemble(const __grid_constant__ launch_arguments<Model, R, placement> arguments) {
    detail::integrate_thread<Model, Method, R, placement>(arguments);
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
