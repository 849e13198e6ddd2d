// SPDX-License-Identifier: MIT
// Loading shared objects, and making sure that it is the right one.
#include "compile/loaded_library.hpp"

#include <dlfcn.h>

#include "compile/compiled_cache.hpp"
#include "myriad/host/core/error.hpp"

namespace myriad::compiling {

namespace {

constexpr const char* digest_symbol = "myriad_made_from";

}  // namespace

std::string digest_line(std::string_view made_from) {
    return message("\nextern \"C\" {\nextern __attribute__((visibility(\"default\"))) const char ", digest_symbol,
                   "[];\nconst char ", digest_symbol, "[] = \"", text_hash(made_from), "\";\n}\n");
}

loaded_library::loaded_library(const std::string& path, std::string_view made_from)
    : handle_(::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    require(handle_ != nullptr, "the compiled model could not be loaded: ", handle_ != nullptr ? "" : ::dlerror());
    const auto* const digest = static_cast<const char*>(find(digest_symbol));
    const bool is_right = digest != nullptr && text_hash(made_from) == digest;
    if (is_right) return;
    ::dlclose(handle_);
    host::refuse({digest == nullptr
                      ? "the file of a compiled model holds none"
                      : "the system's loader has taken another compiled model for the one that was asked for",
                  host::cure, "remove the cache of compiled models, and start the program again"});
}
loaded_library::~loaded_library() {
    if (!is_kept_) ::dlclose(handle_);
}

void* loaded_library::find(const char* name) const { return ::dlsym(handle_, name); }

void* loaded_library::keep() {
    is_kept_ = true;
    return handle_;
}

}  // namespace myriad::compiling
