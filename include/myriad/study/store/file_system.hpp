// SPDX-License-Identifier: MIT
// All that a store does with files, behind one interface, so that tests can make any call fail. Above it, what stores
// and exports are made of: new files that appear whole or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "myriad/host/core/error.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// What is known of an open file.
struct file_facts {
    std::int64_t size = 0;
    std::int64_t modified = 0;  ///< nanoseconds, by the clock of the disk's machine
    std::int64_t number = 0;    ///< of the file or folder on its disk
};

/// Functions of the operating system, by their names in POSIX: they return -1 and set errno if they fail.
class file_system {
public:
    virtual ~file_system() = default;
    /// The operating system's.
    static file_system& real();

    virtual int open(const std::string& path, int flags);
    virtual ssize_t read(int file, void* data, std::size_t size);
    virtual ssize_t write(int file, const void* data, std::size_t size);
    virtual int fsync(int file);
    virtual int close(int file);
    virtual int facts(int file, file_facts& result);
    virtual int size(const std::string& path, std::int64_t& result);  ///< without opening it
    virtual int rename(const std::string& from, const std::string& to);
    virtual int link(const std::string& from, const std::string& to);
    virtual int unlink(const std::string& path);
    virtual int mkdir(const std::string& path);
    virtual int rmdir(const std::string& path);
    virtual int touch(const std::string& path);  ///< modified now
    virtual int list(const std::string& folder, std::vector<std::string>& names);
    virtual int free_bytes(const std::string& folder, std::int64_t& result);
};

/// An error of a call, with its errno.
class file_error : public error {
public:
    /// "<what> <path> failed: <reason>", and what to do about it in a study.
    file_error(std::string_view what, std::string_view path, int code);
    int code() const { return code_; }
    /// The same with what to do if it happened while a file was exported.
    error of_export() const;

private:
    std::string what_, path_;
    int code_;
};

/// What is wrong with data, as the error says that `read` throws; nothing if it throws none. Errors of calls are
/// thrown.
template <class Read>
std::optional<std::string> damage_in(Read&& read) {
    try {
        read();
    } catch (const file_error&) {
        throw;
    } catch (const error& damaged) {
        return damaged.what();
    }
    return std::nullopt;
}

/// An open file, closed at the end.
class open_file {
public:
    /// Throws `file_error`.
    open_file(file_system& files, std::string path, int flags);
    open_file(open_file&& other) noexcept;
    open_file& operator=(open_file&&) = delete;
    ~open_file();

    /// As many bytes as there are, at most those that fit.
    std::size_t read(std::span<std::byte> bytes);
    void write(std::span<const std::byte> bytes);
    /// What was written is on the disk when this returns.
    void sync();
    /// For files that were written: errors that only closing shows.
    void close();
    file_facts facts();
    const std::string& path() const { return path_; }
    int descriptor() const { return file_; }

private:
    file_system* files_;
    std::string path_;
    int file_;
};

/// A file that is written under a temporary name, made durable, and gets its name when it is whole. Without that it is
/// removed.
class new_file {
public:
    new_file(file_system& files, std::string temporary_path);
    new_file(new_file&& other) noexcept;
    new_file& operator=(new_file&&) = delete;
    ~new_file();

    void write(std::span<const std::byte> bytes) { file_.write(bytes); }
    void write(std::string_view text) { file_.write(std::as_bytes(std::span(text))); }
    /// The last step before it gets its name.
    void finish();
    /// Replaces a file of that name. Durable when the folder was synchronised.
    void rename_to(const std::string& path);
    /// False if there is a file of that name, which stays.
    bool link_to(const std::string& path);

private:
    file_system* files_;
    open_file file_;
    bool there_ = true;
};

/// Makes the names in a folder durable.
void sync_folder(file_system& files, const std::string& folder);
/// Makes a folder that may be there already.
void make_folder(file_system& files, const std::string& folder);
/// The same with the folders that it is in, durably.
void make_folders(file_system& files, const std::string& folder);
/// The names in a folder, unsorted; nothing if there is no such folder.
std::optional<std::vector<std::string>> names_in(file_system& files, const std::string& folder);
/// The contents of a small file; nothing if there is none.
std::optional<std::string> read_text(file_system& files, const std::string& path);
/// Writes a small file, durably and at once.
void write_text(file_system& files, const std::string& temporary_path, const std::string& path, std::string_view text);
/// The same if there is no file of that name: false if there is. To be made durable by `sync_folder`.
bool write_first(file_system& files, const std::string& temporary_path, const std::string& path, std::string_view text);
/// The number in a file's name, as in "17.json" with the ending ".json"; nothing if it is another name.
std::optional<std::int64_t> number_in(std::string_view name, std::string_view ending = "");
/// The folder that a path is in.
std::string folder_of(const std::string& path);
/// Throws `error` if there is a zero byte in a path: the system would take what is before it for the path.
void refuse_zero_byte(std::string_view path);
/// The place of a file to be written to a path: symbolic links are followed. Throws `error` if there is something else
/// than a file, as a folder or a device, which a new file must not replace.
std::string file_place(const std::string& path);

}  // namespace myriad::studies::inline MYRIAD_ABI
