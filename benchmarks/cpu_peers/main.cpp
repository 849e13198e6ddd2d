// SPDX-License-Identifier: MIT
// Command line and output of the benchmark: one CSV row per case and implementation, below a header that says what was
// measured, how and where. Exit status 0; 1 if a promise is broken, instances failed or results differ; 2 for an error.
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
#include "machine.hpp"
#include "measure.hpp"
#include "promises.hpp"

namespace {

using namespace cpu_peers;

struct settings {
    std::vector<std::string> cases;
    measure_options measure;
    bool quick = false, check = false;
    double slack = 0;
};

void write(const std::string& line) { std::cout << line << std::endl; }

std::string number(double value, const char* format) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

void write_header(const measure_options& chosen) {
    write("# Myriad beside its peers on the CPU; times are comparable within this run only");
    for (const std::string& line : describe_machine()) write("# " + line);
    write("# threads: " + std::to_string(chosen.threads));
    write("# milliseconds: CPU time of all threads over their number; median of " + std::to_string(chosen.repetitions) +
          " repetitions in turns, after one to warm up");
    write("# nanoseconds_per_step: milliseconds * threads / accepted_steps, time of a core per step of one instance");
    write("# ratio_to_odeint: odeint's time over this one's in the same repetition, median; larger is faster");
    write(
        "# max_difference: largest over components and 64 instances spread over the range, |difference| / max(1, "
        "|value|)");
    write(
        "# accepted_steps: of all instances; odeint's error norm is another and cannot be changed, so its steps "
        "differ");
    write("# idle_lanes: share of lane steps without work");
    write(
        "case,implementation,compiler,instances,milliseconds,nanoseconds_per_step,ratio_to_odeint,max_difference,"
        "accepted_steps,idle_lanes");
}

/// Returns whether all instances of all implementations were integrated, and to the same results.
bool run_case(const benchmark_case& what, const measure_options& options) {
    write("# " + what.name + ": " + what.work);
    write("# " + what.name + ": max_difference of the " + what.difference);
    bool all_well = true;
    for (const measurement& m : measure(what, options)) {
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
        write(what.name + ',' + m.implementation + ',' + compiler() + ',' + std::to_string(m.instances) + ',' +
              number(m.milliseconds, "%.3f") + ',' +
              number(1e6 * m.milliseconds * options.threads / static_cast<double>(m.accepted_steps), "%.4f") + ',' +
              (m.ratio_to_odeint > 0 ? number(m.ratio_to_odeint, "%.3f") : "") + ',' + number(m.difference, "%.2e") +
              ',' + std::to_string(m.accepted_steps) + ',' + number(m.idle_share, "%.4f"));
    }
    return all_well;
}

int run(const settings& chosen) {
    if (chosen.check) {
        for (const std::string& line : describe_machine()) write("# " + line);
        return check_promises(chosen.slack) ? 0 : 1;
    }
    write_header(chosen.measure);
    bool all_well = true;
    for (const benchmark_case& what : {lorenz_rk4(), duffing_cash_karp(), keller_miksis_cash_karp(), relief_valve()})
        if (chosen.cases.empty() ||
            std::find(chosen.cases.begin(), chosen.cases.end(), what.name) != chosen.cases.end())
            all_well = run_case(what, chosen.measure) && all_well;
    if (!std::cout) throw std::runtime_error("the output cannot be written");
    return all_well ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    settings chosen;
    chosen.measure.threads = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1u));
    CLI::App app("Myriad's OpenMP backend beside Boost.odeint and hand-written code");
    app.add_option("--cases", chosen.cases, "Cases to run, all by default")
        ->delimiter(',')
        ->check(CLI::IsMember({"lorenz_rk4", "duffing_cash_karp", "keller_miksis_cash_karp", "relief_valve"}));
    app.add_option("--implementations", chosen.measure.implementations, "Implementations to run, all by default")
        ->delimiter(',')
        ->check(CLI::IsMember({"odeint", "loop", "packs", "myriad"}));
    app.add_option("--instances-scale", chosen.measure.instances_scale, "Factor to the number of instances")
        ->check(CLI::Range(1e-3, 1e4))
        ->capture_default_str();
    auto* const repetitions = app.add_option("--repetitions", chosen.measure.repetitions, "Times that each is timed")
                                  ->check(CLI::Range(1, 1000))
                                  ->capture_default_str();
    app.add_option("--threads", chosen.measure.threads, "OpenMP threads")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    app.add_flag("--quick", chosen.quick, "A quarter of the instances and, if not said otherwise, three repetitions");
    app.add_flag("--check", chosen.check,
                 "Only check what is promised of Myriad's speed, on one thread; exit status 1 if broken");
    app.add_option("--slack", chosen.slack, "Part by which --check lets promises be missed, for busy machines")
        ->check(CLI::Range(0.0, 0.5))
        ->capture_default_str();
    try {
        app.parse(argc, argv);
        if (chosen.quick) {
            chosen.measure.instances_scale *= 0.25;
            if (repetitions->count() == 0) chosen.measure.repetitions = 3;
        }
        return run(chosen);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    } catch (const std::exception& e) {
        std::cerr << e.what() << '\n';
    }
    return 2;
}
