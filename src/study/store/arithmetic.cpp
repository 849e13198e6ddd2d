// SPDX-License-Identifier: MIT
// The arithmetic of this process.
#include <utility>

#include <unistd.h>

#if defined(__GLIBC__)
#include <gnu/libc-version.h>
#endif

#include "myriad/host/core/error.hpp"
#include "myriad/study/store/store.hpp"
#include "myriad/version.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

arithmetic arithmetic::of_kernel(std::string instruction_set, std::string compiler) {
    arithmetic made{std::move(instruction_set), std::move(compiler), "Myriad " MYRIAD_VERSION, ""};
#if defined(__GLIBC__)
    made.library += message(", glibc ", ::gnu_get_libc_version());
#endif
    char name[256] = {};
    if (::gethostname(name, sizeof name - 1) == 0) made.host = name;
    return made;
}

std::string arithmetic::text() const {
    std::string all;
    for (const std::string* const part : {&instruction_set, &compiler, &library})
        if (!part->empty()) all += (all.empty() ? "" : ", ") + *part;
    return all;
}

}  // namespace myriad::studies::inline MYRIAD_ABI
