// SPDX-License-Identifier: MIT
// Names in the cache of compiled models; its files and locks are tested from Python (python/tests/test_cache.py) and by
// the program (examples/program/check_trust.sh).
#include "compile/compiled_cache.hpp"

#include "tests/catch.hpp"

using namespace myriad::compiling;

TEST_CASE("the hash of a text is FNV-1a") {
    CHECK(text_hash("") == "cbf29ce484222325");
    CHECK(text_hash("a") == "af63dc4c8601ec8c");
    CHECK(text_hash("foobar") == "85944171f73967e8");
}
