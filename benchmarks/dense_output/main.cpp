// SPDX-License-Identifier: MIT
// Time and memory of dense output relative to the same integration without it, as comma-separated ratios: medians of
// the processor time of interleaved runs on one thread. Usage: dense_output [--check]; --check only fails (exit status
// 1) if dense output that is off, or not compiled, takes memory.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <iostream>
#include <new>
#include <string_view>
#include <vector>

#include <myriad/myriad.hpp>

#include "../../examples/common/exit_status.hpp"
#include "models.hpp"

namespace {

std::int64_t allocated = 0;  // bytes of arrays allocated since the last reset

constexpr std::int64_t instances = 16384;
constexpr double t_end = 20;
constexpr int repetitions = 9;

struct cost {
    double seconds;
    std::int64_t bytes;
};

template <class Method>
cost run(const myriad::sample_options& samples) {
    allocated = 0;
    myriad::ensemble<forced_oscillator> sweep(instances);
    sweep.parameter(forced_oscillator::k) = Eigen::ArrayXd::LinSpaced(instances, 0.2, 0.3);
    sweep.state(forced_oscillator::x) = -0.5;
    sweep.state(forced_oscillator::v) = -0.1;
    sweep.time_domain(0, t_end);
    const std::clock_t begin = std::clock();  // not wall time, which other processes would affect
    myriad::solve<Method>(myriad::device::cpu(1), sweep,
                          {.relative_tolerance = 1e-8, .absolute_tolerance = 1e-8, .step = 0.02, .samples = samples});
    return {static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, allocated};
}

/// One line for each kind of sampling. True if kinds without samples take no memory.
template <class Method>
bool compare(const char* name, bool check) {
    using dense = myriad::dense<Method>;
    const auto evenly = [](std::int64_t n, std::vector<int> states) {
        return myriad::sample_options{.states = std::move(states), .capacity = n, .evenly = n};
    };
    const std::array<const char*, 6> what = {"off",         "compiled but off",         "20 samples",
                                             "200 samples", "200 samples of one state", "every step"};
    const std::array<std::function<cost()>, 6> runs = {
        [] { return run<Method>({}); },
        [] { return run<dense>({}); },
        [&] {
            return run<dense>(evenly(20, {0, 1}));
        },
        [&] {
            return run<dense>(evenly(200, {0, 1}));
        },
        [&] { return run<dense>(evenly(200, {0})); },
        [] {
            return run<dense>({.states = {0, 1}, .capacity = 1001, .every = 1});
        },
    };
    if (check) {
        const std::int64_t without = runs[0]().bytes, off = runs[1]().bytes;
        return without > 0 && without == off && runs[2]().bytes > off;
    }

    std::array<std::vector<double>, 6> seconds;
    std::array<std::int64_t, 6> bytes{};
    for (int r = 0; r <= repetitions; ++r) {
        for (std::size_t i = 0; i < runs.size(); ++i) {
            const cost c = runs[i]();
            if (r > 0) seconds[i].push_back(c.seconds);  // the first run warms up
            bytes[i] = c.bytes;
        }
    }
    for (std::size_t i = 0; i < runs.size(); ++i) {
        std::nth_element(seconds[i].begin(), seconds[i].begin() + repetitions / 2, seconds[i].end());
        std::cout << name << ',' << what[i] << ',' << seconds[i][repetitions / 2] / seconds[0][repetitions / 2] << ','
                  << static_cast<double>(bytes[i]) / instances << '\n';
    }
    return bytes[0] == bytes[1];
}

}  // namespace

// Only the arrays of ensembles and samples are allocated by these operators.
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
    allocated += static_cast<std::int64_t>(size);
    const auto a = static_cast<std::size_t>(alignment);
    return std::aligned_alloc(a, (size + a - 1) / a * a);
}
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }

int main(int argc, char** argv) {
    const bool check = argc == 2 && std::string_view(argv[1]) == "--check";
    if (argc > 1 && !check) {
        std::cerr << "Usage: dense_output [--check]\n";
        return 2;
    }
    if (!check) std::cout << "method,samples,time_ratio,bytes_per_instance\n";
    bool as_before = compare<myriad::runge_kutta_4>("runge_kutta_4", check);
    as_before = compare<myriad::cash_karp>("cash_karp", check) && as_before;
    as_before = compare<myriad::tsitouras_5>("tsitouras_5", check) && as_before;
    if (!as_before) std::cerr << "Dense output takes memory although it is off\n";
    return examples::after_output(as_before ? EXIT_SUCCESS : EXIT_FAILURE);
}
