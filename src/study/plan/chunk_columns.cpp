// SPDX-License-Identifier: MIT
// The columns of a chunk by their names.
#include "myriad/study/plan/chunk_columns.hpp"

#include <string>

#include "myriad/host/core/error.hpp"

namespace myriad {

const chunk_columns::column& chunk_columns::find(std::string_view name) const {
    std::string all;
    for (const column& c : columns_) {
        if (c.what->name == name) return c;
        all += (all.empty() ? "" : ", ") + c.what->name;
    }
    throw error(message("no variable \"", name, "\" is computed; there are ", all));
}

}  // namespace myriad
