// SPDX-License-Identifier: MIT
// Which process is alive, and what happens to the claims of those that are not.
#include "myriad/study/writer.hpp"

#include <algorithm>
#include <chrono>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/catch.hpp"
#include "tests/study/synthetic.hpp"

namespace {

using namespace myriad::studies;
using std::chrono::milliseconds;

file_system& disk() { return file_system::real(); }

// The folder that writers share, as a store makes it.
std::string shared_folder(const tests::temporary_folder& folder) {
    make_folders(disk(), folder / "myriad/claims");
    return folder / "myriad";
}

TEST_CASE("a process has ended if it ran here and does no longer, or is only waited for") {
    const process_identity self = process_identity::own();
    CHECK(self.process == ::getpid());
    CHECK(process_identity::of(self.id).id == self.id);
    CHECK(process_identity::of(self.id).start == self.start);

    int pipe_ends[2];
    REQUIRE(::pipe(pipe_ends) == 0);
    const pid_t child = ::fork();
    if (child == 0) {
        const std::string id = process_identity::own().id;
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
    CHECK_FALSE(other.ended_here());
    ::kill(child, SIGKILL);
    siginfo_t ended;
    ::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT);
    CHECK(other.ended_here());  // a zombie
    ::waitpid(child, nullptr, 0);
    CHECK(other.ended_here());

    process_identity changed = other;
    changed.host = "elsewhere";
    CHECK_FALSE(changed.ended_here());
    changed = other;
    changed.space = "container";
    CHECK_FALSE(changed.ended_here());
    changed = process_identity::of(std::to_string(1));
    CHECK(changed.id.empty());
    CHECK_FALSE(changed.ended_here());
    CHECK(process_identity::of("../../x~1~1~1~1~1").id.empty());
    // The number of a process that runs, which had another before.
    changed = other;
    changed.process = ::getppid();
    CHECK(changed.ended_here());
    // Before the machine started anew.
    changed = process_identity::own();
    changed.boot = "earlier";
    CHECK(changed.ended_here());
}

TEST_CASE("a writer that gives signs of life keeps its claims for longer than the expiry") {
    tests::temporary_folder folder;
    const std::string shared = shared_folder(folder);
    writer first(disk(), shared, milliseconds(250)), second(disk(), shared, milliseconds(250));
    REQUIRE(first.claim(3));
    CHECK_FALSE(first.claim(3));
    for (int i = 0; i < 20; ++i) {
        CHECK_FALSE(second.claim(3));
        ::usleep(50000);
    }
    first.release(3);
    CHECK(second.claim(3));
    CHECK_FALSE(first.claim(3));
    first.release(3);  // not its own: it stays
    CHECK_FALSE(first.claim(3));
}

TEST_CASE("a process that is stopped loses its claim, and one that is killed loses it at once, with its files") {
    for (const int signal : {SIGSTOP, SIGKILL}) {
        tests::temporary_folder folder;
        const std::string shared = shared_folder(folder);
        int pipe_ends[2];
        REQUIRE(::pipe(pipe_ends) == 0);
        const pid_t child = ::fork();
        if (child == 0) {
            writer mine(disk(), shared, milliseconds(300));
            const char done = mine.claim(0) && mine.claim(1) ? 'y' : 'n';
            std::ofstream(mine.temporary()) << "half";
            if (::write(pipe_ends[1], &done, 1) == 1)
                while (true) ::pause();
            ::_exit(1);
        }
        char done = 'n';
        REQUIRE(::read(pipe_ends[0], &done, 1) == 1);
        REQUIRE(done == 'y');
        ::close(pipe_ends[0]);
        ::close(pipe_ends[1]);
        writer other(disk(), shared, milliseconds(300));
        CHECK_FALSE(other.claim(0));
        ::kill(child, signal);
        const auto begin = std::chrono::steady_clock::now();
        bool taken = false;
        while (!(taken = other.claim(0)) && std::chrono::steady_clock::now() - begin < std::chrono::seconds(20))
            ::usleep(5000);
        const auto waited = std::chrono::steady_clock::now() - begin;
        CHECK(taken);
        if (signal == SIGSTOP) CHECK(waited > milliseconds(200));
        other.remove_dead();
        CHECK(names_in(disk(), shared + "/writers").value().size() == 1);
        CHECK(names_in(disk(), shared + "/claims").value() == std::vector<std::string>{"0"});
        ::kill(child, SIGKILL);
        ::waitpid(child, nullptr, 0);
    }
}

TEST_CASE("a writer leaves nothing, and one that was forked with it leaves it alone") {
    tests::temporary_folder folder;
    const std::string shared = shared_folder(folder);
    {
        writer mine(disk(), shared, milliseconds(60000));
        REQUIRE(mine.claim(5));
        std::ofstream(mine.temporary()) << "half";
        const pid_t child = ::fork();
        if (child == 0) {
            mine.~writer();
            ::_exit(0);
        }
        ::waitpid(child, nullptr, 0);
        CHECK(names_in(disk(), shared + "/claims").value() == std::vector<std::string>{"5"});
        mine.remove_dead();
        CHECK(names_in(disk(), shared + "/claims").value().size() == 1);
    }
    CHECK(names_in(disk(), shared + "/claims").value().empty());
    CHECK(names_in(disk(), shared + "/writers").value().empty());
}

}  // namespace
