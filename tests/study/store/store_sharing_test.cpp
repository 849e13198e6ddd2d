// SPDX-License-Identifier: MIT
// Processes that share a store and take each other for dead, or are: none of them dies of it, and no result changes.
#include <cerrno>
#include <chrono>
#include <thread>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "myriad/host/core/error.hpp"
#include "myriad/study/store/array_file.hpp"
#include "myriad/study/store/store.hpp"
#include "tests/catch.hpp"
#include "tests/study/store/other_machine.hpp"
#include "tests/study/store/synthetic.hpp"

namespace {

using Catch::Matchers::Contains;
using myriad::store;
using namespace myriad::studies;
using std::chrono::milliseconds;
using tests::commit_synthetic;
using tests::run_synthetic;
using tests::synthetic_layout;
namespace fs = std::filesystem;

enum class when { now, continued };  // at once, or at SIGCONT

// A process that takes so long for each chunk, on a machine of its own if `files` is one.
pid_t start(const std::string& folder, const layout& content, milliseconds each, const store_options& options,
            when begin = when::now) {
    const pid_t child = ::fork();
    if (child != 0) {
        if (begin == when::continued) ::waitpid(child, nullptr, WUNTRACED);
        return child;
    }
    if (begin == when::continued) ::raise(SIGSTOP);
    ::alarm(60);  // rather than wait forever for a claim that nobody gives back
    int status = 0;
    try {
        store mine = store::create_or_resume(folder, content, options);
        while (!mine.complete()) {
            const auto chunk = mine.claim_next();
            std::this_thread::sleep_for(each);
            if (chunk) commit_synthetic(mine, *chunk);
        }
        if (!mine.written("total")) tests::write_total(mine);
    } catch (const std::exception& failure) {
        std::fprintf(stderr, "%s\n", failure.what());
        status = 1;
    }
    ::_exit(status);
}

int status_of(pid_t child) {
    int status = -1;
    ::waitpid(child, &status, 0);
    return status;
}

// Without what says who was at work.
void check_same(const std::string& run, const layout& content, const std::map<std::string, std::string>& expected) {
    run_synthetic(run, content, {.expiry = milliseconds(100)});
    CHECK(store::open(run).verify().empty());
    auto now = tests::contents(run);
    std::erase_if(now, [](const auto& file) { return file.first.starts_with("myriad/writers"); });
    const bool same = now == expected;
    CHECK(same);
}

TEST_CASE("two machines of one host name share a study, and neither dies nor takes the other's work") {
    const layout content = synthetic_layout(8, 2);  // 20 chunks
    tests::temporary_folder folder;
    run_synthetic(folder / "expected", content);
    const auto expected = tests::contents(folder / "expected");
    for (int round = 0; round < 7; ++round) {
        INFO(round);
        const std::string run = folder / "run" + std::to_string(round);
        tests::other_machine elsewhere(folder / "boot");
        const store_options here{.expiry = milliseconds(400)}, there{.expiry = milliseconds(400), .files = &elsewhere};
        std::vector<pid_t> children;
        for (int i = 0; i < 2; ++i) {
            children.push_back(start(run, content, milliseconds(5), here));
            children.push_back(start(run, content, milliseconds(5), there));
        }
        for (const pid_t child : children) CHECK(status_of(child) == 0);
        check_same(run, content, expected);
    }
}

TEST_CASE("processes whose folders are removed again and again make them anew and go on") {
    const layout content = synthetic_layout(20, 4);
    tests::temporary_folder folder;
    run_synthetic(folder / "expected", content);
    const auto expected = tests::contents(folder / "expected");
    const std::string run = folder / "run";
    std::vector<pid_t> children;
    for (int i = 0; i < 3; ++i) children.push_back(start(run, content, milliseconds(2), {}));
    int removed = 0, running = 3;
    while (running > 0) {
        std::error_code ignored;
        removed += fs::remove_all(run + "/myriad/writers", ignored) > 0;
        ::usleep(1000);
        for (pid_t& child : children) {
            int status = -1;
            if (child > 0 && ::waitpid(child, &status, WNOHANG) == child) {
                CHECK(status == 0);
                child = 0;
                --running;
            }
        }
    }
    CHECK(removed > 10);
    fs::remove_all(run + "/myriad/claims");
    check_same(run, content, expected);
}

TEST_CASE("of three processes one is suspended for longer than the expiry, here or elsewhere, and goes on after it") {
    const layout content = synthetic_layout(8, 4);  // 10 chunks
    tests::temporary_folder folder;
    run_synthetic(folder / "expected", content);
    const auto expected = tests::contents(folder / "expected");
    for (const bool is_elsewhere : {false, true}) {
        for (int round = 0; round < 3; ++round) {
            INFO(is_elsewhere << ' ' << round);
            const std::string run = folder / "run" + std::to_string(round) + (is_elsewhere ? "e" : "h");
            tests::other_machine elsewhere(folder / "boot");
            const store_options here{.expiry = milliseconds(100)};
            store_options there = here;
            if (is_elsewhere) there.files = &elsewhere;
            const pid_t sleepy = start(run, content, milliseconds(10), there);
            const pid_t first = start(run, content, milliseconds(10), here);
            const pid_t second = start(run, content, milliseconds(10), here);
            ::usleep(static_cast<useconds_t>(20000 + 7000 * round));
            ::kill(sleepy, SIGSTOP);
            // Elsewhere it is given up, and here waited for: it lives.
            ::usleep(1000000);
            ::kill(sleepy, SIGCONT);
            for (const pid_t child : {sleepy, first, second}) CHECK(status_of(child) == 0);
            check_same(run, content, expected);
        }
    }
}

TEST_CASE("a store that is copied while it runs can be gone on with, and leaves the original alone") {
    const layout content = synthetic_layout(20, 4);
    tests::temporary_folder folder;
    const std::string run = folder / "run";
    // Before this process has threads, of which a child might begin none under ThreadSanitizer.
    const pid_t child =
        start(folder / "copy", content, milliseconds(0), {.expiry = milliseconds(200)}, when::continued);
    store running = store::create_or_resume(run, content);
    for (int i = 0; i < 5; ++i) commit_synthetic(running, running.claim_next().value());
    const std::int64_t under_way = running.claim_next().value();
    fs::copy(run, folder / "copy", fs::copy_options::recursive);
    // Copied at another time than its writer's sign of life.
    const fs::path claim = folder / ("copy/myriad/claims/" + std::to_string(under_way));
    fs::last_write_time(claim, fs::last_write_time(claim) - std::chrono::seconds(1));
    ::kill(child, SIGCONT);
    CHECK(status_of(child) == 0);
    CHECK(store::open(folder / "copy").complete());
    CHECK(store::open(folder / "copy").verify().empty());
    commit_synthetic(running, under_way);
    CHECK(running.progress().chunks == 6);
    CHECK(running.verify().empty());
}

TEST_CASE("a store that is moved or replaced by another study while it runs is not written to") {
    tests::temporary_folder folder;
    const std::string run = folder / "run";
    store running = store::create_or_resume(run, synthetic_layout());
    commit_synthetic(running, 0);
    fs::rename(run, folder / "moved");
    CHECK_THROWS_WITH(commit_synthetic(running, 1), Contains("a folder of the study was removed or moved"));
    CHECK_FALSE(fs::exists(run));
    layout other = synthetic_layout();
    other.description = R"({"model": "another"})";
    store second = store::create_or_resume(run, other);
    CHECK_THROWS_WITH(commit_synthetic(running, 1), Contains("holds something else than when this study began"));
    CHECK(second.progress().chunks == 0);
    // Back again, it goes on.
    fs::rename(run, folder / "other");
    fs::rename(folder / "moved", run);
    CHECK_NOTHROW(commit_synthetic(running, 1));
    CHECK(running.progress().chunks == 2);
    CHECK(running.verify().empty());
}

TEST_CASE("two processes that write one chunk with different bits leave one of them, or none") {
    tests::temporary_folder folder;
    const std::string run = folder / "run";
    store first = store::create_or_resume(run, synthetic_layout());
    REQUIRE(first.claim(0));
    // Another one takes the chunk over, and publishes a part of it with other values while the first one does.
    class interleaved final : public file_system {
    public:
        explicit interleaved(std::string path) : path_(std::move(path)) {}
        int rename(const std::string& from, const std::string& to) override {
            const int result = file_system::rename(from, to);
            if (to == path_) {  // over what was just written: one changed value with its checksum
                const std::vector<double> other(4, 0.5);
                std::uint32_t checksum = 0;
                new_file file = write_array_file(*this, path_ + "-other", array_shape{element::f64, {{"i", 4}}, 4},
                                                 std::as_bytes(std::span(other)), checksum);
                file.finish();
                file_system::rename(path_ + "-other", path_);
                ++times;
            }
            return result;
        }
        int times = 0;

    private:
        std::string path_;
    } disk(run + "/x/c.0");
    store second = store::create_or_resume(run, synthetic_layout(), {.files = &disk});
    commit_synthetic(second, 0);  // without the claim
    CHECK(disk.times == 1);
    CHECK_FALSE(second.done(0));
    CHECK(second.verify().empty());
    commit_synthetic(first, 0);
    CHECK(first.done(0));
    CHECK(first.verify().empty());
}

TEST_CASE("a server that does what it is told and loses its answer is asked again, and harms nothing") {
    // As NFS, where a call that is repeated fails because it was done.
    class forgetful final : public file_system {
    public:
        int rename(const std::string& a, const std::string& b) override {
            return lost(file_system::rename(a, b), ENOENT);
        }
        int link(const std::string& a, const std::string& b) override { return lost(file_system::link(a, b), EEXIST); }
        int mkdir(const std::string& p) override { return lost(file_system::mkdir(p), EEXIST); }
        int unlink(const std::string& p) override { return lost(file_system::unlink(p), ENOENT); }

    private:
        int lost(int result, int code) {
            if (result < 0 || ++calls_ % 41 != 0) return result;
            errno = code;
            return -1;
        }
        int calls_ = 0;
    } server;
    tests::temporary_folder folder;
    run_synthetic(folder / "expected", synthetic_layout());
    run_synthetic(folder / "run", synthetic_layout(), {.files = &server});
    CHECK(store::open(folder / "run").verify().empty());
    check_same(folder / "run", synthetic_layout(), tests::contents(folder / "expected"));
}

TEST_CASE("a finished store is opened on a disk that cannot be written to, and an unfinished one is refused") {
    class read_only final : public file_system {
    public:
        int open(const std::string& p, int flags) override {
            return (flags & O_ACCMODE) == O_RDONLY ? file_system::open(p, flags) : refuse();
        }
        int rename(const std::string&, const std::string&) override { return refuse(); }
        int link(const std::string&, const std::string&) override { return refuse(); }
        int unlink(const std::string&) override { return refuse(); }
        int rmdir(const std::string&) override { return refuse(); }
        int touch(const std::string&) override { return refuse(); }
        int mkdir(const std::string& p) override {
            errno = fs::exists(p) ? EEXIST : EROFS;
            return -1;
        }

    private:
        static int refuse() {
            errno = EROFS;
            return -1;
        }
    } disk;
    tests::temporary_folder folder;
    const std::string run = folder / "run";
    run_synthetic(run, synthetic_layout());
    const auto before = tests::contents(run);
    for (const resume_check check : {resume_check::sizes, resume_check::checksums}) {
        store finished = store::create_or_resume(run, synthetic_layout(), {.check = check, .files = &disk});
        CHECK(finished.complete());
        CHECK_FALSE(finished.claim_next().has_value());
        CHECK(finished.read<double>("x", 4, 1)[0] == tests::synthetic(4, 1));
    }
    CHECK(tests::contents(run) == before);
    fs::resize_file(run + "/x/c.3", 5);
    CHECK_THROWS_WITH(store::create_or_resume(run, synthetic_layout(), {.files = &disk}),
                      Contains("Read-only file system: give a folder that you may write to"));
}

TEST_CASE("a study does not go on with another instruction set, compiler or library, unless that is allowed") {
    tests::temporary_folder folder;
    const std::string run = folder / "run";
    const arithmetic sse2 = arithmetic::of_kernel("sse2", "g++ 12"), avx2 = arithmetic::of_kernel("avx2", "g++ 12");
    const auto commit = [](store& s, const arithmetic& by) {
        const std::int64_t chunk = s.claim_next().value();
        const tests::synthetic_chunk values(s.content(), chunk);
        chunk_record record = values.record();
        record.computed_by = by;
        s.commit(chunk, values.columns(), record);
    };
    {
        store first = store::create_or_resume(run, synthetic_layout(), {.computed_by = sse2});
        // Also at the same time, before any chunk is done.
        CHECK_THROWS_WITH(store::create_or_resume(run, synthetic_layout(), {.computed_by = avx2}),
                          Contains("was begun with sse2, g++ 12") && Contains("has avx2, g++ 12") &&
                              Contains("set MYRIAD_INSTRUCTION_SET"));
        commit(first, sse2);
    }
    CHECK_THROWS_AS(
        store::create_or_resume(run, synthetic_layout(), {.computed_by = arithmetic::of_kernel("sse2", "g++ 13")}),
        myriad::error);
    CHECK_NOTHROW(store::create_or_resume(run, synthetic_layout(), {.computed_by = sse2}));
    {
        store second =
            store::create_or_resume(run, synthetic_layout(), {.computed_by = avx2, .others = other_arithmetic::warn});
        REQUIRE(second.warnings().size() == 1);
        CHECK_THAT(second.warnings()[0], Contains("results differ in their last digits"));
        commit(second, avx2);
        CHECK(second.arithmetics().size() == 2);
    }
    // What the CPU computes nothing of, and what is complete, needs none.
    CHECK_NOTHROW(store::create_or_resume(run, synthetic_layout()));
    run_synthetic(run, synthetic_layout(), {.computed_by = sse2});
    CHECK_NOTHROW(store::create_or_resume(run, synthetic_layout(), {.computed_by = avx2}));
    const store results = store::open(run);
    CHECK(results.arithmetics()[0].text() != results.arithmetics()[1].text());
}

}  // namespace
