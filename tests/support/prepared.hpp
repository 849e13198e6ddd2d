// SPDX-License-Identifier: MIT
// The arguments of a call, for tests that run kernels and engines by themselves, without the checks of `solve`.
#pragma once

#include <myriad/myriad.hpp>

namespace tests {

template <class Method, class Model, class R>
class prepared {
public:
    prepared(myriad::ensemble<Model, R>& e, const myriad::options& o)
        : call_(myriad::host::ensemble_access::data(e), myriad::host::ensemble_access::samples(e), records_, o,
                myriad::detail::facts_of<Model, Method, R>) {}
    myriad::detail::any_arguments<R>& arguments() { return call_.arguments; }
    /// The columns of samples, one of each state.
    std::int16_t* sample_columns() {
        return call_.template array<std::int16_t>(call_.arguments.offsets().sample_column);
    }

private:
    myriad::host::record_data<R> records_;
    myriad::host::prepared_call<R> call_;
};
template <class Method, class Model, class R>
prepared<Method, Model, R> prepare(myriad::ensemble<Model, R>& e, const myriad::options& o) {
    return {e, o};
}

}  // namespace tests
