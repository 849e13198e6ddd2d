// SPDX-License-Identifier: MIT
// The calls of POSIX, and files that appear whole.
#include "myriad/study/store/file_system.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <limits>
#include <system_error>
#include <utility>

#include <dirent.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

// At most so much in one call: the disk begins while the next part is prepared, and Linux takes no more than 2 GB.
constexpr std::size_t largest_call = std::size_t{1} << 24;

// Repeats a call that a signal interrupted.
template <class F>
auto uninterrupted(F call) {
    auto result = call();
    while (result < 0 && errno == EINTR) result = call();
    return result;
}

std::string files_open() {
    rlimit limit{};
    ::getrlimit(RLIMIT_NOFILE, &limit);
    return message(": this process has all ", limit.rlim_cur,
                   " files open that it may have: raise the limit (`ulimit -n ",
                   std::max<rlim_t>(4096, 2 * std::min<rlim_t>(limit.rlim_cur, 1 << 20)), "`)");
}
constexpr const char* all_files_open =
    ": all programs together have as many files open as the machine allows: end some, or raise fs.file-max";

std::string study_advice(int code) {
    switch (code) {
        case ENOSPC:
        case EDQUOT:
            return ". What was finished is kept: free space, or move the folder to a larger disk, and start again";
        case EACCES:
        case EPERM:
        case EROFS:
            return ": give a folder that you may write to";
        case ENOTDIR:
        case ELOOP:
            return ": give the path of a folder";
        case ENAMETOOLONG:
            return ": give a folder with a shorter path";
        case ENOENT:
            return ": a folder of the study was removed or moved; start again, which makes it anew";
        case EISDIR:
            return ": it is a folder, which belongs to no study; remove it, and start again";
        case EMFILE:
            return files_open() + " and start again, which goes on";
        case ENFILE:
            return all_files_open;
        case EMLINK:
        case ENOTSUP:
            return ": give a folder on a file system with hard links, as those of Linux and NFS";
        default:
            return ". What was finished is kept: start again when the disk works";
    }
}

std::string export_advice(int code) {
    switch (code) {
        case ENOSPC:
        case EDQUOT:
        case EFBIG:
            return ": free space, or give a file on a larger disk, and export again";
        case EACCES:
        case EPERM:
        case EROFS:
            return ": give a file in a folder that you may write to";
        case ENOENT:
        case ENOTDIR:
        case ELOOP:
            return ": give a file in a folder that exists";
        case EMFILE:
            return files_open() + " and export again";
        case ENFILE:
            return all_files_open;
        case ENAMETOOLONG:
            return ": give a shorter name";
        case EEXIST:
            return ": remove it, if no other export writes it at the moment, and export again";
        default:
            return ": export again when the disk works";
    }
}

std::string failure_of(std::string_view what, std::string_view path, int code) {
    return message(what, ' ', path.empty() ? "a file without a name" : path,
                   " failed: ", std::generic_category().message(code));
}

}  // namespace

file_system& file_system::real() {
    static file_system system;
    return system;
}

int file_system::open(const std::string& path, int flags) {
    if ((flags & O_ACCMODE) != O_RDONLY) return ::open(path.c_str(), flags | O_CLOEXEC, 0666);
    // A pipe in the place of a file would be waited for, and a device may have no end: they are read as empty.
    const int file = ::open(path.c_str(), flags | O_CLOEXEC | O_NONBLOCK);
    if (file < 0 && errno != ENXIO) return file;  // which a socket gives
    struct stat status;
    if (file >= 0 && (::fstat(file, &status) < 0 || S_ISREG(status.st_mode) || S_ISDIR(status.st_mode))) return file;
    if (file >= 0) ::close(file);
    return ::open("/dev/null", O_RDONLY | O_CLOEXEC);
}
ssize_t file_system::read(int file, void* data, std::size_t size) { return ::read(file, data, size); }
ssize_t file_system::write(int file, const void* data, std::size_t size) { return ::write(file, data, size); }
int file_system::fsync(int file) { return ::fsync(file); }
int file_system::close(int file) { return ::close(file); }
int file_system::rename(const std::string& from, const std::string& to) { return ::rename(from.c_str(), to.c_str()); }
int file_system::link(const std::string& from, const std::string& to) { return ::link(from.c_str(), to.c_str()); }
int file_system::unlink(const std::string& path) { return ::unlink(path.c_str()); }
int file_system::mkdir(const std::string& path) { return ::mkdir(path.c_str(), 0777); }
int file_system::rmdir(const std::string& path) { return ::rmdir(path.c_str()); }
int file_system::touch(const std::string& path) { return ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0); }

int file_system::facts(int file, file_facts& result) {
    struct stat status;
    if (::fstat(file, &status) < 0) return -1;
    result.size = status.st_size;
    result.modified = std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec;
    result.number = static_cast<std::int64_t>(status.st_ino);
    return 0;
}

int file_system::size(const std::string& path, std::int64_t& result) {
    struct stat status;
    if (::stat(path.c_str(), &status) < 0) return -1;
    result = status.st_size;
    return 0;
}

int file_system::list(const std::string& folder, std::vector<std::string>& names) {
    DIR* const opened = ::opendir(folder.c_str());
    if (opened == nullptr) return -1;
    names.clear();
    errno = 0;
    while (const dirent* const entry = ::readdir(opened)) {
        const std::string_view name = entry->d_name;
        if (name != "." && name != "..") names.emplace_back(name);
        errno = 0;
    }
    const int code = errno;
    ::closedir(opened);
    errno = code;
    return code == 0 ? 0 : -1;
}

int file_system::free_bytes(const std::string& folder, std::int64_t& result) {
    struct statvfs status;
    if (::statvfs(folder.c_str(), &status) < 0) return -1;
    const auto most = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    std::uint64_t bytes = 0;
    if (__builtin_mul_overflow(std::uint64_t{status.f_bavail}, std::uint64_t{status.f_frsize}, &bytes)) bytes = most;
    result = static_cast<std::int64_t>(std::min(bytes, most));
    return 0;
}

file_error::file_error(std::string_view what, std::string_view path, int code)
    : error(failure_of(what, path, code) + study_advice(code)), what_(what), path_(path), code_(code) {}

error file_error::of_export() const { return error(failure_of(what_, path_, code_) + export_advice(code_)); }

open_file::open_file(file_system& files, std::string path, int flags)
    : files_(&files), path_(std::move(path)), file_(uninterrupted([&] { return files.open(path_, flags); })) {
    if (file_ < 0) throw file_error("opening", path_, errno);
}

open_file::open_file(open_file&& other) noexcept
    : files_(other.files_), path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {}

open_file::~open_file() {
    if (file_ >= 0) files_->close(file_);
}

std::size_t open_file::read(std::span<std::byte> bytes) {
    std::size_t had = 0;
    while (had < bytes.size()) {
        const std::size_t part = std::min(bytes.size() - had, largest_call);
        const ssize_t got = uninterrupted([&] { return files_->read(file_, bytes.data() + had, part); });
        if (got < 0) throw file_error("reading", path_, errno);
        if (got == 0) break;
        had += static_cast<std::size_t>(got);
    }
    return had;
}

void open_file::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const std::size_t part = std::min(bytes.size(), largest_call);
        const ssize_t put = uninterrupted([&] { return files_->write(file_, bytes.data(), part); });
        if (put < 0) throw file_error("writing", path_, errno);
        if (put == 0) throw file_error("writing", path_, ENOSPC);
        bytes = bytes.subspan(static_cast<std::size_t>(put));
    }
}

// Not repeated after an error: what it was about may be lost by then.
void open_file::sync() {
    if (uninterrupted([&] { return files_->fsync(file_); }) < 0) throw file_error("writing", path_, errno);
}

void open_file::close() {
    // Not repeated if interrupted, since Linux has closed it then.
    if (files_->close(std::exchange(file_, -1)) < 0 && errno != EINTR) throw file_error("closing", path_, errno);
}

file_facts open_file::facts() {
    file_facts result;
    if (files_->facts(file_, result) < 0) throw file_error("reading", path_, errno);
    return result;
}

new_file::new_file(file_system& files, std::string temporary_path)
    : files_(&files), file_(files, std::move(temporary_path), O_WRONLY | O_CREAT | O_EXCL) {}

new_file::new_file(new_file&& other) noexcept
    : files_(other.files_), file_(std::move(other.file_)), there_(std::exchange(other.there_, false)) {}

new_file::~new_file() {
    if (there_) files_->unlink(file_.path());
}

void new_file::finish() {
    file_.sync();
    file_.close();
}

void new_file::rename_to(const std::string& path) {
    if (files_->rename(file_.path(), path) < 0) throw file_error("writing", path, errno);
    there_ = false;
}

bool new_file::link_to(const std::string& path) {
    if (files_->link(file_.path(), path) == 0) return true;
    if (errno == EEXIST) return false;
    throw file_error("writing", path, errno);
}

void sync_folder(file_system& files, const std::string& folder) {
    open_file opened(files, folder, O_RDONLY | O_DIRECTORY);
    try {
        opened.sync();
    } catch (const file_error& failure) {
        // Some file systems cannot, and need not.
        if (failure.code() != EINVAL && failure.code() != ENOTSUP) throw;
    }
}

void make_folder(file_system& files, const std::string& folder) {
    if (files.mkdir(folder) < 0 && errno != EEXIST) throw file_error("making the folder", folder, errno);
}

namespace {

/// Refuses a link to nothing, of which the system says both that it exists and that it does not.
void refuse_dangling_link(const std::string& folder) {
    std::error_code unknown;
    const std::filesystem::path target = std::filesystem::read_symlink(folder, unknown);
    if (unknown || std::filesystem::status(folder, unknown).type() != std::filesystem::file_type::not_found) return;
    host::refuse({host::named_option("store", "the folder"), " ", folder, " is a link to ", target.string(),
                  ", which is not there", host::cure, "make that folder, or remove the link"});
}

}  // namespace

void make_folders(file_system& files, const std::string& folder) {
    const std::string parent = folder_of(folder);
    if (files.mkdir(folder) < 0) {
        if (errno == EEXIST) return refuse_dangling_link(folder);
        if (errno != ENOENT || parent == folder) throw file_error("making the folder", folder, errno);
        make_folders(files, parent);
        make_folder(files, folder);
    }
    try {
        sync_folder(files, parent);
    } catch (const file_error& failure) {
        if (failure.code() != EACCES) throw;  // one that may be written, and not be read
    }
}

std::optional<std::vector<std::string>> names_in(file_system& files, const std::string& folder) {
    std::vector<std::string> names;
    if (files.list(folder, names) == 0) return names;
    if (errno == ENOENT) return std::nullopt;
    throw file_error("reading the folder", folder, errno);
}

std::optional<std::string> read_text(file_system& files, const std::string& path) {
    std::string text;
    try {
        open_file file(files, path, O_RDONLY);
        std::size_t had = 0;
        do {
            text.resize(had + 65536);
            const std::size_t got = file.read(std::as_writable_bytes(std::span(text).subspan(had)));
            had += got;
            text.resize(had);
            if (got < 65536) return text;
        } while (true);
    } catch (const file_error& failure) {
        if (failure.code() != ENOENT) throw;
        return std::nullopt;
    }
}

void write_text(file_system& files, const std::string& temporary_path, const std::string& path, std::string_view text) {
    new_file file(files, temporary_path);
    file.write(text);
    file.finish();
    file.rename_to(path);
    sync_folder(files, folder_of(path));
}

bool write_first(file_system& files, const std::string& temporary_path, const std::string& path,
                 std::string_view text) {
    new_file file(files, temporary_path);
    file.write(text);
    file.finish();
    return file.link_to(path);
}

std::optional<std::int64_t> number_in(std::string_view name, std::string_view ending) {
    std::int64_t number = 0;
    const auto [rest, problem] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (problem != std::errc() || std::string_view(rest, name.data() + name.size()) != ending) return std::nullopt;
    return number;
}

std::string folder_of(const std::string& path) {
    const std::size_t end = path.find_last_not_of('/');
    if (end == std::string::npos) return path.empty() ? "." : "/";
    const std::size_t slash = path.find_last_of('/', end);
    if (slash == std::string::npos) return ".";
    const std::size_t last = path.find_last_not_of('/', slash);
    return last == std::string::npos ? "/" : path.substr(0, last + 1);
}

void refuse_zero_byte(std::string_view path) {
    const std::size_t end = path.find('\0');
    require(end == std::string_view::npos, "the path ", path.substr(0, end),
            " goes on after a zero byte, where the system would end it", host::cure, "give a path without one");
}

std::string file_place(const std::string& path) {
    require(!path.empty(), "the file has no name", host::cure, "give the path of a file");
    refuse_zero_byte(path);
    std::filesystem::path place = path;
    std::error_code unknown;  // what cannot be looked up shows when it is written
    for (int links = 0; std::filesystem::is_symlink(place, unknown); ++links) {
        if (links == 40) throw file_error("following the link", path, ELOOP).of_export();
        place = place.parent_path() / std::filesystem::read_symlink(place, unknown);
    }
    const std::filesystem::file_status now = std::filesystem::status(place, unknown);
    require(!std::filesystem::exists(now) || std::filesystem::is_regular_file(now), path,
            std::filesystem::is_directory(now) ? " is a folder" : " is no regular file",
            ", which an exported one cannot replace", host::cure, "give the path of a file");
    return place.string();
}

}  // namespace myriad::studies::inline MYRIAD_ABI
