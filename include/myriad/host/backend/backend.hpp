// SPDX-License-Identifier: MIT
// The interface between host code and backends: the few functions that a backend provides for a model, a method and a
// real type, declared here and defined where the model is instantiated. Host programs include no backend.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "myriad/host/backend/arrays.hpp"
#include "myriad/host/backend/cpu_backend.hpp"
#include "myriad/host/backend/facts.hpp"
#include "myriad/host/core/weak.hpp"
#include "myriad/host/options/schedule.hpp"
#include "myriad/kernel/core/stop_request.hpp"
#include "myriad/kernel/study/axis_rule.hpp"
#include "myriad/kernel/study/reduced_values.hpp"

// Weak, as are the functions of the CPU's backend (cpu_backend.hpp).
namespace myriad {
namespace cuda {

struct engine_options {
    int device = 0;
    std::int64_t block_size = 0;
    myriad::shared_placement shared_placement = myriad::shared_placement::automatic;
    myriad::schedule schedule = myriad::schedule::automatic;

    bool operator==(const engine_options&) const = default;
};

/// Whether instances have a past, so that their bookkeeping must be copied, or none, so that it is known to be zero.
enum class past { none, kept };

/// Work on a device, for which other work may wait.
class work {
public:
    virtual ~work() = default;
    /// A backend's event (as in CUDA), reached when all work submitted so far is done.
    virtual void* mark() = 0;

protected:
    work() = default;
    work(const work&) = delete;
    work& operator=(const work&) = delete;
};

/// What is known of an `engine` without its model.
class any_engine : public work {
public:
    virtual void wait() = 0;
    /// Work submitted to this engine from now on begins when all work submitted to the other before is done.
    virtual void wait_for(work& other) = 0;
    /// Whether everything is done.
    virtual bool idle() = 0;
    /// Has the kernels of the last `integrate` stop so far, soon: a later request goes further.
    virtual void stop(detail::stop_request how) = 0;
    /// Seconds that the device took for the last `integrate`; waits for it.
    virtual double kernel_seconds() = 0;
    /// The same as begin and end on a clock that some engine of the device has started.
    struct interval {
        double begin, end;
    };
    virtual interval kernel_interval(void* clock) = 0;
    virtual void* start_clock() = 0;
    virtual kernel_facts facts() const = 0;
    /// Instances that the device works on at the same time.
    virtual std::int64_t full_load() const = 0;
    /// Instances of an ensemble that fit into the device's free memory, at `bytes` each.
    virtual std::int64_t affordable(std::int64_t bytes) const = 0;

    /// Frees device memory if it is more than a small part of the device's. No work may be in progress.
    virtual void rest() = 0;
};

/// How one component of all instances is set on the device: `array` is a pointer of the host's arguments.
struct generated_component {
    const void* array;
    std::int64_t component;
    axis_rule rule;                                                  ///< its table is on the host
    enum class valid { any, finite, not_nan } must_be = valid::any;  ///< otherwise the instance is marked
};
/// How instances are set on the device.
struct generation {
    std::vector<generated_component> components;
    std::uint64_t seed = 0;
    bool calls_model = false;  ///< the model's `generate`, after all components are set
};

/// Values on the device: `inner` components of an array of the host's arguments, or what `rule` gives.
struct device_values {
    const void* array = nullptr;
    std::int64_t component = 0, inner = 1;
    value_type type = value_type::f64;
    const axis_rule* rule = nullptr;  ///< as among the components of `generation`
    std::uint64_t seed = 0;           ///< of the rule
    bool ends_with_phases = false;    ///< a phase that an instance did not do has no value,
    std::int32_t from_phase = 0;      ///< which counts from here
};
/// A reduction over the instances of a chunk that have not failed.
struct device_reduction {
    reduction_kind kind;
    std::vector<double> edges = {};  ///< of histograms
    /// How many integers the result has for so many inner values.
    std::int64_t words(std::int64_t inner) const {
        switch (kind) {
            case reduction_kind::histogram:
                return static_cast<std::int64_t>(edges.size()) + 2;
            case reduction_kind::histograms:
                return inner * (static_cast<std::int64_t>(edges.size()) + 2);
            case reduction_kind::sum:
                return inner * (sum_digits + 1);
            case reduction_kind::moments:
                return 2 * inner * (sum_digits + 1);
            case reduction_kind::statuses:
                return status_count;
            default:
                return inner;
        }
    }
};

/// Where an engine has a value of the host's arrays, and how kernels use it.
struct place_on_device {
    std::byte* address = nullptr;  ///< null if it is not there
    array_access access = array_access::read;
};

/// One chunk of an ensemble on one CUDA device, with its memory and its stream. All but the constructor, `wait`, and
/// uploads of host memory that is not pinned, return before the work is done; work is done in the order of submission.
/// Downloaded data are on the host after the next `wait`, not before. Only one thread at a time may use an engine, but
/// another may call `idle`, `stop` and `affordable` meanwhile. Arguments are the host's, for the whole ensemble;
/// `first` and `count` select the instances. Errors of the device, also from earlier work, are thrown as
/// `error`.
/// It can also set and reduce instances on the device, instead of an upload and a download: the host's arguments then
/// have arrays of fewer instances, which only say which arrays there are; `first` is the number of the first instance
/// from that of the arguments on. All but `generate` wait for the work before.
template <class R>
class engine : public any_engine {
public:
    /// Allocates memory for chunks of `count` instances; larger chunks allocate more when they are uploaded.
    virtual void reserve(const any_arguments<R>& host, std::int64_t count) = 0;
    /// Copies the chunk to the device.
    virtual void upload(const any_arguments<R>& host, std::int64_t first, std::int64_t count,
                        past of_instances = past::kept) = 0;
    /// Integrates the chunk that was uploaded last, with the options of `host`, which must have the same arrays.
    virtual void integrate(const any_arguments<R>& host) = 0;
    /// Copies what kernels write back to where it was uploaded from, and the records of the last call into
    /// `host.record`. Components for which `wanted(kind, component)` is false are left out.
    virtual void download(const any_arguments<R>& host, bool (*wanted)(void*, array_kind, std::int64_t) = nullptr,
                          void* context = nullptr) = 0;

    /// The place of a value of the chunk that was uploaded last, whose components are contiguous on the device.
    virtual place_on_device find(const any_arguments<R>& host, const void* value) = 0;
    /// The stream that work is submitted to, as the backend has it.
    virtual void* native_stream() = 0;

    /// Sets a chunk of instances without a past.
    virtual void generate(const any_arguments<R>& host, std::shared_ptr<const generation> how, std::int64_t first,
                          std::int64_t count) = 0;
    /// Copies values of all instances of the chunk, the instance outermost.
    virtual void fetch(const any_arguments<R>& host, const device_values& what, std::byte* to) = 0;
    /// The result of a reduction.
    virtual std::vector<std::int64_t> reduce(const any_arguments<R>& host, const device_values& what,
                                             const device_reduction& how) = 0;
    /// Copies all arrays of the first `count` instances of the chunk to the host's arrays.
    virtual void fetch_first(const any_arguments<R>& host, std::int64_t count) = 0;
};

/// The engine for a model, method and real type. Throws `error` if the device does not exist or cannot run the kernel.
template <class Model, class Method, class R, class Counts = component_counts<Model>>
__attribute__((weak)) std::unique_ptr<engine<R>> make_engine(const engine_options& options);

/// A device of this machine.
struct device_facts {
    std::string name;
    std::int64_t memory = 0;  ///< bytes
    int multiprocessors = 0;
    int capability = 0;  ///< 90 for 9.0
};
/// The CUDA devices of this machine; if there are none, `why_none` says why.
__attribute__((weak)) std::vector<device_facts> list_devices(std::string& why_none);

}  // namespace cuda
}  // namespace myriad
