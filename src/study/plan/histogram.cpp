// SPDX-License-Identifier: MIT
// Reductions by histograms: counts in bins, and quantiles.
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "myriad/host/core/error.hpp"
#include "myriad/kernel/study/reduced_values.hpp"
#include "myriad/study/plan/reduction.hpp"
#include "reduced_values.hpp"

namespace myriad {

namespace {

/// The bins of one or more histograms, which share them.
struct histogram_bins {
    std::vector<double> edges;

    std::size_t count() const { return edges.size() - 1; }
    /// What a histogram has: bins, and three places for what is in none.
    std::size_t places() const { return count() + 3; }
    std::size_t place_of(double value) const {
        return static_cast<std::size_t>(
            detail::place_in_histogram(value, edges.data(), static_cast<std::int64_t>(count())));
    }
};

/// What results are made of: the counts of a histogram.
using counts = std::span<const double>;

/// The number below which a share `q` of the finite values lies, if those in a bin are spread over it evenly.
double quantile_in(const histogram_bins& bins, counts of_places, double q) {
    const double below = of_places[bins.count()], above = of_places[bins.count() + 1];
    double inside = 0;
    for (const double n : of_places.first(bins.count())) inside += n;
    const double wanted = q * (below + inside + above);
    double found = below;
    if (inside == 0 || wanted < below || wanted > below + inside) return std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0;; ++i) {  // ends where all that is inside is counted
        const double n = of_places[i];
        if (n > 0 && found + n >= wanted)
            return bins.edges[i] + (bins.edges[i + 1] - bins.edges[i]) * ((wanted - found) / n);
        found += n;
    }
}

/// Histograms of all values, or one for each inner value, and what is made of them.
class histogram_state final : public reduction_state {
public:
    using make_results = std::function<std::vector<std::vector<double>>(const histogram_bins&, counts all)>;

    histogram_state(std::string of, histogram_bins bins, std::int64_t histograms, make_results make)
        : of_(std::move(of)), bins_(std::move(bins)), make_(std::move(make)),
          count_(static_cast<std::size_t>(histograms) * bins_.places()) {}

    void add(const chunk_columns& chunk) override {
        const bool is_one = count_.size() == bins_.places();
        for_each_value(chunk, of_, [&](std::size_t j, double value) {
            ++count_[(is_one ? 0 : j) * bins_.places() + bins_.place_of(value)];
        });
    }
    void add(std::span<const double> partial) override {
        for (std::size_t i = 0; i < count_.size(); ++i) count_[i] += partial[i];
    }
    void add_words(std::span<const std::int64_t> words) override {
        for (std::size_t i = 0; i < count_.size(); ++i) count_[i] += static_cast<double>(words[i]);
    }
    std::vector<double> partial() override { return count_; }
    std::vector<std::vector<double>> results() override { return make_(bins_, count_); }

private:
    std::string of_;
    histogram_bins bins_;
    make_results make_;
    std::vector<double> count_;  // exact up to 2^53
};

/// The bins of a histogram, if there are any.
histogram_bins bins_between(std::string_view of, const axis_values& edges) {
    require(!edges.random() && edges.size() >= 2, "a histogram of ", of, " needs two or more edges of bins");
    histogram_bins all;
    for (std::int64_t i = 0; i < edges.size(); ++i) {
        all.edges.push_back(edges[i]);
        if (i == 0) continue;
        const double last = edges[i - 1];
        require(last < edges[i], "the edges of the bins of a histogram of ", of, " do not increase: ", last,
                " is followed by ", edges[i]);
    }
    return all;
}
std::string exact_texts(std::span<const double> all) {
    std::string text;
    for (const double value : all) text += message(' ', studies::exact_text(value));
    return text;
}

/// Whether values of all phases or samples are in one histogram.
enum class histograms : std::uint8_t { one, of_each };

/// The counts, and how many values are outside: results that are called `name` and `outside`.
ensemble_reduction counts_in(const std::string& of, const histogram_bins& bins, histograms which,
                             const std::string& name, const std::string& outside, const std::string& dimension_prefix) {
    studies::reduction_definition made;
    made.name = name;
    made.inputs = {of};
    made.description = message(which == histograms::one ? "histogram of " : "histograms of each of ", of, ", edges",
                               exact_texts(bins.edges));
    made.plan = [=](const inputs& in) {
        std::vector<double> middles;
        for (std::size_t i = 1; i < bins.edges.size(); ++i)
            middles.push_back(0.5 * bins.edges[i - 1] + 0.5 * bins.edges[i]);
        const std::string bin = dimension_prefix + "_bin";
        std::vector<studies::dimension> in_bins, in_no_bin;
        if (which == histograms::of_each) in_bins = in_no_bin = in[0]->inner;
        in_bins.push_back({bin, static_cast<std::int64_t>(bins.count())});
        in_no_bin.push_back({dimension_prefix + "_side", 3});
        const std::int64_t number = which == histograms::one ? 1 : in[0]->values_per_item();
        const auto divided = [](const histogram_bins& by, counts all) {
            std::vector<double> inside, none;
            for (std::size_t at = 0; at < all.size(); at += by.places()) {
                const counts one = all.subspan(at, by.places());
                const auto after_bins = one.begin() + static_cast<std::ptrdiff_t>(by.count());
                inside.insert(inside.end(), one.begin(), after_bins);
                none.insert(none.end(), after_bins, one.end());
            }
            return std::vector{inside, none};
        };
        return reduction_plan{
            number * static_cast<std::int64_t>(bins.places()),
            {result(name, element::i64, in_bins,
                    {{"long_name", "number of values of " + of + " in each bin"}, {"edges", bins.edges}}),
             result(outside, element::i64, in_no_bin,
                    {{"long_name", "number of values of " + of + " in no bin"},
                     {"comment",
                      "how many values are below the first edge, above the last one, and not finite or "
                      "missing"}})},
            {studies::with_values(bin, bin, middles, {{"long_name", "middle of the bin"}})},
            [=] { return std::make_unique<histogram_state>(of, bins, number, divided); },
            cuda::device_reduction{
                which == histograms::one ? detail::reduction_kind::histogram : detail::reduction_kind::histograms,
                bins.edges}};
    };
    return ensemble_reduction(std::move(made));
}

}  // namespace

ensemble_reduction histogram_of(std::string_view variable, const axis_values& edges) {
    const std::string of(variable);
    return counts_in(of, bins_between(of, edges), histograms::one, of + "_histogram", of + "_outside", of);
}
ensemble_reduction histograms_of(std::string_view variable, const axis_values& edges) {
    const std::string of(variable), name = of + "_histograms";
    return counts_in(of, bins_between(of, edges), histograms::of_each, name, name + "_outside", name);
}
ensemble_reduction quantiles_of(std::string_view variable, std::vector<double> quantiles, const axis_values& edges) {
    const std::string of(variable);
    const histogram_bins bins = bins_between(of, edges);
    require(!quantiles.empty(), "quantiles of ", of, " are asked for, but none is given: give numbers from 0 to 1");
    for (const double q : quantiles)
        require(q >= 0 && q <= 1, "a quantile of ", of, " is ", q, " (must be from 0 to 1): 0.5 is the median");
    studies::reduction_definition made;
    made.name = of + "_quantiles";
    made.inputs = {of};
    made.description = message("quantiles", exact_texts(quantiles), " of ", of, ", edges", exact_texts(bins.edges));
    made.plan = [=, name = made.name](const inputs& in) {
        const std::string dimension = of + "_quantile";
        std::vector<studies::dimension> inner{{dimension, static_cast<std::int64_t>(quantiles.size())}};
        inner.insert(inner.end(), in[0]->inner.begin(), in[0]->inner.end());
        const std::int64_t number = in[0]->values_per_item();
        const auto found = [quantiles](const histogram_bins& by, counts all) {
            std::vector<double> values;
            for (const double q : quantiles)
                for (std::size_t at = 0; at < all.size(); at += by.places())
                    values.push_back(quantile_in(by, all.subspan(at, by.places()), q));
            return std::vector<std::vector<double>>{values};
        };
        return reduction_plan{
            number * static_cast<std::int64_t>(bins.places()),
            {result(name, element::f64, inner,
                    {{"long_name", "quantiles of " + of}, {"comment", "by a histogram"}, {"edges", bins.edges}})},
            {studies::with_values(dimension, dimension, quantiles, {{"long_name", "share of instances below"}})},
            [=] { return std::make_unique<histogram_state>(of, bins, number, found); },
            cuda::device_reduction{detail::reduction_kind::histograms, bins.edges}};
    };
    return ensemble_reduction(std::move(made));
}

}  // namespace myriad
