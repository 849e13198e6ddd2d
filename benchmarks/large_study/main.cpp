// SPDX-License-Identifier: MIT
// Lorenz' equations from a billion random starts, ten steps of Runge-Kutta 4 each: set on the device, reduced there to
// a histogram and a mean, and, on request, with one component kept in a folder. Says what an instance takes beside a
// study of fewer instances, how much memory of the host it takes, and, of what is kept, whether the disk or the
// computation is the limit. Exit status 1 if results do not agree.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <numeric>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <myriad/myriad.hpp>
#include <myriad/study.hpp>
#include <sys/resource.h>
#include <unistd.h>

#include "benchmarks/large_study/model.hpp"
#include "examples/common/exit_status.hpp"

namespace {

using model = large_study::lorenz;
using study = myriad::study<model, myriad::runge_kutta_4>;

struct settings {
    std::string device = "auto", keep;
    std::vector<std::string> beside;
    int repetitions = 1;
    std::int64_t instances = 1'000'000'000, small = 10'000'000, chunk = 0;
    bool progress = false;
};

using devices = std::vector<myriad::device>;

void describe(study& s, const settings& chosen, std::int64_t instances, const devices& used) {
    s.repeat(instances);
    s.set("rho", 28);
    s.time_domain(0, 0.1);
    s.generate("random starts");
    s.options.step = 0.01;
    s.options.counting = myriad::counting::off;
    s.keep.status = false;
    s.reduce(myriad::histogram_of("x_end", myriad::linspace(-20, 20, 129)));
    s.reduce(myriad::mean_of("x_end"));
    s.devices = used;
    s.chunk = chosen.chunk;
    if (chosen.progress) s.progress = myriad::progress_line();
}

/// The most memory of the host that the process has had, in GB.
double most_memory() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return static_cast<double>(used.ru_maxrss) * 1024 / 1e9;
}

/// GB per second at which the disk of a folder takes a file of 2 GB, durable at the end.
double disk_rate(const std::string& folder) {
    const std::string path = folder + "/disk_rate";
    const int file = open(path.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
    myriad::require(file >= 0, path, " cannot be written");
    const std::vector<char> block(std::size_t{16} << 20, 'x');
    const auto begin = std::chrono::steady_clock::now();
    bool fine = true;
    constexpr int blocks = 128;
    for (int i = 0; i < blocks && fine; ++i)
        fine = write(file, block.data(), block.size()) == static_cast<ssize_t>(block.size());
    fine = fsync(file) == 0 && fine;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    close(file);
    std::filesystem::remove(path);
    myriad::require(fine, path, " cannot be written: the disk may be full");
    return static_cast<double>(block.size()) * blocks / 1e9 / seconds;
}

double counted(const myriad::study_result& r) {
    double sum = 0;
    for (const char* name : {"x_end_histogram", "x_end_outside"})
        for (const double count : r.values(name)) sum += count;
    return sum;
}

double median_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

int run(const settings& chosen) {
    bool agrees = true;
    const devices alone{myriad::device::parse(chosen.device)};
    devices together = alone;
    for (const std::string& name : chosen.beside) together.push_back(myriad::device::parse(name));
    const auto reduced = [&](std::int64_t instances, const devices& used) {
        study s;
        describe(s, chosen, instances, used);
        const myriad::study_result r = s.run();
        agrees = agrees && r.complete && counted(r) == static_cast<double>(instances);
        return r;
    };
    // Creates what the devices need once.
    (void)reduced(std::min<std::int64_t>(chosen.small, 1'000'000), together);
    std::vector<double> times;
    for (int repetition = 0; repetition < 3; ++repetition) times.push_back(reduced(chosen.small, alone).seconds);
    const double small = median_of(times) / static_cast<double>(chosen.small);

    myriad::study_result all = reduced(chosen.small, alone);
    std::vector<double> seconds, seconds_together;
    for (int repetition = 0; repetition < chosen.repetitions; ++repetition) {
        all = reduced(chosen.instances, alone);
        seconds.push_back(all.seconds);
        if (chosen.beside.empty()) continue;
        const myriad::study_result more = reduced(chosen.instances, together);
        seconds_together.push_back(more.seconds);
        agrees = agrees && more.values("x_end_histogram") == all.values("x_end_histogram") &&
                 more.values("x_end_mean") == all.values("x_end_mean");
    }
    const double taken = median_of(seconds);
    const double large = taken / static_cast<double>(chosen.instances);
    std::cout << "device: " << alone[0].description() << '\n'
              << chosen.small << " instances, reduced: " << 1e9 * small << " ns each, " << median_of(times)
              << " s (median of " << times.size() << ")\n"
              << chosen.instances << " instances, reduced: " << 1e9 * large << " ns each, " << taken << " s (median of "
              << seconds.size() << "); " << large / small << " times as long per instance\n"
              << "most memory of the host: " << most_memory() << " GB\n"
              << "mean of x: " << all.values("x_end_mean")[0] << '\n';
    if (!chosen.beside.empty()) {
        std::cout << "with";
        for (std::size_t d = 1; d < together.size(); ++d) std::cout << ' ' << together[d].name();
        std::cout << " beside it: " << median_of(seconds_together) << " s, " << median_of(seconds_together) / taken
                  << " times as long\n";
    }
    if (!chosen.keep.empty()) {
        const std::string folder = chosen.keep + "/large_study";
        std::filesystem::remove_all(folder);
        std::filesystem::create_directories(folder);
        const double disk = disk_rate(folder);
        study s;
        describe(s, chosen, chosen.instances, alone);
        s.keep.end = {"x"};
        s.store(folder + "/store");
        const myriad::study_result r = s.run();
        const double bytes = static_cast<double>(chosen.instances) * sizeof(double) / 1e9;
        agrees = agrees && r.complete && r.values("x_end_histogram") == all.values("x_end_histogram") &&
                 r.values("x_end_mean") == all.values("x_end_mean");
        std::cout << "x of each kept: " << bytes << " GB in " << r.seconds << " s, " << bytes / r.seconds
                  << " GB/s; the disk took a single file at " << disk << " GB/s, and computing alone would give "
                  << bytes / taken << " GB/s: the " << (bytes / taken > disk ? "disk" : "computation")
                  << " is the limit\n"
                  << "most memory of the host: " << most_memory() << " GB\n";
        std::filesystem::remove_all(folder);
    }
    if (!agrees) std::cout << "WRONG: the results do not agree\n";
    return agrees ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
    settings chosen;
    CLI::App app{"A study of many instances, set and reduced on the device"};
    app.add_option("--instances", chosen.instances, "instances of the large study")->capture_default_str();
    app.add_option("--small", chosen.small, "instances of the small one")->capture_default_str();
    app.add_option("--device", chosen.device, "auto, cpu, cpu:2, cuda, cuda:1")->capture_default_str();
    app.add_option("--beside", chosen.beside, "devices that take part in a second study")->delimiter(',');
    app.add_option("--repetitions", chosen.repetitions, "of the large study, of which the median counts")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--chunk", chosen.chunk, "instances of a chunk; 0: as the study chooses")->capture_default_str();
    app.add_option("--keep", chosen.keep, "a folder in which x of each instance is kept for a while");
    app.add_flag("--progress", chosen.progress, "show progress");
    CLI11_PARSE(app, argc, argv);
    try {
        return examples::after_output(run(chosen));
    } catch (const std::exception& e) {
        std::cerr << e.what() << '\n';
    }
    return 2;
}
