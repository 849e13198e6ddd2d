// SPDX-License-Identifier: MIT
// Shows that the measures of order detect a wrong coefficient: every coefficient of every method, changed in its fourth
// digit, must be reported by the very functions that validate the methods, and the unchanged methods must not. Kernels
// on single lanes, compiled here. Exit status 1 if a mutant passes, or a method fails.
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <myriad/instantiate.hpp>
#include <myriad/myriad.hpp>

#include "../measures/measures.hpp"
#include "../problems/problems.hpp"
#include "../problems/timed_circle.hpp"
#include "../runner.hpp"

namespace validation {

constexpr double change = 1e-4;

/// Kind of coefficient: of the stages (their nodes c stay unchanged), of the solution, of the error estimate, a node.
enum class part { a, b, e, c };

template <class Method, part which, std::size_t i, std::size_t j>
struct mutated : Method {
    static constexpr auto tableau() {
        auto t = Method::tableau();
        if (which == part::a) t.a[i][j] *= 1 + change;
        if (which == part::e) t.e[j] *= 1 + change;
        if (which == part::c) t.c[j] *= 1 + change;
        if (which == part::b) {
            t.b[j] *= 1 + change;
            // the solution must remain the argument of the last stage
            if (Method::first_same_as_last) t.a[Method::stages - 1][j] = t.b[j];
        }
        return t;
    }
};

namespace {

references in_closed_form(const problem& p) {
    references r;
    for (const instance& i : p.instances) {
        r.known.push_back(p.exactly(i, p.samples));
        r.error.push_back(0);
        conditioning c;
        c.end = 10;  // e^2 from the smallest to the largest value of exp(sin s), plus a margin
        r.conditions.push_back(c);
    }
    return r;
}

/// Kernels without dense output suffice here, and compile faster.
problem not_sampled() {
    problem p = timed_circle_problem();
    p.sampled.clear();
    std::vector<instance> some;  // all around the circle; the first one takes the single step
    for (std::size_t i = 0; i < p.instances.size(); i += 4) some.push_back(p.instances[i]);
    p.instances = some;
    return p;
}

class judge {
public:
    /// Measures a method, and reports if the verdict is wrong.
    template <class Method>
    void add(const std::string& method, const std::string& change, bool is_mutant) {
        std::ostringstream log;
        report rows(log);
        session s{myriad::device::cpu(1), extent::whole, rows};
        const method_entry m = entry<timed_circle, Method>(method.c_str());
        measure_step(s, problem_, m);
        measure_order(s, problem_, m, known_);
        measure_estimate(s, problem_, m);
        const bool right = (rows.missed() > 0) == is_mutant && rows.judged() > 0;
        mutants_ += is_mutant;
        wrong_ += !right;
        if (!right)
            std::cout << method << change
                      << (is_mutant ? " is wrong, and nothing was reported\n" : " is reported to be wrong:\n")
                      << log.str();
    }
    template <class Method>
    void add_all(const std::string& name) {
        add<Method>(name, "", false);
        [&]<std::size_t... k>(std::index_sequence<k...>) {
            (add_coefficient<Method, k / Method::stages, k % Method::stages>(name), ...);
        }
        (std::make_index_sequence<static_cast<std::size_t>(Method::stages * Method::stages)>{});
    }
    int wrong() const { return wrong_; }
    int mutants() const { return mutants_; }

private:
    template <class Method, std::size_t i, std::size_t j>
    void add_coefficient(const std::string& method) {
        constexpr auto t = Method::tableau();
        const std::string column = '[' + std::to_string(j) + ']';
        // there the last row of a is b
        constexpr bool is_b = Method::first_same_as_last && i + 1 == static_cast<std::size_t>(Method::stages);
        if constexpr (t.a[i][j] != 0 && !is_b)
            add<mutated<Method, part::a, i, j>>(method, " with another a[" + std::to_string(i) + ']' + column, true);
        if constexpr (i == 0 && t.b[j] != 0)
            add<mutated<Method, part::b, i, j>>(method, " with another b" + column, true);
        if constexpr (i == 0 && t.e[j] != 0)
            add<mutated<Method, part::e, i, j>>(method, " with another e" + column, true);
        // a last stage that is the first of the next step is evaluated at the end of the step, whatever its node
        constexpr bool is_end = Method::first_same_as_last && j + 1 == static_cast<std::size_t>(Method::stages);
        if constexpr (i == 0 && t.c[j] != 0 && !is_end)
            add<mutated<Method, part::c, i, j>>(method, " with another c" + column, true);
    }

    const problem problem_ = not_sampled();
    const references known_ = in_closed_form(problem_);
    int wrong_ = 0, mutants_ = 0;
};

}  // namespace
}  // namespace validation

int main() {
    validation::judge all;
#define VALIDATION_MUTATE(M) all.add_all<myriad::M>(#M);
    VALIDATED_METHODS(VALIDATION_MUTATE)
    std::cout << all.mutants() << " coefficients changed by " << validation::change << " of themselves, one at a time; "
              << all.wrong() << " verdicts wrong\n";
    return all.wrong() == 0 && all.mutants() > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
