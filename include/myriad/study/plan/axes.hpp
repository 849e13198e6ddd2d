// SPDX-License-Identifier: MIT
// The axes of a study: which values the components of each instance have. Any part of the instances can be filled by
// itself, and nothing is stored for each of them. Host code only.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/study/axis_rule.hpp"
#include "myriad/study/plan/component_names.hpp"

namespace myriad {

/// The values along one axis: made by `linspace`, `geomspace`, `values`, `uniform` or `normal`.
class axis_values {
public:
    /// The kinds of values; the last two are random.
    enum class kind {
        linear,       ///< evenly spaced
        logarithmic,  ///< with a constant ratio
        list,         ///< as given
        uniform,      ///< random, evenly distributed
        normal,       ///< random, normally distributed
    };

    /// How the values were made.
    axis_values::kind which() const { return kind_; }
    /// Whether every instance has a random value of its own, so that there is no length.
    bool random() const { return kind_ == kind::uniform || kind_ == kind::normal; }
    /// The number of values; 1 for random ones.
    std::int64_t size() const { return size_; }
    /// The first value, the lower bound or the mean; 0 for a list.
    double first() const { return first_; }
    /// The last value, the upper bound or the standard deviation; 0 for a list.
    double last() const { return last_; }
    /// Value i of `size()`; not for random ones.
    double operator[](std::int64_t i) const;
    /// The values given one by one.
    const std::vector<double>& listed() const { return list_; }
    /// The same for kernels, with a stride of 1; used by the library. A list must outlive it.
    detail::axis_rule rule() const;

private:
    friend class axes;
    friend axis_values linspace(double, double, std::int64_t);
    friend axis_values geomspace(double, double, std::int64_t);
    friend axis_values values(std::vector<double>);
    friend axis_values uniform(double, double);
    friend axis_values normal(double, double);
    axis_values(axis_values::kind kind, double first, double last, std::int64_t size, std::vector<double> list = {});

    axis_values::kind kind_;
    double first_, last_;
    std::int64_t size_;
    std::vector<double> list_;
    double first_log_ = 0, log_step_ = 0;
};

/// `size` evenly spaced values from `first` to `last`, both included, as numpy.linspace; a single one is `first`.
/// Throws `error` unless both are finite and `size` is positive.
[[nodiscard]] axis_values linspace(double first, double last, std::int64_t size);
/// `size` values from `first` to `last`, both included, with a constant ratio between neighbours, as numpy.geomspace.
/// Throws `error` unless both are finite and of one sign, not zero, and `size` is positive.
[[nodiscard]] axis_values geomspace(double first, double last, std::int64_t size);
/// These values. Throws `error` if there is none, or one that is not finite.
[[nodiscard]] axis_values values(std::vector<double> list);
/// A random value for each instance, evenly distributed between two bounds: see `axes::seed`. Throws `error` unless
/// both are finite.
[[nodiscard]] axis_values uniform(double from, double to);
/// A random value for each instance, normally distributed. Throws `error` unless both are finite and the deviation is
/// positive.
[[nodiscard]] axis_values normal(double mean, double standard_deviation);

/// The axes of a study, in the order in which they were given: the last one varies fastest. Components that no axis
/// changes may have a value for all instances.
class axes {
public:
    /// A component that a study sets, along an axis or to one value.
    struct entry {
        studies::component what;            ///< the component
        axis_values values;                 ///< its values
        std::optional<int> dimension = {};  ///< along which they vary; none: random, or one for all
    };
    /// A dimension of the grid of instances.
    struct dimension {
        std::string name;         ///< as results call it: "k", "x_start", or for paired ones "x_start_v_start"
        std::int64_t length;      ///< the number of its values
        std::int64_t stride = 1;  ///< instances from one value to the next
    };

    /// No axes of a model with these components.
    explicit axes(studies::component_names names) : names_(std::move(names)) {}

    /// An axis, or a random value in each instance. Throws `error` if there is no such component, if it has been given,
    /// if integers are wanted and these are not, or if there are too many instances to be numbered.
    void add(std::string_view component, axis_values values);
    /// Paired components, which vary together along one axis. Throws `error` as `add`, and unless they have equally
    /// many values, none of them random.
    void zip(const std::vector<std::pair<std::string, axis_values>>& paired);
    /// `count` instances for each point of the other axes, as for random draws: a dimension without a coordinate.
    /// Throws `error` unless `count` is positive.
    void repeat(std::int64_t count, std::string_view name = "draw");
    /// A value for all instances; may be given again. Throws `error` if it is not finite (t_end may be infinite), if
    /// there is no such component, or if it has an axis.
    void set(std::string_view component, double value);
    /// The seed of random values, 0 unless it is set. A value depends on it, on the component and on the instance's
    /// number alone, and on no random number that a model's hooks draw with the same seed.
    void seed(std::uint64_t seed) { seed_ = seed; }
    std::uint64_t seed() const { return seed_; }

    /// The number of instances: the product of all dimensions.
    std::int64_t size() const { return size_; }
    /// The dimensions, the slowest first.
    const std::vector<axes::dimension>& dimensions() const { return dimensions_; }
    /// What is set, in the order in which it was given.
    const std::vector<entry>& entries() const { return entries_; }
    /// The components they are about.
    const studies::component_names& names() const { return names_; }

    /// The values of an entry in instances [first, first + count), rounded to the type of `to`.
    void fill(const entry& e, std::int64_t first, std::int64_t count, double* to) const;
    void fill(const entry& e, std::int64_t first, std::int64_t count, float* to) const;
    void fill(const entry& e, std::int64_t first, std::int64_t count, std::int32_t* to) const;
    /// The same values for kernels; used by the library. The axes must outlive it.
    detail::axis_rule rule(const entry& e) const;

private:
    const studies::component& find_free(std::string_view name) const;
    void add_dimension(std::string name, std::int64_t length);
    template <class T>
    void fill_with(const entry& e, std::int64_t first, std::int64_t count, T* to) const;

    studies::component_names names_;
    std::vector<entry> entries_;
    std::vector<axes::dimension> dimensions_;
    std::int64_t size_ = 1;
    std::uint64_t seed_ = 0;
};

}  // namespace myriad
