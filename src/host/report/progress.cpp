// SPDX-License-Identifier: MIT
// Progress as text.
#include "myriad/host/report/progress.hpp"

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>
#include <string_view>

#include <unistd.h>

#include "myriad/host/core/error.hpp"
#include "myriad/host/report/status_names.hpp"

namespace myriad {
namespace {

/// Digits in groups of three.
std::string grouped(std::int64_t number) {
    std::string text = std::to_string(number);
    for (std::ptrdiff_t at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3)
        text.insert(static_cast<std::size_t>(at), 1, ' ');
    return text;
}
std::string duration(double seconds) {
    const auto s = static_cast<std::int64_t>(seconds + 0.5);
    if (s < 60) return message(s, " s");
    if (s < 3600) return message(s / 60, " min ", s % 60, " s");
    return message(s / 3600, " h ", s / 60 % 60, " min");
}
/// Two digits.
std::string rounded(double rate) {
    if (rate < 1) return message(std::round(100 * rate) / 100);
    const double unit = std::pow(10, std::floor(std::log10(rate)) - 1);
    const double value = std::round(rate / unit) * unit;
    return value < 1e15 && unit >= 1 ? grouped(std::llround(value)) : message(value);
}

bool is_terminal() {
    const char* const terminal = std::getenv("TERM");
    return ::isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::string_view(terminal) != "dumb";
}

}  // namespace

std::ostream& operator<<(std::ostream& stream, const work_progress& p) {
    const auto percent =
        p.total > 0 ? static_cast<std::int64_t>(100.0 * static_cast<double>(p.done) / static_cast<double>(p.total))
                    : 100;
    std::string text = message(percent, " %, ", grouped(p.done), " of ", grouped(p.total), " instances");
    if (p.rate() > 0) text += message(", ", rounded(p.rate()), "/s");
    // The first instances come late, when all lanes have been busy for a while.
    if (p.rate() > 0 && p.seconds >= 1 && p.done < p.total) text += message(", ", duration(p.seconds_left()), " left");
    if (p.failed() > 0) {
        text += message(", ", grouped(p.failed()), " failed (");
        bool first = true;
        for (int s = 0; s < status_count; ++s) {
            const std::int64_t count = p.by_status[static_cast<std::size_t>(s)];
            if (!is_failure(static_cast<status>(s)) || count == 0) continue;
            text += message(first ? "" : ", ", name_of(static_cast<status>(s)), ' ', grouped(count));
            first = false;
        }
        text += ')';
    }
    return stream << text;
}

struct progress_line::shown {
    using clock = std::chrono::steady_clock;

    shown(std::ostream& stream, bool over_again, std::chrono::milliseconds pause)
        : to(stream), overwrites(over_again), interval(pause) {
        if (pause.count() < 0) interval = over_again ? std::chrono::milliseconds(200) : std::chrono::seconds(5);
    }
    ~shown() { clear(); }

    void show(const work_progress& now) {
        if (now.done >= now.total) return clear();
        if (clock::now() - last < interval) return;
        last = clock::now();
        to << (overwrites ? "\r\033[K" : "") << now << (overwrites ? "" : "\n") << std::flush;
        drawn = overwrites;
    }
    void clear() {
        if (drawn) to << "\r\033[K" << std::flush;
        drawn = false;
    }

    std::ostream& to;
    bool overwrites, drawn = false;
    clock::duration interval;
    clock::time_point begin = clock::now(), last = begin;
};

progress_line::progress_line(progress_style how) : progress_line(std::cerr, how) {}
progress_line::progress_line(std::ostream& to, progress_style how, std::chrono::milliseconds pause)
    : shown_(std::make_shared<shown>(
          to, how == progress_style::line || (how == progress_style::automatic && is_terminal()), pause)) {}

void progress_line::operator()(std::int64_t done, std::int64_t total) {
    (*this)({.done = done,
             .total = total,
             .seconds = std::chrono::duration<double>(shown::clock::now() - shown_->begin).count()});
}
void progress_line::operator()(const work_progress& now) { shown_->show(now); }

}  // namespace myriad
