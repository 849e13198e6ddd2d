// SPDX-License-Identifier: MIT
// Compiled models on disk. Their code runs with all rights of the user, so that folder and files must belong to the
// user or root, and nobody else may write to them; what is looked at is an open file, which nobody can exchange before
// it is loaded. The program `myriad` and the Python package share them. Host code only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "compile/child_process.hpp"
#include "compile/text_files.hpp"

namespace myriad::compiling {

/// The folder of compiled models, $MYRIAD_CACHE_DIR, or myriad in the user's folder of caches; where that cannot be
/// used, one of this process alone.
class compiled_cache {
public:
    /// Writes `model.so` into a folder that is removed afterwards.
    using maker = std::function<void(const std::filesystem::path&)>;
    /// Loads a file by a name that it has until this returns, and that no other file ever gets, since the system's
    /// loader tells libraries apart by their names. Throws `error` if the file cannot be loaded.
    using loader = std::function<void(const std::string&)>;

    /// Opens the folder, which is made if need be. Throws `error` if $MYRIAD_CACHE_SIZE is no number. `check` is for
    /// waits for other processes.
    explicit compiled_cache(signal_check check = {});
    compiled_cache(const compiled_cache&) = delete;
    compiled_cache& operator=(const compiled_cache&) = delete;
    ~compiled_cache();

    /// The user's folder, which may not exist; empty if none is known.
    static std::filesystem::path user_folder();

    /// Why the user's folder is not used, and what to do; empty if it is.
    const std::string& objection() const { return objection_; }
    /// Whether that is because others could have put something there.
    bool is_distrusted() const { return is_distrusted_; }

    /// Loads what was made from a text, which stands for everything that the result depends on, and returns whether it
    /// was there. If it is missing, damaged, another's or cannot be loaded, it is made, by one process at a time as far
    /// as the file system has locks, and kept. What a killed process left is removed by the next one.
    bool obtain(std::string_view made_from, const maker& make, const loader& load);

    /// The path of a file of the user's folder that nobody else can have written; empty if there is none.
    std::string find_file(const std::string& name) const;
    /// Makes a file of the user's folder, unless another process does; returns its path, empty if it could not be made.
    std::string make_file(const std::string& name, const maker& make);

    /// Whether this user has compiled a source before, of any compiler and version.
    bool knows(const std::string& source) const;
    /// From now on it is known.
    void remember(const std::string& source);

    /// Removes all compiled models and prepared headers of the user's folder; returns how many models.
    int clear() const;

private:
    class workplace;
    bool find(const std::string& key, std::string_view made_from, const loader& load) const;
    bool make_model(const std::string& key, std::string_view made_from, const maker& make, const loader& load) const;
    void open_folder(const std::filesystem::path& path);
    void use_folder_of_process();
    void shrink(const std::string& keep) const;

    signal_check check_;
    std::uintmax_t limit_;
    int folder_ = -1;  // of the user, -1 if it is not used
    std::filesystem::path made_in_;
    int made_in_folder_ = -1;  // the same if it can be written
    std::string objection_;
    bool is_distrusted_ = false;
};

}  // namespace myriad::compiling
