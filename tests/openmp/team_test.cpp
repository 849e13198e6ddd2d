// SPDX-License-Identifier: MIT
// Teams of threads: no more than there is work for or than the system allows, in a child process too, on sufficient
// stacks and in a floating-point environment of their own; and exceptions from a model's function.
#include <atomic>
#include <cfenv>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>

#include <omp.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "myriad/host/threads/parallel.hpp"
#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/host/ensemble/refusal.hpp"
#include "tests/openmp/models.hpp"

using namespace teams;
using myriad::device, myriad::runge_kutta_4, myriad::cash_karp, myriad::status;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define MYRIAD_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define MYRIAD_SANITIZED 1
#endif
#endif

namespace {

const myriad::options by_tenths{.step = 0.1};

myriad::ensemble<ring> rings(std::int64_t size) {
    myriad::ensemble<ring> e(size);
    for (int c = 0; c < ring::masses; ++c) e.state(c) = Eigen::ArrayXd::LinSpaced(size, c, c + 1);
    e.parameter(ring::rate) = 0.5;
    e.time_domain(0, 1);
    return e;
}
myriad::ensemble<root> roots(std::int64_t size) {
    myriad::ensemble<root> e(size);
    e.state(root::x) = Eigen::ArrayXd::LinSpaced(size, 1, 2);
    e.state(root::y) = 0.0;
    e.parameter(root::rate) = Eigen::ArrayXd::LinSpaced(size, 0.5, 1.5);
    e.time_domain(0, 1);
    return e;
}
myriad::ensemble<thrower> throwers(std::int64_t size) {
    myriad::ensemble<thrower> e(size);
    e.state(thrower::x) = 0.0;
    e.time_domain(0, 1);
    return e;
}

template <class Model>
bool same_states(const myriad::ensemble<Model>& a, const myriad::ensemble<Model>& b) {
    bool same = true;
    for (int c = 0; c < myriad::detail::n_state<Model>; ++c)
        same = same && std::memcmp(a.state(c).data(), b.state(c).data(),
                                   static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
    return same;
}

int threads_of_process() {
    std::ifstream file("/proc/self/status");
    for (std::string line; std::getline(file, line);)
        if (line.rfind("Threads:", 0) == 0) return std::stoi(line.substr(8));
    return 0;
}

}  // namespace

TEST_CASE("4096 threads for three instances are as many as have something to do") {
    auto few = rings(3);
    const int before = threads_of_process();
    const auto report = myriad::solve<runge_kutta_4>(device::cpu(4096), few, by_tenths);
    CHECK(report.threads == (3 + report.lanes - 1) / report.lanes);
    CHECK(report.count(status::success) == 3);
    CHECK(threads_of_process() <= before + 3);
}

TEST_CASE("the report tells how many threads OpenMP gave, not how many were asked for") {
    auto e = rings(1000);
    CHECK(myriad::solve<runge_kutta_4>(device::cpu(3), e, by_tenths).threads == 3);
    int inside = 0;
#pragma omp parallel num_threads(2)
#pragma omp single
    inside = myriad::solve<runge_kutta_4>(device::cpu(3), e, by_tenths).threads;
    CHECK(inside == 1);
}

#if !defined(MYRIAD_SANITIZED)
TEST_CASE("threads that the system does not have are done without") {
    auto e = rings(10'000), expected = rings(10'000);
    myriad::solve<runge_kutta_4>(device::cpu(1), expected, by_tenths);
    int threads = 0;
    std::thread caller([&] {  // a thread for which OpenMP has no threads yet
        rlimit before{};
        getrlimit(RLIMIT_AS, &before);
        std::ifstream file("/proc/self/statm");
        rlim_t pages = 0;
        file >> pages;
        rlimit limit = before;
        limit.rlim_cur = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (rlim_t{200} << 20);
        setrlimit(RLIMIT_AS, &limit);
        threads = myriad::solve<runge_kutta_4>(device::cpu(600), e, by_tenths).threads;
        setrlimit(RLIMIT_AS, &before);
    });
    caller.join();
    INFO(threads << " threads");
    CHECK(threads >= 2);
    CHECK(threads < 600);
    CHECK(same_states(e, expected));
}

TEST_CASE(
    "a child process of one that has solved gets the same bits, instead of waiting for threads that it does not have") {
    auto before = rings(1000);
    CHECK(myriad::solve<runge_kutta_4>(device::cpu(4), before, by_tenths).threads == 4);
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        alarm(60);
        auto e = rings(1000);
        std::atomic<int> told_here = 0, told_elsewhere = 0;
        myriad::options o = by_tenths;
        const std::thread::id me = std::this_thread::get_id();
        o.progress = [&](std::int64_t, std::int64_t) {
            ++(std::this_thread::get_id() == me ? told_here : told_elsewhere);
        };
        const auto report = myriad::solve<runge_kutta_4>(device::cpu(4), e, o);
        auto large = roots(100'000);  // several threads check and count it
        large.time_domain(0, 1e-6);
        const bool all = myriad::solve<cash_karp>(device::cpu(2), large).count(status::success) == large.size();
        const bool told = told_here > 0 && told_elsewhere == 0;
        _exit(report.threads != 4 ? 1 : !same_states(e, before) ? 2 : !all ? 3 : !told ? 4 : 0);
    }
    int ended = 0;
    REQUIRE(waitpid(child, &ended, 0) == child);
    INFO("status " << ended);
    CHECK(WIFEXITED(ended));
    CHECK(WEXITSTATUS(ended) == 0);
}

TEST_CASE("an instance that takes for ever ends as interrupted when the progress function throws") {
    for (const int threads : {1, 2}) {
        auto e = roots(200);
        e.t_end() = 1.0;
        e.t_end()[150] = 1e9;
        myriad::options o;
        o.maximum_step = 1e-4;  // which takes days
        o.step = o.maximum_step;
        o.max_steps = 2'000'000'000;
        o.progress = [begin = std::chrono::steady_clock::now()](std::int64_t, std::int64_t) {
            if (std::chrono::steady_clock::now() - begin > std::chrono::milliseconds(200))
                throw std::runtime_error("enough");
        };
        REQUIRE_THROWS_WITH((myriad::solve<cash_karp>(device::cpu(threads), e, o)), "enough");
        CHECK(e.status(150) == status::interrupted);
        CHECK(e.t()[150] > 0);
        CHECK(e.t()[150] < 1e9);
        CHECK(e.state(root::x)[150] > 1);
        for (std::int64_t i = 0; i < e.size(); ++i)
            if (i != 150) CHECK((e.status(i) == status::success || e.status(i) == status::not_started));
    }
}

TEST_CASE("stacks of OpenMP that are too small are refused", "[.spawned]") {
    auto e = rings(1000);
    refused([&] { myriad::solve<runge_kutta_4>(device::cpu(4), e, by_tenths); },
            {"bytes of stack", "the kernel of this model", "set OMP_STACKSIZE to more"});
    CHECK((e.phases_done() == 0).all());
    CHECK(myriad::solve<runge_kutta_4>(device::cpu(1), e, by_tenths).count(status::success) == 1000);
}

TEST_CASE("OMP_STACKSIZE=16k and a model of forty states are refused, not a segmentation fault") {
    char program[4096] = {};
    REQUIRE(readlink("/proc/self/exe", program, sizeof(program) - 1) > 0);
    const std::string command = "OMP_STACKSIZE=16k '" + std::string(program) +
                                "' 'stacks of OpenMP that are too small are refused' >/dev/null 2>&1";
    CHECK(std::system(command.c_str()) == 0);
}

TEST_CASE("a thread of one's own with too small a stack is refused") {
    pthread_attr_t small;
    pthread_attr_init(&small);
    pthread_attr_setstacksize(&small, 128 << 10);
    std::string said;
    pthread_t thread;
    REQUIRE(pthread_create(
                &thread, &small,
                [](void* text) -> void* {
                    myriad::host::in_parallel(1, 1, [](std::int64_t, std::int64_t) {});
                    myriad::openmp::team work{[](void*, int) {}, nullptr, 1, std::size_t{1} << 20};
                    myriad::host::lend_threads().in_parts(work);
                    if (work.least_stack < work.stack && work.least_stack > 64 << 10)
                        *static_cast<std::string*>(text) = "refused";
                    return nullptr;
                },
                &said) == 0);
    pthread_join(thread, nullptr);
    pthread_attr_destroy(&small);
    CHECK(said == "refused");
}
#endif

TEST_CASE("what a hook throws is thrown by solve and by a solver, and the next call works") {
    for (const int place : {thrower::in_initialise, thrower::in_after_step, thrower::in_finalise}) {
        CAPTURE(place);
        auto e = throwers(5000);
        e.integer_accessory(thrower::where)[3000] = place;
        myriad::options o = by_tenths;
        for (const auto order : {myriad::schedule::automatic, myriad::schedule::by_cost}) {
            o.schedule = order;
            o.phases = 2;
            CHECK_THROWS_WITH(myriad::solve<runge_kutta_4>(device::cpu(3), e, o), "no such oscillator");
            CHECK_THROWS_AS(myriad::solve<runge_kutta_4>(device::cpu(1), e, o), std::domain_error);
        }
        myriad::solver<thrower, runge_kutta_4> s(device::cpu(2), 100, by_tenths);
        s.instances().state(thrower::x) = 0.0;
        s.instances().integer_accessory(thrower::where)[70] = place;
        s.instances().time_domain(0, 1);
        s.upload();
        CHECK_THROWS_AS(s.integrate(), std::domain_error);
    }
    auto good = throwers(5000);
    CHECK(myriad::solve<runge_kutta_4>(device::cpu(3), good, by_tenths).count(status::success) == 5000);
}

TEST_CASE("a model that throws ends the call before the instances that were not begun") {
    auto e = throwers(200'000);
    e.integer_accessory(thrower::where)[0] = thrower::in_initialise;
    CHECK_THROWS_AS(myriad::solve<runge_kutta_4>(device::cpu(2), e, by_tenths), std::domain_error);
    CHECK((e.phases_done() == 0).count() > 0);
}

#if defined(FE_DIVBYZERO) && defined(__GLIBC__)
TEST_CASE("a healthy model raises no signal where the caller traps floating-point exceptions") {
    auto e = roots(3), expected = roots(3);  // lanes without an instance hold zeros
    myriad::solve<cash_karp>(device::cpu(2), expected);
    std::thread caller([&] {
        feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
        myriad::solve<cash_karp>(device::cpu(2), e);
        const int traps = fegetexcept();
        fedisableexcept(FE_ALL_EXCEPT);
        CHECK(traps == (FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW));
    });
    caller.join();
    CHECK(same_states(e, expected));
}
#endif

TEST_CASE("the caller's rounding mode and flags change no bit, and are left as they were") {
    auto e = roots(1000), expected = roots(1000);
    myriad::solve<cash_karp>(device::cpu(2), expected);
    std::feclearexcept(FE_ALL_EXCEPT);
    std::fesetround(FE_UPWARD);
    myriad::solve<cash_karp>(device::cpu(2), e);
    const int mode = std::fegetround(), flags = std::fetestexcept(FE_ALL_EXCEPT);
    std::fesetround(FE_TONEAREST);
    CHECK(mode == FE_UPWARD);
    CHECK(flags == 0);
    CHECK(same_states(e, expected));
}
