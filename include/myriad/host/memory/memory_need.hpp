// SPDX-License-Identifier: MIT
// How much memory the program may still allocate: Linux overcommits memory, and kills a program that uses more than
// there is. So the library checks before it allocates much. Host code only.
#pragma once

#include <algorithm>
#include <fstream>
#include <limits>
#include <locale>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

#include "myriad/host/core/error.hpp"

namespace myriad::host {

/// Bytes in human-readable form: "1.53 GB".
inline std::string bytes_text(double bytes, int digits = 3) {
    const char* const units[] = {" bytes", " kB", " MB", " GB"};
    int unit = 0;
    for (; bytes >= 1000 && unit < 3; ++unit) bytes /= 1000;
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(bytes >= 1000 ? 9 : digits);
    text << bytes << units[unit];
    return text.str();
}
/// Two of them, with enough digits to tell them apart.
inline std::pair<std::string, std::string> bytes_texts(double one, double other) {
    int digits = 3;
    while (digits < 15 && bytes_text(one, digits) == bytes_text(other, digits)) ++digits;
    return {bytes_text(one, digits), bytes_text(other, digits)};
}

/// Memory that is left, and what limits it. Limits that cannot be read are ignored.
struct memory_left {
    double bytes = std::numeric_limits<double>::infinity();
    std::string of = {};

    void at_most(double other, const std::string& what) {
        if (other < bytes) *this = {std::max(other, 0.0), what};
    }
};

/// Reads the system's files below `root`.
class memory_reader {
public:
    explicit memory_reader(std::string root = "") : root_(std::move(root)) {}

    /// The minimum of what is left in the machine and in the program's control groups (versions 1 and 2) with all their
    /// ancestors.
    memory_left left() const {
        memory_left least;
        const double swap = 1024 * entry("/proc/meminfo", "SwapFree:").value_or(0);
        if (const auto available = entry("/proc/meminfo", "MemAvailable:"))
            least.at_most(1024 * *available + swap, "this machine");
        std::ifstream groups(root_ + "/proc/self/cgroup");
        for (std::string line; std::getline(groups, line);) {  // number:controllers:path
            const std::size_t first = line.find(':'), second = line.find(':', first + 1);
            if (first == std::string::npos || second == std::string::npos) continue;
            const std::string controllers = ',' + line.substr(first + 1, second - first - 1) + ',',
                              path = line.substr(second + 1);
            if (controllers == ",,") {
                look_at_groups(least, "/sys/fs/cgroup", path, version_2, swap);
                look_at_groups(least, "/sys/fs/cgroup/unified", path, version_2, swap);
            } else if (controllers.find(",memory,") != std::string::npos) {
                look_at_groups(least, "/sys/fs/cgroup/memory", path, version_1, swap);
            }
        }
        return least;
    }

private:
    struct file_names {
        const char *limit, *usage, *swap_limit, *swap_usage, *sum_limit, *sum_usage, *inactive, *active;
    };
    static constexpr file_names version_2{"memory.max", "memory.current", "memory.swap.max", "memory.swap.current", "",
                                          "",           "inactive_file",  "active_file"};
    static constexpr file_names version_1{"memory.limit_in_bytes",
                                          "memory.usage_in_bytes",
                                          "",
                                          "",
                                          "memory.memsw.limit_in_bytes",
                                          "memory.memsw.usage_in_bytes",
                                          "total_inactive_file",
                                          "total_active_file"};

    /// The number after a word, or the file's only number.
    std::optional<double> entry(const std::string& file, const std::string& word = "") const {
        std::ifstream in(root_ + file);
        in.imbue(std::locale::classic());
        double value = 0;
        if (word.empty()) return in >> value ? std::optional(value) : std::nullopt;
        for (std::string read; in >> read;)
            if (read == word) return in >> value ? std::optional(value) : std::nullopt;
        return std::nullopt;
    }

    /// The group at `path` and all its ancestors. In a container a path may begin outside of it; groups that do not
    /// exist are skipped.
    void look_at_groups(memory_left& least, const std::string& mount, std::string path, const file_names& name,
                        double swap) const {
        for (;; path.resize(path.rfind('/'))) {
            while (!path.empty() && path.back() == '/') path.pop_back();
            const std::string group = mount + path + '/', called = "the control group " + path + '/';
            // The system reclaims the file cache when programs need memory.
            const double cache = entry(group + "memory.stat", name.inactive).value_or(0) +
                                 entry(group + "memory.stat", name.active).value_or(0);
            const auto limit = entry(group + name.limit), usage = entry(group + name.usage);
            const auto swap_limit = entry(group + name.swap_limit);
            const double swapped =
                swap_limit ? std::min(swap, *swap_limit - entry(group + name.swap_usage).value_or(0)) : swap;
            if (limit && usage) least.at_most(*limit - *usage + cache + std::max(swapped, 0.0), called);
            const auto sum_limit = entry(group + name.sum_limit), sum_usage = entry(group + name.sum_usage);
            if (sum_limit && sum_usage) least.at_most(*sum_limit - *sum_usage + cache, called);
            if (path.find('/') == std::string::npos) return;
        }
    }

    std::string root_;
};

/// What is left now, including address space.
inline memory_left available_memory() {
    memory_left least = memory_reader().left();
    rlimit space{};
    double pages = 0;
    if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY &&
        std::ifstream("/proc/self/statm") >> pages)
        least.at_most(static_cast<double>(space.rlim_cur) - pages * static_cast<double>(sysconf(_SC_PAGESIZE)),
                      "the address space (ulimit -v)");
    return least;
}

/// The memory that something is going to allocate, part by part.
class memory_need {
public:
    void add(const char* part, double bytes) {
        if (bytes > 0) parts_.emplace_back(part, bytes);
    }
    double bytes() const {
        double sum = 0;
        for (const auto& part : parts_) sum += part.second;
        return sum;
    }
    /// Throws `error` unless that much is available; not checked for a few megabytes. `who` allocates it; `advice` says
    /// what to do.
    void check(const std::string& who, const char* advice, memory_left (*available)() = &available_memory) const {
        constexpr double worth_asking = 64e6;
        if (bytes() < worth_asking) return;
        const memory_left left = available();
        if (bytes() <= left.bytes) return;
        const auto [needed, there] = bytes_texts(bytes(), left.bytes);
        std::string parts;
        for (const auto& [part, size] : parts_)
            parts += message(parts.empty() ? "" : ", ", part, ' ', bytes_text(size));
        throw error(message("out of memory: ", who, " would take ", needed,
                            parts_.size() > 1 ? " (" + parts + ')' : std::string(), ", and ", there, " of ", left.of,
                            " are left: ", advice));
    }

private:
    std::vector<std::pair<const char*, double>> parts_;
};

}  // namespace myriad::host
