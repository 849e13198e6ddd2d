// SPDX-License-Identifier: MIT
// Which process runs here, which has ended, and of which nothing is known.
#include "myriad/study/store/process_identity.hpp"

#include <algorithm>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/catch.hpp"
#include "tests/study/store/other_machine.hpp"
#include "tests/study/store/synthetic.hpp"

namespace {

using namespace myriad::studies;

file_system& disk() { return file_system::real(); }

TEST_CASE("a process has ended if it ran here and does no longer, or is only waited for") {
    tests::temporary_folder folder;
    const process_identity self = process_identity::own(disk(), folder / "");
    CHECK(self.process == ::getpid());
    CHECK(process_identity::of(self.id).id == self.id);
    CHECK(process_identity::of(self.id).start == self.start);
    CHECK(process_identity::of(self.id).place == self.place);
    CHECK(self.state_of(self) == process_state::ended);  // of no writer of this process
    add_own_writer(self.id);
    CHECK(self.state_of(self) == process_state::runs);
    remove_own_writer(self.id);

    int pipe_ends[2];
    REQUIRE(::pipe(pipe_ends) == 0);
    const pid_t child = ::fork();
    if (child == 0) {
        const std::string id = process_identity::own(disk(), folder / "").id;
        const bool sent = ::write(pipe_ends[1], id.data(), id.size()) == static_cast<ssize_t>(id.size());
        if (sent) ::pause();
        ::_exit(1);
    }
    std::string id(500, '\0');
    id.resize(static_cast<std::size_t>(std::max<ssize_t>(0, ::read(pipe_ends[0], id.data(), id.size()))));
    ::close(pipe_ends[0]);
    ::close(pipe_ends[1]);
    const process_identity other = process_identity::of(id);
    CHECK(other.process == child);
    CHECK(self.state_of(other) == process_state::runs);
    // At work in another folder, as that which this one is a copy of.
    process_identity changed = other;
    changed.place = self.place + 1;
    CHECK(self.state_of(changed) == process_state::unknown);
    ::kill(child, SIGKILL);
    siginfo_t ended;
    ::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT);
    CHECK(self.state_of(other) == process_state::ended);  // a zombie
    ::waitpid(child, nullptr, 0);
    CHECK(self.state_of(other) == process_state::ended);
    // The number of a process that runs, which had another before.
    changed = other;
    changed.process = ::getppid();
    CHECK(self.state_of(changed) == process_state::ended);
    // A machine may get another name.
    changed = other;
    changed.host = "elsewhere";
    CHECK(self.state_of(changed) == process_state::ended);
}

TEST_CASE("of a process of another start of the machine, of a container or of an unknown one nothing is known") {
    tests::temporary_folder folder;
    const process_identity self = process_identity::own(disk(), folder / "");
    tests::other_machine elsewhere(folder / "boot");
    const process_identity other = process_identity::own(elsewhere, folder / "");
    CHECK(other.host == self.host);
    CHECK(other.process == self.process);
    CHECK(self.state_of(other) == process_state::unknown);
    CHECK(other.state_of(self) == process_state::unknown);
    process_identity changed = self;
    changed.space = "container";
    CHECK(self.state_of(changed) == process_state::unknown);
    changed = process_identity::of("1");
    CHECK(changed.id.empty());
    CHECK(self.state_of(changed) == process_state::unknown);
    CHECK(process_identity::of("../../x~1~1~1~1~1").id.empty());
    // A machine that cannot tell when it was started knows nothing of others.
    tests::other_machine unknown(folder / "none", "");
    const process_identity first = process_identity::own(unknown, folder / "");
    CHECK(first.state_of(process_identity::own(unknown, folder / "")) == process_state::unknown);
    // Of an earlier version, which did not name the folder.
    CHECK_FALSE(process_identity::of("host~boot~space~5~6~7").id.empty());
}

}  // namespace
