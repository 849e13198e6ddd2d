// SPDX-License-Identifier: MIT
// A sweep in chunks on several solver objects, each driven by a thread of its own.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <myriad/myriad.hpp>

#include "../common/command_line.hpp"
#include "sweep.hpp"
#include "timeline.hpp"
#include "turns.hpp"

/// The sweep in `chunks` parts. Each solver object (`solvers` per device) takes the next chunk when it has finished its
/// last.
class chunked_sweep {
    using solver = myriad::solver<duffing, myriad::cash_karp>;

public:
    chunked_sweep(const examples::sweep_options& chosen, const std::vector<myriad::device>& devices,
                  std::int64_t solvers, std::int64_t chunks)
        : instances_(chosen.instances), chunks_(std::min(chunks, instances_)), all_(instances_),
          tables_(std::filesystem::path(chosen.output).replace_extension().string() + "_chunks/") {
        if (!chosen.quiet) show_ = myriad::progress_line();
        for (const myriad::device& where : devices) {
            turns_[where.name()];
            for (std::int64_t i = 0; i < solvers; ++i)
                solvers_.emplace_back(where, (instances_ + chunks_ - 1) / chunks_,
                                      duffing_sweep::integration(chosen.phases));
        }
    }

    /// The intervals of all steps, in the order of their beginning.
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
                        next_ = chunks_;  // no thread begins another chunk
                    }
                });
        }
        for (const auto& failure : failures)
            if (failure) std::rethrow_exception(failure);
        return times.sorted();
    }
    const duffing_sweep::results& results() const { return all_; }
    std::int64_t failed() const { return failed_; }
    const std::string& tables() const { return tables_; }

private:
    // snippet: work
    /// A thread per solver object: chunk by chunk, step by step. The work of different solvers overlaps.
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
            done_ += count;
            if (show_) show_(done_, instances_);
        }
    }
    std::string table_of(std::int64_t chunk) const {
        return tables_ + std::to_string(chunk + 1) + "_of_" + std::to_string(chunks_) + ".csv";
    }

    std::int64_t instances_, chunks_;
    duffing_sweep::results all_;
    std::string tables_;
    std::deque<solver> solvers_;  // solvers can be neither copied nor moved
    std::map<std::string, turns> turns_;
    std::atomic<std::int64_t> next_{0}, failed_{0};
    std::mutex showing_;
    std::int64_t done_ = 0;
    std::function<void(std::int64_t done, std::int64_t total)> show_;
};
