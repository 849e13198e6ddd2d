// SPDX-License-Identifier: MIT
// The checks of the paths of stochastic equations, for both real types.
#include "myriad/host/checks/path_check.hpp"

#include <algorithm>
#include <cmath>

#include "myriad/host/core/error.hpp"

namespace myriad::host::inline MYRIAD_ABI {

template <class R>
double cell_of_paths(const ensemble_data<R>& e, const options& o, bool adaptive) {
    if (o.noise_step > 0) return o.noise_step;
    if (!adaptive) return o.step;
    const double length = o.phase_length > 0
                              ? o.phase_length
                              : std::abs(static_cast<double>(e.common_end) - static_cast<double>(e.common_begin));
    return length > 0 ? length / cells_of_domain : 1;
}

template <class R>
void check_paths(const ensemble_data<R>& e, const options& o, std::int64_t count, bool adaptive) {
    if (!e.shape->has_diffusion) return;
    require(!adaptive || o.noise_step > 0 || o.phase_length > 0 || e.has_common_domain(), named_option("noise_step"),
            " is not set, and instances have domains of their own, so that none of them gives all the longest adaptive "
            "step",
            cure, "give noise_step, the longest step, of which the others are halves, quarters and so on");
    const std::int64_t last = std::int64_t{e.first_index} + std::int64_t{e.size} - 1;
    require(last < most_paths, "instance ", last,
            " has no paths of its own, as those of a stochastic equation are counted "
            "up to ",
            most_paths);
    // Time that is carried from phase to phase is rounded; cells are told apart by it with some bits to spare.
    constexpr bool is_double = sizeof(R) == sizeof(double);
    const bool carries = o.phase_time == phase_time::carry_on || o.phase_length > 0;
    const double most = is_double ? 0x1p36 : carries ? 0x1p18 : 0x1p30;
    const double cell = cell_of_paths(e, o, adaptive);
    for (std::int64_t i = 0; i < (e.has_common_domain() ? std::min<std::int64_t>(count, 1) : count); ++i) {
        double length = std::abs(static_cast<double>(e.t_end_of(i)) - static_cast<double>(e.t_begin_of(i)));
        if (std::isinf(length)) length = o.phase_length * static_cast<double>(e.phase.data()[i] + o.phases);
        if (!(length / cell > most)) continue;
        refuse({"the path of instance ", i, " has ", length / cell, " cells (at most ", most,
                is_double ? "): " : " can be told apart in single precision): ", "give a larger ",
                named_option("noise_step"), " or a shorter domain",
                is_double ? statement() : statement_of(", or ", cures::use_doubles)});
    }
}

template double cell_of_paths(const ensemble_data<double>&, const options&, bool);
template void check_paths(const ensemble_data<double>&, const options&, std::int64_t, bool);
template double cell_of_paths(const ensemble_data<float>&, const options&, bool);
template void check_paths(const ensemble_data<float>&, const options&, std::int64_t, bool);

}  // namespace myriad::host::inline MYRIAD_ABI
