// SPDX-License-Identifier: MIT
// How programs are found before they are started.
#include "program/child_process.hpp"

#include "tests/catch.hpp"

using namespace myriad::programs;

TEST_CASE("a folder is not found as a program") {
    CHECK(find_program("/tmp").empty());
    CHECK(find_program("/").empty());
    CHECK(find_program("/none/at/all").empty());
    CHECK(find_program("/bin/sh") == "/bin/sh");
    CHECK_FALSE(find_program("sh").empty());
}
