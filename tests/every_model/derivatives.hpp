// SPDX-License-Identifier: MIT
// What the Jacobian and its pattern must be for any model: compared with the dense derivatives by dual numbers, at
// random states, parameters and times.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "myriad/kernel/core/table_loop.hpp"
#include "myriad/kernel/methods/rodas_5p.hpp"
#include "myriad/kernel/model/jacobian.hpp"
#include "myriad/kernel/model/jacobian_pattern.hpp"
#include "myriad/kernel/scalar/pack.hpp"
#include "myriad/kernel/stepper/lu.hpp"
#include "myriad/kernel/stepper/rosenbrock.hpp"
#include "myriad/kernel/stepper/sparse_lu.hpp"

namespace every_model {

/// What was found for one model.
struct outcome {
    std::vector<std::string> wrong;
    int samples = 0;  ///< at which all derivatives were finite
    std::string pattern;
};

/// A model, and the function that checks it.
struct check {
    std::string model;
    std::function<outcome()> run;
    bool is_wrong;  ///< on purpose, as the model says
};
inline std::vector<check>& all_checks() {
    static std::vector<check> all;
    return all;
}

namespace detail = myriad::detail;

template <class Model>
class checks {
    static constexpr int n = detail::n_state<Model>;
    using R = double;
    using dense = myriad::matrix<R, n>;

public:
    static bool add(const char* name) {
        static const bool added = (all_checks().push_back({name, &run, is_wrong}), true);
        return added;
    }

private:
    static constexpr bool is_wrong = requires { Model::has_wrong_derivatives; };
    static constexpr bool has_pattern = detail::n_jacobian_entry<Model> > 0;

    static outcome run() {
        outcome found;
        if constexpr (has_pattern) {
            found.pattern = std::to_string(detail::n_jacobian_entry<Model>) + " of " + std::to_string(n * n) +
                            (detail::has_jacobian_pattern<Model> ? " declared" : " found");
            if constexpr (detail::factorises_sparsely<Model>)
                found.pattern += ", " + std::to_string(detail::n_factor_entry<Model>) + " of the factors";
        } else {
            found.pattern = "no pattern";
        }
        std::mt19937 engine(11);
        // Some models are defined near zero alone, others for numbers around one, or for large ones.
        for (const double size : {0.3, 1.0, 30.0})
            for (int sample = 0; sample < 4; ++sample) compare(found, engine, size);
        return found;
    }

    static void compare(outcome& found, std::mt19937& engine, double size) {
        std::uniform_real_distribution<R> number(0.1 * size, size);
        std::uniform_int_distribution<std::int32_t> integer(0, 2);
        const auto p_of = std::make_unique<myriad::inputs<Model, R>>();
        auto& p = *p_of;
        std::vector<R> shared(static_cast<std::size_t>(detail::n_shared<Model>) + 1);
        std::vector<std::int32_t> shared_integer(static_cast<std::size_t>(detail::n_shared_integer<Model>) + 1);
        for (int i = 0; i < detail::n_parameter<Model>; ++i) p.parameter[i] = number(engine);
        for (R& value : shared) value = number(engine);
        for (std::int32_t& value : shared_integer) value = integer(engine);
        p.shared = shared.data();
        p.shared_integer = shared_integer.data();
        if constexpr (!detail::accessories_are_outputs<Model>) {
            for (int i = 0; i < detail::n_accessory<Model>; ++i) p.accessory[i] = number(engine);
            for (int i = 0; i < detail::n_integer_accessory<Model>; ++i) p.integer_accessory[i] = integer(engine);
        }
        myriad::vec<R, n> y;
        for (int i = 0; i < n; ++i) y[i] = number(engine);
        const R t = number(engine);

        const auto by_duals = std::make_unique<dense>(), other = std::make_unique<dense>();
        detail::dual_jacobian<Model>(t, y, p, *by_duals);
        bool finite = true;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) finite = finite && std::isfinite((*by_duals)[i][j]);
        if (!finite) return;
        ++found.samples;
        const auto complain = [&](const char* what, int row, int column, R is, R should_be) {
            found.wrong.push_back(std::string(what) + " has " + std::to_string(is) + " in row " + std::to_string(row) +
                                  ", column " + std::to_string(column) + "; by dual numbers it is " +
                                  std::to_string(should_be));
        };
        const auto same = [&](const char* what, const dense& is, R digits) {
            for (int i = 0; i < n; ++i) {
                R scale = 0;
                for (int j = 0; j < n; ++j) scale = std::max(scale, std::abs((*by_duals)[i][j]));
                for (int j = 0; j < n; ++j)
                    if (!(std::abs(is[i][j] - (*by_duals)[i][j]) <= digits * scale))
                        complain(what, i, j, is[i][j], (*by_duals)[i][j]);
            }
        };
        detail::evaluate_jacobian<Model>(t, y, p, *other);
        same("the Jacobian", *other, 1e-11);
        if constexpr (!detail::depends_on_time<Model>) {
            const auto by_time = detail::time_derivative<Model>(t, y, p);
            for (int i = 0; i < n; ++i)
                if (by_time[i] != 0) complain("an autonomous model's time derivative", i, 0, by_time[i], 0);
        }
        if constexpr (has_pattern) {
            *other = {};
            constexpr auto& entries = detail::jacobian_entries_of<Model>;
            std::vector<bool> may(static_cast<std::size_t>(n * n));
            for (int e = 0; e < detail::n_jacobian_entry<Model>; ++e)
                may[static_cast<std::size_t>(entries[e].row * n + entries[e].column)] = true;
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j)
                    if (!may[static_cast<std::size_t>(i * n + j)] && (*by_duals)[i][j] != 0)
                        complain("the pattern", i, j, 0, (*by_duals)[i][j]);
            detail::for_each_jacobian_entry<Model, detail::table_loop<false>>(
                t, y, p,
                [&](auto e, const R& derivative) { (*other)[entries[e].row][entries[e].column] = derivative; });
            same("the Jacobian by groups of columns", *other, 1e-11);
        }
        if constexpr (detail::factorises_sparsely<Model>) compare_solutions(found, *by_duals, t, y, p);
    }

    /// The sparse factors solve what the dense ones do, in packs, with derivatives that know whether they are zero.
    static void compare_solutions(outcome& found, const dense& jacobian, R t, const myriad::vec<R, n>& at,
                                  const myriad::inputs<Model, R>& inputs) {
        using S = myriad::pack<R, 1>;
        using method = myriad::rodas_5p;
        const auto p_of = std::make_unique<myriad::inputs<Model, S>>();
        auto& p = *p_of;
        for (int i = 0; i < detail::n_parameter<Model>; ++i) p.parameter[i] = S(inputs.parameter[i]);
        if constexpr (!detail::accessories_are_outputs<Model>) {
            for (int i = 0; i < detail::n_accessory<Model>; ++i) p.accessory[i] = S(inputs.accessory[i]);
            for (int i = 0; i < detail::n_integer_accessory<Model>; ++i)
                p.integer_accessory[i] = myriad::integer_of<S>(inputs.integer_accessory[i]);
        }
        p.shared.values = inputs.shared.values;
        p.shared_integer.values = inputs.shared_integer.values;
        myriad::vec<S, n> y, one, other;
        for (int i = 0; i < n; ++i) {
            y[i] = S(at[i]);
            one[i] = other[i] = S(std::sin(i + 1.0));
        }
        R scale = 1;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) scale = std::max(scale, std::abs(jacobian[i][j]));
        const S per_h(3 * scale);  // a step in which the diagonal is large
        const auto sparse = std::make_unique<detail::sparse_lu_factors<Model, S>>();
        const auto full = std::make_unique<detail::lu_factors<S, n>>();
        const bool regular = detail::all(detail::factorise_stage_matrix<method, Model>(S(t), per_h, y, p, *sparse)) &&
                             detail::all(detail::factorise_stage_matrix<method, Model>(S(t), per_h, y, p, *full));
        if (!regular) {
            if constexpr (!detail::has_mass_matrix<Model>) found.wrong.push_back("a matrix is singular");
            return;
        }
        detail::solve_factorised(*sparse, one);
        detail::solve_factorised(*full, other);
        const auto lane = [](const S& x) { return detail::get_lane(x, 0); };
        R largest = 0;
        for (int i = 0; i < n; ++i) largest = std::max(largest, std::abs(lane(other[i])));
        for (int i = 0; i < n; ++i)
            if (!(std::abs(lane(one[i]) - lane(other[i])) <= 1e-9 * largest))
                found.wrong.push_back("the sparse factors give " + std::to_string(lane(one[i])) + " for component " +
                                      std::to_string(i) + " of a solution, the dense ones " +
                                      std::to_string(lane(other[i])));
    }
};

}  // namespace every_model
