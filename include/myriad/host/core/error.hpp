// SPDX-License-Identifier: MIT
// The host side's exception. A message names the problem, why it is one, and what to do.
#pragma once

#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>

#include "myriad/kernel/core/ieee.hpp"

namespace myriad {

/// Thrown by every check on the host before any work is done.
class error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Joins its arguments into one message, independently of the program's locale, since device names are parsed again.
template <class... Parts>
std::string message(const Parts&... parts) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(9);
    (out << ... << parts);
    return out.str();
}

/// Throws an error of the joined parts unless the condition holds.
template <class... Parts>
void require(bool condition, const Parts&... parts) {
    if (!condition) throw error(message(parts...));
}

}  // namespace myriad
