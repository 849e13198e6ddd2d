// SPDX-License-Identifier: MIT
// Checks the promises such that a busy machine does not break them: ratios of CPU times of consecutive runs on one
// thread, the median of many, and another try before a promise counts as broken. Code that has become slower fails
// every try.
#include "promises.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>

#include "machine.hpp"
#include "measure.hpp"

namespace cpu_peers {
namespace {

implementation_function find(const benchmark_case& what, std::string_view name) {
    return std::find_if(what.implementations.begin(), what.implementations.end(),
                        [&](const implementation& i) { return i.name == name; })
        ->run;
}

/// A ratio of times that is at least or at most `limit`.
struct promise {
    const char* text;
    implementation_function one, other;
    enum kind { at_least, at_most } kind;
    double limit;
};

bool keeps(const benchmark_case& what, const promise& p, double slack) {
    constexpr int tries = 5, pairs = 15;
    constexpr std::int64_t instances = 12288;  // whole packs of one to four batches of 2, 4 and 8 lanes
    const double limit = p.kind == promise::at_least ? p.limit * (1 - slack) : p.limit * (1 + slack);
    for (int i = 1; i <= tries; ++i) {
        const double ratio = ratio_of_times(what, instances, p.one, p.other, pairs);
        const bool kept = p.kind == promise::at_least ? ratio >= limit : ratio <= limit;
        std::printf("%s: %s: %s: %.3f (promised: %s %g; checked: %.3g)\n",
                    kept        ? "kept"
                    : i < tries ? "again"
                                : "BROKEN",
                    what.name.c_str(), p.text, ratio, p.kind == promise::at_least ? "at least" : "at most", p.limit,
                    limit);
        if (kept) return true;
    }
    return false;
}

}  // namespace

bool check_promises(double slack) {
    const benchmark_case lorenz_case = lorenz_rk4();
    const implementation_function myriad = find(lorenz_case, "myriad");
    bool kept = keeps(lorenz_case,
                      {"Myriad's time over that of the plain loop over the same packs with the same flags", myriad,
                       find(lorenz_case, "packs_as_models"), promise::at_most, 1.10},
                      slack);
    if (compiler().rfind("GNU", 0) == 0 && instruction_set() == "avx512") {
        const promise speed = {"Boost.odeint's time over Myriad's", find(lorenz_case, "odeint"), myriad,
                               promise::at_least, 8};
        kept = keeps(lorenz_case, speed, slack) && kept;
    } else {
        std::printf("skipped: lorenz_rk4: Boost.odeint's time over Myriad's is promised for g++ and AVX-512\n");
    }
    return kept;
}

}  // namespace cpu_peers
