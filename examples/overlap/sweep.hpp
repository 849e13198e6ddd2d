// SPDX-License-Identifier: MIT
// The Duffing sweep in chunks: their parameters, their results, and the table of one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <string>

#include <myriad/myriad.hpp>

#include "../common/csv_file.hpp"
#include "../duffing/sweep.hpp"

namespace duffing_sweep {

inline myriad::options integration(std::int64_t phases) {
    return {.phases = phases,
            .relative_tolerance = tolerance,
            .absolute_tolerance = tolerance,
            .events = {{.direction = myriad::direction::falling, .tolerance = event_tolerance},
                       {.tolerance = event_tolerance}},
            .counting = myriad::counting::off,
            .advice = myriad::advice::off};
}

/// Damping of instance i of `instances`, independent of the chunks.
inline double damping(std::int64_t i, std::int64_t instances) {
    return k_first +
           (k_last - k_first) * static_cast<double>(i) / static_cast<double>(std::max<std::int64_t>(instances - 1, 1));
}

/// Sets the first `count` instances of `part` to the sweep's instances first, first + 1, ...
inline void fill(myriad::ensemble<duffing>& part, std::int64_t first, std::int64_t count, std::int64_t instances) {
    part.restart();  // a new chunk, not further phases of the last one
    for (std::int64_t i = 0; i < count; ++i) part.parameter(duffing::k)[i] = damping(first + i, instances);
    part.shared(duffing::B) = forcing;
    part.state(duffing::x).head(count) = x_start;
    part.state(duffing::v).head(count) = v_start;
    part.time_domain(0, 2 * std::numbers::pi);
}

/// The results kept for every instance.
struct results {
    Eigen::ArrayXd x, v, x_global_max;
    Eigen::ArrayXi zeros;

    explicit results(std::int64_t instances) : x(instances), v(instances), x_global_max(instances), zeros(instances) {}
    void take(const myriad::ensemble<duffing>& part, std::int64_t first, std::int64_t count) {
        x.segment(first, count) = part.state(duffing::x).head(count);
        v.segment(first, count) = part.state(duffing::v).head(count);
        x_global_max.segment(first, count) = part.accessory(duffing::x_global_max).head(count);
        zeros.segment(first, count) = part.integer_accessory(duffing::zeros).head(count);
    }
    bool operator==(const results& other) const {
        return (x == other.x).all() && (v == other.v).all() && (x_global_max == other.x_global_max).all() &&
               (zeros == other.zeros).all();
    }
};

/// The table of the sweep's instances first, first + 1, ...
inline void write(const std::string& name, const results& all, std::int64_t first, std::int64_t count) {
    examples::csv_file file(name);
    file.row("instance", "k", "x", "v", "x_global_max", "zeros");
    for (std::int64_t i = first; i < first + count; ++i)
        file.row(i, damping(i, all.x.size()), all.x[i], all.v[i], all.x_global_max[i], all.zeros[i]);
    file.commit();
}

}  // namespace duffing_sweep
