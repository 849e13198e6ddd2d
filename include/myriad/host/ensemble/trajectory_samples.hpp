// SPDX-License-Identifier: MIT
// Host storage of dense output: samples of chosen states along every trajectory, with a fixed capacity per instance.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "myriad/host/core/error.hpp"
#include "myriad/host/core/left_behind.hpp"
#include "myriad/host/ensemble/component_array.hpp"
#include "myriad/host/model/numbering.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad {

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
    trajectory_samples(const sample_options& o, std::int64_t size)
        : size_(size), capacity_(o.capacity), chosen_(o.states), stored_(1, size, 0) {
        for (const int c : o.states) column_[static_cast<std::size_t>(c)] = static_cast<int>(columns_++);
        require(capacity_ <= std::numeric_limits<std::int64_t>::max() / size, "samples.capacity ", capacity_, " times ",
                size, " instances exceeds any memory: take fewer samples");
        const std::int64_t cells = size * capacity_;
        time_ = host::component_array<R>(1, cells, std::numeric_limits<R>::quiet_NaN());
        values_ = host::component_array<R>(static_cast<int>(columns_), cells, std::numeric_limits<R>::quiet_NaN());
    }

    /// The memory they take for an ensemble of that size.
    static double bytes_for(const sample_options& o, std::int64_t size) {
        const auto cells = static_cast<double>(o.capacity) * static_cast<double>(o.states.size() + 1);
        return static_cast<double>(size) * (sizeof(std::int32_t) + sizeof(R) * cells);
    }

    /// The largest number of samples per instance.
    std::int64_t capacity() const { return capacity_; }
    /// Samples stored, per instance; `capacity()` if there may have been more.
    Eigen::Map<const Eigen::Array<std::int32_t, Eigen::Dynamic, 1>> stored() const& { return {stored_.data(), size_}; }
    Eigen::Map<const Eigen::Array<std::int32_t, Eigen::Dynamic, 1>> stored() const&& = delete;
    /// The times of the samples, in the model's unit of time; NaN beyond those stored.
    map time() const& { return map(time_.data(), size_, capacity_); }
    map time() const&& = delete;
    /// State component c at those times; NaN beyond the samples stored. Throws `error` if it was not sampled.
    template <class C>
    map state(C c) const& {
        const std::int64_t number = host::state_numbering<Model>::index(c);
        const int column =
            number >= 0 && number < detail::n_state<Model> ? column_[static_cast<std::size_t>(number)] : -1;
        require(column >= 0, "state ", number, " was not sampled: name it in options::samples.states");
        return map(values_.component(column), size_, capacity_);
    }
    template <class C>
    map state(C) const&& = delete;

    /// Whether no samples were asked for.
    bool empty() const { return capacity_ == 0; }
    /// Whether samples with these options can be appended to the existing ones.
    bool fits(const sample_options& o) const { return o.capacity == capacity_ && o.states == chosen_; }
    /// Forgets all samples, as `ensemble::restart` does.
    void clear() {
        if (empty()) return;
        stored_.fill(0);
        time_.fill(std::numeric_limits<R>::quiet_NaN());
        values_.fill(std::numeric_limits<R>::quiet_NaN());
    }
    /// Pins their memory, for copies from GPUs; used by the library.
    void pin(int device) {
        stored_.pin(device);
        time_.pin(device);
        values_.pin(device);
    }
    /// Passes their memory to a kernel; used by the library.
    void describe(detail::sample_arguments<Model, R>& a) {
        a.time = time_.data();
        a.values = values_.data();
        a.stored = stored_.data();
        a.capacity = static_cast<std::int32_t>(capacity_);
        for (std::size_t c = 0; c < column_.size(); ++c) a.column[c] = static_cast<std::int16_t>(column_[c]);
    }

private:
    static constexpr auto no_columns() {
        std::array<int, static_cast<std::size_t>(detail::n_state<Model>)> columns{};
        for (int& c : columns) c = -1;
        return columns;
    }

    host::moved_number<std::int64_t> size_ = 0, capacity_ = 0;
    std::int64_t columns_ = 0;
    component_list chosen_;
    std::array<int, static_cast<std::size_t>(detail::n_state<Model>)> column_ = no_columns();
    host::component_array<std::int32_t> stored_;
    host::component_array<R> time_, values_;
};

}  // namespace myriad
