// SPDX-License-Identifier: MIT
// One process among those that fill a store: the sign that it is alive, its temporary files, and its claims on chunks.
//
// In the folder, all in myriad/:
//   writers/<id>/alive   a thread changes its time of modification again and again; the id says which process it is
//   writers/<id>/...     temporary files, before they get their names
//   claims/<chunk>       a hard link to a writer's file alive, so made by one atomic call, and renewed with it
// A claim of a process that is dead is renamed to a name of the one who takes it over, which only one can do. Who was
// taken for dead and is not makes its folder anew.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>

#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/store/file_system.hpp"
#include "myriad/study/store/process_identity.hpp"
#include "myriad/study/store/signs_of_life.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// This process as a writer to a store. Functions may be called by several threads at a time.
class writer {
public:
    /// `folder` is the store's folder myriad/, which must be there.
    writer(file_system& files, std::string folder, std::chrono::milliseconds expiry);
    /// Removes all traces. Not in a process that was forked from the one which made it.
    ~writer();
    writer(const writer&) = delete;
    writer& operator=(const writer&) = delete;

    /// A path for a new temporary file.
    std::string temporary();
    /// Is there again if another process took this one for dead, after which its temporary files are lost.
    void appear();
    /// Whether this writer has the claim on a chunk in the folder.
    bool holds(std::int64_t chunk) const;

    /// Takes a chunk, if need be from a dead process. False if another has it.
    bool claim(std::int64_t chunk);
    /// Gives a chunk back; it may be no longer, or never have been, this writer's. Does not throw: what stays is taken
    /// over when this process has ended.
    void release(std::int64_t chunk) noexcept;
    /// Removes writers that are dead, with their temporary files and claims.
    void remove_dead();
    /// Removes the claims on chunks that are done, whosever they are.
    void remove_claims(const std::function<bool(std::int64_t chunk)>& is_done);

private:
    std::string path_of(std::int64_t chunk) const;
    std::string alive() const;
    // Whether the writer of the claim or sign of life at `path` is dead; `was` is where that was before it was renamed.
    bool is_dead(const std::string& path, process_identity* who = nullptr, const std::string& was = "");
    bool take_away(const std::string& claim);
    void remove_writer(const std::string& id) noexcept;
    void leave() noexcept;
    void stay_alive();

    file_system& files_;
    std::string folder_;
    std::chrono::milliseconds expiry_;
    process_identity self_;
    signs_of_life others_;
    std::int64_t owner_;  // the number of the process that made it

    std::mutex mutex_;
    std::int64_t temporaries_ = 0;
    std::set<std::int64_t> held_;

    // The thread that renews the sign of life, and what ends it. In one place, which a forked process leaves alone.
    struct heartbeat {
        std::mutex mutex;
        bool ending = false;
        std::condition_variable end;
        std::thread thread;
    };
    std::unique_ptr<heartbeat> heartbeat_;
};

}  // namespace myriad::studies::inline MYRIAD_ABI
