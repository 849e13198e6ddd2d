// SPDX-License-Identifier: MIT
// A store's files with what describes the results: made, compared with what it should be, and restored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "found_group.hpp"
#include "myriad/study/store/store_files.hpp"
#include "myriad/study/store/writer.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

class described_files : public store_files {
public:
    described_files(file_system& used, std::string where, const found_group& of)
        : store_files(used, std::move(where), of.group), group_text(of.text) {}

    const std::string group_text;
    std::vector<coordinate> given;  // coordinates to write, only of a store that can be written
    std::unique_ptr<writer> self;   // null if opened for reading

    void write_own(const std::string& path, const std::string& text) {
        write_text(files, self->temporary(), path, text);
    }
    // Everything but results. May be done by several processes at a time, with equal files.
    void write_arrays();
    void write_coordinates(bool replaces);
    // Adds what is not as it should be, and restores it if it can be written.
    void check_metadata(std::vector<damage>& problems);
    // Keeps what the model does, if that is not there yet.
    void keep_model(const model_behaviour* model, const layout& wanted);

    // Compares the arithmetic that the store began with with this process', which is it if there is none yet.
    void check_arithmetic(const store_options& options, bool is_complete);
    // Compares it with the arithmetic of results, by the option.
    void compare_arithmetic(const arithmetic& here);
    std::vector<std::string> warnings() const {
        const std::lock_guard lock(mutex_);
        return warnings_;
    }

private:
    std::uint32_t write_coordinate_file(std::size_t c, std::int64_t file, bool replaces);
    void begin_array(const stored_array& array);
    // That which the store began with; nothing if there is none, or, of the second, if it is damaged.
    std::optional<arithmetic> read_arithmetic() const;
    std::optional<arithmetic> first_arithmetic() const;

    std::optional<arithmetic> begun_with_;
    other_arithmetic others_ = other_arithmetic::refuse;
    mutable std::mutex mutex_;
    std::vector<std::string> warnings_;
};

}  // namespace myriad::studies::inline MYRIAD_ABI
