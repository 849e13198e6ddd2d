// SPDX-License-Identifier: MIT
// A study without differential equations, for tests of stores and exports: its layout, its values, and folders for it.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include <unistd.h>

#include "myriad/study/plan/layout.hpp"
#include "myriad/study/store/store.hpp"

namespace tests {

namespace studies = myriad::studies;

/// An empty folder that is removed at the end. In memory if possible and TMPDIR is not set, since stores
/// wait for the disk at every step.
class temporary_folder {
public:
    temporary_folder() {
        const std::filesystem::path memory = "/dev/shm";
        const bool usable = std::getenv("TMPDIR") == nullptr && ::access(memory.c_str(), W_OK) == 0;
        std::string name =
            ((usable ? memory : std::filesystem::temp_directory_path()) / "myriad_store_XXXXXX").string();
        path_ = ::mkdtemp(name.data());
    }
    temporary_folder(const temporary_folder&) = delete;
    temporary_folder& operator=(const temporary_folder&) = delete;
    ~temporary_folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    std::string operator/(const std::string& name) const { return path_ + '/' + name; }

private:
    std::string path_;
};

inline std::string text_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// A grid of a (n_a values) and b (5 values); variables of every type and extent.
inline studies::layout synthetic_layout(std::int64_t n_a = 7, std::int64_t chunk = 4) {
    studies::layout content;
    content.axes = {{"a", n_a}, {"b", 5}};
    content.chunk = chunk;
    content.variables = {
        {.name = "x", .attributes = {{"units", "m"}, {"valid_range", std::vector<double>{-1.5, 2.0}}}},
        {.name = "y", .type = studies::element::f32, .inner = {{"phase", 3}}},
        {.name = "count", .type = studies::element::i64},
        {.name = "step", .type = studies::element::i32, .inner = {{"phase", 3}, {"side", 2}}},
        {.name = "status",
         .type = studies::element::u8,
         .attributes = {{"flag_values", std::vector<std::int64_t>{0, 1}}, {"flag_meanings", "ok failed"}}},
        {.name = "noise", .role = studies::role::coordinate},
        {.name = "partial", .inner = {{"bin", 4}}, .extent = studies::along::chunks},
        {.name = "total", .inner = {{"bin", 4}}, .extent = studies::along::nothing}};
    std::vector<double> a(static_cast<std::size_t>(n_a));
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = 0.1 * static_cast<double>(i);
    content.coordinates = {studies::with_values("a", "a", a, {{"long_name", "first axis"}}),
                           studies::with_values("b", "b", {1.0, 2.0, 4.0, 8.0, 16.0}),
                           studies::with_values("bin", "bin", {0.5, 1.5, 2.5, 3.5}),
                           studies::with_values("t_end", "", {12.5})};
    content.description =
        R"({"model": "synthetic", "seed": 7, "options": {"relative_tolerance": 1e-9, "steps": [1, 2]}, "dense": true})";
    return content;
}

// Values that depend on everything, so that no two are equal.
inline double synthetic(std::int64_t instance, std::int64_t salt) {
    std::uint64_t z = static_cast<std::uint64_t>(instance) * 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(salt);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/// The values of one chunk.
struct synthetic_chunk {
    std::vector<double> x, noise, partial;
    std::vector<float> y;
    std::vector<std::int64_t> count;
    std::vector<std::int32_t> step;
    std::vector<std::uint8_t> status;

    synthetic_chunk(const studies::layout& content, std::int64_t chunk) : partial(4, 0.0) {
        const studies::chunk_range range = studies::range_of(content, chunk);
        for (std::int64_t i = range.first; i < range.first + range.count; ++i) {
            x.push_back(synthetic(i, 1));
            for (int j = 0; j < 3; ++j) y.push_back(static_cast<float>(synthetic(i, 2 + j)));
            count.push_back(i * i);
            for (int j = 0; j < 6; ++j) step.push_back(static_cast<std::int32_t>(10 * i + j));
            status.push_back(static_cast<std::uint8_t>(i % 3 == 0));
            noise.push_back(synthetic(i, 99));
            partial[static_cast<std::size_t>(x.back() * 4)] += 1;
        }
    }
    std::vector<studies::column> columns() const {
        return {studies::column_of("noise", noise),
                studies::column_of("x", x),
                studies::column_of("y", y),
                studies::column_of("count", count),
                studies::column_of("step", step),
                studies::column_of("status", status),
                studies::column_of("partial", partial)};
    }
    studies::chunk_record record() const {
        std::int64_t failed = 0;
        for (const std::uint8_t s : status) failed += s;
        return {
            "simulated device", 0.5, {{"ok", static_cast<std::int64_t>(status.size()) - failed}, {"failed", failed}}};
    }
};

inline void commit_synthetic(myriad::store& store, std::int64_t chunk) {
    const synthetic_chunk values(store.content(), chunk);
    store.commit(chunk, values.columns(), values.record());
}

/// The sum over chunks of their partial results, which is the final one.
inline void write_total(myriad::store& store) {
    std::vector<double> total(4, 0.0);
    for (std::int64_t chunk = 0; chunk < store.content().chunks(); ++chunk) {
        const std::vector<double> partial = store.read<double>("partial", chunk, 1);
        for (std::size_t i = 0; i < 4; ++i) total[i] += partial[i];
    }
    store.write(studies::column_of("total", total));
}

/// Does what is left of a study, beside other processes if there are some.
inline void run_synthetic(const std::string& folder, const studies::layout& content,
                          const studies::store_options& options = {}) {
    myriad::store store = myriad::store::create_or_resume(folder, content, options);
    while (!store.complete()) {
        if (const auto chunk = store.claim_next())
            commit_synthetic(store, *chunk);
        else
            ::usleep(1000);
    }
    if (!store.written("total")) write_total(store);
}

/// The files of a store by their paths, without its records, which say when and where.
inline std::map<std::string, std::string> contents(const std::string& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && entry.path().parent_path().filename() != "chunks")
            files[std::filesystem::relative(entry.path(), folder).string()] = text_of(entry.path());
    return files;
}

}  // namespace tests
