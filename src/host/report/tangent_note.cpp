// SPDX-License-Identifier: MIT
// The note on phases that are too long for the smallest Lyapunov exponent.
#include "myriad/host/report/tangent_note.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "myriad/host/core/error.hpp"

namespace myriad::host::inline MYRIAD_ABI {

namespace {

/// The error of a step relative to the tangents, which have length one at the start of a phase: their tolerance, or, if
/// they take no part in the error test, that of the model's states; with fixed steps, rounding.
template <class R>
double tangent_error(const options& o, const call_facts& facts) {
    const tangent_places& in = facts.tangents;
    const auto rounding = static_cast<double>(std::numeric_limits<R>::epsilon());
    if (!facts.adaptive()) return rounding;
    const auto original = static_cast<std::size_t>(in.n_original),
               all = original * static_cast<std::size_t>(1 + in.n_vectors);
    double error = rounding;
    for (std::size_t c = original; c < all; ++c)
        error = std::max({error, o.relative_tolerance[c], o.absolute_tolerance[c]});
    if (error < 1) return error;
    error = rounding;
    for (std::size_t c = 0; c < original; ++c) error = std::max(error, o.relative_tolerance[c]);
    return error;
}

}  // namespace

template <class R>
void note_exponents(report_of<R>& r, const ensemble_data<R>& e, const options& o, const call_facts& facts) {
    const tangent_places& in = facts.tangents;
    constexpr double limit = 1e-4;
    if (in.n_vectors < 2 || o.advice == advice::off) return;
    const double error = tangent_error<R>(o, facts);
    const std::int64_t size = e.size, stride = std::max<std::int64_t>(size / 1024, 1);
    std::int64_t looked_at = 0, doubtful = 0;
    double worst = 0;
    for (std::int64_t i = 0; i < size; i += stride) {
        if (e.ended.data()[i] != 0) continue;
        const std::int64_t phases = e.phase.data()[i] - e.shared_integer.data()[in.transient_phases];
        if (phases < 1) continue;
        double fastest = -std::numeric_limits<double>::infinity(), slowest = -fastest;
        for (int k = 0; k < in.n_vectors; ++k) {
            const double growth =
                static_cast<double>(e.accessory.component(in.first_growth + k)[i]) / static_cast<double>(phases);
            fastest = std::max(fastest, growth);
            slowest = std::min(slowest, growth);
        }
        const double product = error * std::exp(fastest - slowest);
        ++looked_at;
        if (!(product > limit)) continue;
        ++doubtful;
        worst = std::max(worst, product);
    }
    if (doubtful == 0) return;
    r.notes.push_back(
        statement_of("phases may be too long for the smallest exponent in ", doubtful, " of ", looked_at,
                     " instances looked at: the tangents grow apart so far in one that the error of a step, ", error,
                     ", becomes up to ", worst, " of the slowest (should be below ", limit, ")", cure,
                     "take shorter phases or smaller tolerances, and see whether it changes"));
}

template void note_exponents(report_of<double>&, const ensemble_data<double>&, const options&, const call_facts&);
template void note_exponents(report_of<float>&, const ensemble_data<float>&, const options&, const call_facts&);

}  // namespace myriad::host::inline MYRIAD_ABI
