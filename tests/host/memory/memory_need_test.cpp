// SPDX-License-Identifier: MIT
// The memory that is left, read from files like the system's; and that too large a need is refused as a whole before
// any memory is taken.
#include "myriad/host/memory/memory_need.hpp"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "tests/host/ensemble/refusal.hpp"
#include "tests/support/device.hpp"

namespace {

using myriad::host::bytes_text;
using myriad::host::bytes_texts;
using myriad::host::memory_left;
using myriad::host::memory_need;

/// A system of a few files.
class files {
public:
    files() : root_(std::filesystem::temp_directory_path() / ("myriad_memory_" + std::to_string(::getpid()))) {
        std::filesystem::remove_all(root_);
        std::filesystem::create_directories(root_);
    }
    ~files() { std::filesystem::remove_all(root_); }
    files& write(const std::string& path, const std::string& text) {
        const auto file = root_ / path;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file) << text << '\n';
        return *this;
    }
    memory_left left() const { return myriad::host::memory_reader(root_.string()).left(); }

private:
    std::filesystem::path root_;
};

constexpr const char* machine = "MemTotal: 32000 kB\nMemFree: 100 kB\nMemAvailable: 20000 kB\nSwapFree: 1000 kB";

}  // namespace

TEST_CASE("where nothing can be read nothing is refused") {
    CHECK(std::isinf(files().left().bytes));
    CHECK(std::isinf(
        files().write("proc/meminfo", "MemTotal: 32000 kB").write("proc/self/cgroup", "0::/a\nnonsense").left().bytes));
}

TEST_CASE("without a limit of its own a program has what the machine has, with swap") {
    files f;
    f.write("proc/meminfo", machine)
        .write("proc/self/cgroup", "0::/user/job")
        .write("sys/fs/cgroup/user/job/memory.max", "max");
    f.write("sys/fs/cgroup/user/job/memory.current", "5000");
    CHECK(f.left().bytes == 1024.0 * 21'000);
    CHECK(f.left().of == "this machine");
}

TEST_CASE("a control group of version 2 leaves its limit less its usage, of which the page cache can be taken back") {
    files f;
    const std::string group = "sys/fs/cgroup/user/job/memory.";
    f.write("proc/meminfo", machine).write("proc/self/cgroup", "0::/user/job");
    f.write(group + "max", "9000000").write(group + "current", "4000000").write(group + "swap.max", "0");
    CHECK(f.left().bytes == 5e6);
    f.write(group + "stat", "anon 2000000\nfile 1500000\ninactive_file 1000000\nactive_file 500000");
    CHECK(f.left().bytes == 6.5e6);
    CHECK(f.left().of == "the control group /user/job/");
    f.write(group + "swap.max", "300000").write(group + "swap.current", "100000");
    CHECK(f.left().bytes == 6.7e6);
    f.write(group + "current", "11000000").write(group + "stat", "").write(group + "swap.max", "0");
    CHECK(f.left().bytes == 0);
}

TEST_CASE("the control groups above limit the program too") {
    files f;
    f.write("proc/meminfo", machine).write("proc/self/cgroup", "0::/user/job");
    f.write("sys/fs/cgroup/user/job/memory.max", "9000000").write("sys/fs/cgroup/user/job/memory.current", "0");
    f.write("sys/fs/cgroup/user/memory.max", "8000000").write("sys/fs/cgroup/user/memory.current", "6000000");
    f.write("sys/fs/cgroup/user/memory.swap.max", "0");
    CHECK(f.left().bytes == 2e6);
    CHECK(f.left().of == "the control group /user/");
}

TEST_CASE("in a container, whose paths begin outside of it, the limit at the top is found") {
    files two;
    two.write("proc/self/cgroup", "0::/../outside/job").write("sys/fs/cgroup/memory.max", "3000000");
    CHECK(two.write("sys/fs/cgroup/memory.current", "1000000").left().bytes == 2e6);
    files one;
    one.write("proc/self/cgroup", "3:cpu,cpuacct:/docker/1\n4:memory:/docker/1\n0::/");
    one.write("sys/fs/cgroup/memory/memory.limit_in_bytes", "3000000");
    CHECK(one.write("sys/fs/cgroup/memory/memory.usage_in_bytes", "500000").left().bytes == 2.5e6);
}

TEST_CASE("a control group of version 1 limits memory, and memory with swap") {
    files f;
    const std::string group = "sys/fs/cgroup/memory/job/memory.";
    f.write("proc/meminfo", machine).write("proc/self/cgroup", "4:memory:/job\n0::/");
    f.write(group + "limit_in_bytes", "9223372036854771712").write(group + "usage_in_bytes", "4000000");
    CHECK(f.left().bytes == 1024.0 * 21'000);
    f.write(group + "limit_in_bytes", "9000000")
        .write(group + "stat", "cache 0\ntotal_inactive_file 700000\ntotal_active_file 300000");
    CHECK(f.left().bytes == 6e6 + 1024.0 * 1000);
    f.write(group + "memsw.limit_in_bytes", "9500000").write(group + "memsw.usage_in_bytes", "4000000");
    CHECK(f.left().bytes == 6.5e6);
}

TEST_CASE("what would take more than there is is refused with its parts, and small needs are not looked at") {
    memory_need need;
    need.add("records", 3.2e9);
    need.add("counters", 20e6);
    need.add("samples", 0);
    refused(
        [&] { need.check("this call", "ask for less", [] {
                  return memory_left{1.5e9, "the control group /job/"};
              }); },
        {"out of memory: this call would take 3.22 GB (records 3.2 GB, counters 20 MB), and 1.5 GB of "
         "the control group /job/ are left: ask for less"});
    need.check("this call", "ask for less", [] { return memory_left{3.22e9, "this machine"}; });
    memory_need small;
    small.add("records", 63e6);
    small.check("this call", "ask for less", [] { return memory_left{0, "this machine"}; });
}

TEST_CASE("sizes are told apart, and never 0.0") {
    CHECK(bytes_text(0) == "0 bytes");
    CHECK(bytes_text(960) == "960 bytes");
    CHECK(bytes_text(1e3) == "1 kB");
    CHECK(bytes_text(45'678) == "45.7 kB");
    CHECK(bytes_text(3.2e9) == "3.2 GB");
    CHECK(bytes_text(9e18) == "9e+09 GB");
    CHECK(bytes_texts(5'004'000, 5'001'000) == std::pair<std::string, std::string>{"5.004 MB", "5.001 MB"});
    CHECK(bytes_texts(40, 20) == std::pair<std::string, std::string>{"40 bytes", "20 bytes"});
}

TEST_CASE(
    "an ensemble, its records, samples, time domains and a solver that no machine has memory for "
    "are refused as a whole") {
    using ensemble_models::bare;
    using ensemble_models::complete;
    const auto here = tests::test_device(1);
    constexpr std::int64_t many = 100'000'000'000;
    refused([] { myriad::ensemble<complete> e(many); },
            {"an ensemble of 100000000000 instances would take ", "states 1600 GB", "accessories", " are left",
             "smaller parts"});
    auto e = good_decays(1000);
    myriad::options o;
    o.phases = 1'000'000'000;
    o.record.states = {bare::x, bare::w};
    refused([&] { myriad::solve<myriad::cash_karp>(here, e, o); },
            {"this call for 1000 instances would take ", "records 16000 GB"});
    o = {};
    o.samples = {.states = {bare::x}, .capacity = 1'000'000'000, .every = 1};
    refused([&] { myriad::solve<myriad::dense<myriad::cash_karp>>(here, e, o); },
            {"this call for 1000 instances", "16000 GB"});
    CHECK((e.phases_done() == 0).all());
    refused([&] { myriad::solver<bare, myriad::cash_karp>(myriad::device::cpu(1), many); },
            {"a solver for 100000000000 instances", "states", "counters"});
    CHECK(myriad::solve<myriad::cash_karp>(here, e).failed() == 0);
}
