// SPDX-License-Identifier: MIT
// Validates a backend against CVODE, closed forms and quadruple precision, and against another backend's results. Exit
// status 0 if all bounds are kept, 1 if one is missed, 2 for bad arguments and errors.
#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <myriad/myriad.hpp>
#include <sundials/sundials_config.h>

#include "examples/common/device_option.hpp"
#include "measures/measures.hpp"
#include "problems/problems.hpp"

namespace {

using namespace validation;

struct arguments {
    std::string device = "cpu", output = "results/validation", record, compare;
    std::vector<std::string> problems;
    bool quick = false;

    bool wants(const std::string& name) const {
        return problems.empty() || std::find(problems.begin(), problems.end(), name) != problems.end();
    }
};

/// The processor, as the system names it.
std::string processor() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
    return "unknown";
}

std::vector<std::string> describe(const myriad::device& device) {
    const std::string where =
        device.which() == myriad::device::kind::cpu ? "CPU backend" : "CUDA backend, " + device.description();
    return {"Myriad " MYRIAD_VERSION ": " + where,
            "processor: " + processor() + ", " + std::to_string(std::thread::hardware_concurrency()) + " threads",
            "sources: " MYRIAD_COMMIT, "host compiler: " MYRIAD_COMPILER ", flags of models: " MYRIAD_FLAGS,
            "SUNDIALS " SUNDIALS_VERSION};
}

int validate(const arguments& chosen) {
    const auto begin = std::chrono::steady_clock::now();
    report rows(std::cout);
    recorder record;
    std::unique_ptr<recorded> compare;
    if (!chosen.compare.empty()) compare = std::make_unique<recorded>(chosen.compare);
    session s{myriad::device::parse(chosen.device), chosen.quick ? extent::quick : extent::whole, rows};
    if (!chosen.record.empty()) s.record = &record;
    s.compare = compare.get();
    auto comments = describe(s.device);

    for (const problem& p : all_problems()) {
        if (!chosen.wants(p.name)) continue;
        comments.push_back("problem " + p.name + ": " + p.what);
        const auto start = std::chrono::steady_clock::now();
        const references known = measure_references(s, p);
        const auto referred = std::chrono::steady_clock::now();
        for (const method_entry& m : p.methods) {
            measure_tolerances(s, p, m, known);
            measure_step(s, p, m);
            measure_order(s, p, m, known);
            measure_estimate(s, p, m);
        }
        measure_work(s, p, known);
        const auto seconds = [](auto from, auto to) { return std::chrono::duration<double>(to - from).count(); };
        std::cout << p.name << ": " << seconds(start, referred) << " s for the references, "
                  << seconds(referred, std::chrono::steady_clock::now()) << " s for the rest" << std::endl;
    }
    if (chosen.wants("chaos")) measure_chaos(s);
    if (chosen.wants("orbit")) measure_rounding(s);

    rows.write(chosen.output + "/report.csv", comments);
    if (s.record != nullptr) record.write(chosen.record, comments);
    std::cout << rows.judged() << " bounds checked, " << rows.missed() << " missed, in "
              << std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() << " s\n";
    if (rows.judged() == 0) throw std::runtime_error("nothing was checked: --problems names none of the problems");
    if (compare && compare->found() == 0)
        throw std::runtime_error(chosen.compare + " holds none of the runs: record it anew with --record");
    return rows.missed() == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    arguments chosen;
    CLI::App app("Validates Myriad against SUNDIALS CVODE, closed forms and quadruple precision");
    app.add_option("--device", chosen.device, examples::device_help())->type_name("NAME")->capture_default_str();
    app.add_option("--output", chosen.output, "Folder for report.csv")->type_name("DIR")->capture_default_str();
    app.add_option("--record", chosen.record, "Write the results as reference data for other backends")
        ->type_name("FILE");
    app.add_option("--compare", chosen.compare, "Compare with results recorded on another backend")->type_name("FILE");
    app.add_option("--problems", chosen.problems, "Only these, such as lorenz,kepler,orbit,chaos")
        ->delimiter(',')
        ->type_name("NAME");
    app.add_flag("--quick", chosen.quick, "Fewer tolerances and shorter statistics");
    try {
        app.parse(argc, argv);
        return validate(chosen);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    } catch (const std::exception& e) {
        std::cerr << e.what() << '\n';
        return 2;
    }
}
