// SPDX-License-Identifier: MIT
// Patterns of Jacobians found in plain right-hand sides when they are compiled: against derivatives by dual numbers,
// and what cannot be found.
#include "myriad/kernel/model/jacobian_pattern.hpp"

#include <cmath>
#include <random>

#include "myriad/kernel/model/jacobian.hpp"
#include "myriad/kernel/model/tables.hpp"
#include "myriad/kernel/stepper/sparse_lu.hpp"
#include "problems/pollution.hpp"
#include "problems/van_der_pol_ring.hpp"
#include "tests/catch.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/sparse.hpp"
#include "tests/support/stiff.hpp"

namespace {

using namespace myriad::detail;
using myriad::inputs;
using myriad::matrix;
using myriad::vec;

/// Whether every derivative by dual numbers that is not zero is in the pattern that was found, at random states; and
/// whether every entry of the pattern is not zero somewhere, unless the model has cancelling terms.
template <class Model>
void compare_with_dual_numbers() {
    static_assert(traceable<Model>);
    constexpr int n = n_state<Model>;
    static bool found[n][n], seen[n][n];
    for (int e = 0; e < n_jacobian_entry<Model>; ++e)
        found[jacobian_entries_of<Model>[e].row][jacobian_entries_of<Model>[e].column] = true;
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> number(0.1, 0.9);
    double shared[64]{};
    static_assert(n_shared<Model> <= 64 && n_shared_integer<Model> == 0);
    bool moves = false;
    for (int sample = 0; sample < 5; ++sample) {
        inputs<Model, double> p{};
        for (int i = 0; i < n_parameter<Model>; ++i) p.parameter[i] = number(engine);
        for (double& value : shared) value = number(engine);
        p.shared = shared;
        vec<double, n> y;
        for (int i = 0; i < n; ++i) y[i] = number(engine);
        const double t = number(engine);
        matrix<double, n> dense;
        dual_jacobian<Model>(t, y, p, dense);
        const auto by_time = time_derivative<Model>(t, y, p);
        for (int i = 0; i < n; ++i) {
            moves = moves || by_time[i] != 0;
            for (int j = 0; j < n; ++j) {
                INFO("entry " << i << ", " << j);
                CHECK((found[i][j] || dense[i][j] == 0));
                seen[i][j] = seen[i][j] || dense[i][j] != 0;
            }
        }
    }
    CHECK(moves == depends_on_time<Model>);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            INFO("entry " << i << ", " << j);
            CHECK((seen[i][j] || !found[i][j]));
        }
}

enum class kind { plain, branch, branch_on_parameter, shared_integer, accessory, table, loop, functions, std_function };

/// Eight states, of which the first two slopes are of a given kind.
template <kind what>
struct of_kind {
    enum state { a, b, c, d, n_state = 8 };
    enum parameter { k, n_parameter };
    enum shared { table, s = 4, n_shared };
    enum shared_integer { m, n_shared_integer };
    enum accessory { memory, n_accessory };

    template <class R>
    MYRIAD_FUNCTION static vec<R, n_state> rhs(auto t, const vec<R, n_state>& y, const auto& p) {
        using namespace myriad;
        vec<R, n_state> f{};
        if constexpr (what == kind::plain) {
            f[a] = select(y[b] > 0.0, y[a], R(1.0)) * p[k] / p.shared[s];
            f[b] = floor(y[a]) + 2 * y[d];
            f[b] -= y[c] / y[c];  // a derivative of zero, but not by its structure
        } else if constexpr (what == kind::branch) {
            if (y[a] > 0.0) f[b] = y[b];
        } else if constexpr (what == kind::branch_on_parameter) {
            if (p[k] > 0.0) f[b] = y[b];
        } else if constexpr (what == kind::shared_integer) {
            f[a] = p.shared_integer[m] * y[a];
        } else if constexpr (what == kind::accessory) {
            f[a] = p.accessory[memory] * y[b];
        } else if constexpr (what == kind::table) {
            f[a] = lookup(&p.shared[table], 1, 4, find_interval(&p.shared[table], 4, y[b])) * y[c];
        } else if constexpr (what == kind::loop) {
            R sum(0.0);
            for (int i = 0; i < n_state; i += 2) sum += y[i];
            f[a] = sum * t;
        } else if constexpr (what == kind::functions) {
            const auto [sine, cosine] = sincos(y[a]);
            f[a] = sine + fma(pow(y[b], 3), 2.0, cosine) + hypot(y[c], 1.0);
            f[b] = min(max(y[a], 0.5), atan2(y[d], p[k])) + powr(y[a], p[k]) - fmod(y[c], 2.0) + copysign(1.0, y[b]);
            f[c] = exp(-y[c]) * sqrt(abs(y[d])) + R(1.0) / reciprocal(y[a]) + log1p(tanh(y[a]));
        } else {
            f[a] = R(std::tgamma(3.0)) * y[a];
        }
        return f;
    }
};

template <class Model>
bool has_entry(int row, int column) {
    for (int e = 0; e < n_jacobian_entry<Model>; ++e)
        if (jacobian_entries_of<Model>[e].row == row && jacobian_entries_of<Model>[e].column == column) return true;
    return false;
}

struct scalar_branch : of_kind<kind::branch> {
    static constexpr bool scalar_only = true;
};

}  // namespace

TEST_CASE("found patterns hold every derivative, and no other entry", "[jacobian_pattern]") {
    compare_with_dual_numbers<problems::decay>();
    compare_with_dual_numbers<problems::logistic>();
    compare_with_dual_numbers<problems::timed_circle>();
    compare_with_dual_numbers<problems::oscillator>();
    compare_with_dual_numbers<problems::van_der_pol>();
    compare_with_dual_numbers<problems::roessler>();
    compare_with_dual_numbers<problems::pendulum>();
    compare_with_dual_numbers<stiff::robertson>();
    compare_with_dual_numbers<stiff::van_der_pol>();
    compare_with_dual_numbers<stiff::prothero_robinson>();
    compare_with_dual_numbers<stiff::rod<24>>();
    compare_with_dual_numbers<problems::pollution>();
    compare_with_dual_numbers<problems::van_der_pol_ring<32>>();
    compare_with_dual_numbers<problems::van_der_pol_ring<130>>();  // sets of more than two words
}

TEST_CASE("the pattern found for a ring is the one that was declared", "[jacobian_pattern]") {
    using plain = sparse::plain_ring<32>;
    using declared = sparse::ring<32>;
    static_assert(origin_of_pattern<plain>() == pattern_origin::found);
    static_assert(origin_of_pattern<declared>() == pattern_origin::declared);
    static_assert(n_jacobian_entry<plain> == n_jacobian_entry<declared>);
    static_assert(!depends_on_time<plain>);
    static_assert(origin_of_pattern<sparse::dense_ring<32>>() == pattern_origin::none);
    for (const auto& entry : declared::jacobian_pattern) CHECK(has_entry<plain>(entry.row, entry.column));
}

TEST_CASE("what a derivative sees is found, and the conditions of a selection are not", "[jacobian_pattern]") {
    using plain = of_kind<kind::plain>;
    CHECK(n_jacobian_entry<plain> == 3);
    CHECK(has_entry<plain>(plain::a, plain::a));
    CHECK(has_entry<plain>(plain::b, plain::c));
    CHECK(has_entry<plain>(plain::b, plain::d));
    CHECK(n_jacobian_entry<of_kind<kind::table>> == 1);  // the table is constant between its knots
    CHECK(n_jacobian_entry<of_kind<kind::accessory>> == 1);
    CHECK(n_jacobian_entry<of_kind<kind::loop>> == 4);
    CHECK(depends_on_time<of_kind<kind::loop>>);
    CHECK_FALSE(depends_on_time<of_kind<kind::plain>>);
    CHECK(n_jacobian_entry<of_kind<kind::functions>> == 3 + 3 + 3);
    CHECK(n_jacobian_entry<of_kind<kind::std_function>> == 1);
}

TEST_CASE("a right-hand side that looks at values has no pattern", "[jacobian_pattern]") {
    CHECK_FALSE(traceable<of_kind<kind::branch>>);
    CHECK_FALSE(traceable<of_kind<kind::branch_on_parameter>>);
    CHECK_FALSE(traceable<of_kind<kind::shared_integer>>);
    CHECK_FALSE(traceable<scalar_branch>);
    CHECK(n_jacobian_entry<of_kind<kind::branch>> == 0);
    CHECK(depends_on_time<of_kind<kind::branch>>);
    CHECK_FALSE(factorises_sparsely_of<of_kind<kind::branch>>());
}

TEST_CASE("functions depend on their arguments as the derivatives by dual numbers do", "[jacobian_pattern]") {
    using pattern = functions<myriad::dependence<2>>;
    using derivative = functions<myriad::dual<double>>;
    const auto first = myriad::dependence<2>::of(0), second = myriad::dependence<2>::of(1);
    const myriad::dual<double> x(0.3, 1);
    const auto check = [&](const char* name, const auto& y, const auto& depends, bool smooth) {
        CAPTURE(name);
        CHECK((y.derivative != 0) == smooth);
        CHECK(depends.contains(1) == smooth);
        CHECK_FALSE(depends.contains(0));
    };
#define CHECK_SMOOTH(name) check(#name, derivative::name(x), pattern::name(second), true);
#define CHECK_STEP(name) check(#name, derivative::name(x), pattern::name(second), false);
#define CHECK_BOTH(name) CHECK((pattern::name(first, second).contains(0) && pattern::name(first, second).contains(1)));
    MYRIAD_SMOOTH_FUNCTIONS(CHECK_SMOOTH)
    MYRIAD_STEP_FUNCTIONS(CHECK_STEP)
    MYRIAD_FUNCTIONS_OF_TWO(CHECK_BOTH)
#undef CHECK_SMOOTH
#undef CHECK_STEP
#undef CHECK_BOTH
}
