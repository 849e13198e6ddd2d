// SPDX-License-Identifier: MIT
// Solves the model and compares with exp(-k t); exit status 1 if it is wrong.
#include <cmath>
#include <cstdio>

#include <myriad/myriad.hpp>

#include "decay.hpp"

#if !defined(MYRIAD_HAS_OPENMP)
#error "myriad::openmp must tell its users that it is there"
#endif

int main() {
    myriad::ensemble<decay> ensemble(100);
    ensemble.parameter(decay::k) = Eigen::ArrayXd::LinSpaced(ensemble.size(), 0.5, 1.5);
    ensemble.state(decay::x) = 1.0;
    ensemble.time_domain(0.0, 2.0);
    myriad::solve<myriad::cash_karp>(myriad::device::best(), ensemble, {.relative_tolerance = 1e-9});

    double largest_error = 0.0;
    for (Eigen::Index i = 0; i < ensemble.size(); ++i) {
        const double exact = std::exp(-2.0 * ensemble.parameter(decay::k)[i]);
        // Written so that NaN counts as an error.
        if (!(std::abs(ensemble.state(decay::x)[i] - exact) <= largest_error))
            largest_error = std::abs(ensemble.state(decay::x)[i] - exact);
    }
    std::printf("largest error %.1e\n", largest_error);
    return largest_error < 1e-7 ? 0 : 1;
}
