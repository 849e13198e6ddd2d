// SPDX-License-Identifier: MIT
// Times the implementations of a case in turns, so that a disturbance meets all of them, and keeps for each the shortest
// time, since others' work on the same cores only ever adds to it. CPU time and not the clock on the wall, which on shared
// cores shows above all how busy the others are.
#include "measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "lorenz_rk4/equations.hpp"

namespace cpu_peers {
namespace {

/// The arrays of one sweep, with room for the results of one run.
class sweep_data {
public:
    sweep_data(const benchmark_case& what, std::int64_t instances, int phases, int threads)
        : start_(size(what.components, instances)), parameters_(size(what.parameters, instances)),
          states_(start_.size()), accepted_(size(1, instances)),
          endings_(size(1, instances)), sweep_{instances,      phases,           threads,        parameters_.data(),
                                               states_.data(), accepted_.data(), endings_.data()} {
        what.fill(instances, parameters_.data(), start_.data());
    }

    outcome run(implementation_function how) {
        states_ = start_;
        std::fill(endings_.begin(), endings_.end(), ending::failed);
        return how(sweep_);
    }
    const std::vector<double>& states() const { return states_; }
    const std::vector<std::int64_t>& accepted() const { return accepted_; }
    const std::vector<ending>& endings() const { return endings_; }

private:
    static std::size_t size(int components, std::int64_t instances) {
        return static_cast<std::size_t>(components) * static_cast<std::size_t>(instances);
    }

    std::vector<double> start_, parameters_, states_;
    std::vector<std::int64_t> accepted_;
    std::vector<ending> endings_;
    sweep sweep_;
};

// Enough to cover a sweep's range, few enough for long double.
constexpr std::int64_t compared_instances = 64;

void compare(const benchmark_case& what, const std::vector<implementation>& chosen, int threads,
             std::vector<measurement>& results) {
    sweep_data data(what, compared_instances, what.compared_phases, threads);
    data.run(what.reference);
    const std::vector<double> reference = data.states();
    const std::vector<ending> reference_endings = data.endings();
    for (std::size_t j = 0; j < chosen.size(); ++j) {
        data.run(chosen[j].run);
        double largest = 0;
        for (std::size_t i = 0; i < compared_instances; ++i) {
            if (reference_endings[i] != ending::completed || data.endings()[i] != ending::completed) continue;
            ++results[j].compared;
            for (std::size_t c = 0; c < static_cast<std::size_t>(what.components); ++c) {
                const double exact = reference[c * compared_instances + i];
                const double difference =
                    std::fabs(data.states()[c * compared_instances + i] - exact) / std::fmax(1, std::fabs(exact));
                if (!(difference <= largest)) largest = difference;  // NaN stays
                if (std::isnan(largest)) break;
            }
        }
        results[j].difference = largest;
    }
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

/// CPU time of `one` over that of `other`, on one thread: the median over pairs of runs, one right after the other.
double ratio_of_times(sweep_data& data, implementation_function one, implementation_function other, int pairs) {
    std::vector<double> ratios;
    for (int i = 0; i < pairs + 1; ++i) {
        const double first = data.run(one).cpu_seconds;
        const double ratio = first / data.run(other).cpu_seconds;
        if (i > 0) ratios.push_back(ratio);  // the first pair warms up
    }
    return median(ratios);
}

const implementation& find(const benchmark_case& what, const std::string& name) {
    return *std::find_if(what.implementations.begin(), what.implementations.end(),
                         [&](const implementation& i) { return i.name == name; });
}

}  // namespace

std::vector<measurement> measure(const benchmark_case& what, const measure_options& options) {
    std::vector<implementation> chosen;
    for (const implementation& i : what.implementations) {
        const auto& wanted = options.implementations;
        if (wanted.empty() || std::find(wanted.begin(), wanted.end(), i.group) != wanted.end()) chosen.push_back(i);
    }
    std::vector<measurement> results(chosen.size());
    if (chosen.empty()) return results;
    compare(what, chosen, options.threads, results);

    const auto instances = std::max(
        static_cast<std::int64_t>(options.instances_scale * static_cast<double>(what.instances)), std::int64_t{1});
    sweep_data data(what, instances, what.phases, options.threads);
    for (int repetition = 0; repetition < options.repetitions + 1; ++repetition) {
        for (std::size_t j = 0; j < chosen.size(); ++j) {
            measurement& m = results[j];
            const outcome o = data.run(chosen[j].run);
            const double milliseconds = 1e3 * o.cpu_seconds / options.threads;
            if (repetition == 0) {  // warms up
                m.implementation = chosen[j].name;
                m.instances = instances;
                m.milliseconds = std::numeric_limits<double>::infinity();
                m.idle_share = o.idle_share;
                for (const std::int64_t n : data.accepted()) m.accepted_steps += n;
                for (const ending e : data.endings()) ++m.by_ending[static_cast<int>(e)];
            } else {
                m.milliseconds = std::min(m.milliseconds, milliseconds);
            }
        }
    }
    return results;
}

bool check_promises(bool against_odeint) {
    const benchmark_case lorenz_case = lorenz_rk4();
    const implementation_function myriad = find(lorenz_case, "myriad").run;
    constexpr int pairs = 15;
    bool kept = true;
    const auto report = [&kept](bool good, const char* what, double measured, double promised) {
        std::printf("%s: %s %.3f (promised: %.3g)\n", good ? "kept" : "BROKEN", what, measured, promised);
        kept = kept && good;
    };

    sweep_data data(lorenz_case, 12288, 1, 1);  // whole packs of one to four batches of 2, 4 and 8 lanes
    constexpr double most = 1.10;
    const double overhead = ratio_of_times(data, myriad, find(lorenz_case, "packs_as_models").run, pairs);
    report(overhead <= most, "lorenz_rk4: Myriad's time over that of the plain loop over the same packs, same flags",
           overhead, most);
    if (against_odeint) {
        constexpr double least = 8;
        const double speed = ratio_of_times(data, find(lorenz_case, "odeint").run, myriad, pairs);
        report(speed >= least, "lorenz_rk4: Boost.odeint's time over Myriad's", speed, least);
    } else {
        std::printf("skipped: lorenz_rk4 against Boost.odeint is promised for g++ and AVX-512\n");
    }
    return kept;
}

}  // namespace cpu_peers
