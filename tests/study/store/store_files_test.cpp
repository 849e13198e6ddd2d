// SPDX-License-Identifier: MIT
// Files of a store that are exchanged, changed or replaced: every read, verify and resume sees it.
#include "myriad/study/store/store_files.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <sys/stat.h>

#include "myriad/host/core/error.hpp"
#include "myriad/study/store/store.hpp"
#include "tests/catch.hpp"
#include "tests/study/store/synthetic.hpp"

namespace {

using Catch::Matchers::Contains;
using myriad::store;
using namespace myriad::studies;
using tests::run_synthetic;
using tests::synthetic_layout;
namespace fs = std::filesystem;

void put(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

// All values and coordinates of a store, or the message of the first refusal.
struct everything {
    std::map<std::string, std::vector<std::byte>> values;
    std::string refused;
    bool operator==(const everything&) const = default;
};
everything read_all(const std::string& folder) {
    everything all;
    try {
        const store results = store::open(folder);
        const layout& content = results.content();
        for (const variable& v : content.variables) {
            const std::int64_t items = v.extent == along::instances ? content.instances()
                                       : v.extent == along::chunks  ? content.chunks()
                                                                    : 1;
            auto& to = all.values[v.name];
            to.resize(static_cast<std::size_t>(items * v.values_per_item()) * size_of(v.type));
            results.read(v.name, 0, items, to.data());
        }
        for (const coordinate& c : content.coordinates) {
            std::vector<double> values(static_cast<std::size_t>(shape_of(content, c).items()));
            c.values(0, values);
            const auto bytes = std::as_bytes(std::span(values));
            all.values[c.name] = {bytes.begin(), bytes.end()};
        }
    } catch (const myriad::error& failure) {
        all.refused = failure.what();
    }
    return all;
}

// What verify finds, or the message of its refusal.
std::string verified(const std::string& folder) {
    try {
        std::string all;
        for (const damage& d : store::open(folder).verify()) all += d.variable + ": " + d.reason + '\n';
        return all;
    } catch (const myriad::error& failure) {
        return failure.what();
    }
}

std::vector<std::string> files_of(const std::string& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) names.push_back(fs::relative(entry.path(), folder).string());
    std::sort(names.begin(), names.end());
    return names;
}

TEST_CASE("a chunk's file copied over that of another chunk is not read in silence") {
    tests::temporary_folder folder;
    const std::string run = folder / "run";
    run_synthetic(run, synthetic_layout());
    const store before = store::open(run);
    CHECK(before.read<double>("x", 4, 1)[0] == tests::synthetic(4, 1));
    fs::copy_file(run + "/x/c.0", run + "/x/c.1", fs::copy_options::overwrite_existing);
    for (const store& results : {store::open(run), store::open(run)}) {
        CHECK(results.read<double>("x", 0, 1)[0] == tests::synthetic(0, 1));
        CHECK_THROWS_WITH(results.read<double>("x", 4, 1),
                          Contains("/x/c.1 is damaged (its checksum is") && Contains("in the record"));
    }
    CHECK_THROWS_WITH(before.read<double>("x", 4, 1), Contains("/x/c.1 is damaged"));
}

TEST_CASE("coordinates and results of another study are not read in silence") {
    tests::temporary_folder folder;
    const std::string run = folder / "run", other = folder / "other";
    run_synthetic(run, synthetic_layout());
    layout with_other_values = synthetic_layout();
    with_other_values.description = R"({"model": "synthetic", "seed": 8})";
    with_other_values.coordinates[1] = with_values("b", "b", {1.0, 2.0, 4.0, 8.0, 17.0});
    run_synthetic(other, with_other_values);
    for (const char* const name : {"b", "x", "total"}) {
        for (const bool with_records : {false, true}) {
            INFO(name << with_records);
            fs::remove_all(folder / "mixed");
            fs::copy(run, folder / "mixed", fs::copy_options::recursive);
            const auto take = [&](const std::string& part) {
                fs::copy(other + '/' + part, folder / "mixed/" + part,
                         fs::copy_options::recursive | fs::copy_options::overwrite_existing);
            };
            take(name);
            // Of x and total the values are the same, but the records are of another study.
            if (with_records)
                for (const char* const record : {"myriad/coordinates.json", "myriad/chunks", "myriad/results"})
                    take(record);
            if (!with_records && std::string(name) != "b") continue;
            CHECK(verified(folder / "mixed") != "");
            CHECK(read_all(folder / "mixed").refused != "");
            run_synthetic(folder / "mixed", synthetic_layout(), {.check = resume_check::checksums});
            CHECK(verified(folder / "mixed") == "");
            CHECK(read_all(folder / "mixed") == read_all(run));
        }
    }
}

TEST_CASE("what follows a zero byte in a file of a store is not read, and not seen by verify") {
    tests::temporary_folder folder;
    const std::string run = folder / "run";
    run_synthetic(run, synthetic_layout());
    for (const std::string& name : files_of(run)) {
        INFO(name);
        const std::string text = tests::text_of(run + '/' + name);
        put(run + '/' + name, text + '\0');
        CHECK(verified(run) != "");
        put(run + '/' + name, text);
        CHECK(verified(run) == "");
    }
}

TEST_CASE("a file of a store that takes the place of any other is seen by verify, and no read is wrong") {
    tests::temporary_folder folder;
    const std::string run = folder / "run";
    run_synthetic(run, synthetic_layout(2, 4), {.computed_by = arithmetic::of_kernel("avx2", "g++")});
    const std::vector<std::string> names = files_of(run);
    const everything expected = read_all(run);
    CHECK(expected.refused == "");
    CHECK(verified(run) == "");
    int exchanged = 0, unseen = 0, wrong = 0;
    for (const std::string& to : names) {
        const std::string text = tests::text_of(run + '/' + to);
        for (const std::string& from : names) {
            const std::string other = tests::text_of(run + '/' + from);
            if (other == text) continue;
            ++exchanged;
            put(run + '/' + to, other);
            INFO(from << " over " << to);
            const everything now = read_all(run);
            const bool is_wrong = now.refused.empty() && now != expected;
            const bool is_unseen = verified(run).empty();
            wrong += is_wrong;
            unseen += is_unseen;
            if (is_wrong || is_unseen) CHECK(from + " over " + to == "");
        }
        put(run + '/' + to, text);
    }
    CHECK(wrong == 0);
    CHECK(unseen == 0);
    CHECK(exchanged > 500);
    CHECK(verified(run) == "");
}

TEST_CASE("any byte that changes in the metadata is seen by verify and mended when the study goes on") {
    tests::temporary_folder folder;
    const std::string run = folder / "run";
    const layout content = synthetic_layout(2, 4);
    run_synthetic(run, content);
    const everything expected = read_all(run);
#if defined(MYRIAD_NIGHTLY)
    constexpr std::size_t each = 1, each_resume = 1;
#else
    constexpr std::size_t each = 11, each_resume = 88;  // all bytes are in metadata_test.cpp
#endif
    for (const char* const name : {"zarr.json", "myriad/group.json", "myriad/coordinates.json"}) {
        const std::string path = run + '/' + name, text = tests::text_of(path);
        int unseen = 0, wrong = 0, not_mended = 0;
        for (std::size_t i = 0; i < text.size(); i += each) {
            std::string changed = text;
            changed[i] = static_cast<char>(changed[i] ^ (i % 7 == 0 ? 0x80 : i % 2 == 0 ? 1 : 4));
            put(path, changed);
            unseen += verified(run).empty();
            const everything now = read_all(run);
            wrong += now.refused.empty() && now != expected;
            if (i % each_resume == 0) {
                const store again = store::create_or_resume(run, content);
                not_mended += again.put_back().empty() || tests::text_of(path) != text;
            }
        }
        put(path, text);
        INFO(name << ' ' << text.size());
        CHECK(unseen == 0);
        CHECK(wrong == 0);
        CHECK(not_mended == 0);
    }
    CHECK(verified(run) == "");
    CHECK(read_all(run) == expected);
    // Of an array, but for spaces, which mean nothing.
    const std::string path = run + "/x/zarr.json", text = tests::text_of(path);
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == ' ' || text[i] == '\n' || i % each != 0) continue;
        std::string changed = text;
        changed[i] = static_cast<char>(changed[i] ^ 1);
        put(path, changed);
        CHECK(verified(run) != "");
        CHECK(store::create_or_resume(run, content).put_back().size() == 1);
        CHECK(tests::text_of(path) == text);
    }
}

TEST_CASE("a study goes on with the copy of its metadata when zarr.json is lost, and readers say so") {
    tests::temporary_folder folder;
    const std::string run = folder / "run";
    run_synthetic(run, synthetic_layout());
    const everything expected = read_all(run);
    fs::remove(run + "/zarr.json");
    CHECK_THROWS_WITH(store::open(run), Contains("zarr.json is missing: start the study again, which restores it"));
    CHECK(store::create_or_resume(run, synthetic_layout(7, 5)).content().chunk == 4);
    CHECK(read_all(run) == expected);
    put(run + "/zarr.json", "");
    CHECK_THROWS_WITH(store::open(run), Contains("zarr.json is no JSON") && Contains("restores it from its copy"));
    store::create_or_resume(run, synthetic_layout());
    CHECK(verified(run) == "");
    // Without either it is no study.
    fs::remove(run + "/zarr.json");
    put(run + "/myriad/group.json", "");
    CHECK_THROWS_WITH(store::create_or_resume(run, synthetic_layout()), Contains("is not empty and holds no study"));
}

TEST_CASE("a folder, a pipe or nothing in the place of a chunk is damage, and is not waited for") {
    tests::temporary_folder folder;
    const std::string run = folder / "run";
    run_synthetic(run, synthetic_layout());
    fs::remove(run + "/x/c.0");
    fs::create_directory(run + "/x/c.0");
    fs::remove(run + "/x/c.1");
    REQUIRE(::mkfifo((run + "/x/c.1").c_str(), 0600) == 0);
    fs::remove(run + "/myriad/chunks/2.json");
    REQUIRE(::mkfifo((run + "/myriad/chunks/2.json").c_str(), 0600) == 0);
    put(run + "/myriad/chunks/3.json", tests::text_of(run + "/myriad/chunks/3.json").substr(0, 100));
    const store reader = store::open(run);
    CHECK_THROWS_WITH(reader.read<double>("x", 0, 1), Contains("it is a folder"));
    CHECK_THROWS_WITH(reader.read<double>("x", 4, 1), Contains("it is too short"));
    CHECK_THROWS_WITH(reader.read<double>("x", 8, 1), Contains("the record of chunk 2 is damaged"));
    CHECK_THROWS_WITH(reader.read<double>("x", 12, 1), Contains("the record of chunk 3 is damaged"));
    store counting = store::open(run);
    CHECK(counting.progress().damaged == 2);
    CHECK(counting.progress().chunks == 9);
    // After progress too, nothing is taken for not computed.
    CHECK_THROWS_WITH(counting.read<double>("x", 12, 1), Contains("the record of chunk 3 is damaged"));
    CHECK_THROWS_WITH(run_synthetic(run, synthetic_layout()),
                      Contains("Is a directory: it is a folder, which belongs to no study; remove it"));
    fs::remove(run + "/x/c.0");
    run_synthetic(run, synthetic_layout());
    CHECK(verified(run) == "");
}

TEST_CASE("chunk files that are hard links of one file are replaced one by one") {
    tests::temporary_folder folder;
    const std::string run = folder / "run";
    run_synthetic(run, synthetic_layout());
    const everything expected = read_all(run);
    // As by a program that finds equal files: the statuses of chunks 0 and 3 are not equal, so this is damage.
    fs::remove(run + "/status/c.3");
    fs::create_hard_link(run + "/status/c.1", run + "/status/c.3");
    CHECK(verified(run) != "");
    run_synthetic(run, synthetic_layout(), {.check = resume_check::checksums});
    CHECK(read_all(run) == expected);
    CHECK(fs::hard_link_count(run + "/status/c.1") == 1);
}

}  // namespace
