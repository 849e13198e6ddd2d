// SPDX-License-Identifier: MIT
// Kuramoto's oscillators, each of which sees the others a time tau ago, by one thread of a GPU and by teams: M. K. S.
// Yeung, S. H. Strogatz, Phys. Rev. Lett. 82 (1999) 648.
#pragma once

#include <myriad/coupled_units.hpp>
#include <myriad/model.hpp>

namespace gpu_ensembles {

/// By so many threads; 0: as many as the library chooses.
template <int threads>
struct delayed_phase {
    static constexpr int threads_per_instance = threads;
    enum unit_state { theta, n_unit_state };
    enum unit_parameter { omega, n_unit_parameter };
    enum parameter { K, tau, n_parameter };
    enum unit_delayed { theta_before, n_unit_delayed };
    enum publication { sine, cosine, n_publication };
    static constexpr myriad::coupling couplings[] = {myriad::full_coupling(sine), myriad::same_coupling(cosine, 0)};

    MYRIAD_FUNCTION static int delayed_state(int) { return theta; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto& p) {
        return p[tau];
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_publication> publish(int, auto, const auto&, const auto& p) {
        return {myriad::sin(p.unit_delayed[theta_before]), myriad::cos(p.unit_delayed[theta_before])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int, auto, const auto& y, const auto& p) {
        return myriad::vec<R, n_unit_state>{
            p.unit_parameter[omega] +
            p[K] * (myriad::cos(y[theta]) * y.coupled(sine) - myriad::sin(y[theta]) * y.coupled(cosine))};
    }
};
template <int units, int threads>
using delayed_phases = myriad::coupled_units<delayed_phase<threads>, units>;

}  // namespace gpu_ensembles
