// SPDX-License-Identifier: MIT
// Reductions to one number: extrema, means, moments, sums.
#include "myriad/study/plan/reduction.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "myriad/host/core/error.hpp"
#include "myriad/kernel/study/reduced_values.hpp"
#include "myriad/study/plan/exact_sum.hpp"
#include "reduced_values.hpp"

namespace myriad {

namespace {

using studies::exact_sum;

class extremum_state final : public reduction_state {
public:
    /// `sign`: 1 for the largest value, -1 for the smallest.
    extremum_state(std::string of, std::int64_t size, double sign)
        : of_(std::move(of)), sign_(sign), most_(static_cast<std::size_t>(size), none) {}

    void add(const chunk_columns& chunk) override {
        for_each_value(chunk, of_, [this](std::size_t j, double value) {
            if (std::isfinite(value)) add(j, sign_ * value);
        });
    }
    void add(std::span<const double> partial) override {
        for (std::size_t j = 0; j < most_.size(); ++j) add(j, partial[j]);
    }
    void add_words(std::span<const std::int64_t> words) override {
        for (std::size_t j = 0; j < most_.size(); ++j)
            if (words[j] != 0) add(j, detail::number_of_ordered(static_cast<std::uint64_t>(words[j])));
    }
    std::vector<double> partial() override { return most_; }
    std::vector<std::vector<double>> results() override {
        std::vector<double> found(most_);
        for (double& value : found) value = value == none ? std::numeric_limits<double>::quiet_NaN() : sign_ * value;
        return {found};
    }

private:
    /// Of zeros too, the order of the values must not decide.
    void add(std::size_t j, double value) {
        if (detail::ordered(value) > detail::ordered(most_[j])) most_[j] = value;
    }

    static constexpr double none = -std::numeric_limits<double>::infinity();
    std::string of_;
    double sign_;
    std::vector<double> most_;
};

/// Sums of several numbers, each exact.
class sums {
public:
    static constexpr std::size_t stored = exact_sum::digits;

    explicit sums(std::int64_t size) : sum_(static_cast<std::size_t>(size)) {}
    std::size_t size() const { return sum_.size(); }
    exact_sum& operator[](std::size_t j) { return sum_[j]; }
    void add(std::span<const double> partial) {
        std::int64_t digits[stored];
        for (std::size_t j = 0; j < size(); ++j) {
            for (std::size_t i = 0; i < stored; ++i) digits[i] = static_cast<std::int64_t>(partial[j * stored + i]);
            sum_[j].add(digits);
        }
    }
    /// As doubles, which have the digits of 32 bits exactly.
    void store(std::vector<double>& to) {
        std::int64_t digits[stored];
        for (exact_sum& s : sum_) {
            s.store(digits);
            to.insert(to.end(), std::begin(digits), std::end(digits));
        }
    }

private:
    std::vector<exact_sum> sum_;
};

class mean_state final : public reduction_state {
public:
    mean_state(std::string of, std::int64_t size)
        : of_(std::move(of)), sum_(size), count_(static_cast<std::size_t>(size)) {}

    void add(const chunk_columns& chunk) override {
        for_each_value(chunk, of_, [this](std::size_t j, double value) {
            if (!std::isfinite(value)) return;
            sum_[j].add(value);
            ++count_[j];
        });
    }
    void add(std::span<const double> partial) override {
        sum_.add(partial);
        const auto counts = partial.last(count_.size());
        for (std::size_t j = 0; j < count_.size(); ++j) count_[j] += counts[j];
    }
    void add_words(std::span<const std::int64_t> words) override {
        for (std::size_t j = 0; j < count_.size(); ++j) {
            const auto of_sum = words.subspan(j * (sums::stored + 1), sums::stored + 1);
            sum_[j].add(of_sum.first<sums::stored>());
            count_[j] += static_cast<double>(of_sum.back());
        }
    }
    std::vector<double> partial() override {
        std::vector<double> all;
        sum_.store(all);
        all.insert(all.end(), count_.begin(), count_.end());
        return all;
    }
    std::vector<std::vector<double>> results() override {
        std::vector<double> mean(count_.size());
        for (std::size_t j = 0; j < mean.size(); ++j) {
            mean[j] = sum_[j].value() / count_[j];
            // The sum may be too large for a double, and the mean is not: a count has less than 64 bits.
            if (std::isinf(mean[j])) mean[j] = std::ldexp(sum_[j].value(-64) / count_[j], 64);
        }
        return {mean};
    }

private:
    std::string of_;
    sums sum_;
    std::vector<double> count_;
};

/// The sum of the products of deviations of n pairs from the means, of the sums of the first and of the second numbers
/// and of their products; NaN of less than two pairs. That from the rounded means a and b is exact,
/// S12 - a S2 - b S1 + n a b, and rounded once.
double deviations(const exact_sum& first, const exact_sum& second, const exact_sum& products, double n) {
    if (n < 2) return std::numeric_limits<double>::quiet_NaN();
    const auto add_product = [](exact_sum& to, double a, double b) {
        const double product = a * b;
        to.add(product);
        to.add(std::fma(a, b, -product));
    };
    exact_sum all = products;
    const auto subtract = [&](double mean, exact_sum rest) {
        for (double part = rest.value(); part != 0; part = rest.value()) {
            add_product(all, -mean, part);
            rest.add(-part);
        }
    };
    const auto beyond = [&](exact_sum sum, double mean) {  // n times what the mean was rounded by
        add_product(sum, -n, mean);
        return sum.value();
    };
    const double a = first.value() / n, b = second.value() / n;
    subtract(a, second);
    subtract(b, first);
    const double product = a * b;
    add_product(all, n, product);
    add_product(all, n, std::fma(a, b, -product));
    return all.value() - beyond(first, a) * (beyond(second, b) / n);
}

/// Sums of numbers and of their squares.
class moments_state final : public reduction_state {
public:
    moments_state(std::string of, std::int64_t size, bool of_mean)
        : of_(std::move(of)), of_mean_(of_mean), sum_(size), squares_(size), count_(static_cast<std::size_t>(size)),
          squared_(count_) {}

    void add(const chunk_columns& chunk) override {
        for_each_value(chunk, of_, [this](std::size_t j, double value) {
            if (!std::isfinite(value)) return;
            sum_[j].add(value);
            ++count_[j];
            const detail::exact_square square = detail::square_of(value);
            if (!square.is_known) return;
            squares_[j].add(square.rounded);
            squares_[j].add(square.rest);
            ++squared_[j];
        });
    }
    void add(std::span<const double> partial) override {
        const std::size_t n = count_.size();
        sum_.add(partial.first(n * sums::stored));
        squares_.add(partial.subspan(n * sums::stored, n * sums::stored));
        const auto counts = partial.last(2 * n);
        for (std::size_t j = 0; j < n; ++j) {
            count_[j] += counts[j];
            squared_[j] += counts[n + j];
        }
    }
    void add_words(std::span<const std::int64_t> words) override {
        constexpr std::size_t of_sum = sums::stored + 1;
        for (std::size_t j = 0; j < count_.size(); ++j) {
            const auto values = words.subspan(j * of_sum, of_sum),
                       squares = words.subspan((count_.size() + j) * of_sum, of_sum);
            sum_[j].add(values.first<sums::stored>());
            squares_[j].add(squares.first<sums::stored>());
            count_[j] += static_cast<double>(values.back());
            squared_[j] += static_cast<double>(squares.back());
        }
    }
    std::vector<double> partial() override {
        std::vector<double> all;
        sum_.store(all);
        squares_.store(all);
        all.insert(all.end(), count_.begin(), count_.end());
        all.insert(all.end(), squared_.begin(), squared_.end());
        return all;
    }
    std::vector<std::vector<double>> results() override {
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        std::vector<double> found(count_.size());
        for (std::size_t j = 0; j < found.size(); ++j) {
            const bool is_known = squared_[j] == count_[j];
            const double variance =
                is_known ? std::fmax(deviations(sum_[j], sum_[j], squares_[j], count_[j]), 0) / (count_[j] - 1) : none;
            found[j] = of_mean_ ? std::sqrt(variance / count_[j]) : variance;
        }
        return {found};
    }

private:
    std::string of_;
    bool of_mean_;
    sums sum_, squares_;
    std::vector<double> count_, squared_;
};

/// Sums of numbers, of others and of their products.
class covariance_state final : public reduction_state {
public:
    covariance_state(std::string of, std::string other, std::int64_t size)
        : of_(std::move(of)), other_(std::move(other)), first_(size), second_(size), products_(size),
          count_(static_cast<std::size_t>(size)), multiplied_(count_) {}

    void add(const chunk_columns& chunk) override {
        std::vector<double> others;
        for_each_value(chunk, other_, [&](std::size_t, double value) { others.push_back(value); });
        std::size_t at = 0;
        for_each_value(chunk, of_, [&](std::size_t j, double value) {
            const double other = others[at++];
            if (!std::isfinite(value) || !std::isfinite(other)) return;
            first_[j].add(value);
            second_[j].add(other);
            ++count_[j];
            if (!detail::square_of(value).is_known || !detail::square_of(other).is_known) return;
            const double product = value * other;
            products_[j].add(product);
            products_[j].add(std::fma(value, other, -product));
            ++multiplied_[j];
        });
    }
    void add(std::span<const double> partial) override {
        const std::size_t n = count_.size(), of_sums = n * sums::stored;
        first_.add(partial.first(of_sums));
        second_.add(partial.subspan(of_sums, of_sums));
        products_.add(partial.subspan(2 * of_sums, of_sums));
        const auto counts = partial.last(2 * n);
        for (std::size_t j = 0; j < n; ++j) {
            count_[j] += counts[j];
            multiplied_[j] += counts[n + j];
        }
    }
    std::vector<double> partial() override {
        std::vector<double> all;
        for (sums* const each : {&first_, &second_, &products_}) each->store(all);
        all.insert(all.end(), count_.begin(), count_.end());
        all.insert(all.end(), multiplied_.begin(), multiplied_.end());
        return all;
    }
    std::vector<std::vector<double>> results() override {
        std::vector<double> found(count_.size(), std::numeric_limits<double>::quiet_NaN());
        for (std::size_t j = 0; j < found.size(); ++j)
            if (multiplied_[j] == count_[j])
                found[j] = deviations(first_[j], second_[j], products_[j], count_[j]) / (count_[j] - 1);
        return {found};
    }

private:
    std::string of_, other_;
    sums first_, second_, products_;
    std::vector<double> count_, multiplied_;
};

using user_function = std::function<void(const chunk_columns&, std::span<double>)>;

class user_state final : public reduction_state {
public:
    user_state(user_function function, std::int64_t size) : function_(std::move(function)), sum_(size) {}

    void add(const chunk_columns& chunk) override {
        std::vector<double> of_chunk(sum_.size());
        function_(chunk, of_chunk);
        for (std::size_t j = 0; j < of_chunk.size(); ++j) {
            require(std::isfinite(of_chunk[j]), "a reduction's function gave ", of_chunk[j], " for instances ",
                    chunk.first(), " to ", chunk.first() + chunk.size() - 1, ": it has to leave such values out");
            sum_[j].add(of_chunk[j]);
        }
    }
    void add(std::span<const double> partial) override { sum_.add(partial); }
    std::vector<double> partial() override {
        std::vector<double> all;
        sum_.store(all);
        return all;
    }
    std::vector<std::vector<double>> results() override {
        std::vector<double> values;
        for (std::size_t j = 0; j < sum_.size(); ++j) values.push_back(sum_[j].value());
        return {values};
    }

private:
    user_function function_;
    sums sum_;
};

/// A reduction with one result that has the inner dimensions of what it reduces.
template <class State, class... More>
ensemble_reduction one_value(std::string_view of, const char* what, std::int64_t partial_values,
                             detail::reduction_kind on_device, More... more) {
    studies::reduction_definition made;
    made.name = message(of, '_', what);
    made.inputs = {std::string(of)};
    made.description = message(what, " of ", of);
    made.plan = [=, name = made.name, description = made.description, of = std::string(of)](const inputs& in) {
        const std::int64_t size = in[0]->values_per_item();
        return reduction_plan{size * partial_values,
                              {result(name, element::f64, in[0]->inner, {{"long_name", description}})},
                              {},
                              [=] { return std::make_unique<State>(of, size, more...); },
                              cuda::device_reduction{on_device}};
    };
    return ensemble_reduction(std::move(made));
}

}  // namespace

ensemble_reduction minimum_of(std::string_view of) {
    return one_value<extremum_state>(of, "minimum", 1, detail::reduction_kind::minimum, -1.0);
}
ensemble_reduction maximum_of(std::string_view of) {
    return one_value<extremum_state>(of, "maximum", 1, detail::reduction_kind::maximum, 1.0);
}
ensemble_reduction mean_of(std::string_view of) {
    return one_value<mean_state>(of, "mean", exact_sum::digits + 1, detail::reduction_kind::sum);
}

ensemble_reduction variance_of(std::string_view of) {
    return one_value<moments_state>(of, "variance", 2 * (exact_sum::digits + 1), detail::reduction_kind::moments,
                                    false);
}
ensemble_reduction standard_error_of(std::string_view of) {
    return one_value<moments_state>(of, "standard_error", 2 * (exact_sum::digits + 1), detail::reduction_kind::moments,
                                    true);
}

ensemble_reduction covariance_of(std::string_view of, std::string_view other) {
    studies::reduction_definition made;
    made.name = message(of, '_', other, "_covariance");
    made.inputs = {std::string(of), std::string(other)};
    made.description = message("covariance of ", of, " and ", other);
    made.plan = [name = made.name, names = made.inputs, description = made.description](const inputs& in) {
        require(in[0]->inner == in[1]->inner, "a covariance is asked for of ", names[0], " and ", names[1],
                ", which have different shapes: give two last values, or two of the same phases or samples");
        const std::int64_t size = in[0]->values_per_item();
        return reduction_plan{size * (3 * exact_sum::digits + 2),
                              {result(name, element::f64, in[0]->inner, {{"long_name", description}})},
                              {},
                              [=] { return std::make_unique<covariance_state>(names[0], names[1], size); }};
    };
    return ensemble_reduction(std::move(made));
}

ensemble_reduction sum_of(std::string name, std::vector<std::string> of, std::int64_t size, user_function function) {
    require(!name.empty(), "a reduction needs a name");
    require(size > 0, "the reduction ", name, " has ", size, " sums (must be positive)");
    require(function != nullptr, "the reduction ", name, " has no function");
    studies::reduction_definition made;
    made.name = name;
    made.inputs = std::move(of);
    made.description = message("sum of a function of ", made.inputs.size(), " variables, ", size, " numbers");
    made.plan = [name, size, function = std::move(function)](const inputs&) {
        std::vector<studies::dimension> inner;
        if (size > 1) inner.push_back({name + "_number", size});
        return reduction_plan{
            size * exact_sum::digits, {result(name, element::f64, inner, {{"long_name", "sum of " + name}})}, {}, [=] {
                return std::make_unique<user_state>(function, size);
            }};
    };
    return ensemble_reduction(std::move(made));
}

}  // namespace myriad
