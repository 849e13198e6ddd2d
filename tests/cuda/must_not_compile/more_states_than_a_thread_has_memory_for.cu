// expect: a step of this method with so many states takes more than the 512 KiB of local memory
// SPDX-License-Identifier: MIT
// A dense matrix that no thread of a GPU has room for.
#include <myriad/instantiate.hpp>
#include <myriad/model.hpp>

struct all_of_all {
    enum state { n_state = 260 };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        R sum(0.0);
        for (int i = 0; i < n_state; ++i) sum += y[i];
        myriad::vec<R, n_state> f;
        for (int i = 0; i < n_state; ++i) f[i] = sum - y[i];
        return f;
    }
};

MYRIAD_INSTANTIATE(all_of_all, myriad::rodas_5p)
