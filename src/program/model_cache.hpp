// SPDX-License-Identifier: MIT
// Compiled models on disk. Their code runs with all rights of the user, so that folder and files must belong to the
// user or root, and nobody else may write to them; what is looked at is an open file, which nobody can exchange before
// it is loaded. Host code only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace myriad::programs {

/// An open file that is loaded by the name that its descriptor has. It stays open, since the loader tells libraries
/// apart by their names.
struct compiled_file {
    int descriptor = -1;
    std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor); }
};

/// The folder of compiled models, $MYRIAD_CACHE_DIR, or myriad in the user's folder of caches; where that cannot be
/// used, one of this process alone.
class model_cache {
public:
    model_cache();
    model_cache(const model_cache&) = delete;
    model_cache& operator=(const model_cache&) = delete;
    ~model_cache();

    /// Why the user's folder is not used, and what to do; empty if it is.
    const std::string& objection() const { return objection_; }

    /// What was made from this text; nothing if there is no such file, or it is damaged or another's.
    std::optional<compiled_file> find(const std::string& key, std::string_view made_from) const;

    /// Whether this user has compiled a source before, of any compiler and version.
    bool knows(const std::string& source) const;
    void remember(const std::string& source) const;

    /// The place where a model is compiled. One process has it at a time, as far as the file system has locks; it is
    /// removed at the end, or by the next one if this process is killed.
    class workplace {
    public:
        workplace(const model_cache& cache, const std::string& key);
        workplace(const workplace&) = delete;
        workplace& operator=(const workplace&) = delete;
        ~workplace();
        const std::filesystem::path& folder() const { return folder_; }
        /// Opens `model.so` of the folder, with what it was made from and a checksum behind it.
        compiled_file seal(std::string_view made_from) const;
        /// Puts that into the cache.
        void keep() const;

    private:
        const model_cache& cache_;
        std::string key_;
        int lock_;
        std::filesystem::path folder_;
    };

    /// Removes what was not used for longest until the rest is within $MYRIAD_CACHE_SIZE, and what killed processes
    /// left.
    void shrink(const std::string& keep) const;

private:
    void open_folder(const std::filesystem::path& path);

    int folder_ = -1;  // of the user, -1 if it is not used
    std::filesystem::path made_in_;
    int made_in_folder_ = -1;  // the same if it can be written
    std::string objection_;
};

}  // namespace myriad::programs
