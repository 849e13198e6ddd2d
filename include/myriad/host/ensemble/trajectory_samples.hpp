// SPDX-License-Identifier: MIT
// Host storage of dense output: samples of chosen states along every trajectory, with a fixed capacity per instance.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "myriad/host/ensemble/sample_data.hpp"
#include "myriad/host/model/numbering.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/concepts.hpp"

namespace myriad {

namespace host::inline MYRIAD_ABI {
struct ensemble_access;
}

/// Samples of all instances, kept over phases and calls until `ensemble::restart`. The accessors return maps with one
/// row per instance and one column per sample; columns from `stored()(i)` on are NaN in row i. Maps into a temporary
/// are refused.
template <class Model, class R>
class trajectory_samples {
public:
    /// An array of Eigen with one row per instance and one column per sample.
    using map = Eigen::Map<const Eigen::Array<R, Eigen::Dynamic, Eigen::Dynamic>>;

    /// Made by `solve` and `solver`, for `size` instances.
    trajectory_samples() = default;
    trajectory_samples(const sample_options& o, std::int64_t size) : data_(detail::n_state<Model>, o, size) {
        data_.clear();
    }

    /// The largest number of samples per instance.
    std::int64_t capacity() const { return data_.capacity; }
    /// Samples stored, per instance; `capacity()` if there may have been more.
    Eigen::Map<const Eigen::Array<std::int32_t, Eigen::Dynamic, 1>> stored() const& {
        return {data_.stored.data(), data_.size};
    }
    Eigen::Map<const Eigen::Array<std::int32_t, Eigen::Dynamic, 1>> stored() const&& = delete;
    /// The times of the samples, in the model's unit of time; NaN beyond those stored.
    map time() const& { return map(data_.time.data(), data_.size, data_.capacity); }
    map time() const&& = delete;
    /// State component c at those times; NaN beyond the samples stored. Throws `error` if it was not sampled.
    template <class C>
    map state(C c) const& {
        const std::int64_t number = host::state_numbering<Model>::index(c);
        return map(data_.component(number), data_.size, data_.capacity);
    }
    template <class C>
    map state(C) const&& = delete;

    /// Whether no samples were asked for.
    bool empty() const { return data_.capacity == 0; }
    /// Forgets all samples, as `ensemble::restart` does.
    void clear() { data_.clear(); }
    /// Pins their memory, for copies from GPUs; used by the library.
    void pin(int device) { data_.pin(device); }

private:
    friend host::ensemble_access;
    host::sample_data<R> data_;
};

}  // namespace myriad
