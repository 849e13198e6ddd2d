// SPDX-License-Identifier: MIT
// Reductions over the instances of a study: histograms, quantiles, an extremum, a mean, a covariance, or a sum of the
// user's. Host code only.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "myriad/host/backend/backend.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/plan/axes.hpp"
#include "myriad/study/plan/chunk_columns.hpp"
#include "myriad/study/plan/layout.hpp"

namespace myriad {

namespace studies::inline MYRIAD_ABI {

/// A reduction under way: of a chunk, or of the partial results of all chunks in their order.
class reduction_state {
public:
    virtual ~reduction_state() = default;
    virtual void add(const chunk_columns& values) = 0;
    virtual void add(std::span<const double> partial) = 0;
    /// Adds what a device found in a part of the chunk; for reductions that have `on_device`.
    virtual void add_words(std::span<const std::int64_t>) {}
    /// What `add` takes, of a length that depends on the reduction alone.
    virtual std::vector<double> partial() = 0;
    /// The values of each of the `results`.
    virtual std::vector<std::vector<double>> results() = 0;
};

/// What is known of a reduction once it is known what it reduces.
struct reduction_plan {
    std::int64_t partial_size = 0;
    std::vector<variable> results = {};        ///< of the whole study, f64 or i64
    std::vector<coordinate> coordinates = {};  ///< of their inner dimensions
    std::function<std::unique_ptr<reduction_state>()> start = {};
    /// What a device computes of the only input; nothing if the reduction is a function of the user's. Such reductions
    /// may also be divided among threads.
    std::optional<cuda::device_reduction> on_device = {};
};

/// The definition of a reduction.
struct reduction_definition {
    std::string name;                 ///< that its results begin with
    std::vector<std::string> inputs;  ///< names of the variables that it reduces
    std::string description;          ///< all that determines its results
    /// For inputs as they turned out to be.
    std::function<reduction_plan(const std::vector<const variable*>& inputs)> plan;
    std::vector<std::string> over = {};  ///< axes that it reduces; none: all
};

}  // namespace studies::inline MYRIAD_ABI

/// A reduction of a variable over all instances that have not failed (`sum_of`: over all); values that are not finite,
/// or missing as those of phases that an instance did not reach, are left out. Made by the functions below; variables
/// are named as in results: "x" at recorded phases, "x_end", "x_sample". Its result does not depend on chunks, devices
/// or their order, bit for bit.
class ensemble_reduction {
public:
    /// Made by `histogram_of` and its like.
    explicit ensemble_reduction(studies::reduction_definition what)
        : what_(std::make_shared<const studies::reduction_definition>(std::move(what))) {}

    /// The same over the named axes alone, "path" or "k", by names as results have them: one reduction for each point
    /// of the other axes, along which the results are, in front of their own dimensions. It is not known before the
    /// study begins whether there are such axes. Throws `error` if none is named.
    [[nodiscard]] ensemble_reduction over(std::vector<std::string> axes) const;

    /// What it is; used by the library.
    const studies::reduction_definition& definition() const { return *what_; }

private:
    std::shared_ptr<const studies::reduction_definition> what_;
};

/// How many values lie in each bin between neighbouring edges, the upper edge of the last bin included, as
/// numpy.histogram: variable "x_end_histogram" with dimension "x_end_bin"; and "x_end_outside", how many lie below,
/// above, and are not finite or missing. All phases or samples of an instance are counted. Throws `error` unless there
/// are two or more edges, and they increase.
[[nodiscard]] ensemble_reduction histogram_of(std::string_view variable, const axis_values& edges);
/// The same for each phase or sample alone: "x_sample_histograms", with dimensions "sample" and
/// "x_sample_histograms_bin", and "x_sample_histograms_outside".
[[nodiscard]] ensemble_reduction histograms_of(std::string_view variable, const axis_values& edges);
/// Quantiles for each phase or sample, as bands of percentiles over time: variable "x_sample_quantiles", whose first
/// dimension "x_sample_quantile" has the given numbers from 0 to 1. They are found by a histogram, as if the values in
/// a bin were spread over it evenly, and so to the width of a bin; NaN where one lies below the first edge or above the
/// last one. Throws `error` as `histogram_of`, and for other numbers.
[[nodiscard]] ensemble_reduction quantiles_of(std::string_view variable, std::vector<double> quantiles,
                                              const axis_values& edges);
/// The smallest value, for each phase or sample: "x_end_minimum"; NaN if there is none.
[[nodiscard]] ensemble_reduction minimum_of(std::string_view variable);
/// The largest value, for each phase or sample: "x_end_maximum"; NaN if there is none.
[[nodiscard]] ensemble_reduction maximum_of(std::string_view variable);
/// The mean, for each phase or sample: "x_end_mean"; NaN if there is no value. The sum is exact and rounded once.
[[nodiscard]] ensemble_reduction mean_of(std::string_view variable);
/// The variance, for each phase or sample: "x_end_variance", the squares of deviations from the mean over their number
/// less one; NaN of less than two values, or of larger ones than 1e144. Sums are exact, so that it has the same bits
/// whatever the order, and nothing cancels.
[[nodiscard]] ensemble_reduction variance_of(std::string_view variable);
/// The standard error of the mean, for each phase or sample: "x_end_standard_error", the root of the variance over the
/// number of values.
[[nodiscard]] ensemble_reduction standard_error_of(std::string_view variable);
/// The covariance of two variables, for each phase or sample: "x_end_v_end_covariance", the products of deviations from
/// the means over their number less one, of instances where both are finite; NaN of less than two, or of larger ones
/// than 1e144. Sums are exact as those of `variance_of`.
[[nodiscard]] ensemble_reduction covariance_of(std::string_view variable, std::string_view other);
/// The sum of what a function computes of each chunk of instances: a variable `name` of `size` numbers. The function
/// adds to `sums`, which are zero at first, and is called by several threads at a time. It sees all instances: those
/// that failed it leaves out by `chunk.status(i)`, if they are not what it counts. Partial sums are added exactly; what
/// the function itself rounds depends on the chunks. `name` stands for the function in the study's description:
/// give another one when it changes. Of a reduction `over` axes it is called for each run of neighbouring instances of
/// a set. `inputs` are the variables that it asks for.
[[nodiscard]] ensemble_reduction sum_of(
    std::string name, std::vector<std::string> inputs, std::int64_t size,
    std::function<void(const chunk_columns& chunk, std::span<double> sums)> function);

namespace studies::inline MYRIAD_ABI {

/// A reduction of a variable alone, by the name of its function.
struct named_reduction {
    const char* name;
    ensemble_reduction (*make)(std::string_view variable);
};
/// Those that files and the Python package have from here.
inline constexpr named_reduction named_reductions[] = {{"minimum_of", &minimum_of},
                                                       {"maximum_of", &maximum_of},
                                                       {"mean_of", &mean_of},
                                                       {"variance_of", &variance_of},
                                                       {"standard_error_of", &standard_error_of}};

}  // namespace studies::inline MYRIAD_ABI

}  // namespace myriad
