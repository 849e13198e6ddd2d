// SPDX-License-Identifier: MIT
// Which process is alive, and what happens to the claims of those that are not.
#include "myriad/study/store/writer.hpp"

#include <atomic>
#include <chrono>
#include <ctime>

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/catch.hpp"
#include "tests/study/store/other_machine.hpp"
#include "tests/study/store/synthetic.hpp"

namespace {

using namespace myriad::studies;
using std::chrono::milliseconds;

file_system& disk() { return file_system::real(); }

// The folder that writers share, as a store makes it.
std::string shared_folder(const tests::temporary_folder& folder) {
    make_folders(disk(), folder / "myriad/claims");
    return folder / "myriad";
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

// A process with a writer that claims chunks 0 and 1, has half a temporary file, and waits.
pid_t start_writer(file_system& files, const std::string& shared, milliseconds expiry) {
    int pipe_ends[2];
    REQUIRE(::pipe(pipe_ends) == 0);
    const pid_t child = ::fork();
    if (child == 0) {
        writer mine(files, shared, expiry);
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
    return child;
}
void end(pid_t child) {
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
}

// Whether a claim is given within a time.
bool claims_within(writer& w, std::int64_t chunk, milliseconds time) {
    const auto begin = std::chrono::steady_clock::now();
    while (!w.claim(chunk)) {
        if (std::chrono::steady_clock::now() - begin > time) return false;
        ::usleep(5000);
    }
    return true;
}

TEST_CASE("a process that is killed loses its claims at once, with its files") {
    tests::temporary_folder folder;
    const std::string shared = shared_folder(folder);
    const pid_t child = start_writer(disk(), shared, milliseconds(60000));
    writer other(disk(), shared, milliseconds(60000));
    CHECK_FALSE(other.claim(0));
    ::kill(child, SIGKILL);
    CHECK(claims_within(other, 0, milliseconds(5000)));
    other.remove_dead();
    CHECK(names_in(disk(), shared + "/writers").value().size() == 1);
    CHECK(names_in(disk(), shared + "/claims").value() == std::vector<std::string>{"0"});
    end(child);
}

TEST_CASE("a process of this machine that is stopped keeps its claims and files for longer than the expiry") {
    tests::temporary_folder folder;
    const std::string shared = shared_folder(folder);
    const pid_t child = start_writer(disk(), shared, milliseconds(100));
    writer other(disk(), shared, milliseconds(100));
    ::kill(child, SIGSTOP);
    CHECK_FALSE(claims_within(other, 0, milliseconds(1000)));
    other.remove_dead();
    CHECK(names_in(disk(), shared + "/writers").value().size() == 2);
    end(child);
    CHECK(claims_within(other, 0, milliseconds(5000)));
}

TEST_CASE("two machines of one host name and process numbers leave each other's claims alone while they live") {
    tests::temporary_folder folder;
    const std::string shared = shared_folder(folder);
    tests::other_machine elsewhere(folder / "boot");
    const pid_t child = start_writer(elsewhere, shared, milliseconds(200));
    writer here(disk(), shared, milliseconds(200));
    CHECK_FALSE(claims_within(here, 0, milliseconds(1500)));
    here.remove_dead();
    CHECK(names_in(disk(), shared + "/writers").value().size() == 2);
    end(child);
    // Nobody here knows that it ended, but for its silence.
    CHECK(claims_within(here, 0, milliseconds(20000)));
    here.remove_dead();
    CHECK(names_in(disk(), shared + "/writers").value().size() == 1);
}

TEST_CASE("clocks that jump take nobody's claims, and a claim from the future expires too") {
    tests::temporary_folder folder;
    const std::string shared = shared_folder(folder);
    tests::other_machine elsewhere(folder / "boot");
    // The disk's clock jumps forth and back by a minute at every look; that of a living process still changes.
    class jumping final : public file_system {
    public:
        int facts(int f, file_facts& r) override {
            const int result = file_system::facts(f, r);
            r.modified += (odd_ = !odd_) ? 60'000'000'000 : -60'000'000'000;
            return result;
        }

    private:
        std::atomic<bool> odd_ = false;
    } clock;
    pid_t child = start_writer(elsewhere, shared, milliseconds(300));
    {
        writer here(clock, shared, milliseconds(300));
        CHECK_FALSE(claims_within(here, 0, milliseconds(1500)));
    }
    end(child);
    // Of a day that is to come.
    const timespec tomorrow[2] = {{::time(nullptr) + 86400, 0}, {::time(nullptr) + 86400, 0}};
    REQUIRE(::utimensat(AT_FDCWD, (shared + "/claims/0").c_str(), tomorrow, 0) == 0);
    writer here(disk(), shared, milliseconds(300));
    CHECK(claims_within(here, 0, milliseconds(20000)));
}

TEST_CASE("the claims in a copy of a folder expire although the process of the original lives") {
    tests::temporary_folder folder;
    const std::string shared = shared_folder(folder);
    const pid_t child = start_writer(disk(), shared, milliseconds(100));
    std::filesystem::copy(shared, folder / "copy", std::filesystem::copy_options::recursive);
    writer other(disk(), folder / "copy", milliseconds(100));
    CHECK(claims_within(other, 0, milliseconds(20000)));
    writer original(disk(), shared, milliseconds(100));
    CHECK_FALSE(claims_within(original, 0, milliseconds(500)));
    end(child);
}

TEST_CASE("a writer whose folder is lost makes it anew, as often as that happens") {
    tests::temporary_folder folder;
    const std::string shared = shared_folder(folder);
    writer mine(disk(), shared, milliseconds(60000));
    for (std::int64_t chunk = 0; chunk < 5; ++chunk) {
        std::filesystem::remove_all(shared + "/writers");
        CHECK(mine.claim(chunk));
        CHECK(mine.holds(chunk));
    }
    // Also by itself, before it needs it.
    writer second(disk(), shared, milliseconds(100));
    std::filesystem::remove_all(shared + "/writers");
    const auto begin = std::chrono::steady_clock::now();
    while (!std::filesystem::exists(shared + "/writers") &&
           std::chrono::steady_clock::now() - begin < std::chrono::seconds(10))
        ::usleep(10000);
    CHECK(std::filesystem::exists(shared + "/writers"));
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
