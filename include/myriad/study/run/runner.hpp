// SPDX-License-Identifier: MIT
// Runs a study: chunks are handed out to all devices, computed, reduced and stored, each device working on one chunk
// while the next is prepared and the last one stored. Host code only.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "myriad/host/backend/device.hpp"
#include "myriad/host/report/progress.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/core/status.hpp"
#include "myriad/study/plan/study_plan.hpp"
#include "myriad/study/run/chunk_solver.hpp"
#include "myriad/study/run/result_keeper.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// How a study is run.
struct run_settings {
    std::vector<device> devices;
    std::int64_t piece = 0;            ///< most instances in the host's memory at a time; 0: a chunk
    double tried_after = 0.25;         ///< seconds of GPUs alone, before a CPU beside them is tried
    std::function<bool()> stops = {};  ///< whether to end after the chunks under way; called by all threads
    std::chrono::milliseconds patience = std::chrono::seconds(10);  ///< with them then; slower ones are given up
    std::function<void(const work_progress&)> progress = {};        ///< may be empty
    std::function<void(const std::string&)> warning = {};           ///< may be empty
};

/// How a run went.
struct run_outcome {
    bool complete = false;
    std::int64_t instances = 0;
    double seconds = 0;
    std::array<std::int64_t, status_count> by_status{};
    std::vector<statement> notes;
    std::vector<std::string> warnings;
};

/// Computes all chunks that are not done, and then the reductions. Callbacks are called in this thread. A GPU that
/// fails is dropped with a warning, and its chunk is done elsewhere; where memory is too short, fewer instances are
/// integrated at a time. Throws `error` if all devices fail, and what the CPU throws.
run_outcome run_study(const any_model& model, const study_plan& plan, result_keeper& keeper,
                      const run_settings& settings);

}  // namespace myriad::studies::inline MYRIAD_ABI
