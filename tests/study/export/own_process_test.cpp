// SPDX-License-Identifier: MIT
// Work in a process of its own: its data, its errors, its end.
#include "myriad/study/export/own_process.hpp"

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "myriad/study/store/file_system.hpp"
#include "tests/catch.hpp"
#include "tests/study/store/synthetic.hpp"

namespace {

using Catch::Matchers::Contains;
using namespace myriad::studies;

const data_source nothing = [](auto&&...) {};

// What goes wrong if this is the work.
process_error failure_of(const std::function<void()>& work) {
    try {
        in_own_process([&](const data_source&) { work(); }, nothing);
    } catch (const process_error& failure) {
        return failure;
    }
    return {"nothing was thrown", 0};
}

TEST_CASE("a process gets data from the one that it was started by, and writes a file") {
    tests::temporary_folder folder;
    std::mutex locked;  // by a thread that is not in the new process
    const std::lock_guard lock(locked);
    int asked = 0;
    in_own_process(
        [&](const data_source& ask) {
            std::string text(300'000, ' ');  // more than a socket holds
            for (const char letter : {'a', 'b'}) {
                ask({letter, 2, 3}, std::as_writable_bytes(std::span(text)));
                std::ofstream(folder / "file", std::ios::app) << text;
            }
            asked = 100;  // another one's
        },
        [&](const data_request& wanted, std::span<std::byte> answer) {
            ++asked;
            std::memset(answer.data(), static_cast<int>(wanted[0]), answer.size());
        });
    CHECK(asked == 2);
    CHECK(tests::text_of(folder / "file") == std::string(300'000, 'a') + std::string(300'000, 'b'));
}
TEST_CASE("what a process throws is an error here, with its text and its errno") {
    CHECK_THAT(failure_of([] { throw std::runtime_error("no"); }).what(), Contains("no"));
    CHECK(failure_of([] { throw 5; }).code() == 0);
    CHECK(failure_of([] { throw file_error("writing", "x", ENOSPC); }).code() == ENOSPC);
}
// ThreadSanitizer sets errno to 99 before it calls a signal's function, to find functions that spoil it.
#if !defined(__has_feature)
#define __has_feature(name) 0
#endif
constexpr bool hides_errno = __has_feature(thread_sanitizer);

TEST_CASE("a process that a signal ends is an error here, with its errno") {
    const process_error segment = failure_of([] {
        errno = ENOSPC;
        std::raise(SIGSEGV);
    });
    const process_error aborted = failure_of([] {
        errno = EIO;
        std::abort();
    });
    CHECK((segment.code() == ENOSPC || hides_errno));
    CHECK((aborted.code() == EIO || hides_errno));
    const process_error killed = failure_of([] { ::kill(::getpid(), SIGKILL); });
    CHECK(killed.code() == 0);
    CHECK_THAT(killed.what(), Contains("a signal ended the process"));
}
TEST_CASE("a file that gets larger than the limit is an error of its process and not the end of this one") {
    tests::temporary_folder folder;
    const process_error failure = failure_of([&] {
        const rlimit limit{1000, 1000};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        open_file file(file_system::real(), folder / "file", O_WRONLY | O_CREAT);
        file.write(std::vector<std::byte>(2000));
    });
    CHECK(failure.code() == EFBIG);
}
TEST_CASE("what the source of data throws is thrown here, and no process is left") {
    const auto run = [] {
        in_own_process([](const data_source& ask) { ask({}, {}); },
                       [](auto&&...) { throw std::invalid_argument("damaged"); });
    };
    CHECK_THROWS_AS(run(), std::invalid_argument);
    CHECK(::waitpid(-1, nullptr, WNOHANG) == -1);
}
TEST_CASE("a program that ignores the ends of its processes hears how they ended") {
    std::signal(SIGCHLD, SIG_IGN);
    in_own_process([](const data_source&) {}, nothing);
    CHECK_THAT(failure_of([] { throw std::runtime_error("no"); }).what(), Contains("no"));
    std::signal(SIGCHLD, SIG_DFL);
}

}  // namespace
