// SPDX-License-Identifier: MIT
// The epidemic's peak in closed form, and the comparison of a sample with it. Host code.
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>
#include <myriad/random.hpp>

/// s + i - log(s) / R0 is constant, so that the peak, where s = 1 / R0, follows from the initial values; it grows with
/// R0. Without growth, R0 s <= 1, the peak is at the start.
inline double exact_peak(double R0, double s, double i) { return R0 * s > 1 ? s + i - (1 + std::log(R0 * s)) / R0 : i; }

/// The distribution of the peak for a normal R0.
struct peak_distribution {
    double R0_mean, R0_deviation, s, i;

    double at(double z) const { return exact_peak(R0_mean + R0_deviation * z, s, i); }
    double quantile(double p) const { return at(myriad::normal_quantile(p)); }

    /// The mean of (peak - centre)^power, by the trapezoidal rule over eight standard deviations; the probability
    /// beyond is 1e-15.
    double moment(int power, double centre) const {
        constexpr int parts = 16'000;
        constexpr double reach = 8, h = 2 * reach / parts;
        double sum = 0;
        for (int k = 0; k <= parts; ++k) {
            const double z = -reach + k * h;
            sum += std::exp(-z * z / 2) * std::pow(at(z) - centre, power);
        }
        return sum * h / std::sqrt(2 * std::acos(-1.0));
    }
};

/// An estimate, its expectation, and its standard deviation in samples of this size.
struct estimate {
    double found, expected, error;
    double deviation() const { return (found - expected) / error; }
};

inline estimate mean_of(const Eigen::ArrayXd& peaks, const peak_distribution& exact) {
    const double mean = exact.moment(1, 0);
    return {peaks.mean(), mean, std::sqrt(exact.moment(2, mean) / static_cast<double>(peaks.size()))};
}
inline estimate variance_of(const Eigen::ArrayXd& peaks, const peak_distribution& exact) {
    const double mean = exact.moment(1, 0), variance = exact.moment(2, mean);
    return {(peaks - mean).square().mean(), variance,
            std::sqrt((exact.moment(4, mean) - variance * variance) / static_cast<double>(peaks.size()))};
}
/// The fraction of peaks below the exact quantile, which is binomial.
inline estimate share_below(const Eigen::ArrayXd& peaks, const peak_distribution& exact, double p) {
    const auto n = static_cast<double>(peaks.size());
    return {static_cast<double>((peaks < exact.quantile(p)).count()) / n, p, std::sqrt(p * (1 - p) / n)};
}
