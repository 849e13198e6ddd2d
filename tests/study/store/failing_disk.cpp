// SPDX-License-Identifier: MIT
// A disk that fails: calls of the C library, preloaded before it (LD_PRELOAD). MYRIAD_FAILING_DISK="write 3 28" makes
// the third write to an unfinished file (".part-" in its name) fail with error 28, "write 3+ 28" those after it too.
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <dlfcn.h>
#include <sys/types.h>
#include <unistd.h>

namespace {

/// Whether this call is to fail; errno is set then.
bool fails(const char* call, const char* path) {
    static int count = 0;
    const char* const wanted = std::getenv("MYRIAD_FAILING_DISK");
    char name[16] = {}, later = 0;
    int at = 0, code = 0;
    if (wanted == nullptr || std::strstr(path, ".part-") == nullptr) return false;
    if (std::sscanf(wanted, "%15s %d%c %d", name, &at, &later, &code) != 4 || std::strcmp(name, call) != 0)
        return false;
    ++count;
    if (later == '+' ? count < at : count != at) return false;
    errno = code;
    return true;
}
bool fails(const char* call, int file) {
    char link[32], path[4096] = {};
    std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    const int before = errno;
    const bool known = ::readlink(link, path, sizeof path - 1) > 0;
    errno = before;
    return known && fails(call, path);
}
template <class F>
F* real(const char* name) {
    return reinterpret_cast<F*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {
ssize_t write(int file, const void* data, std::size_t size) {
    return fails("write", file) ? -1 : real<ssize_t(int, const void*, std::size_t)>("write")(file, data, size);
}
ssize_t pwrite(int file, const void* data, std::size_t size, off_t at) {
    return fails("write", file) ? -1
                                : real<ssize_t(int, const void*, std::size_t, off_t)>("pwrite")(file, data, size, at);
}
ssize_t pwrite64(int file, const void* data, std::size_t size, off64_t at) {
    return fails("write", file)
               ? -1
               : real<ssize_t(int, const void*, std::size_t, off64_t)>("pwrite64")(file, data, size, at);
}
int ftruncate(int file, off_t size) noexcept {
    return fails("truncate", file) ? -1 : real<int(int, off_t)>("ftruncate")(file, size);
}
int ftruncate64(int file, off64_t size) noexcept {
    return fails("truncate", file) ? -1 : real<int(int, off64_t)>("ftruncate64")(file, size);
}
int fsync(int file) { return fails("fsync", file) ? -1 : real<int(int)>("fsync")(file); }
int close(int file) {
    const bool failed = fails("close", file);
    const int code = errno, closed = real<int(int)>("close")(file);
    if (!failed) return closed;
    errno = code;
    return -1;
}
int rename(const char* from, const char* to) noexcept {
    return fails("rename", from) ? -1 : real<int(const char*, const char*)>("rename")(from, to);
}
}
