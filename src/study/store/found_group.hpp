// SPDX-License-Identifier: MIT
// Which study a folder holds, if any.
#pragma once

#include <optional>
#include <string>

#include "myriad/host/core/error.hpp"
#include "myriad/study/plan/layout.hpp"
#include "myriad/study/store/file_system.hpp"
#include "myriad/study/store/metadata.hpp"
#include "myriad/study/store/records.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

// A group that was found in a folder, and what is wrong with its file, if it is known from its copy alone.
struct found_group {
    stored_group group;
    std::string text, damage;
    statement advice = {};  // to those who only read, besides what `damage` says
};

inline std::string group_path(const std::string& folder) { return folder + "/zarr.json"; }
inline std::string copy_path(const std::string& folder) { return folder + "/myriad/group.json"; }
inline std::string model_path(const std::string& folder) { return folder + "/myriad/model.json"; }

// Where a folder is also after the process has gone to another one.
std::string absolute(const std::string& folder);
// The group of a folder with a store, or nothing if there is none yet. An error if there is something else.
std::optional<found_group> find_group(file_system& files, const std::string& folder);
// The same for readers, who have nothing to restore it with.
std::optional<found_group> whole_group(file_system& files, const std::string& folder);
// What the model of a store does; nothing if that is not known. An error if the record is damaged.
std::optional<model_behaviour> read_model(file_system& files, const std::string& folder, const group_checksum& group);
// An error, with what differs, if a store is of another study.
void refuse_other(file_system& files, const stored_group& stored, const layout& here, const model_behaviour* model,
                  const std::string& folder);

}  // namespace myriad::studies::inline MYRIAD_ABI
