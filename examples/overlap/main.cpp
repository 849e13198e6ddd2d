// SPDX-License-Identifier: MIT
// Solver objects that take turns: while one integrates, others are downloaded, written to a file and filled anew, on one device
// or on several; and the timeline of what overlapped.
#include <atomic>
#include <cstdint>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <myriad/myriad.hpp>

#include "../common/command_line.hpp"
#include "../common/csv_file.hpp"
#include "../common/progress.hpp"
#include "sweep.hpp"
#include "timeline.hpp"
#include "turns.hpp"

namespace {

using solver = myriad::solver<duffing, myriad::cash_karp>;

struct {
    std::vector<std::string> devices;
    std::int64_t solvers = 2, chunks = 16;
    bool check = false;
} own;

/// The sweep in chunks, of which each solver object takes the next when it is done with its last.
class chunked_sweep {
public:
    chunked_sweep(const examples::sweep_options& chosen, const std::vector<myriad::device>& devices)
        : instances_(chosen.instances), chunks_(std::min(own.chunks, instances_)), all_(instances_),
          tables_(std::filesystem::path(chosen.output).replace_extension().string() + "_chunks/"),
          shown_(chosen.quiet ? examples::progress::style::none : examples::progress::style::automatic) {
        for (const myriad::device& where : devices) {
            turns_[where.name()];
            for (std::int64_t i = 0; i < own.solvers; ++i)
                solvers_.emplace_back(where, (instances_ + chunks_ - 1) / chunks_,
                                      duffing_sweep::integration(chosen.phases));
        }
    }

    /// When each step was done, in the order of their beginning.
    std::vector<interval> run() {
        timeline times;
        std::vector<std::exception_ptr> failures(solvers_.size());
        {
            std::vector<std::jthread> threads;
            for (std::size_t n = 0; n < solvers_.size(); ++n)
                threads.emplace_back([&, n] {
                    try {
                        work(solvers_[n], static_cast<int>(n), times);
                    } catch (...) {
                        failures[n] = std::current_exception();
                        next_ = chunks_;  // nobody begins another
                    }
                });
        }
        for (const auto& failure : failures)
            if (failure) std::rethrow_exception(failure);
        shown_.finish();
        return times.sorted();
    }
    const duffing_sweep::results& results() const { return all_; }
    std::int64_t failed() const { return failed_; }
    const std::string& tables() const { return tables_; }

private:
    // snippet: work
    /// A thread for each solver object: chunk by chunk, step by step. What overlaps is the work of different solvers.
    void work(solver& mine, int number, timeline& times) {
        for (std::int64_t chunk = next_++; chunk < chunks_; chunk = next_++) {
            const std::int64_t first = instances_ * chunk / chunks_, count = instances_ * (chunk + 1) / chunks_ - first;
            times.during(step::fill, number, chunk,
                         [&] { duffing_sweep::fill(mine.instances(), first, count, instances_); });
            times.during(step::upload, number, chunk, [&] {
                mine.upload(count);
                mine.wait();
            });
            turns_.at(mine.where().name()).take([&] {  // one integration at a time on each device
                times.during(step::integrate, number, chunk, [&] {
                    mine.integrate();
                    mine.wait();
                });
            });
            times.during(step::download, number, chunk, [&] {
                mine.download({.states = {duffing::x, duffing::v},
                               .accessories = {duffing::x_global_max},
                               .integer_accessories = {duffing::zeros}});
                mine.wait();
            });
            times.during(step::write, number, chunk, [&] {
                all_.take(mine.results(), first, count);
                duffing_sweep::write(table_of(chunk), all_, first, count);
            });
            // end of snippet
            const auto& report = mine.report();
            times.set_kernel_seconds(number, chunk, report.kernel_seconds);
            failed_ += report.failed();
            const std::lock_guard lock(showing_);
            shown_(++done_, chunks_);
        }
    }
    std::string table_of(std::int64_t chunk) const {
        return tables_ + std::to_string(chunk + 1) + "_of_" + std::to_string(chunks_) + ".csv";
    }

    std::int64_t instances_, chunks_;
    duffing_sweep::results all_;
    std::string tables_;
    std::deque<solver> solvers_;  // they can be neither copied nor moved
    std::map<std::string, turns> turns_;
    std::atomic<std::int64_t> next_{0}, failed_{0};
    std::mutex showing_;
    std::int64_t done_ = 0;
    examples::progress shown_;
};

std::vector<myriad::device> chosen_devices(const myriad::device& one) {
    std::vector<myriad::device> devices;
    if (own.devices == std::vector<std::string>{"all"}) {
        for (const myriad::device& d : myriad::devices())
            if (d.which() == myriad::device::kind::cuda) devices.push_back(d);
    } else {
        for (const std::string& name : own.devices) devices.push_back(myriad::device::parse(name));
    }
    if (devices.empty()) devices.push_back(one);
    return devices;
}

void write(examples::csv_file& file, const std::vector<interval>& all, const examples::sweep_options& chosen,
           const std::vector<myriad::device>& devices) {
    using myriad::message;
    file.comment(message("Duffing sweep of ", chosen.instances, " instances over ", chosen.phases,
                         " phases: which solver object did what with which chunk, and when"));
    for (std::size_t d = 0; d < devices.size(); ++d)
        file.comment(message("device ", d, ": ", devices[d].name(), ", ", devices[d].description()));
    file.comment("step: 0 fill, 1 upload, 2 integrate, 3 download, 4 write to a file; begin, end: seconds of the host's "
                 "clock; kernel_seconds: the GPU's own time for the integration");
    file.row("solver", "device", "chunk", "step", "begin", "end", "kernel_seconds");
    for (const interval& i : all)
        file.row(i.solver, i.solver / own.solvers, i.chunk, static_cast<int>(i.what), i.begin, i.end, i.kernel_seconds);
    file.commit();
}

/// Says how much ran at the same time.
void print(const std::vector<interval>& all, const std::vector<myriad::device>& devices) {
    double last = 0, sum = 0;
    for (const interval& i : all) {
        last = std::max(last, i.end);
        sum += i.end - i.begin;
    }
    const auto percent = [&](double seconds) { return std::to_string(100 * seconds / last).substr(0, 4) + " %"; };
    std::cout << last << " s, in which steps of " << sum << " s were done: two or more at once for "
              << percent(seconds_with(all, 2)) << " of the time\n";
    for (std::size_t d = 0; d < devices.size(); ++d) {
        std::vector<interval> integrations;
        double kernels = 0;
        for (const interval& i : all) {
            if (i.what != step::integrate || i.solver / own.solvers != static_cast<std::int64_t>(d)) continue;
            integrations.push_back(i);
            kernels += i.kernel_seconds;
        }
        std::cout << devices[d].name() << " integrated for " << percent(seconds_with(integrations, 1));
        if (kernels > 0) std::cout << "; its kernels took " << kernels << " s";
        std::cout << '\n';
    }
}

int run(const examples::sweep_options& chosen, const myriad::device& device) {
    const auto devices = chosen_devices(device);
    examples::csv_file file(chosen.output);
    chunked_sweep sweep(chosen, devices);
    const auto all = sweep.run();
    if (!chosen.quiet) print(all, devices);
    write(file, all, chosen, devices);
    if (!chosen.quiet) std::cout << "Written to " << chosen.output << " and " << sweep.tables() << '\n';
    if (sweep.failed() > 0) std::cerr << sweep.failed() << " instances failed\n";
    if (!own.check) return sweep.failed() > 0 ? 1 : 0;

    // snippet: whole
    myriad::ensemble<duffing> whole(chosen.instances);
    duffing_sweep::fill(whole, 0, chosen.instances, chosen.instances);
    for (int c = 0; c < duffing::n_accessory; ++c) whole.accessory(c) = 0.0;
    myriad::solve<myriad::cash_karp>(devices.front(), whole, duffing_sweep::integration(chosen.phases));
    duffing_sweep::results expected(chosen.instances);
    expected.take(whole, 0, chosen.instances);
    const bool same = sweep.results() == expected;
    // end of snippet
    if (!same) std::cerr << "The chunks do not have the bits of one call of solve over all of them\n";
    if (same && !chosen.quiet) std::cout << "The chunks have the bits of one call of solve over all of them\n";
    return same && sweep.failed() == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    const auto add_options = [](CLI::App& app) {
        app.add_option("--devices", own.devices, "Devices to spread over, as cuda:0,cuda:1, or all: every GPU")
            ->delimiter(',')
            ->type_name("NAMES");
        app.add_option("--solvers", own.solvers, "Solver objects on each device")
            ->check(CLI::Range(std::int64_t{1}, std::int64_t{16}).description(""))
            ->type_name("N")
            ->capture_default_str();
        app.add_option("--chunks", own.chunks, "Parts of the sweep")
            ->check(CLI::Range(std::int64_t{1}, std::int64_t{100'000}).description(""))
            ->type_name("N")
            ->capture_default_str();
        app.add_flag("--check", own.check, "Integrate it in one call of solve too, and compare the bits");
    };
    return examples::run_sweep(argc, argv,
                               {.description = "Solver objects that take turns over chunks of the Duffing sweep",
                                .full = {.instances = 2'097'152, .phases = 192},
                                .small = {.instances = 8000, .phases = 8},
                                .output = "results/overlap.csv",
                                .phases_help = "Phases to integrate, periods of the forcing",
                                .has_transient = false,
                                .add_options = add_options},
                               run);
}
