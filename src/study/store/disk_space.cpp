// SPDX-License-Identifier: MIT
// Adds up files, and compares them with what is free.
#include "disk_space.hpp"

#include <cerrno>

#include "myriad/host/core/error.hpp"
#include "myriad/host/memory/memory_need.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

void room::require_free(file_system& files, const std::string& folder) const {
    std::string place = folder;
    std::int64_t size = 0, free = 0;
    while (files.size(place, size) < 0 && folder_of(place) != place) {
        if (errno != ENOENT) throw file_error("looking for", place, errno);
        place = folder_of(place);
    }
    if (files.free_bytes(place, free) < 0) throw file_error("asking for the free space of", place, errno);
    const auto [need, have] = host::bytes_texts(bytes, static_cast<double>(free));
    require(bytes <= static_cast<double>(free), "the ", chunks, " chunks ",
            has_coordinates ? "and the coordinates " : "", "that are left take ", need, ", and the disk of ",
            host::named_option("store", folder), " has ", have, " free", host::cure,
            "free space, give a folder on a larger disk, or keep less");
}

room needed_room(const layout& content) {
    room all(content.chunks());
    for (const coordinate& c : content.coordinates) {
        const array_shape shape = shape_of(content, c);
        all.add_coordinates(shape.file_bytes(), shape.files());
    }
    for (const variable& v : content.variables)
        all.add(shape_of(content, v).file_bytes(), v.extent == along::nothing ? 1 : all.chunks);
    return all;
}

room left_room(const store_files& of, std::int64_t missing) {
    room left(missing);
    for (const stored_array& array : of.coordinates)
        for (std::int64_t file = 0; file < array.shape.files(); ++file)
            if (!of.has_length(of.path_of(array, file), array.shape.file_bytes()))
                left.add_coordinates(array.shape.file_bytes(), 1);
    for (std::size_t v = 0; v < of.variables.size(); ++v) {
        const std::int64_t bytes = of.variables[v].shape.file_bytes();
        if (of.content.variables[v].extent != along::nothing)
            left.add(bytes, left.chunks);
        else if (!of.exists(of.path_of(of.variables[v], 0)))
            left.add(bytes, 1);
    }
    return left;
}

}  // namespace myriad::studies::inline MYRIAD_ABI
