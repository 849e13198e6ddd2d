// SPDX-License-Identifier: MIT
// Layouts as the JSON of Zarr, version 3 (https://zarr-specs.readthedocs.io/en/latest/v3/core), and back. As text, so
// that nothing else needs a JSON library.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "myriad/host/core/error.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/plan/layout.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// How an array is divided into files: along its outermost dimension.
struct array_shape {
    element type = element::f64;
    std::vector<dimension> dimensions;
    std::int64_t chunk = 1;  ///< items of a file; 1 for an array without dimensions

    /// Of the outermost dimension, 1 for an array without dimensions.
    std::int64_t items() const;
    std::int64_t item_bytes() const;
    /// Of each of its files, the last one too: filled up, and with four bytes of checksum.
    std::int64_t file_bytes() const;
    std::int64_t files() const;
    /// The name of a file of it, as "c.17.0".
    std::string file_name(std::int64_t file) const;
};

/// The array of a variable or of a coordinate.
array_shape shape_of(const layout& content, const variable& v);
array_shape shape_of(const layout& content, const coordinate& c);

/// The file zarr.json of the group, with the metadata of all arrays, so that readers need not look for them, and a
/// checksum of itself.
std::string group_json(const layout& content);
/// The file zarr.json of one array.
std::string array_json(const array_shape& shape, const std::vector<attribute>& attributes);
/// What the file of a group says.
struct stored_group {
    layout content;        ///< with coordinates without values
    std::string checksum;  ///< of the file, by which records name it
};
/// Throws `error` that begins with `path` if the text is none of `group_json`, or is damaged.
stored_group group_of(std::string_view text, const std::string& path);
/// For programs that read exported arrays: the names of the axes, and of each array its dimensions, which are the axes
/// for what every instance has, its role and its attributes.
std::string contents_json(const layout& content);
/// Whether two texts are JSON, and equal.
bool same_json(std::string_view a, std::string_view b);

/// What differs between the layout in a store and another, as "options.relative_tolerance: 1e-09 in the store, 1e-08
/// here", whose subject is the option. Chunk sizes and attributes may differ.
std::vector<statement> differences(const layout& stored, const layout& here);
/// Whether that is nothing but notes, which stand for the model's source, too.
bool differ_in_notes_alone(const layout& stored, const layout& here);

/// The global attributes that an exported file gets: the entries of the description, with dots in their names.
std::vector<attribute> attributes_of(std::string_view description);

}  // namespace myriad::studies::inline MYRIAD_ABI
