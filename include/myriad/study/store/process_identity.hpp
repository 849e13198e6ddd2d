// SPDX-License-Identifier: MIT
// Which process is at work in a store, and whether it still runs. Only this run of this machine can be asked for that:
// names of machines and numbers of processes are the same on several.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/store/file_system.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// What is known of a process.
enum class process_state {
    runs,   ///< on this machine
    ended,  ///< it ran on this machine, and does no longer
    /// It is on another machine, in a container, or was on this machine before that started anew. Only its signs of
    /// life tell.
    unknown,
};

/// Which process a writer is.
struct process_identity {
    std::string id;     ///< all of it, and a random number: the name of the writer's folder, and the text of its file
    std::string host;   ///< the name of the machine, for people: several may have it
    std::string boot;   ///< of this run of this machine alone
    std::string space;  ///< among whom numbers of processes and times mean something: a container has its own
    std::int64_t process = 0;
    std::int64_t start = 0;  ///< of the process, in the system's ticks
    /// The number of the folder where it is at work, which a copy of the folder does not have; 0: not known.
    std::int64_t place = 0;

    /// This process, as a new writer to a folder.
    static process_identity own(file_system& files, const std::string& folder);
    /// From its id; empty if the text is none.
    static process_identity of(std::string_view id);

    /// What is known of another one, by this one, which is of this process.
    process_state state_of(const process_identity& other) const;
};

/// Tells this process' writers from those that it had before.
void add_own_writer(const std::string& id);
void remove_own_writer(const std::string& id);

}  // namespace myriad::studies::inline MYRIAD_ABI
