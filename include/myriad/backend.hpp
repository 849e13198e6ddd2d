// SPDX-License-Identifier: MIT
// The seam between host code and backends: the few functions that a backend provides for a model, a method and a real
// type, declared here and defined where the model is instantiated. Host programs include no backend.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "myriad/core/weak.hpp"
#include "myriad/core/instruction_set.hpp"
#include "myriad/ensemble/arrays.hpp"
#include "myriad/ensemble/view.hpp"
#include "myriad/integrator/options.hpp"
#include "myriad/model/concepts.hpp"

namespace myriad {

/// What a backend needs beside the kernel's arguments.
struct run_options {
    int threads = 0;  ///< at most; 0: as OMP_NUM_THREADS or the machine says
    /// Called from the calling thread with the number of instances begun; may be null.
    bool (*progress)(void* context, std::int64_t begun) = nullptr;  ///< returns whether to go on
    void* context = nullptr;
    std::int64_t count = 0;  ///< instances to integrate, the first ones; 0: all
    myriad::schedule schedule = myriad::schedule::automatic;
    /// Called while what a function of the model has thrown is handled, once at most; may be null.
    void (*caught)(void* failure) = nullptr;
    void* failure = nullptr;
};

/// How a run used its lanes.
struct run_statistics {
    std::int64_t lane_turns = 0;  ///< trial steps times lanes, those of idle lanes included; 0: not counted
    int lanes = 1;                ///< instances side by side in one pack, or CUDA threads in a block
    int threads = 1;                   ///< that have worked
    const char* instruction_set = "";  ///< of the CPU's kernel
    bool computed_as_written = true;   ///< else the kernel's file was compiled so that nothing was integrated: core/ieee.hpp
    bool failed = false;               ///< since a function of the model has thrown
    std::size_t stack = 0;             ///< bytes that the kernel needs of a thread's stack,
    std::size_t least_stack = 0;       ///< and that a thread has; if fewer, nothing was integrated
};

/// How many components of each kind a model has. In the names of its kernels, so that host code that was compiled with another
/// model of the same name finds none.
template <class Model>
using component_counts = std::integer_sequence<int, n_state<Model>, n_parameter<Model>, n_shared<Model>, n_shared_integer<Model>,
                                               n_accessory<Model>, n_integer_accessory<Model>, n_event<Model>>;

/// What MYRIAD_INSTANTIATE defines beside the kernels, and not weakly, so that linkers refuse a program with two models of one
/// name, of which the kernels of one would run for both.
template <class Backend, class Model, class Method, class R>
void instantiated_in_one_file_alone();

// Everything below is weak, so that a program that names a method nobody instantiated, or a backend it was built without,
// gets a readable error instead of one by the linker.
namespace openmp {

/// The kernel for one instruction set. A program may hold several (MYRIAD_ARCH as a list), of which host code chooses
/// one by the CPU it runs on: cpu_kernel.hpp.
#define MYRIAD_DECLARE_KERNEL(set)                                                                                    \
    template <class Model, class Method, class R, class Counts = component_counts<Model>>                             \
    __attribute__((weak)) run_statistics run_on(for_set<instruction_set::set>, const kernel_arguments<Model, R>&, \
                                                const run_options&);
MYRIAD_DECLARE_KERNEL(avx512)
MYRIAD_DECLARE_KERNEL(avx2)
MYRIAD_DECLARE_KERNEL(sse2)
MYRIAD_DECLARE_KERNEL(generic)
#undef MYRIAD_DECLARE_KERNEL

}  // namespace openmp

namespace cuda {

/// A CUDA kernel and how it is launched.
struct kernel_facts {
    int block_size = 0;             ///< of the last launch; before it, what fills a multiprocessor best
    int registers = 0;              ///< per thread
    std::int64_t local_bytes = 0;   ///< per thread: stack frame and spilled registers
    std::int64_t shared_bytes = 0;  ///< of shared memory per block
    myriad::shared_placement shared_placement = myriad::shared_placement::constant_bank;
    myriad::schedule schedule = myriad::schedule::in_order;  ///< of the last call of `integrate`
    int blocks_per_multiprocessor = 0;  ///< that run at the same time, of the size that fills it best
};

struct engine_options {
    int device = 0;
    std::int64_t block_size = 0;
    myriad::shared_placement shared_placement = myriad::shared_placement::automatic;
    myriad::schedule schedule = myriad::schedule::automatic;

    bool operator==(const engine_options&) const = default;
};

/// Whether instances have a past: what they need to go on is copied, or is known to be zero.
enum class past { none, kept };

/// Work on a device that other work may wait for.
class work {
public:
    virtual ~work() = default;
    /// A mark, as the backend has them, that is reached when all that was asked for so far is done.
    virtual void* mark() = 0;

protected:
    work() = default;
    work(const work&) = delete;
    work& operator=(const work&) = delete;
};

/// One chunk of an ensemble on one CUDA device, with its memory and its stream. All but the constructor, `wait`, and uploads
/// of host memory that is not pinned, return before the work is done; work is done in the order in which it was asked for.
/// What is downloaded is on the host after the next `wait`, not before. One thread at a time uses an engine, but `idle` and
/// `affordable` may be called by another meanwhile.
/// Arguments are the host's, for the whole ensemble; `first` and `count` say which of its instances are meant. Errors of
/// the device, those of earlier work too, are thrown as `error`.
template <class Model, class R>
class engine : public work {
public:
    /// Takes the memory for chunks of `count` instances; larger ones take more when they come.
    virtual void reserve(const kernel_arguments<Model, R>& host, std::int64_t count) = 0;
    /// Copies the chunk to the device.
    virtual void upload(const kernel_arguments<Model, R>& host, std::int64_t first, std::int64_t count,
                        past of_instances = past::kept) = 0;
    /// Integrates the chunk that was uploaded last, with the options of `host`, which must have asked for the same arrays.
    virtual void integrate(const kernel_arguments<Model, R>& host) = 0;
    /// Copies what kernels write back to where it was uploaded from, and the records of the last call to `host.record`.
    /// Components for which `wanted(kind, component)` is false are left out.
    virtual void download(const kernel_arguments<Model, R>& host,
                          bool (*wanted)(void*, array_kind, std::int64_t) = nullptr, void* context = nullptr) = 0;
    virtual void wait() = 0;
    /// Work asked of this engine from now on begins when all that was asked of the other before is done.
    virtual void wait_for(work& other) = 0;
    /// Whether everything is done.
    virtual bool idle() = 0;
    /// Seconds that the device took for the last `integrate`; waits for it.
    virtual double kernel_seconds() = 0;
    /// The same as two times on a clock that some engine of the device has started.
    struct interval {
        double begin, end;
    };
    virtual interval kernel_interval(void* clock) = 0;
    virtual void* start_clock() = 0;
    virtual kernel_facts facts() const = 0;
    /// Instances that the device works on at the same time.
    virtual std::int64_t full_load() const = 0;
    /// Instances of an ensemble for which the device has memory left, when it holds `bytes` for each.
    virtual std::int64_t affordable(std::int64_t bytes) const = 0;

    /// Gives device memory back, if it is more than a small part of all that the device has. Nothing may be under way.
    virtual void rest() = 0;
};

/// The engine for a model, method and real type. Throws `error` if the device does not exist or cannot run the kernel.
template <class Model, class Method, class R, class Counts = component_counts<Model>>
__attribute__((weak)) std::unique_ptr<engine<Model, R>> make_engine(const engine_options& options);

/// A device of this machine.
struct device_facts {
    std::string name;
    std::int64_t memory = 0;  ///< bytes
    int multiprocessors = 0;
    int capability = 0;  ///< 90 for 9.0
};
/// The CUDA devices there are; none: `why_none` says why.
__attribute__((weak)) std::vector<device_facts> list_devices(std::string& why_none);

}  // namespace cuda
}  // namespace myriad
