// SPDX-License-Identifier: MIT
// Joins the parts of messages.
#include "myriad/host/core/error.hpp"

#include <locale>
#include <ostream>
#include <sstream>

#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

std::ostream& operator<<(std::ostream& out, const message_part& part) {
    switch (part.kind_) {
        case message_part::kind::character:
            return out << part.value_.character;
        case message_part::kind::integer:
            return out << part.value_.integer;
        case message_part::kind::natural:
            return out << part.value_.natural;
        case message_part::kind::real:
            return out << part.value_.real;
        case message_part::kind::text:
            return out << std::string_view(part.value_.text.begin, part.value_.text.size);
        case message_part::kind::other:
            part.value_.other.print(out, part.value_.other.value);
    }
    return out;
}

std::string join(std::initializer_list<message_part> parts) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(9);
    for (const message_part& part : parts) out << part;
    return out.str();
}

void refuse(std::initializer_list<message_part> parts) { throw error(join(parts)); }

}  // namespace myriad::host::inline MYRIAD_ABI
