// SPDX-License-Identifier: MIT
// Compares the methods with each other: work, time and error on three problems over a range of tolerances. Exit status
// 0 if all is well, 1 if results are wrong, 2 for an error, with its reason on stderr.
#include <algorithm>
#include <csignal>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "examples/common/csv_file.hpp"
#include "examples/common/device_option.hpp"
#include "examples/common/exit_status.hpp"
#include "measure.hpp"

namespace {

using namespace methods;

template <class Model>
bool run_explicit(const study<Model>& of, const settings& chosen, const output& out) {
    return run<myriad::dormand_prince_8>(
        of, chosen, out, named<myriad::cash_karp>{"cash_karp"}, named<myriad::dormand_prince_5>{"dormand_prince_5"},
        named<myriad::tsitouras_5>{"tsitouras_5"}, named<tsitouras_5_pi>{"tsitouras_5 pi"},
        named<myriad::verner_7>{"verner_7"}, named<myriad::dormand_prince_8>{"dormand_prince_8"},
        named<dormand_prince_8_pi>{"dormand_prince_8 pi"}, named<dormand_prince_8_rms>{"dormand_prince_8 rms"});
}

// The number of steps of order two grows with the cube root of the tolerance's reciprocal.
bool run_robertson(const settings& chosen, const output& out) {
    return run<myriad::rodas_5p>(robertson_study(), chosen, out, named<myriad::rosenbrock_23>{"rosenbrock_23", 1e-8},
                                 named<myriad::rodas_5p>{"rodas_5p"}, named<rodas_5p_pi>{"rodas_5p pi"});
}

struct choice {
    std::string name;
    std::function<bool(const settings&, const output&)> run;
};
std::vector<choice> all_cases() {
    const auto explicit_methods = [](const auto& study) {
        return choice{study.name, [study](const settings& s, const output& o) { return run_explicit(study, s, o); }};
    };
    return {explicit_methods(keller_miksis_study()),
            explicit_methods(relief_valve_study()),
            explicit_methods(closely_watched_valve_study()),
            {robertson_study().name, run_robertson}};
}

bool run_chosen(const std::vector<std::string>& names, const settings& chosen, const std::string& device,
                const std::string& path) {
    const auto file = path.empty() ? nullptr : std::make_unique<examples::csv_file>(path);
    const auto comment = [&](const std::string& text) {
        std::cout << "# " << text << '\n';
        if (file) file->comment(text);
    };
    const auto line = [&](const auto& first, const auto&... more) {
        std::cout << first;
        ((std::cout << ',' << more), ...);
        std::cout << std::endl;
        if (file) file->row(first, more...);
    };
    examples::announce(device, chosen.device);
    const bool on_gpu = chosen.device.which() == myriad::device::kind::cuda;
    comment("device: " + chosen.device.name() + (on_gpu ? " (" + chosen.device.description() + ")" : "") +
            "; host compiler " __VERSION__ "; double precision, work counted");
    comment(std::string("milliseconds: shortest of ") + std::to_string(chosen.repetitions) + " runs, " +
            (on_gpu ? "of the kernel" : "of processor time, comparable within this table only"));
    line("case", "method", "device", "instances", "tolerance", "milliseconds", "accepted", "rejected",
         "rhs_evaluations", "median_error", "largest_error", "failed", "astray");
    const output out{comment, [&](const row& r) {
                         line(r.study, r.method, chosen.device.name(), r.instances, r.tolerance, r.milliseconds,
                              r.accepted, r.rejected, r.evaluations, r.error.median, r.error.largest, r.failed,
                              r.error.astray);
                     }};
    bool right = true;
    for (const choice& c : all_cases())
        if (names.empty() || std::find(names.begin(), names.end(), c.name) != names.end())
            right = c.run(chosen, out) && right;
    if (!std::cout.flush()) throw std::runtime_error("standard output cannot be written");
    if (file) file->commit();
    return right;
}

}  // namespace

int main(int argc, char** argv) {
    settings chosen;
    std::vector<std::string> names, known;
    std::string device = "cpu:1", path;
    for (const choice& c : all_cases()) known.push_back(c.name);
    CLI::App app("Methods of integration beside each other: work, time and error over the tolerance");
    app.add_option("--case", names, "Cases to run, all by default")->delimiter(',')->check(CLI::IsMember(known));
    app.add_option("--instances", chosen.instances, "Number of instances; 0: as many as suit case and device")
        ->check(CLI::Range(0, 100'000'000))
        ->capture_default_str();
    app.add_option("--tolerances", chosen.tolerances, "Relative tolerances, by default those of the case")
        ->delimiter(',')
        ->check(CLI::PositiveNumber);
    app.add_option("--repetitions", chosen.repetitions, "Times that each is timed")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--device", device, examples::device_help())->type_name("NAME")->capture_default_str();
    app.add_option("--output", path, "File to write the same table to, as comma-separated values")->type_name("FILE");
    std::signal(SIGXFSZ, SIG_IGN);  // so that a limit on file size is an error of the writer
    try {
        app.parse(argc, argv);
        chosen.device = myriad::device::parse(device);
        return run_chosen(names, chosen, device, path) ? 0 : 1;
    } catch (const CLI::ParseError& e) {
        return examples::after_output(app.exit(e) == 0 ? 0 : 2);
    } catch (const std::bad_alloc&) {
        std::cerr << "There is not enough memory: give fewer --instances\n";
    } catch (const std::exception& e) {
        std::cerr << e.what() << '\n';
    }
    return 2;
}
