// SPDX-License-Identifier: MIT
// Signals as a request to stop; what a study does then is in study_test.cpp.
#include <csignal>

#include <myriad/study/run/stop_signals.hpp>
#include <unistd.h>

#include "tests/catch.hpp"

namespace {

volatile std::sig_atomic_t others = 0;

}  // namespace

TEST_CASE("A signal is remembered for as long as the object lives", "[stop_signals]") {
    const auto before = std::signal(SIGTERM, [](int) { others = others + 1; });
    {
        const myriad::studies::stop_signals first;
        CHECK(!first.came());
        std::raise(SIGINT);
        CHECK(first.came());
        CHECK(others == 0);
    }
    {
        const myriad::studies::stop_signals second;
        CHECK(!second.came());
        std::raise(SIGTERM);
        CHECK(second.came());
    }
    CHECK(others == 0);
    std::raise(SIGTERM);  // the handler that was there before
    CHECK(others == 1);
    std::signal(SIGTERM, before);
}
TEST_CASE("A signal that is sent twice at once ends nothing, one that is sent again later does", "[stop_signals]") {
    others = 0;
    const auto before = std::signal(SIGTERM, [](int) { others = others + 1; });
    {
        const myriad::studies::stop_signals stop;
        for (int i = 0; i < 3; ++i) std::raise(SIGTERM);
        CHECK(others == 0);
        usleep(1'100'000);
        std::raise(SIGTERM);
        CHECK(others == 1);
    }
    std::signal(SIGTERM, before);
}
