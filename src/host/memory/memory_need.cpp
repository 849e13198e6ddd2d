// SPDX-License-Identifier: MIT
// Reads from the system how much memory is left, and compares.
#include "myriad/host/memory/memory_need.hpp"

#include <algorithm>
#include <fstream>
#include <locale>
#include <sstream>

#include <sys/resource.h>
#include <unistd.h>

namespace myriad::host::inline MYRIAD_ABI {

std::string bytes_text(double bytes, int digits) {
    const char* const units[] = {" bytes", " kB", " MB", " GB"};
    int unit = 0;
    for (; bytes >= 1000 && unit < 3; ++unit) bytes /= 1000;
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(bytes >= 1000 ? 9 : digits);
    text << bytes << units[unit];
    return text.str();
}
std::pair<std::string, std::string> bytes_texts(double one, double other) {
    int digits = 3;
    while (digits < 15 && bytes_text(one, digits) == bytes_text(other, digits)) ++digits;
    return {bytes_text(one, digits), bytes_text(other, digits)};
}

void memory_left::at_most(double other, const std::string& what) {
    if (other < bytes) *this = {std::max(other, 0.0), what};
}

struct memory_reader::file_names {
    const char *limit, *usage, *swap_limit, *swap_usage, *sum_limit, *sum_usage, *inactive, *active;
};
const memory_reader::file_names memory_reader::version_2{
    "memory.max", "memory.current", "memory.swap.max", "memory.swap.current", "", "", "inactive_file", "active_file"};
const memory_reader::file_names memory_reader::version_1{"memory.limit_in_bytes",
                                                         "memory.usage_in_bytes",
                                                         "",
                                                         "",
                                                         "memory.memsw.limit_in_bytes",
                                                         "memory.memsw.usage_in_bytes",
                                                         "total_inactive_file",
                                                         "total_active_file"};

memory_left memory_reader::left() const {
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

std::optional<double> memory_reader::entry(const std::string& file, const std::string& word) const {
    std::ifstream in(root_ + file);
    in.imbue(std::locale::classic());
    double value = 0;
    if (word.empty()) return in >> value ? std::optional(value) : std::nullopt;
    for (std::string read; in >> read;)
        if (read == word) return in >> value ? std::optional(value) : std::nullopt;
    return std::nullopt;
}

void memory_reader::look_at_groups(memory_left& least, const std::string& mount, std::string path,
                                   const file_names& name, double swap) const {
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

memory_left available_memory() {
    memory_left least = memory_reader().left();
    rlimit space{};
    double pages = 0;
    if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY &&
        std::ifstream("/proc/self/statm") >> pages)
        least.at_most(static_cast<double>(space.rlim_cur) - pages * static_cast<double>(sysconf(_SC_PAGESIZE)),
                      "the address space (ulimit -v)");
    return least;
}

void memory_need::add(const char* part, double bytes) {
    if (!(bytes > 0)) return;
    for (auto& there : parts_) {
        if (std::string_view(there.first) == part) {
            there.second += bytes;
            return;
        }
    }
    parts_.emplace_back(part, bytes);
}

void memory_need::check(const std::string& who, const message_part& advice, memory_left (*available)()) const {
    constexpr double worth_asking = 64e6;
    if (bytes() < worth_asking) return;
    const memory_left left = available();
    if (bytes() <= left.bytes) return;
    const auto [needed, there] = bytes_texts(bytes(), left.bytes);
    std::string parts;
    for (const auto& [part, size] : parts_) parts += message(parts.empty() ? "" : ", ", part, ' ', bytes_text(size));
    throw out_of_memory(statement_of("out of memory: ", who, " would take ", needed,
                                     parts_.size() > 1 ? " (" + parts + ')' : std::string(), ", and ", there, " of ",
                                     left.of, " are left", cure, advice));
}

}  // namespace myriad::host::inline MYRIAD_ABI
