// SPDX-License-Identifier: MIT
// Command line and output of the benchmark: one CSV row per case and implementation, below a header with the work, the
// method and the machine. Exit status 0; 1 if a promise is broken, instances failed or results differ; 2 for an error.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>

#include "cases.hpp"
#include "equal_error.hpp"
#include "examples/common/exit_status.hpp"
#include "lorenz_rk4/equations.hpp"
#include "machine.hpp"
#include "measure.hpp"
#include "promises.hpp"

namespace {

using namespace cpu_peers;

struct settings {
    std::vector<std::string> cases;
    measure_options measure;
    std::vector<int> threads;
    std::vector<std::int64_t> instances = {0};
    bool quick = false, check = false, equal_error = false;
    double slack = 0;
};

void write(const std::string& line) { std::cout << line << std::endl; }

std::string number(double value, const char* format) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}
/// A figure that may be missing: 0 is none.
std::string optional(double value, const char* format) { return value > 0 ? number(value, format) : ""; }

void write_header(const settings& chosen) {
    write("# Myriad beside its peers on the CPU; times are comparable within this run only");
    for (const std::string& line : describe_machine()) write("# " + line);
    write("# milliseconds: CPU time of all threads over their number; median of " +
          std::to_string(chosen.measure.repetitions) + " repetitions in turns, after one to warm up");
    write("# wall_milliseconds: by the clock on the wall, shortest of the same repetitions");
    write("# nanoseconds_per_step: milliseconds * threads / accepted_steps, time of a core per step of one instance");
    write("# ratio_to_odeint: odeint's time over this one's in the same repetition, median; larger is faster");
    write(
        "# max_difference, median_difference: over 64 instances spread over the range, of each the largest "
        "|difference| "
        "/ max(1, |value|) of its components");
    write(
        "# accepted_steps: of all instances; odeint's error norm is another and cannot be changed, so its steps "
        "differ");
    write("# idle_lanes: share of lane steps without work");
    write(
        "# fma_peak_share: floating-point instructions per second, " + number(lorenz::instructions_per_step, "%g") +
        " for each step and batch, over the fused multiply-adds per second that the same core issues in the same run");
    if (chosen.equal_error)
        write(
            "# rows CASE:equal_error: the contenders at several tolerances; where there is none, the time for that "
            "median_difference, between the measured points, and ratio_to_cvode");
    write(
        "case,implementation,compiler,instruction_set,threads,instances,tolerance,milliseconds,wall_milliseconds,"
        "nanoseconds_per_step,"
        "ratio_to_odeint,ratio_to_cvode,max_difference,median_difference,accepted_steps,idle_lanes,fma_peak_share");
}

/// Returns whether all implementations integrated all instances, with the same results.
bool run_case(const benchmark_case& what, const measure_options& options) {
    bool all_well = true;
    double fma_per_nanosecond = 0;
    for (const measurement& m : measure(what, options)) {
        fma_per_nanosecond = std::max(fma_per_nanosecond, m.fma_per_nanosecond);
        const std::int64_t completed = m.by_ending[static_cast<int>(ending::completed)],
                           accumulated = m.by_ending[static_cast<int>(ending::accumulated)],
                           failed = m.by_ending[static_cast<int>(ending::failed)];
        const std::string title = "# " + what.name + ' ' + m.implementation + ": ";
        if (accumulated + failed > 0)
            write(title + std::to_string(completed) + " instances completed, " + std::to_string(accumulated) +
                  " ended as event_accumulation, " + std::to_string(failed) + " failed");
        const bool right = m.compared > 0 && m.difference <= what.allowed_difference;
        if (!right) write(title + "WRONG, max_difference must be within " + number(what.allowed_difference, "%g"));
        all_well = all_well && failed == 0 && right;
        write(what.name + ',' + m.implementation + ',' + compiler() + ',' + instruction_set() + ',' +
              std::to_string(options.threads) + ',' + std::to_string(m.instances) + ',' +
              optional(what.tolerance, "%g") + ',' + number(m.milliseconds, "%.3f") + ',' +
              number(m.wall_milliseconds, "%.3f") + ',' +
              number(1e6 * m.milliseconds * options.threads / static_cast<double>(m.accepted_steps), "%.4f") + ',' +
              optional(m.ratio_to_odeint, "%.3f") + ",," + number(m.difference, "%.2e") + ',' +
              number(m.median_difference, "%.2e") + ',' + std::to_string(m.accepted_steps) + ',' +
              number(m.idle_share, "%.4f") + ',' + optional(m.fma_peak_share, "%.3f"));
    }
    if (fma_per_nanosecond > 0)
        write("# " + what.name + ": " + number(fma_per_nanosecond, "%.2f") +
              " fused multiply-adds of one batch per nanosecond and core");
    return all_well;
}

void run_contest(const benchmark_case& what, const measure_options& options) {
    const std::vector<contest_result> results = hold_contest(what, options);
    const std::string name = what.name + ":equal_error";
    write("# " + name + ": " + std::to_string(what.at_equal_error.phases) + " phases");
    const bool has_cvode = results.front().contender == what.at_equal_error.contenders.front().name;
    for (const implementation& i : what.at_equal_error.contenders)
        if (i.run == nullptr)
            write("# " + name + ": " + i.name + " is left out, as " +
                  (i.group == "cvode" ? "SUNDIALS was not found" : "MYRIAD_BENCHMARK_HIGH_ORDER was off") +
                  " when this was built");
    const std::string middle = instruction_set() + ',' + std::to_string(options.threads) + ',' +
                               std::to_string(instances_of(what, options)) + ',';
    for (const contest_result& r : results)
        for (const contest_point& p : r.points)
            write(name + ',' + r.contender + ',' + compiler() + ',' + middle + number(p.tolerance, "%g") + ',' +
                  number(p.milliseconds, "%.3f") + ',' + number(p.wall_milliseconds, "%.3f") + ',' +
                  number(1e6 * p.milliseconds * options.threads / static_cast<double>(p.accepted_steps), "%.4f") +
                  ",,," + number(p.largest_difference, "%.2e") + ',' + number(p.median_difference, "%.2e") + ',' +
                  std::to_string(p.accepted_steps) + ',' + number(p.idle_share, "%.4f") + ',');
    for (const double error : {1e-4, 1e-6, 1e-8, 1e-10})
        for (const contest_result& r : results) {
            const double mine = milliseconds_at(r, error);
            const double cvode = has_cvode ? milliseconds_at(results.front(), error) : 0;
            if (mine > 0)
                write(name + ',' + r.contender + ',' + compiler() + ',' + middle + ',' + number(mine, "%.3f") + ",,,," +
                      optional(cvode / mine, "%.2f") + ",," + number(error, "%.0e") + ",,,");
        }
}

bool run(const settings& chosen) {
    write_header(chosen);
    bool all_well = true;
    for (const benchmark_case& what : {lorenz_rk4(), duffing_cash_karp(), keller_miksis_cash_karp(), relief_valve(),
                                       lorenz96_case<32>(), lorenz96_case<128>()}) {
        if (!chosen.cases.empty() &&
            std::find(chosen.cases.begin(), chosen.cases.end(), what.name) == chosen.cases.end())
            continue;
        write("# " + what.name + ": " + what.work);
        write("# " + what.name + ": max_difference of the " + what.difference);
        for (const std::int64_t instances : chosen.instances)
            for (const int threads : chosen.threads) {
                measure_options options = chosen.measure;
                options.instances = instances;
                options.threads = threads;
                if (!chosen.equal_error) {
                    all_well = run_case(what, options) && all_well;
                } else if (!what.at_equal_error.contenders.empty()) {
                    run_contest(what, options);
                }
            }
    }
    if (!std::cout) throw std::runtime_error("the output cannot be written");
    return all_well;
}

/// Returns whether the promises are kept.
bool check(double slack) {
    for (const std::string& line : describe_machine()) write("# " + line);
    return check_promises(slack);
}

}  // namespace

int main(int argc, char** argv) {
    settings chosen;
    chosen.threads = {static_cast<int>(std::max(std::thread::hardware_concurrency(), 1u))};
    CLI::App app("Myriad's OpenMP backend compared with Boost.odeint, CVODE and hand-written code");
    app.add_option("--cases", chosen.cases, "Cases to run, all by default")
        ->delimiter(',')
        ->check(CLI::IsMember({"lorenz_rk4", "duffing_cash_karp", "keller_miksis_cash_karp", "relief_valve",
                               "lorenz96_32", "lorenz96_128"}));
    app.add_option("--implementations", chosen.measure.implementations, "Implementations to run, all by default")
        ->delimiter(',')
        ->check(CLI::IsMember({"odeint", "loop", "packs", "myriad"}));
    app.add_option("--instances", chosen.instances, "Numbers of instances, with rows for each, instead of the case's")
        ->delimiter(',')
        ->check(CLI::Range(1, 100'000'000));
    app.add_option("--instances-scale", chosen.measure.instances_scale, "Factor on the case's number of instances")
        ->check(CLI::Range(1e-3, 1e4))
        ->capture_default_str();
    auto* const repetitions = app.add_option("--repetitions", chosen.measure.repetitions, "How often each is timed")
                                  ->check(CLI::Range(1, 1000))
                                  ->capture_default_str();
    app.add_option("--threads", chosen.threads, "Numbers of OpenMP threads, with rows for each")
        ->delimiter(',')
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    app.add_flag("--quick", chosen.quick, "A quarter of the instances and, by default, three repetitions");
    app.add_flag(
        "--equal-error", chosen.equal_error,
        "Instead of the table, CVODE's, odeint's and Myriad's methods at several tolerances, and their times at "
        "equal achieved error");
    app.add_flag("--check", chosen.check,
                 "Only check the promises about Myriad's speed, on one thread; exit status 1 if broken");
    app.add_option("--slack", chosen.slack, "Fraction by which --check lets promises be missed, for busy machines")
        ->check(CLI::Range(0.0, 0.5))
        ->capture_default_str();
    try {
        app.parse(argc, argv);
        if (chosen.quick) {
            chosen.measure.instances_scale *= 0.25;
            if (repetitions->count() == 0) chosen.measure.repetitions = 3;
        }
        return examples::after_output((chosen.check ? check(chosen.slack) : run(chosen)) ? 0 : 1);
    } catch (const CLI::ParseError& e) {
        return examples::after_output(app.exit(e) == 0 ? 0 : 2);
    } catch (const std::exception& e) {
        std::cerr << e.what() << '\n';
    }
    return 2;
}
