// SPDX-License-Identifier: MIT
// A shared object that was compiled at run time, in this process. Host code only.
#pragma once

#include <string>
#include <string_view>

namespace myriad::compiling {

/// The line of a source by which its library tells what it was made from.
std::string digest_line(std::string_view made_from);

/// A library, which is closed at the end unless it is kept.
class loaded_library {
public:
    /// Throws `error` if the file cannot be loaded, or if what the process has by that name was made from something
    /// else than `made_from`, as its `digest_line` tells.
    loaded_library(const std::string& path, std::string_view made_from);
    loaded_library(const loaded_library&) = delete;
    loaded_library& operator=(const loaded_library&) = delete;
    ~loaded_library();

    /// A function or variable; null if there is none of that name.
    void* find(const char* name) const;
    /// From now on it stays for the life of the process, as its code may be running. Returns its handle.
    void* keep();

private:
    void* handle_;
    bool is_kept_ = false;
};

}  // namespace myriad::compiling
