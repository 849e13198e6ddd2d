// SPDX-License-Identifier: MIT
// How programs are found before they are started.
#include "compile/child_process.hpp"

#include <chrono>

#include "tests/catch.hpp"

using namespace myriad::compiling;

TEST_CASE("a folder is not found as a program") {
    CHECK(find_program("/tmp").empty());
    CHECK(find_program("/").empty());
    CHECK(find_program("/none/at/all").empty());
    CHECK(find_program("/bin/sh") == "/bin/sh");
    CHECK_FALSE(find_program("sh").empty());
}

TEST_CASE("commands are divided into words as by a shell") {
    using words = std::vector<std::string>;
    CHECK(words_of("  ccache g++\t-fno-plt ") == words{"ccache", "g++", "-fno-plt"});
    CHECK(words_of(R"(g++ -DTEXT='a "b"' -D"X Y"=1 a\ b "c\"d\n" '')") ==
          words{"g++", "-DTEXT=a \"b\"", "-DX Y=1", "a b", "c\"d\\n", ""});
    CHECK(words_of(" ").empty());
    CHECK_THROWS_WITH(words_of("g++ 'a"), "a quotation in it has no end");
}

TEST_CASE("the output of programs, none of one that fails") {
    CHECK(output_of({"sh", "-c", "echo 12; echo more"}) == "12\nmore\n");
    CHECK(output_of({"sh", "-c", "echo 12; exit 1"}).empty());
    CHECK(output_of({"/none/at/all"}).empty());
}

TEST_CASE("a program that nobody waits for is ended") {
    const auto begin = std::chrono::steady_clock::now();
    { const child_process slow({"sleep", "60"}); }
    CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(30));
}
