// SPDX-License-Identifier: MIT
// Command line and output of the benchmark: one CSV row per case and implementation, below a header that says what was
// measured, how and where. Exit status 0, 1 if a promise of --check is broken or instances failed, 2 for an error.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>

#include "cases.hpp"
#include "lorenz_rk4/equations.hpp"
#include "machine.hpp"
#include "measure.hpp"

namespace {

using namespace cpu_peers;

struct settings {
    std::vector<std::string> cases;
    measure_options measure;
    std::string output;
    bool quick = false, check = false;
};

/// Standard output, and a file if one is wanted.
class table {
public:
    explicit table(const std::string& path) {
        if (path.empty()) return;
        file_.open(path);
        if (!file_) throw std::runtime_error(path + " cannot be written; choose another file with --output");
    }
    void line(const std::string& text) {
        std::cout << text << '\n' << std::flush;
        if (file_.is_open()) file_ << text << '\n' << std::flush;
    }
    void finish() {
        if (!std::cout || (file_.is_open() && !file_)) throw std::runtime_error("the output cannot be written");
    }

private:
    std::ofstream file_;
};

std::string number(double value, const char* format) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

void write_header(table& out, const settings& chosen) {
    out.line("# Myriad beside its peers on the CPU; times are comparable within this run only");
    for (const std::string& line : describe_machine()) out.line("# " + line);
    out.line("# threads: " + std::to_string(chosen.measure.threads));
    out.line(
        "# milliseconds: CPU time of all threads over their number, which is the wall time where nothing else runs; "
        "shortest of " +
        std::to_string(chosen.measure.repetitions) + " repetitions in turns, after one to warm up");
    out.line(
        "# nanoseconds_per_step: milliseconds * threads / accepted_steps, time of one core per step of one instance");
    out.line("# ratio_to_odeint: odeint's milliseconds over these; larger is faster");
    out.line(
        "# max_difference: largest over components and 64 instances spread over the range, |difference| / max(1, "
        "|value|); for each case see below");
    out.line("# idle_lanes: share of lane steps without work");
    out.line(
        "# odeint's error norm is not Myriad's and cannot be made so: its accepted steps differ at the same "
        "tolerances");
}

bool run_case(table& out, const benchmark_case& what, const measure_options& options) {
    out.line("# " + what.name + ": " + what.work);
    out.line("# " + what.name + ": max_difference of the " + what.difference);
    const std::vector<measurement> results = measure(what, options);
    double odeint = 0;
    bool all_well = true;
    for (const measurement& m : results) {
        if (m.implementation == "odeint") odeint = m.milliseconds;
        const std::int64_t accumulated = m.by_ending[static_cast<int>(ending::accumulated)],
                           failed = m.by_ending[static_cast<int>(ending::failed)];
        if (accumulated + failed == 0) continue;
        std::ostringstream text;
        text << "# " << what.name << ' ' << m.implementation << ": " << m.by_ending[static_cast<int>(ending::completed)]
             << " instances completed, " << accumulated << " ended as event_accumulation, " << failed
             << " failed; compared: " << m.compared;
        out.line(text.str());
        all_well = all_well && failed == 0;
    }
    for (const measurement& m : results) {
        std::ostringstream row;
        row << what.name << ',' << m.implementation << ',' << compiler() << ',' << m.instances << ','
            << number(m.milliseconds, "%.3f") << ','
            << number(1e6 * m.milliseconds * options.threads / static_cast<double>(m.accepted_steps), "%.4f") << ','
            << (odeint > 0 ? number(odeint / m.milliseconds, "%.3f") : "") << ',' << number(m.difference, "%.2e") << ','
            << m.accepted_steps << ',' << number(m.idle_share, "%.4f");
        out.line(row.str());
    }
    return all_well;
}

int run(const settings& chosen) {
    if (chosen.check) {
        const bool odeint_counts = compiler().rfind("GNU", 0) == 0 &&
                                   std::string_view(lorenz::instruction_set()).find("avx512") != std::string_view::npos;
        for (const std::string& line : describe_machine()) std::printf("# %s\n", line.c_str());
        return check_promises(odeint_counts) ? 0 : 1;
    }
    table out(chosen.output);
    write_header(out, chosen);
    out.line(
        "case,implementation,compiler,instances,milliseconds,nanoseconds_per_step,ratio_to_odeint,max_difference,"
        "accepted_steps,idle_lanes");
    bool all_well = true;
    for (const benchmark_case& what : {lorenz_rk4(), duffing_cash_karp(), keller_miksis_cash_karp(), relief_valve()})
        if (chosen.cases.empty() ||
            std::find(chosen.cases.begin(), chosen.cases.end(), what.name) != chosen.cases.end())
            all_well = run_case(out, what, chosen.measure) && all_well;
    out.finish();
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
    app.add_option("--output", chosen.output, "File to write the table to, beside standard output")->type_name("FILE");
    app.add_flag("--quick", chosen.quick, "A quarter of the instances and, if not said otherwise, three repetitions");
    app.add_flag("--check", chosen.check,
                 "Only check what is promised of Myriad's speed, on one thread; exit status 1 if broken");
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
