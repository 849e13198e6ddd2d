// SPDX-License-Identifier: MIT
// Command line and output of the benchmark: one CSV row per case, size and implementation, below a header with the
// work, the method and the machine. Exit status 0; 1 if results or check values are wrong; 2 for an error.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "by_hand.hpp"
#include "cases.hpp"
#include "examples/common/exit_status.hpp"
#include "reference.hpp"

namespace {

using namespace gpu_ensembles;

struct settings {
    std::vector<std::string> cases;
    std::string device = "auto", output, commit;
    measure_options measure;
    bool check = false;
};

/// Standard output and, if requested, a file.
class table {
public:
    explicit table(const std::string& path) {
        if (path.empty()) return;
        file_.open(path);
        if (!file_) throw std::runtime_error("the file " + path + " cannot be written");
    }
    void write(const std::string& line) {
        std::cout << line << std::endl;
        if (file_.is_open()) file_ << line << std::endl;
        if (!std::cout || !file_) throw std::runtime_error("the output cannot be written");
    }

private:
    std::ofstream file_;
};

std::string number(double value, const char* format) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

void write_machine(table& out, const myriad::device& device) {
    if (device.which() == myriad::device::kind::cuda) {
        for (const std::string& line : describe_gpu(device.number())) out.write("# " + line);
    } else {
        out.write("# CPU TIMES, of no use but to try the program: " + device.name());
    }
    out.write("# flags: " GPU_ENSEMBLES_FLAGS);
}

void write_header(table& out, const settings& chosen) {
    out.write("# Myriad's CUDA backend");
    write_machine(out, chosen.measure.device);
    if (!chosen.commit.empty()) out.write("# commit: " + chosen.commit);
    out.write("# kernel_ms: data on the device, by CUDA events, uploaded anew for each repetition; median of " +
              std::to_string(chosen.measure.repetitions) + " after a warm-up of 0.2 s, with counting off");
    out.write(
        "# end_to_end_ms: upload, kernel and download of everything, wall clock, host memory pinned before; median of "
        "the same runs");
    out.write("# counting_kernel_ms: one run with counting on, which accepted_steps and rhs_evaluations are from");
    out.write("# failed: instances that ended with a failure status, such as event_accumulation");
    out.write(
        "case,implementation,instances,kernel_ms,end_to_end_ms,accepted_steps,rhs_evaluations,"
        "max_error,median_error,failed,counting_kernel_ms,registers,local_bytes,block_size,located_steps");
}

/// Returns whether the results are right.
bool run_case(table& out, const benchmark_case& what, const measure_options& options) {
    out.write("# " + what.name + ": " + what.work);
    out.write("# " + what.name + ": max_error is " + what.error);
    bool all_right = true;
    for (const std::int64_t nominal : what.sizes) {
        const auto scaled = std::llround(static_cast<double>(nominal) * options.instances_scale);
        const std::int64_t size = std::max(static_cast<std::int64_t>(scaled), compared);
        for (const measurement& m : what.measure(size, options)) {
            const std::string title = "# " + what.name + ' ' + m.implementation + ' ' + std::to_string(size) + ": ";
            const bool right = m.max_error <= what.allowed_error;
            all_right = all_right && right;
            out.write(what.name + ',' + m.implementation + ',' + std::to_string(m.instances) + ',' +
                      number(m.kernel_ms, "%.4f") + ',' + number(m.end_to_end_ms, "%.4f") + ',' +
                      std::to_string(m.accepted_steps) + ',' + std::to_string(m.rhs_evaluations) + ',' +
                      number(m.max_error, "%.3e") + ',' + number(m.median_error, "%.3e") + ',' +
                      std::to_string(m.failed) + ',' + number(m.counting_kernel_ms, "%.4f") + ',' +
                      std::to_string(m.registers) + ',' + std::to_string(m.local_bytes) + ',' +
                      std::to_string(m.block_size) + ',' + std::to_string(m.located_steps));
            if (!right) out.write(title + "WRONG, max_error must be within " + number(what.allowed_error, "%g"));
        }
    }
    return all_right;
}

bool run_checks(table& out, const myriad::device& device) {
    write_machine(out, device);
    bool all_right = true;
    for (const auto& check : {check_lorenz(device), check_relief_valve(device)})
        for (const check_value& c : check) {
            out.write(c.name + ": " + number(c.value, "%.13g") + ", expected " + number(c.expected, "%.13g") +
                      " within " + number(c.allowed, "%g") + (c.right() ? ": right" : ": WRONG"));
            all_right = all_right && c.right();
        }
    return all_right;
}

std::vector<benchmark_case> all_cases() {
    std::vector<benchmark_case> all = lorenz_cases();
    all.push_back(keller_miksis_case());
    all.push_back(relief_valve_case());
    all.push_back(duffing_events_case());
    for (benchmark_case& what : method_cases()) all.push_back(std::move(what));
    all.push_back(schedule_case());
    for (benchmark_case& what : stiff_cases()) all.push_back(std::move(what));
    for (benchmark_case& what : lorenz96_cases()) all.push_back(std::move(what));
    all.push_back(pleiades_case());
    all.push_back(van_der_pol_case());
    for (benchmark_case& what : heavy_cases()) all.push_back(std::move(what));
    for (benchmark_case& what : noise_cases()) all.push_back(std::move(what));
    all.push_back(delays_case());
    all.push_back(delayed_units_case());
    return all;
}

int run(settings& chosen) {
    chosen.measure.device = myriad::device::parse(chosen.device);
    if (chosen.device == "auto" && chosen.measure.device.which() == myriad::device::kind::cpu)
        std::cerr << "no GPU (" << myriad::device::no_gpu() << "): using the CPU\n";
    table out(chosen.output);
    if (chosen.check) return run_checks(out, chosen.measure.device) ? 0 : 1;
    write_header(out, chosen);
    bool all_right = true;
    for (const benchmark_case& what : all_cases())
        if (chosen.cases.empty() ||
            std::find(chosen.cases.begin(), chosen.cases.end(), what.name) != chosen.cases.end())
            all_right = run_case(out, what, chosen.measure) && all_right;
    return all_right ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    settings chosen;
    CLI::App app("Myriad's CUDA backend, beside a hand-written kernel");
    std::vector<std::string> names;
    for (const benchmark_case& what : all_cases()) names.push_back(what.name);
    app.add_option("--cases", chosen.cases, "Cases to run, all by default")
        ->delimiter(',')
        ->check(CLI::IsMember(names));
    app.add_option("--instances-scale", chosen.measure.instances_scale, "Factor to the numbers of instances")
        ->check(CLI::Range(1e-6, 1e3))
        ->capture_default_str();
    app.add_option("--repetitions", chosen.measure.repetitions, "Times that each is timed")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--device", chosen.device, "Where to compute: auto, cpu, cpu:THREADS, cuda or cuda:NUMBER")
        ->capture_default_str();
    app.add_option("--output", chosen.output, "File to write the same lines to");
    app.add_option("--commit", chosen.commit, "What was built, for the header");
    app.add_flag("--check", chosen.check, "Only compare with known results; exit status 1 if they differ");
    try {
        app.parse(argc, argv);
        return run(chosen);
    } catch (const CLI::ParseError& e) {
        return examples::after_output(app.exit(e) == 0 ? 0 : 2);
    } catch (const std::bad_alloc&) {
        std::cerr << "There is not enough memory: give a smaller --instances-scale\n";
    } catch (const std::exception& e) {
        std::cerr << e.what() << '\n';
    }
    return 2;
}
