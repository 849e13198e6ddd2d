// SPDX-License-Identifier: MIT
// The compiler of models: which one the environment names, its flags and messages.
#include "compile/compiler.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "tests/catch.hpp"

using namespace myriad::compiling;

namespace {

/// Has a variable of the environment for a while.
class with_variable {
public:
    with_variable(const char* name, const std::string& value) : name_(name), before_(variable(name)) {
        ::setenv(name, value.c_str(), 1);
    }
    with_variable(const with_variable&) = delete;
    with_variable& operator=(const with_variable&) = delete;
    ~with_variable() { before_.empty() ? ::unsetenv(name_) : ::setenv(name_, before_.c_str(), 1); }

private:
    const char* name_;
    std::string before_;
};

}  // namespace

TEST_CASE("the compiler that the environment names, with arguments and behind another program") {
    const with_variable no_other("CXX", "");
    {
        const with_variable named("MYRIAD_CXX", "env clang++-99 g++ -DX='a b'");
        CHECK(find_compiler()->command.size() == 4);
        CHECK(find_compiler()->kind == "g++");
        CHECK(find_compiler()->name() == "env");
        CHECK(find_compiler()->identity.ends_with(" clang++-99 g++ -DX=a b"));
    }
    const with_variable wrong("MYRIAD_CXX", "no-such-compiler -O2");
    CHECK_THROWS_WITH(find_compiler(),
                      Catch::StartsWith("MYRIAD_CXX is 'no-such-compiler -O2', and there is no such program: give"));
}

TEST_CASE("a CXX that is no compiler of C++ is passed over") {
    const with_variable none("MYRIAD_CXX", ""), other("CXX", "sh -c");
    const auto found = find_compiler();
    CHECK((!found || found->name() != "sh"));
}

TEST_CASE("kernels have the flags of the build, and those of their compiler") {
    using enum myriad::openmp::instruction_set;
    const auto has = [](const char* kind, myriad::openmp::instruction_set set, const std::string& flag) {
        const auto flags = compiler{{"any"}, kind, ""}.kernel_flags(set);
        return std::find(flags.begin(), flags.end(), flag) != flags.end();
    };
    for (const char* const kind : {"g++", "clang++", "zig"})
        for (const char* const flag : {"-O3", "-ffp-contract=off", "-fno-math-errno"}) CHECK(has(kind, generic, flag));
    CHECK(has("g++", avx2, "-march=x86-64-v3"));
    CHECK(has("zig", avx512, "-march=x86_64_v4"));
    for (const char* const flag : {"--param=sra-max-scalarization-size-Ospeed=2048", "-fno-tree-pta"}) {
        CHECK(has("g++", avx2, flag));
        CHECK_FALSE(has("clang++", avx2, flag));
    }
}

TEST_CASE("errors are found in what compilers say") {
    const std::string said = "model:3: warning: x\nmodel:4:1: error:  no y \nmodel:5: error: z\nlast\n";
    CHECK(error_lines(said, 5) == std::vector<std::string>{"model:4:1: error:  no y ", "model:5: error: z"});
    CHECK(first_error(said) == "no y");
    CHECK(first_error("cannot find ld\n\n") == "cannot find ld");
    CHECK(first_error("") == "it failed without a message");
}
