// SPDX-License-Identifier: MIT
// The factors of a stiff method's matrix for an interpreted model: sparse as its Jacobian, or dense.
#pragma once

// clang-format off
#include "tape_vectors.hpp"  // before the kernel body
// clang-format on

#include "myriad/python/kernel_library.hpp"

namespace myriad::python {

/// The factors of a stiff method's matrix: as the kernel of a model that is compiled would have them.
template <class S>
class tape_factors {
    static constexpr extent n_state = tape_extent::state;
    static_assert(largest_dense_matrix == detail::largest_matrix_in_registers<double> &&
                  most_matrix_updates == detail::most_updates);
    using dense_factors = detail::lu_factors<S, n_state>;
    using R = real_of<S>;

public:
    tape_factors()
        : of_(current_tape->matrix), n_(current_tape->length.state), a_(static_cast<std::size_t>(of_.factor_entries)),
          sizes_(static_cast<std::size_t>(is_dense() ? 0 : n_)), dense_(1) {
        if (is_dense()) ::new (static_cast<void*>(dense_.data())) dense_factors;
    }
    tape_factors(const tape_factors&) = delete;
    tape_factors& operator=(const tape_factors&) = delete;
    ~tape_factors() {
        if (is_dense()) dense_[0].~dense_factors();
    }

    /// Factorises shift I - J. Returns false in lanes where that is singular.
    template <class Model>
    mask_of<S> factorise(const S& t, const S& shift, const vec<S, n_state>& y, const inputs<Model, S>& p) {
        if constexpr (detail::has_delays<Model>) detail::recall<Model>(t, y, p);
        return is_dense() ? factorise_dense<Model>(t, shift, y, p) : factorise_sparse<Model>(t, shift, y, p);
    }
    void solve(vec<S, n_state>& b) const {
        if (is_dense()) return detail::solve_factorised(dense_[0], b);
        for (int s = 0; s < n_; ++s) {
            const S x = b[of_.pivot[s]];
            for (int l = of_.lower_begin[s]; l < of_.lower_begin[s + 1]; ++l) {
                S& other = b[of_.lower_row[l]];
                other = fma(-a_[of_.lower_entry[l]], x, other);
            }
        }
        for (int s = n_ - 1; s >= 0; --s) {
            const int row = of_.pivot[s];
            S x = b[row];
            for (int u = of_.upper_begin[s]; u < of_.upper_begin[s + 1]; ++u)
                x = fma(-a_[of_.upper_entry[u]], b[of_.upper_column[u]], x);
            b[row] = x * a_[of_.diagonal[row]];
        }
    }

private:
    bool is_dense() const { return of_.factor_entries == 0; }

    template <class Model>
    mask_of<S> factorise_dense(const S& t, const S& shift, const vec<S, n_state>& y, const inputs<Model, S>& p) {
        auto& a = dense_[0].a;
        if (of_.entries == 0) {
            detail::dual_jacobian<Model>(t, y, p, a);
        } else {
            each_entry<Model>(t, y, p, [&](int e, const S& derivative) { a[of_.row[e]][of_.column[e]] = derivative; });
        }
        for (int i = 0; i < n_; ++i) {
            for (int j = 0; j < n_; ++j) a[i][j] = -a[i][j];
            a[i][i] = shift + a[i][i];
        }
        return detail::factorise(dense_[0]);
    }
    template <class Model>
    mask_of<S> factorise_sparse(const S& t, const S& shift, const vec<S, n_state>& y, const inputs<Model, S>& p) {
        for (int e = 0; e < of_.factor_entries; ++e) a_[e] = S(R(0));
        for (int i = 0; i < n_; ++i) {
            a_[of_.diagonal[i]] = shift;
            sizes_[i] = abs(shift);
        }
        each_entry<Model>(t, y, p, [&](int e, const S& derivative) {
            S& place = a_[of_.position[e]];
            place = place - derivative;
            const int row = of_.pivot_row[e];
            if (row >= 0) sizes_[row] = sizes_[row] + abs(derivative);
        });
        mask_of<S> regular = mask_of<S>(true);
        for (int s = 0; s < n_; ++s) {
            const int row = of_.pivot[s];
            S& pivot = a_[of_.diagonal[row]];
            const S size = abs(pivot), inverse = reciprocal(pivot);
            regular = regular & (size > S(detail::least_pivot<R>) * sizes_[row]) & (abs(inverse) > S(R(0)));
            pivot = inverse;
            for (int l = of_.lower_begin[s]; l < of_.lower_begin[s + 1]; ++l) {
                const S multiplier = a_[of_.lower_entry[l]] * inverse;
                a_[of_.lower_entry[l]] = multiplier;
                for (int u = of_.upper_begin[s]; u < of_.upper_begin[s + 1]; ++u) {
                    const int update = of_.first_update[l] + u, row_of_pivot = of_.target_row[update];
                    S& target = a_[of_.target[update]];
                    const S right = a_[of_.upper_entry[u]];
                    target = fma(-multiplier, right, target);
                    if (row_of_pivot >= 0)
                        sizes_[row_of_pivot] = fma(abs(multiplier), abs(right), sizes_[row_of_pivot]);
                }
            }
        }
        return regular;
    }
    /// Calls put(e, derivative) for the entries of the Jacobian: by the tape's function, or by dual numbers, one
    /// evaluation of the right-hand side for each group of columns.
    template <class Model, class Put>
    void each_entry(const S& t, const vec<S, n_state>& y, const inputs<Model, S>& p, Put&& put) {
        if (!current_tape->jacobian.empty()) {
            tape_array<S> found(static_cast<std::size_t>(of_.entries));
            Model::derivatives(t, y, p, found.data());
            for (int e = 0; e < of_.entries; ++e) put(e, found[e]);
            return;
        }
        for (int g = 0; g < of_.groups; ++g) {
            auto seeded = detail::constants<dual<S>>(y);
            for (int j = 0; j < n_; ++j) seeded[j].derivative = S(of_.group_of_column[j] == g ? R(1) : R(0));
            const auto columns = detail::directional_derivative<Model>(dual<S>(t), seeded, p);
            for (int k = of_.begin[g]; k < of_.begin[g + 1]; ++k)
                put(of_.in_group[k], columns[of_.row[of_.in_group[k]]]);
        }
    }

    const tape_matrix& of_;
    int n_;
    tape_array<S> a_, sizes_;  // of each pivot's row: the sum of the sizes of the terms that add up to the pivot
    tape_array<dense_factors> dense_;
};

}  // namespace myriad::python

namespace myriad::detail {

template <class Model, class S>
requires(python::is_name<n_state<Model>>) struct stage_factors_of<Model, S> {
    using type = python::tape_factors<S>;
};

}  // namespace myriad::detail
