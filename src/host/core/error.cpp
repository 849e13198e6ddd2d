// SPDX-License-Identifier: MIT
// Joins the parts of messages.
#include "myriad/host/core/error.hpp"

#include <locale>
#include <ostream>
#include <sstream>

namespace myriad::host::inline MYRIAD_ABI {

void message_part::print(std::ostream& out) const {
    switch (kind_) {
        case kind::character:
            out << value_.character;
            return;
        case kind::integer:
            out << value_.integer;
            return;
        case kind::natural:
            out << value_.natural;
            return;
        case kind::real:
            out << value_.real;
            return;
        case kind::text:
            out << std::string_view(value_.text.begin, value_.text.size);
            return;
        case kind::marked:
            out << value_.marked->text();
            return;
        case kind::other:
            value_.other.print(out, value_.other.value);
    }
}

marked_text join(std::initializer_list<message_part> parts) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(9);
    std::vector<mark> marks;
    for (const message_part& part : parts) {
        const auto begin = static_cast<std::size_t>(out.tellp());
        part.print(out);
        if (part.has_role_)
            marks.push_back({begin, static_cast<std::size_t>(out.tellp()) - begin, part.role_, std::string(part.key_)});
        if (part.kind_ != message_part::kind::marked) continue;
        for (mark inner : part.value_.marked->marks()) {
            inner.begin += begin;
            marks.push_back(inner);
        }
    }
    return {out.str(), std::move(marks)};
}

void refuse(std::initializer_list<message_part> parts) { throw error(join(parts)); }

}  // namespace myriad::host::inline MYRIAD_ABI
