// SPDX-License-Identifier: MIT
// Stores: what is in the folder, going on after any interruption, other studies, damage, claims, faults of the disk,
// and processes that are killed.
#include "myriad/study/store/store.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <random>
#include <set>
#include <thread>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "myriad/host/core/error.hpp"
#include "myriad/study/store/file_system.hpp"
#include "tests/catch.hpp"
#include "tests/study/store/synthetic.hpp"

namespace {

using Catch::Matchers::Contains;
using myriad::store;
using namespace myriad::studies;
using tests::commit_synthetic;
using tests::run_synthetic;
using tests::synthetic_layout;

// What an undisturbed run leaves.
const std::map<std::string, std::string>& undisturbed() {
    static const auto files = [] {
        tests::temporary_folder folder;
        run_synthetic(folder / "run", synthetic_layout());
        return tests::contents(folder / "run");
    }();
    return files;
}

void check_undisturbed(const std::string& folder) {
    const auto files = tests::contents(folder);
    // By name first, so that a failure does not print binary data.
    std::vector<std::string> names, expected, differing;
    for (const auto& [name, text] : files) names.push_back(name);
    for (const auto& [name, text] : undisturbed()) {
        expected.push_back(name);
        if (files.contains(name) && files.at(name) != text) differing.push_back(name);
    }
    CHECK(names == expected);
    CHECK(differing.empty());
}

void overwrite(const std::string& path, std::size_t at, char byte) {
    std::string text = tests::text_of(path);
    REQUIRE(at < text.size());
    REQUIRE(text[at] != byte);
    text[at] = byte;
    std::ofstream(path, std::ios::binary) << text;
}

std::vector<std::string> damaged(const std::vector<damage>& found) {
    std::vector<std::string> texts;
    for (const damage& d : found) texts.push_back(std::to_string(d.chunk) + ' ' + d.variable);
    return texts;
}

// ---------------------------------------------------------------------------------------------------------------------
// Contents
// ---------------------------------------------------------------------------------------------------------------------

TEST_CASE("what was committed is read again, of every type and shape") {
    tests::temporary_folder folder;
    run_synthetic(folder / "run", synthetic_layout());
    const store results = store::open(folder / "run");
    CHECK(results.complete());
    const auto x = results.read<double>("x", 0, 35);
    const auto y = results.read<float>("y", 0, 35);
    const auto count = results.read<std::int64_t>("count", 0, 35);
    const auto step = results.read<std::int32_t>("step", 0, 35);
    const auto status = results.read<std::uint8_t>("status", 0, 35);
    REQUIRE(y.size() == 35 * 3);
    REQUIRE(step.size() == 35 * 6);
    for (std::size_t i = 0; i < 35; ++i) {
        const auto instance = static_cast<std::int64_t>(i);
        CHECK(x[i] == tests::synthetic(instance, 1));
        CHECK(y[3 * i + 2] == static_cast<float>(tests::synthetic(instance, 4)));
        CHECK(count[i] == instance * instance);
        CHECK(step[6 * i + 5] == 10 * instance + 5);
        CHECK(status[i] == (i % 3 == 0));
    }
    // Every range, over the ends of chunks and of the last one.
    for (std::int64_t first = 0; first <= 35; ++first)
        for (std::int64_t n = 0; n <= 35 - first; ++n) {
            const auto part = results.read<float>("y", first, n);
            REQUIRE(std::equal(part.begin(), part.end(), y.begin() + 3 * first, y.begin() + 3 * (first + n)));
        }
    double sum = 0;
    for (const double bin : results.read<double>("total", 0, 1)) sum += bin;
    CHECK(sum == 35);
    std::vector<double> b(3);
    results.content().coordinates[1].values(1, b);
    CHECK(b == std::vector<double>{2.0, 4.0, 8.0});
    CHECK(results.devices() == std::vector<std::string>{"simulated device"});

    CHECK_THROWS_WITH(results.read<double>("z", 0, 1), Contains("there is no variable z"));
    CHECK_THROWS_WITH(results.read<float>("x", 0, 1), "variable x has values of type float64, and not float32");
    CHECK_THROWS_WITH(results.read<double>("x", 34, 2), "variable x has 35 items, and not those from 34 to 36");
    CHECK_THROWS_WITH(results.read<double>("total", 0, 2), Contains("has 1 items"));
}

TEST_CASE("the folder is a group of Zarr with the layout and the description, from the start") {
    tests::temporary_folder folder;
    store made = store::create_or_resume(folder / "a/b/run", synthetic_layout());
    const auto group = tests::text_of(folder / "a/b/run/zarr.json");
    for (const char* const part :
         {"\"zarr_format\": 3", "\"node_type\": \"group\"", "\"relative_tolerance\": 1e-09",
          "\"flag_meanings\": \"ok failed\"", "\"consolidated_metadata\"", "\"crc32c\"", "\"dimension_names\""})
        CHECK_THAT(group, Contains(part));
    CHECK_THAT(tests::text_of(folder / "a/b/run/step/zarr.json"), Contains("\"data_type\": \"int32\""));
    // A chunk of x: four doubles and the checksum.
    commit_synthetic(made, 2);
    CHECK(std::filesystem::file_size(folder / "a/b/run/x/c.2") == 4 * 8 + 4);
    CHECK(std::filesystem::file_size(folder / "a/b/run/step/c.2.0.0") == 4 * 6 * 4 + 4);
    CHECK(std::filesystem::file_size(folder / "a/b/run/t_end/c") == 8 + 4);
    // The last one is filled up.
    commit_synthetic(made, 8);
    CHECK(std::filesystem::file_size(folder / "a/b/run/x/c.8") == 4 * 8 + 4);

    const layout content = store::content_of(folder / "a/b/run").value();
    const layout given = synthetic_layout();
    CHECK(content.axes == given.axes);
    CHECK(content.chunk == given.chunk);
    for (std::size_t v = 0; v < given.variables.size(); ++v) {
        CHECK(content.variables[v].name == given.variables[v].name);
        CHECK(content.variables[v].type == given.variables[v].type);
        CHECK(content.variables[v].inner == given.variables[v].inner);
        CHECK(content.variables[v].attributes == given.variables[v].attributes);
        CHECK(content.variables[v].extent == given.variables[v].extent);
        CHECK(content.variables[v].role == given.variables[v].role);
    }
    CHECK_FALSE(store::content_of(folder / "none").has_value());
    CHECK(made.content().description == given.description);
}

TEST_CASE("what is not done reads as the fill value, and the rest is there, while a study runs") {
    tests::temporary_folder folder;
    store running = store::create_or_resume(folder / "run", synthetic_layout());
    store reader = store::open(folder / "run");
    CHECK(reader.progress().chunks == 0);
    commit_synthetic(running, 1);
    CHECK_FALSE(reader.done(1));
    reader.refresh();
    CHECK(reader.done(1));
    CHECK_FALSE(reader.complete());
    CHECK_FALSE(reader.written("total"));
    const auto x = reader.read<double>("x", 3, 6);
    CHECK(std::isnan(x[0]));
    CHECK(x[1] == tests::synthetic(4, 1));
    CHECK(std::isnan(x[5]));
    CHECK(reader.read<std::uint8_t>("status", 0, 5) == std::vector<std::uint8_t>{255, 255, 255, 255, 0});
    CHECK(std::isnan(reader.read<double>("total", 0, 1)[0]));
    CHECK_THROWS_WITH(reader.claim_next(), Contains("was opened for reading"));
}

TEST_CASE("progress counts instances and statuses of all processes") {
    tests::temporary_folder folder;
    store first = store::create_or_resume(folder / "run", synthetic_layout());
    store second = store::create_or_resume(folder / "run", synthetic_layout());
    commit_synthetic(first, 0);
    commit_synthetic(second, 8);
    for (store* s : {&first, &second}) {
        const store_progress now = s->progress();
        CHECK(now.chunks == 2);
        CHECK(now.all_chunks == 9);
        CHECK(now.instances == 7);
        CHECK(now.all_instances == 35);
        CHECK(now.seconds == 1.0);
        // Of 0 to 3 and 32 to 34, the multiples of three.
        CHECK(now.statuses == std::vector<std::pair<std::string, std::int64_t>>{{"failed", 3}, {"ok", 4}});
    }
}

TEST_CASE("columns that do not fit are refused with what is wrong") {
    tests::temporary_folder folder;
    store made = store::create_or_resume(folder / "run", synthetic_layout());
    const tests::synthetic_chunk values(made.content(), 0);
    auto columns = values.columns();
    const auto refused = [&](const std::string& message) {
        CHECK_THROWS_WITH(made.commit(0, columns, {}), Contains(message));
        columns = values.columns();
    };
    columns.pop_back();
    refused("there is no column for variable partial");
    columns[1] = column_of("x", values.y);
    refused("the column for x has values of type float32, and the variable float64");
    columns[1] = column_of("x", std::span(values.x).first(3));
    refused("the column for x has 24 bytes, and needs 32");
    columns.push_back(column_of("total", values.partial));
    refused("variable total is not of a chunk");
    columns.push_back(column_of("z", values.partial));
    refused("there is no variable z");
    columns.push_back(column_of("x", values.x));
    refused("8 columns for 7 variables");
    CHECK_THROWS_WITH(made.commit(9, columns, {}), Contains("there is no chunk 9"));
    CHECK_THROWS_WITH(made.write(column_of("x", values.x)), Contains("is written chunk by chunk"));
    CHECK_FALSE(made.done(0));
    CHECK(made.progress().chunks == 0);
}

// ---------------------------------------------------------------------------------------------------------------------
// Going on
// ---------------------------------------------------------------------------------------------------------------------

TEST_CASE("a study that was interrupted goes on and ends as if it had not been") {
    tests::temporary_folder folder;
    for (int turn = 0; turn < 9; ++turn) {
        store part = store::create_or_resume(folder / "run", synthetic_layout());
        CHECK(part.progress().chunks == turn);
        CHECK(part.put_back().empty());
        const auto chunk = part.claim_next();
        REQUIRE(chunk.has_value());
        commit_synthetic(part, *chunk);
    }
    run_synthetic(folder / "run", synthetic_layout());
    check_undisturbed(folder / "run");
    store whole = store::create_or_resume(folder / "run", synthetic_layout());
    CHECK(whole.complete());
    CHECK_FALSE(whole.claim_next().has_value());
}

TEST_CASE("the chunks of a store stay as large as they were") {
    tests::temporary_folder folder;
    run_synthetic(folder / "run", synthetic_layout());
    store other = store::create_or_resume(folder / "run", synthetic_layout(7, 10));
    CHECK(other.content().chunk == 4);
    CHECK(other.complete());
}

TEST_CASE("the folder of another study is refused with all that differs, and stays as it is") {
    tests::temporary_folder folder;
    { store::create_or_resume(folder / "run", synthetic_layout()); }
    const auto before = tests::contents(folder / "run");
    const auto refused = [&](auto change, const std::string& message) {
        layout other = synthetic_layout();
        change(other);
        CHECK_THROWS_WITH(store::create_or_resume(folder / "run", other),
                          Contains("another study") && Contains(message));
    };
    refused(
        [](layout& c) {
            c.description =
                R"({"model": "synthetic", "seed": 8, "options": {"relative_tolerance": 1e-8, "steps": [1, 2]},
                                "new": "x"})";
        },
        "\n  seed: 7 in the store, 8 here\n  options.relative_tolerance: 1e-09 in the store, 1e-08 here"
        "\n  dense: true in the store, nothing here\n  new: nothing in the store, \"x\" here\n");
    refused([](layout& c) { c = synthetic_layout(8); }, "grid.a: 7 in the store, 8 here");
    refused([](layout& c) { std::swap(c.axes[0], c.axes[1]); },
            "order of the grid: [[\"a\",7],[\"b\",5]] in the store");
    refused([](layout& c) { c.variables[0].type = element::f32; },
            "variables.x.type: \"float64\" in the store, \"float32\"");
    refused([](layout& c) { c.variables.pop_back(); }, "variables.total: {");
    refused([](layout& c) { c.coordinates.pop_back(); }, "coordinates.t_end: \"\" in the store, nothing here");
    CHECK(tests::contents(folder / "run") == before);
    // The order of keys means nothing, and neither does that of variables.
    layout same = synthetic_layout();
    same.description =
        R"({"dense": true, "options": {"steps": [1, 2], "relative_tolerance": 1.0e-9},
            "seed": 7, "model": "synthetic"})";
    std::swap(same.variables[0], same.variables[1]);
    CHECK_NOTHROW(store::create_or_resume(folder / "run", same));
}

TEST_CASE("a folder with other files is refused, and nothing is written there") {
    tests::temporary_folder folder;
    std::filesystem::create_directories(folder / "full");
    std::ofstream(folder / "full/thesis.tex") << "text";
    CHECK_THROWS_WITH(store::create_or_resume(folder / "full", synthetic_layout()),
                      Contains("is not empty and holds no study (it has thesis.tex)"));
    CHECK(tests::contents(folder / "full").size() == 1);
    std::ofstream(folder / "full/zarr.json") << R"({"zarr_format": 3, "node_type": "group"})";
    CHECK_THROWS_WITH(store::create_or_resume(folder / "full", synthetic_layout()),
                      Contains("is not from a study of Myriad"));
    std::ofstream(folder / "full/zarr.json") << R"({"zarr_format": 3, "attribu)";
    CHECK_THROWS_WITH(store::create_or_resume(folder / "full", synthetic_layout()), Contains("is no JSON"));
    CHECK_THROWS_WITH(store::create_or_resume(folder / "full/thesis.tex", synthetic_layout()),
                      Contains("Not a directory: give the path of a folder"));
    CHECK_THROWS_WITH(store::open(folder / "none"), Contains("there is no folder"));
    std::filesystem::create_directories(folder / "empty");
    CHECK_THROWS_WITH(store::open(folder / "empty"), Contains("is empty"));
    CHECK_NOTHROW(store::create_or_resume(folder / "empty", synthetic_layout()));
}

TEST_CASE("a study whose folder is a link to nothing is not told that the folder was removed") {
    tests::temporary_folder folder;
    std::filesystem::create_symlink(folder / "gone", folder / "link");
    const std::string refused = folder / "link is a link to " + (folder / "gone, which is not there: make that folder");
    CHECK_THROWS_WITH(store::create_or_resume(folder / "link", synthetic_layout()), Contains(refused));
    CHECK_THROWS_WITH(store::create_or_resume(folder / "link/run", synthetic_layout()), Contains(refused));
    std::filesystem::create_directory(folder / "gone");
    CHECK_NOTHROW(store::create_or_resume(folder / "link", synthetic_layout()));
}

TEST_CASE("a store of a later format is refused with the version that wrote it") {
    tests::temporary_folder folder;
    { store::create_or_resume(folder / "run", synthetic_layout()); }
    std::string text = tests::text_of(folder / "run/zarr.json");
    text.replace(text.find("\"format\": 2"), 11, "\"format\": 9");
    std::ofstream(folder / "run/zarr.json") << text;
    CHECK_THROWS_WITH(store::open(folder / "run"), Contains("has format 9"));
}

TEST_CASE("a store in a relative folder stays whole when the process goes to another folder") {
    tests::temporary_folder folder;
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder / "");
    store made = store::create_or_resume("run", synthetic_layout());
    commit_synthetic(made, 0);
    std::filesystem::current_path(before);
    commit_synthetic(made, 1);
    CHECK(made.read<double>("x", 4, 1) == std::vector<double>{tests::synthetic(4, 1)});
    CHECK(made.verify().empty());
    std::vector<double> b(1);
    made.content().coordinates[1].values(2, b);
    CHECK(b[0] == 4.0);
    CHECK_THROWS_WITH(store::create_or_resume("", synthetic_layout()), Contains("has no name"));
}

// ---------------------------------------------------------------------------------------------------------------------
// Damage
// ---------------------------------------------------------------------------------------------------------------------

TEST_CASE("damaged, truncated, lengthened, deleted and exchanged files are found, and their chunks done again") {
    tests::temporary_folder folder;
    const std::string run = folder / "run";
    run_synthetic(run, synthetic_layout());
    overwrite(run + "/x/c.0", 5, 'x');
    overwrite(run + "/y/c.1.0", 3 * 4 * 4 + 2, 'x');  // in the checksum
    std::filesystem::resize_file(run + "/count/c.2", 10);
    std::filesystem::resize_file(run + "/count/c.3", 37);
    std::filesystem::remove(run + "/step/c.4.0.0");
    std::filesystem::copy_file(run + "/x/c.8", run + "/x/c.5", std::filesystem::copy_options::overwrite_existing);
    std::ofstream(run + "/myriad/chunks/6.json") << "{";
    overwrite(run + "/total/c.0", 0, 'x');
    overwrite(run + "/a/c.0", 1, 'x');

    const store reader = store::open(run);
    CHECK_THROWS_WITH(reader.read<double>("x", 0, 4),
                      Contains("/x/c.0 is damaged (its checksum is") && Contains("the option check set to checksums"));
    CHECK_THROWS_WITH(reader.read<std::int64_t>("count", 9, 1), Contains("/count/c.2 is damaged (it is too short)"));
    CHECK_THROWS_WITH(reader.read<std::int64_t>("count", 12, 1), Contains("has not the length it should have"));
    CHECK_THROWS_WITH(reader.read<std::int32_t>("step", 16, 1), Contains("/step/c.4.0.0 is damaged (it is missing)"));

    const std::vector<std::string> expected{"0 x", "1 y", "2 count", "3 count", "4 step",
                                            "5 x", "6 ",  "-1 a",    "-1 total"};
    store only_reader = store::open(run);
    CHECK(damaged(only_reader.verify()) == expected);

    SECTION("by verify") {
        store again = store::create_or_resume(run, synthetic_layout());
        // Lengths and records alone.
        CHECK(damaged(again.put_back()) == std::vector<std::string>{"2 count", "3 count", "4 step", "6 "});
        const std::vector<std::string> rest{"0 x", "1 y", "5 x", "-1 a", "-1 total"};
        CHECK(damaged(again.verify()) == rest);
        CHECK(again.verify().empty());
        CHECK(again.progress().chunks == 2);
    }
    SECTION("at once when the study goes on") {
        const store again = store::create_or_resume(run, synthetic_layout(), {.check = resume_check::checksums});
        CHECK(damaged(again.put_back()) == expected);
    }
    run_synthetic(run, synthetic_layout());
    CHECK(store::open(run).verify().empty());
    check_undisturbed(run);
}

TEST_CASE("a study goes on although someone removed the folder of a variable, of a coordinate, or of claims") {
    tests::temporary_folder folder;
    const std::string run = folder / "run";
    for (const char* const removed : {"x", "a", "myriad/claims", "total", "myriad"}) {
        INFO(removed);
        run_synthetic(run, synthetic_layout());
        std::filesystem::remove_all(run + '/' + removed);
        CHECK_NOTHROW(run_synthetic(run, synthetic_layout()));
        check_undisturbed(run);
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Claims
// ---------------------------------------------------------------------------------------------------------------------

TEST_CASE("a chunk has one claim at a time, which ends with a commit, a release or the process") {
    tests::temporary_folder folder;
    const layout content = synthetic_layout();
    store first = store::create_or_resume(folder / "run", content);
    std::set<std::int64_t> claimed;
    {
        store second = store::create_or_resume(folder / "run", content);
        for (int i = 0; i < 5; ++i) {
            CHECK(claimed.insert(first.claim_next().value()).second);
            if (i < 4) CHECK(claimed.insert(second.claim_next().value()).second);
        }
        CHECK_FALSE(first.claim_next().has_value());
        CHECK_FALSE(second.claim_next().has_value());
        CHECK(claimed.size() == 9);
        first.release(3);  // which is the second one's, and stays so
        CHECK_FALSE(first.claim_next().has_value());
        first.release(2);
        CHECK(second.claim_next() == 2);
    }
    // Those that the second one had are free again.
    std::set<std::int64_t> rest;
    while (const auto chunk = first.claim_next()) rest.insert(*chunk);
    CHECK(rest == std::set<std::int64_t>{1, 2, 3, 5, 7});
    CHECK_FALSE(first.complete());
}

TEST_CASE("a claim without a sign of life is taken over, as are its temporary files") {
    tests::temporary_folder folder;
    const std::string run = folder / "run";
    const layout content = synthetic_layout();
    { store::create_or_resume(run, content); }
    // Of another host, whose processes cannot be looked up, and without a heartbeat.
    const std::string id = "elsewhere~1~1~77~5~123", other = run + "/myriad/writers/" + id;
    std::filesystem::create_directories(other);
    std::ofstream(other + "/alive") << id;
    std::ofstream(other + "/1") << "half a file";
    for (int chunk = 0; chunk < 9; ++chunk)
        std::filesystem::create_hard_link(other + "/alive", run + "/myriad/claims/" + std::to_string(chunk));
    {
        store patient = store::create_or_resume(run, content);
        CHECK_FALSE(patient.claim_next().has_value());
        CHECK(std::filesystem::exists(other + "/1"));
    }
    {
        store waiting = store::create_or_resume(run, content, {.expiry = std::chrono::milliseconds(300)});
        const auto begin = std::chrono::steady_clock::now();
        std::optional<std::int64_t> chunk;
        while (!(chunk = waiting.claim_next()) && std::chrono::steady_clock::now() - begin < std::chrono::seconds(10))
            ::usleep(10000);
        REQUIRE(chunk.has_value());
    }
    CHECK_FALSE(std::filesystem::exists(other));
    run_synthetic(run, content, {.expiry = std::chrono::milliseconds(300)});
    check_undisturbed(run);
}

TEST_CASE("a process that was taken for dead writes its chunk all the same") {
    tests::temporary_folder folder;
    const std::string run = folder / "run";
    store sleepy = store::create_or_resume(run, synthetic_layout());
    const auto chunk = sleepy.claim_next();
    REQUIRE(chunk.has_value());
    std::filesystem::remove_all(run + "/myriad/writers");
    std::filesystem::remove(run + "/myriad/claims/" + std::to_string(*chunk));
    commit_synthetic(sleepy, *chunk);
    CHECK(sleepy.done(*chunk));
    REQUIRE(sleepy.claim_next().has_value());
}

TEST_CASE("threads of one process share a store") {
    tests::temporary_folder folder;
    {
        store shared = store::create_or_resume(folder / "run", synthetic_layout());
        const auto work = [&] {
            while (const auto chunk = shared.claim_next()) commit_synthetic(shared, *chunk);
        };
        std::thread first(work), second(work);
        for (int i = 0; i < 20; ++i) shared.progress();
        first.join();
        second.join();
        CHECK(shared.complete());
        tests::write_total(shared);
    }
    check_undisturbed(folder / "run");
}

// ---------------------------------------------------------------------------------------------------------------------
// A disk that fails
// ---------------------------------------------------------------------------------------------------------------------

// Fails its n-th call, or all from there on, as a disk that is full; or writes less than it was told to.
class faulty final : public file_system {
public:
    enum class fault { once, from_there_on, short_write };
    faulty(std::int64_t at, fault kind, int code) : at_(at), kind_(kind), code_(code) {}
    std::int64_t calls() const { return calls_; }
    bool has_failed() const { return failed_; }
    std::int64_t free = std::int64_t{1} << 40;

    int open(const std::string& p, int flags) override { return fails() ? -1 : file_system::open(p, flags); }
    ssize_t read(int f, void* d, std::size_t n) override { return fails() ? -1 : file_system::read(f, d, n); }
    ssize_t write(int f, const void* d, std::size_t n) override {
        if (!fails()) return file_system::write(f, d, n);
        return kind_ == fault::short_write && n > 1 ? file_system::write(f, d, n / 2) : -1;
    }
    int fsync(int f) override { return fails() ? -1 : file_system::fsync(f); }
    int close(int f) override {
        const int result = file_system::close(f);
        return fails() ? -1 : result;
    }
    int facts(int f, file_facts& r) override { return fails() ? -1 : file_system::facts(f, r); }
    int size(const std::string& p, std::int64_t& r) override { return fails() ? -1 : file_system::size(p, r); }
    int rename(const std::string& a, const std::string& b) override { return fails() ? -1 : file_system::rename(a, b); }
    int link(const std::string& a, const std::string& b) override { return fails() ? -1 : file_system::link(a, b); }
    int unlink(const std::string& p) override { return fails() ? -1 : file_system::unlink(p); }
    int mkdir(const std::string& p) override { return fails() ? -1 : file_system::mkdir(p); }
    int rmdir(const std::string& p) override { return fails() ? -1 : file_system::rmdir(p); }
    int touch(const std::string& p) override { return fails() ? -1 : file_system::touch(p); }
    int list(const std::string& p, std::vector<std::string>& n) override {
        return fails() ? -1 : file_system::list(p, n);
    }
    int free_bytes(const std::string&, std::int64_t& r) override {
        r = free;
        return fails() ? -1 : 0;
    }

private:
    bool fails() {
        const std::int64_t call = calls_++;
        const bool now = kind_ == fault::from_there_on ? call >= at_ : call == at_;
        failed_ = failed_ || now;
        errno = now ? code_ : errno;
        return now;
    }
    std::int64_t at_;
    fault kind_;
    int code_;
    std::atomic<std::int64_t> calls_ = 0;
    bool failed_ = false;
};

// Runs a small study on a disk whose n-th call fails, for every n, and then again on one that works.
void check_every_fault(faulty::fault kind, int code, const std::string& said) {
    const layout content = synthetic_layout(1, 3);  // two chunks
    tests::temporary_folder folder;
    run_synthetic(folder / "expected", content);
    const auto expected = tests::contents(folder / "expected");
    int errors = 0;
    std::int64_t n = 0;
    for (bool failed = true; failed; ++n) {
        const std::string run = folder / std::to_string(n);
        faulty disk(n, kind, code);
        try {
            run_synthetic(run, content, {.files = &disk});
        } catch (const myriad::error& failure) {
            ++errors;
            INFO(n);
            CHECK_THAT(failure.what(), Contains(said));
        }
        failed = disk.has_failed();
        run_synthetic(run, content);
        const auto now = tests::contents(run);
        std::string names;
        for (const auto& [name, text] : now)
            if (!expected.contains(name) || expected.at(name) != text) names += name + ' ';
        INFO(n << ": " << names);
        CHECK(names.empty());
        CHECK(now.size() == expected.size());
        CHECK(store::open(run).verify().empty());
        std::filesystem::remove_all(run);
    }
    // Not every fault is an error: some calls tidy up, a file may be asked for twice.
    CHECK(n > 150);
    CHECK(errors > (kind == faulty::fault::short_write ? 50 : 100));
}

TEST_CASE("a study whose disk fails at any call says so, and goes on when the disk works") {
    check_every_fault(faulty::fault::once, EIO, "Input/output error. What was finished is kept: start again");
}

TEST_CASE("a study whose disk gets full at any call says so, and goes on when there is space") {
    check_every_fault(faulty::fault::from_there_on, ENOSPC, "No space left on device. What was finished is kept: free");
}

TEST_CASE("a study whose disk writes less than it is told to is not harmed") {
    check_every_fault(faulty::fault::short_write, EIO, "Input/output error");
}

TEST_CASE("interrupted calls are repeated") {
    const layout content = synthetic_layout(1, 3);
    tests::temporary_folder folder;
    // A signal may interrupt only some calls: those that read, write, open and wait for the disk.
    class interrupted final : public file_system {
    public:
        int open(const std::string& p, int flags) override { return again() ? -1 : file_system::open(p, flags); }
        ssize_t read(int f, void* d, std::size_t n) override { return again() ? -1 : file_system::read(f, d, n); }
        ssize_t write(int f, const void* d, std::size_t n) override {
            return again() ? -1 : file_system::write(f, d, n);
        }
        int fsync(int f) override { return again() ? -1 : file_system::fsync(f); }

    private:
        bool again() {
            errno = EINTR;
            return (odd_ = !odd_);
        }
        bool odd_ = false;
    } disk;
    run_synthetic(folder / "run", content, {.files = &disk});
    CHECK(store::open(folder / "run").verify().empty());
}

TEST_CASE("more results than the disk holds are refused before the start") {
    tests::temporary_folder folder;
    faulty disk(-1, faulty::fault::once, 0);
    disk.free = 300000;
    CHECK_THROWS_WITH(store::create_or_resume(folder / "run", synthetic_layout(), {.files = &disk}),
                      Contains("the 9 chunks and the coordinates that are left take 315 kB, and the disk of ") &&
                          Contains(" has 300 kB free: free space, give a folder on a larger disk, or keep less"));
    // Not even coordinates, which may be as long as the study.
    CHECK_FALSE(std::filesystem::exists(folder / "run"));
    disk.free = 100000000;
    store made = store::create_or_resume(folder / "run", synthetic_layout(), {.files = &disk});
    for (int i = 0; i < 8; ++i) commit_synthetic(made, i);
    disk.free = 40000;  // enough for one chunk
    CHECK_NOTHROW(store::create_or_resume(folder / "run", synthetic_layout(), {.files = &disk}));
    disk.free = 0;
    CHECK_THROWS_WITH(store::create_or_resume(folder / "run", synthetic_layout(), {.files = &disk}),
                      Contains("the 1 chunks that are left take"));
}

// ---------------------------------------------------------------------------------------------------------------------
// Processes
// ---------------------------------------------------------------------------------------------------------------------

pid_t start(const std::string& folder, const layout& content, int pause) {
    const pid_t child = ::fork();
    if (child != 0) return child;
    int status = 0;
    try {
        store mine = store::create_or_resume(folder, content);
        while (!mine.complete()) {
            const auto chunk = mine.claim_next();
            ::usleep(static_cast<useconds_t>(pause));
            if (chunk) commit_synthetic(mine, *chunk);
        }
        if (!mine.written("total")) tests::write_total(mine);
    } catch (const std::exception& failure) {
        std::fprintf(stderr, "%s\n", failure.what());
        status = 1;
    }
    ::_exit(status);
}

TEST_CASE("processes that start at once in an empty folder share the study") {
    for (int turn = 0; turn < 5; ++turn) {
        tests::temporary_folder folder;
        std::vector<pid_t> children;
        for (int i = 0; i < 4; ++i) children.push_back(start(folder / "run", synthetic_layout(), 100));
        for (const pid_t child : children) {
            int status = -1;
            ::waitpid(child, &status, 0);
            CHECK(status == 0);
        }
        check_undisturbed(folder / "run");
    }
}

TEST_CASE("a study whose processes are killed at random moments ends as if they had not been") {
    const char* const wanted = std::getenv("MYRIAD_TEST_KILLS");
    const int kills = wanted ? std::atoi(wanted) : 6;
    const layout content = synthetic_layout(20, 4);  // 25 chunks
    tests::temporary_folder folder;
    run_synthetic(folder / "expected", content);
    const auto expected = tests::contents(folder / "expected");
    std::mt19937 random(7);
    for (const int processes : {1, 2, 4}) {
        for (int killed = 0, round = 0; killed < kills; ++round) {
            const std::string run = folder / "run";
            std::vector<pid_t> children;
            const auto begin = std::chrono::steady_clock::now();
            // A round is one study: at most so many are killed, so that it comes to an end.
            for (int left = 6; left > 0 && killed < kills; --left) {
                while (children.size() < static_cast<std::size_t>(processes))
                    children.push_back(start(run, content, 300));
                ::usleep(static_cast<useconds_t>(random() % 40000));
                const std::size_t victim = random() % children.size();
                ::kill(children[victim], SIGKILL);
                int status = 0;
                ::waitpid(children[victim], &status, 0);
                if (WIFSIGNALED(status)) ++killed;
                children.erase(children.begin() + static_cast<std::ptrdiff_t>(victim));
            }
            if (children.empty()) children.push_back(start(run, content, 0));
            for (const pid_t child : children) {
                int status = -1;
                ::waitpid(child, &status, 0);
                CHECK(status == 0);
            }
            // Started once more, as users do, which also removes what the killed ones left.
            run_synthetic(run, content);
            CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(30));
            const bool same = tests::contents(run) == expected;
            INFO("processes " << processes << ", round " << round);
            CHECK(same);
            CHECK(store::open(run).verify().empty());
            std::filesystem::remove_all(run);
        }
    }
}

}  // namespace
