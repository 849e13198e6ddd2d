// SPDX-License-Identifier: MIT
// Progress by work done: instances finished, their rate, the time left and failures, in one line on a terminal and in
// plain lines elsewhere. Host code only.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <iosfwd>
#include <memory>

#include "myriad/host/report/status_names.hpp"
#include "myriad/kernel/core/status.hpp"

namespace myriad {

/// How far a study has come.
struct work_progress {
    std::int64_t done = 0;     ///< instances that are finished, also by an earlier run
    std::int64_t total = 0;    ///< all instances
    std::int64_t earlier = 0;  ///< instances that were finished before this run
    double seconds = 0;        ///< since this run began
    /// Instances of this run with each status, as far as their chunks are finished.
    std::array<std::int64_t, status_count> by_status{};

    /// Instances per second in this run; 0 before the first is finished.
    double rate() const { return seconds > 0 ? static_cast<double>(done - earlier) / seconds : 0; }
    /// The time that the rest takes at that rate; infinity if it is zero.
    double seconds_left() const { return static_cast<double>(total - done) / rate(); }
    /// Instances with a failure status.
    std::int64_t failed() const { return host::failed_in(by_status); }
};

/// Prints "37 %, 17 152 of 46 080 instances, 1.2e+03/s, 24 s left", and failures by their status.
std::ostream& operator<<(std::ostream& stream, const work_progress& p);

/// How progress is shown.
enum class progress_style {
    automatic,  ///< `line` if standard error is a terminal, otherwise `lines`
    line,       ///< one line that is written over again, at most five times a second
    lines,      ///< a new line at most every five seconds
};

/// Shows progress on standard error: what `any_study::progress` and `options::progress` may be set to. Copies share one
/// line. The line is removed when all is done, and with the last copy.
class progress_line {
public:
    explicit progress_line(progress_style how = progress_style::automatic);
    /// The same on another stream, which must outlive it; `pause` is the least time between two texts, by default that
    /// of the style.
    progress_line(std::ostream& to, progress_style how,
                  std::chrono::milliseconds pause = std::chrono::milliseconds(-1));

    /// For `options::progress`.
    void operator()(std::int64_t done, std::int64_t total);
    /// For studies.
    void operator()(const work_progress& now);

private:
    struct shown;
    std::shared_ptr<shown> shown_;
};

}  // namespace myriad
