// SPDX-License-Identifier: MIT
// A table of results in comma-separated values: fast enough for millions of rows, and either complete or absent.
#pragma once

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "myriad/host/memory/memory_need.hpp"

namespace examples {

template <class T>
concept number = std::integral<T> || std::floating_point<T>;

/// Writes to a temporary file next to the target and renames it when complete, so that a full disk or a crash never
/// leaves half a table, nor damages one of an earlier run. Numbers are written with the fewest digits that reproduce
/// their bits. All members throw std::runtime_error with the system's reason.
class csv_file {
public:
    /// Checks before the work starts that the target can be written: creates its folder (one level) if there is none,
    /// and tries to create a file in it. Less than `least_bytes` of free space is an error.
    explicit csv_file(std::filesystem::path target, std::uintmax_t least_bytes = 0) : target_(std::move(target)) {
        namespace fs = std::filesystem;
        std::error_code failure;
        if (fs::is_symlink(target_, failure)) target_ = fs::weakly_canonical(target_, failure);
        const fs::file_status there = fs::status(target_, failure);
        // Renaming over a device, such as /dev/null as root, would replace it for the whole system.
        if (fs::exists(there) && !fs::is_regular_file(there)) fail("is not a regular file");
        if (target_.filename().empty()) fail("has no file name");

        const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
        if (!fs::exists(folder, failure)) {
            fs::create_directory(folder, failure);
            if (failure) fail("cannot be written: its folder cannot be created (" + failure.message() + ")");
        }
        const fs::space_info space = fs::space(folder, failure);
        if (!failure && space.capacity > 0 && space.available < least_bytes)
            fail_for_lack_of_space(static_cast<double>(least_bytes), static_cast<double>(space.available));

        temporary_ = target_;
        temporary_ += '.' + std::to_string(::getpid()) + ".part";
        create();
        remove();
    }
    csv_file(const csv_file&) = delete;
    csv_file& operator=(const csv_file&) = delete;
    ~csv_file() { remove(); }

    /// The file as its user named it, with links followed.
    const std::filesystem::path& path() const { return target_; }

    /// A line that readers skip.
    void comment(std::string_view text) {
        begin_line();
        append("# ");
        append(text);
        append('\n');
    }
    /// A row of numbers and names.
    template <class First, class... More>
    void row(const First& first, const More&... more) {
        begin_line();
        append(first);
        ((append(','), append(more)), ...);
        append('\n');
    }

    /// Puts the complete file in place.
    void commit() {
        begin_line();
        flush();
        const int file = file_;
        file_ = -1;
        if (::close(file) != 0) fail_writing();
        std::error_code failure;
        std::filesystem::rename(temporary_, target_, failure);
        if (failure) fail("cannot be written: " + failure.message());
        created_ = false;
        any_is_there_ = true;
    }
    /// A file was put in place otherwise.
    static void set_any_is_there() { any_is_there_ = true; }
    /// Whether the program has put any file in place.
    static bool any_is_there() { return any_is_there_; }

private:
    // A number's text has at most 24 characters; a line is a few dozen of them at most.
    static constexpr std::size_t capacity = 1 << 20, longest_number = 32;

    void begin_line() {
        if (file_ >= 0) return;
        create();
        buffer_.resize(capacity);
    }
    void create() {
        file_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file_ < 0) fail_writing();
        created_ = true;
    }
    void remove() {
        if (file_ >= 0) ::close(file_);
        file_ = -1;
        if (created_) ::unlink(temporary_.c_str());
        created_ = false;
    }

    void reserve(std::size_t bytes) {
        if (capacity - used_ < bytes) flush();
    }
    void append(char c) {
        reserve(1);
        buffer_[used_++] = c;
    }
    void append(std::string_view text) {
        while (!text.empty()) {
            reserve(1);
            const std::string_view part = text.substr(0, capacity - used_);
            std::memcpy(buffer_.data() + used_, part.data(), part.size());
            used_ += part.size();
            text.remove_prefix(part.size());
        }
    }
    void append(const char* text) { append(std::string_view(text)); }
    template <number Number>
    void append(Number value) {
        if constexpr (std::floating_point<Number>) {
            if (std::isnan(value)) return append("nan");  // to_chars may write a sign
        }
        reserve(longest_number);
        char* const begin = buffer_.data() + used_;
        used_ += static_cast<std::size_t>(std::to_chars(begin, begin + longest_number, value).ptr - begin);
    }

    void flush() {
        const char* from = buffer_.data();
        while (used_ > 0) {
            const ssize_t written = ::write(file_, from, used_);
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) fail_writing();
            from += written;
            used_ -= static_cast<std::size_t>(written);
        }
    }

    [[noreturn]] void fail_for_lack_of_space(double needed, double free) const {
        const auto [least, there] = myriad::host::bytes_texts(needed, free);
        fail("cannot be written: at least " + least + " are needed, and " + there + " are free");
    }
    [[noreturn]] void fail(const std::string& why) const {
        throw std::runtime_error((target_.empty() ? "\"\"" : target_.string()) + ' ' + why +
                                 "; choose another file with --output");
    }
    [[noreturn]] void fail_writing() const { fail(std::string("cannot be written: ") + std::strerror(errno)); }

    static inline std::atomic<bool> any_is_there_ = false;
    std::filesystem::path target_, temporary_;
    int file_ = -1;
    bool created_ = false;
    std::vector<char> buffer_;
    std::size_t used_ = 0;
};

}  // namespace examples
