// expect: use of deleted function|call to deleted member function|attempt to use a deleted function
// SPDX-License-Identifier: MIT
// A map of records does not outlive their report.
#include "myriad/myriad.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(p[k] * y[x])};
    }
};

myriad::ensemble<decay> made() { return myriad::ensemble<decay>(10); }

double largest(myriad::ensemble<decay>& sweep) {
    const auto x = myriad::solve<myriad::cash_karp>(myriad::device::cpu(), sweep).records.state(decay::x);
    return x.maxCoeff() + sweep.state(decay::x)[0];
}
