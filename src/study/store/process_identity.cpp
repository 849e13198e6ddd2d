// SPDX-License-Identifier: MIT
// Asks the system which processes run.
#include "myriad/study/store/process_identity.hpp"

#include <cerrno>
#include <charconv>
#include <chrono>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <vector>

#include <fcntl.h>
#include <signal.h>
#include <sys/random.h>
#include <unistd.h>

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

// The start of a process in ticks since the machine's, 0 if it cannot be known, or nothing if there is no such process,
// or one that has ended and was not waited for.
std::optional<std::int64_t> start_of(std::int64_t process) {
    std::optional<std::string> text;
    try {
        text = read_text(file_system::real(), message("/proc/", process, "/stat"));
    } catch (const file_error&) {  // it ended just now, or is another user's
    }
    // "number (name) state ...": the name may have spaces and parentheses.
    const std::size_t name_end = text ? text->rfind(')') : std::string::npos;
    if (name_end == std::string::npos)
        return ::kill(static_cast<pid_t>(process), 0) == 0 || errno == EPERM ? std::optional<std::int64_t>(0)
                                                                             : std::nullopt;
    std::istringstream rest(text->substr(name_end + 1));
    std::string state, skipped;
    rest >> state;
    for (int entry = 4; entry < 20; ++entry) rest >> skipped;
    std::int64_t threads = 0, start = 0;
    rest >> threads >> skipped >> start;  // entries 20 to 22
    // A process whose first thread has ended looks the same while others run.
    if (state == "X" || (state == "Z" && threads <= 1)) return std::nullopt;
    return start;
}

std::string host_name() {
    char name[256] = {};
    return ::gethostname(name, sizeof name - 1) == 0 ? name : "";
}

std::string boot_id(file_system& files) {
    try {
        std::string id = read_text(files, "/proc/sys/kernel/random/boot_id").value_or("");
        while (!id.empty() && id.back() == '\n') id.pop_back();
        return id;
    } catch (const file_error&) {
        return "";
    }
}

// Numbers of processes, and the times of their starts, hold in one namespace.
std::string process_space() {
    std::string spaces;
    for (const char* const path : {"/proc/self/ns/pid", "/proc/self/ns/time"}) {
        char space[64] = {};
        if (::readlink(path, space, sizeof space - 1) > 0) spaces += space;
    }
    return spaces;
}

std::int64_t number_of_folder(file_system& files, const std::string& folder) {
    try {
        open_file opened(files, folder, O_RDONLY | O_DIRECTORY);
        return opened.facts().number;
    } catch (const file_error&) {
        return 0;
    }
}

// The writers of this process.
struct writer_list {
    std::mutex mutex;
    std::set<std::string> ids;
    bool has(const std::string& id) {
        const std::lock_guard lock(mutex);
        return ids.contains(id);
    }
};
writer_list& here() {
    static writer_list list;
    return list;
}

// For a name of a file, whose parts '~' separates.
std::string part_of_name(std::string text) {
    for (char& c : text) {
        const bool kept = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.';
        if (!kept) c = '-';
    }
    return text.substr(0, 64);
}

std::int64_t number_in(const std::string& text) {
    std::int64_t value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

}  // namespace

process_identity process_identity::own(file_system& files, const std::string& folder) {
    std::uint64_t random = 0;
    if (::getrandom(&random, sizeof random, 0) != sizeof random)
        random = static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
    return of(message(part_of_name(host_name()), '~', part_of_name(boot_id(files)), '~', part_of_name(process_space()),
                      '~', ::getpid(), '~', start_of(::getpid()).value_or(0), '~', random, '~',
                      number_of_folder(files, folder)));
}

process_identity process_identity::of(std::string_view text) {
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (c == '~')
            parts.emplace_back();
        else
            parts.back() += c;
    }
    process_identity read;
    if (parts.size() != 6 && parts.size() != 7) return read;  // 6: of an earlier version
    // It is part of a path.
    for (const std::string& part : parts)
        if (part != part_of_name(part)) return read;
    read = {std::string(text), parts[0], parts[1], parts[2], number_in(parts[3]), number_in(parts[4]), 0};
    if (parts.size() == 7) read.place = number_in(parts[6]);
    return read;
}

process_state process_identity::state_of(const process_identity& other) const {
    // Names of machines are not asked: two may have the same, and one may be renamed.
    const bool is_of_this_machine = !boot.empty() && other.boot == boot && !space.empty() && other.space == space;
    if (!is_of_this_machine || other.process <= 0 || other.start <= 0) return process_state::unknown;
    if (other.process == ::getpid() && !here().has(other.id) && other.place == place) return process_state::ended;
    const std::optional<std::int64_t> now = start_of(other.process);
    if (!now || (*now != 0 && *now != other.start)) return process_state::ended;
    // It runs, but may be at work elsewhere, if the folder was copied with its claims.
    return other.place == place || other.place == 0 ? process_state::runs : process_state::unknown;
}

void add_own_writer(const std::string& id) {
    const std::lock_guard lock(here().mutex);
    here().ids.insert(id);
}
void remove_own_writer(const std::string& id) {
    const std::lock_guard lock(here().mutex);
    here().ids.erase(id);
}

}  // namespace myriad::studies::inline MYRIAD_ABI
