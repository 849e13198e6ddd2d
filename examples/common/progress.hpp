// SPDX-License-Identifier: MIT
// Shows the progress of a long integration: a bar on a terminal, plain lines in a log, nothing if quiet.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include <unistd.h>

namespace examples {

/// To be called from `myriad::options::progress`. Writes to stderr, so that stdout contains only results.
class progress {
public:
    enum class style { automatic, none };

    explicit progress(style how) : quiet_(how == style::none), bar_(is_terminal()) {}
    progress(const progress&) = delete;
    progress& operator=(const progress&) = delete;
    ~progress() { finish(); }

    void operator()(std::int64_t done, std::int64_t total) {
        const auto now = clock::now();
        if (quiet_ || done <= 0 || now - shown_ < (bar_ ? bar_interval : line_interval)) return;
        shown_ = now;
        const double share = static_cast<double>(done) / static_cast<double>(total);
        const double elapsed = std::chrono::duration<double>(now - start_).count();
        const int percent = static_cast<int>(100 * share);
        // Counts finished instances, so that the estimate is too low at first, when all lanes are still busy.
        const std::string left = elapsed < 1 ? "" : ", " + duration(elapsed * (1 - share) / share) + " left";
        if (!bar_) {
            std::fprintf(stderr, "%3d %%%s\n", percent, left.c_str());
            return;
        }
        std::string bar(bar_width, '.');
        std::fill_n(bar.begin(), static_cast<int>(bar_width * share), '#');
        std::fprintf(stderr, "\r\033[K[%s] %3d %%%s", bar.c_str(), percent, left.c_str());
        std::fflush(stderr);
        drawn_ = true;
    }

    /// Removes the bar before other output.
    void finish() {
        if (drawn_) std::fputs("\r\033[K", stderr);
        std::fflush(stderr);
        drawn_ = false;
    }

private:
    using clock = std::chrono::steady_clock;
    static constexpr clock::duration bar_interval = std::chrono::milliseconds(200),
                                     line_interval = std::chrono::seconds(5);
    static constexpr int bar_width = 40;

    static bool is_terminal() {
        const char* const terminal = std::getenv("TERM");
        return ::isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::string_view(terminal) != "dumb";
    }
    static std::string duration(double seconds) {
        const auto s = static_cast<long long>(seconds + 0.5);
        if (s < 60) return std::to_string(s) + " s";
        if (s < 3600) return std::to_string(s / 60) + " min " + std::to_string(s % 60) + " s";
        return std::to_string(s / 3600) + " h " + std::to_string(s / 60 % 60) + " min";
    }

    bool quiet_, bar_, drawn_ = false;
    clock::time_point start_ = clock::now(), shown_ = start_;
};

}  // namespace examples
