// SPDX-License-Identifier: MIT
// All results of a study as bytes, to compare two runs of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <myriad/study.hpp>

namespace tests {

/// By the names of the variables.
using content = std::map<std::string, std::vector<std::byte>>;

/// Without the partial results of chunks.
inline content content_of(const myriad::study_result& r) {
    using namespace myriad::studies;
    content all;
    const layout& layout = r.content();
    for (const variable& v : layout.variables) {
        if (v.extent == along::chunks) continue;
        const std::int64_t items = v.extent == along::nothing ? 1 : layout.instances();
        auto& bytes = all[v.name];
        bytes.resize(static_cast<std::size_t>(items * v.values_per_item()) * size_of(v.type));
        r.results().read(v.name, 0, items, bytes.data());
    }
    return all;
}

/// The names of the variables that are not the same in both.
inline std::string difference(const content& a, const content& b) {
    std::string names;
    for (const auto& [name, bytes] : a)
        if (const auto other = b.find(name); other == b.end() || other->second != bytes) names += name + ' ';
    for (const auto& [name, bytes] : b)
        if (!a.contains(name)) names += name + ' ';
    return names;
}

}  // namespace tests
