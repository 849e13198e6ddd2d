// SPDX-License-Identifier: MIT
// What messages advise in words that suit C++ alone. Other front ends have a table of their own, by the same names.
#pragma once

#include <string_view>

#include "myriad/kernel/core/abi.hpp"

/// All of them: name, and words in C++.
// clang-format off
#define MYRIAD_CURES(of) \
    of(mark_invalid, "set invalid_instances = invalid_instances::mark") \
    of(set_value, "set it in the ensemble before solving") \
    of(name_in_record, "name it in options::record") \
    of(name_in_samples, "name it in options::samples.states") \
    of(give_step, "give options::step") \
    of(use_doubles, "use an ensemble of doubles") \
    of(scale_tolerances, "use controlled<Method, tolerance_per_instance>, in solve and in MYRIAD_INSTANTIATE") \
    of(smaller_parts, "integrate the ensemble in smaller parts") \
    of(fewer_instances, "integrate fewer instances at a time: a smaller options::chunk_size or solver capacity") \
    of(smaller_chunk, "make chunk smaller") \
    of(new_folder, "start the study in a new folder with a smaller chunk") \
    of(allow_arithmetic, "allow this by store_options::others = other_arithmetic::warn") \
    of(make_consistent, "call myriad::make_consistent(ensemble)")
// clang-format on

namespace myriad::host::inline MYRIAD_ABI {

enum class cures {
#define MYRIAD_ENUMERATE_CURE(name, words) name,
    MYRIAD_CURES(MYRIAD_ENUMERATE_CURE)
#undef MYRIAD_ENUMERATE_CURE
};

struct known_cure {
    std::string_view name, words;
};
inline constexpr known_cure all_cures[] = {
#define MYRIAD_LIST_CURE(name, words) {#name, words},
    MYRIAD_CURES(MYRIAD_LIST_CURE)
#undef MYRIAD_LIST_CURE
};
constexpr const known_cure& row_of(cures c) { return all_cures[static_cast<int>(c)]; }

}  // namespace myriad::host::inline MYRIAD_ABI
