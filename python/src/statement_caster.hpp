// SPDX-License-Identifier: MIT
// Statements of the core in Python: a list of their parts, each (kind, words in C++, key, number).
#pragma once

#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "myriad/host/core/error.hpp"

namespace nanobind::detail {

template <>
struct type_caster<myriad::statement> {
    using in_python = std::vector<std::tuple<int, std::string, std::string, std::int64_t>>;
    NB_TYPE_CASTER(myriad::statement, make_caster<in_python>::Name)

    bool from_python(handle from, std::uint8_t flags, cleanup_list* cleanup) noexcept {
        make_caster<in_python> sent;
        if (!sent.from_python(from, flags, cleanup)) return false;
        for (auto& [kind, words, key, number] : sent.value)
            value.parts.push_back({static_cast<myriad::part_kind>(kind), words, key, number});
        return true;
    }
    static handle from_cpp(const myriad::statement& said, rv_policy policy, cleanup_list* cleanup) noexcept {
        in_python sent;
        for (const auto& [kind, words, key, number] : said.parts)
            sent.emplace_back(static_cast<int>(kind), words, key, number);
        return make_caster<in_python>::from_cpp(sent, policy, cleanup);
    }
};

}  // namespace nanobind::detail
