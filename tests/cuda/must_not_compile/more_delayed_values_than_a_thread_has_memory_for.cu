// expect: so many delayed values take more memory than a thread of a GPU has
// SPDX-License-Identifier: MIT
// Units that see each of the others after a time of their own, by a method that teams do not have.
#include <myriad/coupled_units.hpp>
#include <myriad/instantiate.hpp>
#include <myriad/model.hpp>

struct listener {
    static constexpr int units = 80;
    enum unit_state { x, n_unit_state };
    enum unit_shared { n_unit_shared = units };
    enum unit_delayed { n_unit_delayed = units };

    MYRIAD_FUNCTION static int delayed_state(int) { return x; }
    MYRIAD_FUNCTION static int delayed_unit(int, int delayed) { return delayed; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, int delayed, const auto& p) {
        return R(p.unit_shared[delayed]);
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(int, auto, const auto& y, const auto& p) {
        return myriad::vec<R, 1>{p.unit_delayed[0] - y[x]};
    }
};
using listeners = myriad::coupled_units<listener, listener::units>;

MYRIAD_INSTANTIATE(listeners, myriad::rodas_5p)
