// SPDX-License-Identifier: MIT
// A model with products of the transposed derivatives of its right-hand side, as kernel/adjoint/transposed_step.hpp
// asks for, by all of its states and parameters: the right-hand side is called with derivatives that are recorded. The
// quantities of which there is an adjoint are the states.
#pragma once

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/lane.hpp"
#include "myriad/openmp/recorded.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model>
struct transposed_model : Model {
    static constexpr int n = detail::n_state<Model>, n_wrt = detail::n_parameter<Model>, n_quantity = n;
    static constexpr int n_action = 0, between_jumps = -1;

    template <class S>
    static vec<S, n + n_wrt> transposed_rhs(const S& t, const vec<S, n>& y, const inputs<transposed_model, S>& p,
                                            const vec<S, n>& v) {
        return product<S>(t, y, p, v);
    }
    template <class S>
    static vec<S, n + n_wrt> transposed_slope(const S& t, const vec<S, n>& y, const inputs<transposed_model, S>& p,
                                              const vec<S, n>& u, const S& tau, const vec<S, n>& v) {
        using D = dual<S>;  // along (u, tau): the derivative of the product with the first derivatives
        vec<D, n> moving, weights;
        for (int c = 0; c < n; ++c) {
            moving[c] = D(y[c], u[c]);
            weights[c] = D(v[c]);
        }
        const auto both = product<D>(D(t, tau), moving, p, weights);
        vec<S, n + n_wrt> found;
        for (int c = 0; c < n + n_wrt; ++c) found[c] = both[c].derivative;
        return found;
    }
    template <class S>
    static vec<S, n> quantities(const S&, const vec<S, n>& y, const inputs<transposed_model, S>&) {
        return y;
    }
    template <class S>
    static vec<S, n + n_wrt> transposed_quantities(const S&, const vec<S, n>&, const inputs<transposed_model, S>&,
                                                   const vec<S, n>& v) {
        vec<S, n + n_wrt> found = {};
        for (int c = 0; c < n; ++c) found[c] = v[c];
        return found;
    }

private:
    /// (df/dz)^T v in numbers N, of which parameters have no derivative. z: the state, and then the parameters.
    template <class N, class S>
    MYRIAD_LARGE_FUNCTION static vec<N, n + n_wrt> product(const N& t, const vec<N, n>& y,
                                                           const inputs<transposed_model, S>& p, const vec<N, n>& v) {
        using D = dual<N, recorded<N>>;
        static thread_local derivative_list<N> list;
        list.begin(n + n_wrt);
        const auto argument = [&](const N& value, int number) { return D(value, recorded<N>{&list, {number}}); };
        vec<D, n> state;
        for (int c = 0; c < n; ++c) state[c] = argument(y[c], c);
        inputs<transposed_model, D> all{};
        for (int i = 0; i < n_wrt; ++i) all.parameter[i] = argument(N(p.parameter[i]), n + i);
        all.shared = p.shared.values;
        all.shared_integer = p.shared_integer.values;
        const auto slope = Model::template rhs<D>(D(t), state, all);
        for (int c = 0; c < n; ++c) {
            const recorded<N>& its = slope[c].derivative;
            if (!its.is_zero()) list.result_by(its.at) = list.result_by(its.at) + v[c];
        }
        list.transpose();
        vec<N, n + n_wrt> found;
        for (int c = 0; c < n + n_wrt; ++c) found[c] = list.result_by({c});
        return found;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
