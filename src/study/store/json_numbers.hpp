// SPDX-License-Identifier: MIT
// Numbers in JSON, which has no NaN and no infinity: as Zarr writes them. Of the files that use the JSON library.
#pragma once

#include <cmath>

#include <nlohmann/json.hpp>

#include "myriad/kernel/core/abi.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

// With keys in the order in which they are written, for those who read it.
using ordered_json = nlohmann::ordered_json;

inline ordered_json number(double value) {
    if (std::isnan(value)) return "NaN";
    if (std::isinf(value)) return value > 0 ? "Infinity" : "-Infinity";
    return value;
}

// A number that may be written as text.
inline bool is_number(const ordered_json& value) {
    return value.is_number() || value == "NaN" || value == "Infinity" || value == "-Infinity";
}
inline double as_double(const ordered_json& value) {
    if (value.is_number()) return value.get<double>();
    return value == "NaN" ? std::nan("") : value == "Infinity" ? HUGE_VAL : -HUGE_VAL;
}

}  // namespace myriad::studies::inline MYRIAD_ABI
