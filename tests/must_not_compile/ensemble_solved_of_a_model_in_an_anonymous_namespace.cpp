// expect: the model is in an anonymous namespace.*move it out
// SPDX-License-Identifier: MIT
// The file that calls solve reports this too.
#include "myriad/myriad.hpp"

namespace {

struct model {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{-y[0]};
    }
};
}  // namespace

auto run(myriad::ensemble<model>& e) { return myriad::solve<myriad::cash_karp>(myriad::device::cpu(), e); }
