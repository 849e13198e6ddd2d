// SPDX-License-Identifier: MIT
// The entries of a model's Jacobian that may differ from zero: declared in the model, or found when it is compiled by
// calling its right-hand side with numbers that record what they depend on.
#pragma once

#include <cstdint>
#include <type_traits>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/lane.hpp"
#include "myriad/kernel/scalar/dependence.hpp"

namespace myriad {

/// An entry of the Jacobian that may differ from zero, df_row/dy_column, from enumerators of `state` or their numbers:
/// `static constexpr myriad::jacobian_entry jacobian_pattern[] = {{x, x}, {x, v}, {v, x}};`
struct jacobian_entry {
    int row;     ///< number of the state whose slope depends on the other
    int column;  ///< number of the state on which it depends
};

}  // namespace myriad

namespace myriad::detail {

/// The model without the tangents that it may have.
template <class Model>
struct without_tangents_of {
    using type = Model;
};
template <class Model>
requires(n_tangent<Model> > 0) struct without_tangents_of<Model> {
    using type = typename Model::original;
};
template <class Model>
using original_of = typename without_tangents_of<Model>::type;

/// Whether a model declares its Jacobian's pattern. One that a model with tangents inherits is for the states without
/// tangents, and does not count.
template <class Model>
constexpr bool declares_jacobian_pattern() {
    return requires { Model::jacobian_pattern; }
    &&n_tangent<Model> == 0;
}
template <class Model>
constexpr int n_declared_entry_of() {
    if constexpr (declares_jacobian_pattern<Model>()) {
        return length_of_array<decltype(Model::jacobian_pattern[0]), sizeof(Model::jacobian_pattern)>;
    } else {
        return 0;
    }
}
/// Number of entries that a model declares.
template <class Model>
inline constexpr int n_declared_entry = n_declared_entry_of<Model>();
template <class Model>
inline constexpr bool has_jacobian_pattern = n_declared_entry<Model> > 0;

/// A set of numbers below n, as bits.
template <int n>
struct number_set {
    static constexpr int words = (n + 63) / 64;
    std::uint64_t bits[words]{};

    constexpr void insert(int i) { bits[i / 64] |= std::uint64_t(1) << (i % 64); }
    constexpr void erase(int i) { bits[i / 64] &= ~(std::uint64_t(1) << (i % 64)); }
    constexpr bool contains(int i) const { return (bits[i / 64] >> (i % 64)) & 1; }
    constexpr void insert(const number_set& other) {
        for (int w = 0; w < words; ++w) bits[w] |= other.bits[w];
    }
    constexpr void erase(const number_set& other) {
        for (int w = 0; w < words; ++w) bits[w] &= ~other.bits[w];
    }
    constexpr bool meets(const number_set& other) const {
        for (int w = 0; w < words; ++w)
            if ((bits[w] & other.bits[w]) != 0) return true;
        return false;
    }
    constexpr int size() const {
        int count = 0;
        for (int w = 0; w < words; ++w) {
            // Knuth, The Art of Computer Programming 4A, 7.1.3, eq. (62)
            std::uint64_t x = bits[w];
            x -= (x >> 1) & 0x5555555555555555u;
            x = (x & 0x3333333333333333u) + ((x >> 2) & 0x3333333333333333u);
            x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fu;
            count += static_cast<int>((x * 0x0101010101010101u) >> 56);
        }
        return count;
    }
};

}  // namespace myriad::detail

namespace myriad::detail::inline MYRIAD_TARGET {

/// Largest system whose right-hand side is evaluated when it is compiled.
inline constexpr int largest_traced_system = 256;

/// What each slope depends on, the states and as number n the time, and about how many instructions they all take.
/// What is computed from inputs alone does not count.
template <class Model>
struct slope_dependences {
    number_set<n_state<Model> + 1> of_slope[n_state<Model>];
    int instructions = 0;
};

/// Inputs that a model is evaluated with for what its functions depend on: none depends on the state. Integers have no
/// value, so that a function that reads one is no constant expression.
template <class Model, class S>
struct traced_inputs : inputs<Model, S> {
    constexpr traced_inputs() {
        for (int i = 0; i < n_parameter<Model>; ++i) this->parameter[i] = S();
        this->shared = of_shared_;
        this->shared_integer = nullptr;
        if constexpr (n_accessory < Model >> 0 && !accessories_are_outputs<Model>)
            for (int i = 0; i < n_accessory<Model>; ++i) this->accessory[i] = S();
    }
    traced_inputs(const traced_inputs&) = delete;  // `shared` points into this one
    traced_inputs& operator=(const traced_inputs&) = delete;

private:
    S of_shared_[n_shared<Model> > 0 ? n_shared<Model> : 1]{};
};

template <class Model>
constexpr slope_dependences<Model> trace_slopes() {
    constexpr int n = n_state<Model>;
    using S = dependence<n + 1>;
    const traced_inputs<Model, S> traced;
    const inputs<Model, S>& p = traced;
    vec<S, n> y;
    slope_dependences<Model> found;
    const auto variable = [&](int i) MYRIAD_LAMBDA {
        S itself = S::of(i);
        itself.work = &found.instructions;
        return itself;
    };
    for (int i = 0; i < n; ++i) y[i] = variable(i);
    const vec<S, n> slopes = Model::template rhs<S>(variable(n), y, p);
    for (int i = 0; i < n; ++i)
        for (int w = 0; w < S::words; ++w) found.of_slope[i].bits[w] = slopes[i].on[w];
    return found;
}

/// Whether a right-hand side can be evaluated without any values. One that branches on its state, as a model that is
/// declared `scalar_only` does, might not even compile with dependences; tangents would need the dependences of
/// derivatives.
template <class Model>
constexpr bool is_traceable() {
    if constexpr (scalar_only<Model> || n_tangent<Model> != 0 || n_state < Model >> largest_traced_system) {
        return false;
    } else {
        return requires { typename std::bool_constant<(trace_slopes<Model>(), true)>; };
    }
}
template <class Model>
inline constexpr bool traceable = is_traceable<Model>();
template <class Model>
requires traceable<Model>
inline constexpr slope_dependences<Model> slope_dependences_of = trace_slopes<Model>();

template <class Model>
constexpr bool may_depend_on_time() {
    if constexpr (n_tangent < Model >> 0) {
        return may_depend_on_time<original_of<Model>>();
    } else if constexpr (autonomous<Model>) {
        return false;
    } else if constexpr (traceable<Model>) {
        for (const auto& slope : slope_dependences_of<Model>.of_slope)
            if (slope.contains(n_state<Model>)) return true;
        return false;
    } else {
        return true;
    }
}
/// Whether the right-hand side may depend on t: it does not if the model is declared, or found, autonomous.
template <class Model>
inline constexpr bool depends_on_time = has_delays<Model> || may_depend_on_time<Model>();

/// Where a Jacobian's pattern is from.
enum class pattern_origin { none, declared, found };
template <class Model>
constexpr pattern_origin origin_of_pattern() {
    if constexpr (n_tangent < Model >> 0) {
        return origin_of_pattern<original_of<Model>>();
    } else if constexpr (has_jacobian_pattern<Model>) {
        return pattern_origin::declared;
    } else {
        return traceable<Model> ? pattern_origin::found : pattern_origin::none;
    }
}

template <class Model>
constexpr int n_jacobian_entry_of() {
    if constexpr (n_tangent < Model >> 0) {
        return n_jacobian_entry_of<original_of<Model>>() * (1 + 2 * (n_tangent<Model> / Model::n_original));
    } else if constexpr (origin_of_pattern<Model>() == pattern_origin::found) {
        int count = 0;
        for (const auto& slope : slope_dependences_of<Model>.of_slope)
            for (int j = 0; j < n_state<Model>; ++j) count += slope.contains(j) ? 1 : 0;
        return count;
    } else {
        return n_declared_entry<Model>;
    }
}
/// Number of entries of the Jacobian that may differ from zero; zero if it is not known.
template <class Model>
inline constexpr int n_jacobian_entry = n_jacobian_entry_of<Model>();

/// These entries: as declared, or row by row. With tangents, v' = J v for each of them, the original model's J stands
/// once for the states and once for each tangent, and a slope of a tangent depends on the states on which the slope of
/// its component does.
template <class Model>
struct jacobian_entries {
    jacobian_entry entry[n_jacobian_entry<Model>]{};

    constexpr jacobian_entries() {
        int e = 0;
        if constexpr (n_tangent < Model >> 0) {
            constexpr int n = Model::n_original;
            const jacobian_entries<original_of<Model>> original;  // for nvcc, whose temporary would be gone
            for (const jacobian_entry& own : original.entry) {
                entry[e++] = own;
                for (int v = 1; v <= n_tangent<Model> / n; ++v) {
                    entry[e++] = {v * n + own.row, own.column};
                    entry[e++] = {v * n + own.row, v * n + own.column};
                }
            }
        } else if constexpr (has_jacobian_pattern<Model>) {
            for (const jacobian_entry& declared : Model::jacobian_pattern) entry[e++] = declared;
        } else {
            for (int i = 0; i < n_state<Model>; ++i)
                for (int j = 0; j < n_state<Model>; ++j)
                    if (slope_dependences_of<Model>.of_slope[i].contains(j)) entry[e++] = {i, j};
        }
    }
    constexpr const jacobian_entry& operator[](int e) const { return entry[e]; }
};
template <class Model>
inline constexpr jacobian_entries<Model> jacobian_entries_of{};

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::detail {

/// The entries of a pattern, and the columns in groups without a common row, so that one evaluation of rhs with dual
/// numbers gives all columns of a group (Curtis, Powell and Reid, IMA J. Appl. Math. 13, 1974, 117): each column joins
/// the first group that it fits.
template <int n, int entries>
struct jacobian_groups {
    int count = 0;
    int group_of_column[n]{};
    int row[entries]{}, column[entries]{};          // of each entry
    int begin[n + 1]{}, entry_of_group[entries]{};  // the entries of each group

    template <class Entries>
    constexpr explicit jacobian_groups(const Entries& given) {
        number_set<n> rows[n]{}, taken[n]{};
        for (int e = 0; e < entries; ++e) rows[given[e].column].insert(given[e].row);
        for (int j = 0; j < n; ++j) {
            int g = 0;
            while (rows[j].meets(taken[g])) ++g;
            group_of_column[j] = g;
            taken[g].insert(rows[j]);
            if (g >= count) count = g + 1;
        }
        for (int e = 0; e < entries; ++e) {
            row[e] = given[e].row;
            column[e] = given[e].column;
        }
        for (int g = 0; g < count; ++g) {
            begin[g + 1] = begin[g];
            for (int e = 0; e < entries; ++e)
                if (group_of_column[column[e]] == g) entry_of_group[begin[g + 1]++] = e;
        }
    }
};

template <class Model>
inline constexpr jacobian_groups<n_state<Model>, n_jacobian_entry<Model>> jacobian_groups_of{
    jacobian_entries_of<Model>};

}  // namespace myriad::detail
