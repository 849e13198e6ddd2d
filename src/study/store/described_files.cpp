// SPDX-License-Identifier: MIT
// Writes what describes the results, and compares what is there.
#include "described_files.hpp"

#include <algorithm>
#include <span>

#include "myriad/host/core/error.hpp"
#include "myriad/study/store/records.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

constexpr const char* own_group = "{\"zarr_format\": 3, \"node_type\": \"group\"}\n";

}  // namespace

std::uint32_t described_files::write_coordinate_file(std::size_t c, std::int64_t file, bool replaces) {
    const array_shape& shape = coordinates[c].shape;
    const std::int64_t first = file * shape.chunk;
    std::vector<double> values(static_cast<std::size_t>(std::min(shape.chunk, shape.items() - first)));
    const auto same =
        std::find_if(given.begin(), given.end(), [&](const coordinate& g) { return g.name == coordinates[c].name; });
    require(same != given.end(), "there are no values for coordinate ", coordinates[c].name);
    same->values(first, values);
    std::uint32_t checksum = 0;
    new_file made = write_array_file(files, self->temporary(), shape, std::as_bytes(std::span(values)), checksum);
    made.finish();
    if (replaces) {
        made.rename_to(path_of(coordinates[c], file));
    } else if (!made.link_to(path_of(coordinates[c], file))) {
        // Another process was faster, perhaps with a library whose functions differ in the last digit: there is one
        // record for both.
        const file_check there = read_array_file(files, path_of(coordinates[c], file), shape);
        if (!there.damage.empty()) return write_coordinate_file(c, file, true);
        return there.checksum;
    }
    return checksum;
}

void described_files::begin_array(const stored_array& array) {
    const std::string place = folder + '/' + array.name;
    make_folder(files, place);
    write_own(place + "/zarr.json", array_json(array.shape, array.attributes));
}

void described_files::write_coordinates(bool replaces) {
    coordinate_checksums checksums;
    for (std::size_t c = 0; c < coordinates.size(); ++c) {
        std::vector<std::uint32_t>& of_files = checksums[coordinates[c].name];
        for (std::int64_t file = 0; file < coordinates[c].shape.files(); ++file)
            of_files.push_back(write_coordinate_file(c, file, replaces));
        sync_folder(files, folder + '/' + coordinates[c].name);
    }
    write_own(places->record_path(), coordinates_json(group.checksum, checksums));
    places->read_record();
}

void described_files::write_arrays() {
    for (const stored_array& array : variables) begin_array(array);
    for (const stored_array& array : coordinates) begin_array(array);
    write_coordinates(false);
    // A group of its own, so that readers which look at every folder know what it is.
    write_own(own("zarr.json"), own_group);
    write_own(copy_path(folder), group_text);
    make_folder(files, own("results"));
    make_folder(files, own("claims"));
    sync_folder(files, folder);
    // The last, as the sign that all this is there.
    make_folder(files, own("chunks"));
    sync_folder(files, own(""));
}

void described_files::check_metadata(std::vector<damage>& problems) {
    const auto restore = [&](const std::string& path, const std::string& name, const std::string& wanted,
                             bool to_the_byte) {
        const std::optional<std::string> text = read_text(files, path);
        if (text && (to_the_byte ? *text == wanted : same_json(*text, wanted))) return;
        problems.push_back({-1, name, text ? "it is not what it should be" : "it is missing"});
        if (!self) return;
        make_folder(files, folder_of(path));
        write_own(path, wanted);
    };
    restore(group_path(folder), "zarr.json", group_text, true);
    restore(copy_path(folder), "myriad/group.json", group_text, true);
    restore(own("zarr.json"), "myriad/zarr.json", own_group, false);
    for (const std::vector<stored_array>* arrays : {&variables, &coordinates})
        for (const stored_array& array : *arrays)
            restore(folder + '/' + array.name + "/zarr.json", array.name + "/zarr.json",
                    array_json(array.shape, array.attributes), false);
    const auto is_to_be_mended = [&](const char* name, auto&& read) {
        const std::optional<std::string> damage = damage_in(read);
        if (damage) problems.push_back({-1, message("myriad/", name), *damage});
        return damage.has_value() && self != nullptr;
    };
    if (is_to_be_mended("arithmetic.json", [&] { read_arithmetic(); })) files.unlink(own("arithmetic.json"));
    if (is_to_be_mended("model.json", [&] { read_model(files, folder, group.checksum); }))
        files.unlink(model_path(folder));
    if (is_to_be_mended("coordinates.json", [&] { places->read_record(); })) write_coordinates(true);
    if (!self) return;
    make_folder(files, own("claims"));
    make_folder(files, own("results"));
}

void described_files::keep_model(const model_behaviour* model, const layout& wanted) {
    if (model == nullptr || model->empty()) return;
    if (!exists(model_path(folder))) {
        const bool is_first =
            write_first(files, self->temporary(), model_path(folder), model_json(group.checksum, *model));
        sync_folder(files, own(""));
        if (is_first) return;
    }
    refuse_other(files, group, wanted, model, folder);  // another process may have been faster
}

std::optional<arithmetic> described_files::read_arithmetic() const {
    const auto text = read_text(files, own("arithmetic.json"));
    return text ? std::optional(arithmetic_of(*text, group.checksum)) : std::nullopt;
}

std::optional<arithmetic> described_files::first_arithmetic() const {
    std::optional<arithmetic> first;
    damage_in([&] { first = read_arithmetic(); });  // of which `check_metadata` tells
    return first;
}

void described_files::compare_arithmetic(const arithmetic& here) {
    if (here.instruction_set.empty() || !begun_with_ || begun_with_->same_as(here)) return;
    const std::string differs = message("the study in ", folder, " was begun with ", begun_with_->text(), " on ",
                                        begun_with_->host, ", and ", here.host, " has ", here.text(),
                                        ": results differ in their last digits, and in more where the model is "
                                        "chaotic");
    require(others_ == other_arithmetic::warn, differs,
            "; set MYRIAD_INSTRUCTION_SET to the same on all machines, and use the same compiler and libraries, or ",
            host::cures::allow_arithmetic);
    const std::lock_guard lock(mutex_);
    if (std::find(warnings_.begin(), warnings_.end(), differs) == warnings_.end()) warnings_.push_back(differs);
}

void described_files::check_arithmetic(const store_options& options, bool is_complete) {
    const arithmetic& here = options.computed_by;
    others_ = options.others;
    if (here.instruction_set.empty() || is_complete) return;
    begun_with_ = first_arithmetic();
    if (!begun_with_ && self) {
        const bool is_first =
            write_first(files, self->temporary(), own("arithmetic.json"), arithmetic_json(group.checksum, here));
        begun_with_ = is_first ? here : first_arithmetic();  // another process may be faster
        sync_folder(files, own(""));
    }
    compare_arithmetic(here);
}

}  // namespace myriad::studies::inline MYRIAD_ABI
