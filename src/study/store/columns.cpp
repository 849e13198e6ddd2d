// SPDX-License-Identifier: MIT
// Finds the columns of variables.
#include "columns.hpp"

#include "myriad/host/core/error.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

std::span<const std::byte> bytes_for(const variable& wanted, std::span<const column> columns, std::int64_t items) {
    const column* given_column = nullptr;
    for (const column& c : columns)
        if (c.variable == wanted.name) given_column = &c;
    require(given_column != nullptr, "there is no column for variable ", wanted.name,
            ": a chunk has one for each variable");
    require(given_column->type == wanted.type, "the column for ", wanted.name, " has values of type ",
            name_of(given_column->type), ", and the variable ", name_of(wanted.type));
    const std::int64_t bytes = items * wanted.item_bytes();
    require(given_column->bytes.size() == static_cast<std::size_t>(bytes), "the column for ", wanted.name, " has ",
            given_column->bytes.size(), " bytes, and needs ", bytes);
    return given_column->bytes;
}

std::vector<std::span<const std::byte>> ordered_columns(const layout& content, std::int64_t chunk,
                                                        std::span<const column> columns) {
    std::vector<std::span<const std::byte>> ordered(content.variables.size());
    std::size_t used = 0;
    for (std::size_t v = 0; v < content.variables.size(); ++v) {
        const along extent = content.variables[v].extent;
        if (extent == along::nothing) continue;
        ordered[v] =
            bytes_for(content.variables[v], columns, extent == along::instances ? range_of(content, chunk).count : 1);
        ++used;
    }
    if (columns.size() != used) {
        for (const column& c : columns) {
            const std::size_t v = content.find(c.variable);
            require(content.variables[v].extent != along::nothing, "variable ", c.variable, " is not of a chunk",
                    host::cure, "use store::write");
        }
        host::refuse({"chunk ", chunk, " has ", columns.size(), " columns for ", used, " variables"});
    }
    return ordered;
}

}  // namespace myriad::studies::inline MYRIAD_ABI
