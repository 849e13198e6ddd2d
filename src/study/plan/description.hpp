// SPDX-License-Identifier: MIT
// The description of a study, which tells it from others, as JSON. As text, so that nothing else needs a JSON library.
#pragma once

#include <string>
#include <string_view>

#include "myriad/study/plan/study_plan.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// All that determines the results, of a plan that has its quantities.
std::string description_of(const study_plan& plan);
/// Whether a text is JSON, and an object.
bool is_json_object(std::string_view text);
/// Whether JSON can have a text, as it has Unicode alone.
bool is_utf8(const std::string& text);

}  // namespace myriad::studies::inline MYRIAD_ABI
