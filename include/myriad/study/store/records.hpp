// SPDX-License-Identifier: MIT
// The records of a store as JSON and back: of chunks, coordinates and final results, each with the checksums of its
// files, one of itself, and the checksum of its group, so that no file can be taken for another.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/plan/layout.hpp"
#include "myriad/study/plan/model_behaviour.hpp"
#include "myriad/study/store/store.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// The group that a record belongs to: the checksum of its file zarr.json.
using group_checksum = std::string;

/// What the record of a chunk holds.
struct stored_chunk {
    chunk_record record;
    std::vector<std::uint32_t> checksums;  ///< of the variables with items for it, in the order of the layout
};
std::string record_json(const layout& content, const group_checksum& group, std::int64_t chunk,
                        const stored_chunk& stored);
/// Throws `error` if the text is no such record of this chunk.
stored_chunk record_of(std::string_view text, const layout& content, const group_checksum& group, std::int64_t chunk);

/// The checksums of the files of each coordinate, by its name.
using coordinate_checksums = std::map<std::string, std::vector<std::uint32_t>>;
std::string coordinates_json(const group_checksum& group, const coordinate_checksums& all);
/// Throws `error` if the text is no such record.
coordinate_checksums coordinates_of(std::string_view text, const group_checksum& group);

/// The checksum of the file of a final result.
std::string result_json(const group_checksum& group, std::string_view variable, std::uint32_t checksum);
/// Throws `error` if the text is no such record of this variable.
std::uint32_t result_of(std::string_view text, const group_checksum& group, std::string_view variable);

/// What the model of a store does.
std::string model_json(const group_checksum& group, const model_behaviour& model);
/// The same. Throws `error` if it is damaged, or of another store.
model_behaviour model_of(std::string_view text, const group_checksum& group);

/// The arithmetic that a store began with.
std::string arithmetic_json(const group_checksum& group, const arithmetic& a);
/// Throws `error` if the text is no such record.
arithmetic arithmetic_of(std::string_view text, const group_checksum& group);

}  // namespace myriad::studies::inline MYRIAD_ABI
