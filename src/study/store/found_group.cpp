// SPDX-License-Identifier: MIT
// Looks for the study in a folder, and compares it with another one.
#include "found_group.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

// The copy of a group's file.
std::optional<found_group> copied_group(file_system& files, const std::string& folder, const std::string& damage) {
    const std::optional<std::string> text = read_text(files, copy_path(folder));
    if (!text) return std::nullopt;
    found_group copy{{}, *text, damage};
    if (damage_in([&] { copy.group = group_of(*text, copy_path(folder)); })) return std::nullopt;
    return copy;
}

}  // namespace

std::string absolute(const std::string& folder) {
    require(!folder.empty(), host::named_option("store", "the folder"), " of a study has no name", host::cure,
            "give one");
    refuse_zero_byte(folder);
    std::error_code unknown;
    const std::filesystem::path path = std::filesystem::absolute(folder, unknown);
    return unknown ? folder : path.string();
}

std::optional<found_group> find_group(file_system& files, const std::string& folder) {
    const std::string path = group_path(folder);
    // In this order, since another process may be about to make one.
    std::vector<std::string> names = names_in(files, folder).value_or(std::vector<std::string>{});
    if (const std::optional<std::string> text = read_text(files, path)) {
        try {
            return found_group{group_of(*text, path), *text, ""};
        } catch (const file_error&) {
            throw;
        } catch (const error& failure) {
            if (auto copy = copied_group(files, folder, failure.what())) return copy;
            throw;
        }
    }
    if (auto copy = copied_group(files, folder, path + " is missing")) {
        copy->advice =
            statement_of(host::cure, "start the study again, which restores it from its copy myriad/group.json");
        return copy;
    }
    // A start that was interrupted early leaves this.
    std::erase(names, "myriad");
    if (names.empty()) return std::nullopt;
    std::sort(names.begin(), names.end());
    host::refuse({host::named_option("store", "the folder"), " ", folder, " is not empty and holds no study (it has ",
                  names.front(), names.size() > 1 ? " and others" : "", ")", host::cure, "give a new folder"});
}

std::optional<found_group> whole_group(file_system& files, const std::string& folder) {
    std::optional<found_group> found = find_group(files, folder);
    if (found && !found->damage.empty()) host::refuse({found->damage, found->advice});
    return found;
}

std::optional<model_behaviour> read_model(file_system& files, const std::string& folder, const group_checksum& group) {
    const auto text = read_text(files, model_path(folder));
    return text ? std::optional(model_of(*text, group)) : std::nullopt;
}

void refuse_other(file_system& files, const stored_group& stored, const layout& here, const model_behaviour* model,
                  const std::string& folder) {
    std::vector<statement> found = differences(stored.content, here);
    // With other instances or options, functions give other values, too.
    if (model != nullptr && (found.empty() || differ_in_notes_alone(stored.content, here))) {
        std::optional<model_behaviour> there;
        damage_in([&] { there = read_model(files, folder, stored.checksum); });  // `described_files` tells of damage
        if (there)
            for (statement& one : model->differences_from(*there)) found.push_back(std::move(one));
    }
    if (found.empty()) return;
    statement list;
    for (std::size_t i = 0; i < found.size() && i < 10; ++i) list = statement_of(list, "\n  ", found[i]);
    if (found.size() > 10) list = statement_of(list, "\n  and ", found.size() - 10, " more");
    host::refuse({"the folder ", folder, " holds the results of another study, which differs in", list,
                  host::cure_begins{"\n"}, "give another ", host::named_option("store", "folder"),
                  ", or the same study"});
}

}  // namespace myriad::studies::inline MYRIAD_ABI
