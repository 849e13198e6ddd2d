// SPDX-License-Identifier: MIT
// Joins the parts of messages.
#include "myriad/host/core/error.hpp"

#include <algorithm>
#include <locale>
#include <ostream>
#include <sstream>

namespace myriad {

namespace {

bool is_separator(const statement_part& p) { return p.kind == part_kind::separator; }

}  // namespace

const statement_part* statement::subject() const {
    for (const statement_part& p : parts)
        if (p.kind == part_kind::option || p.kind == part_kind::component || p.kind == part_kind::event) return &p;
    return nullptr;
}
std::span<const statement_part> statement::problem() const {
    const auto end = std::find_if(parts.begin(), parts.end(), is_separator);
    return {parts.begin(), end};
}
std::span<const statement_part> statement::cure() const {
    const auto begin = std::find_if(parts.begin(), parts.end(), is_separator);
    return {begin == parts.end() ? begin : begin + 1, parts.end()};
}

std::ostream& operator<<(std::ostream& out, const statement& s) { return out << s.text(); }

namespace host::inline MYRIAD_ABI {

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
        case kind::said:
            out << *value_.said;
            return;
        case kind::other:
            value_.other.print(out, value_.other.value);
    }
}

statement join(std::initializer_list<message_part> parts) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(9);
    statement made;
    for (const message_part& part : parts) {
        if (part.kind_ == message_part::kind::said && part.is_ == part_kind::text) {
            const auto& more = part.value_.said->parts;
            made.parts.insert(made.parts.end(), more.begin(), more.end());
            continue;
        }
        out.str({});
        part.print(out);
        // Texts that follow each other are one part.
        if (part.is_ == part_kind::text && !made.parts.empty() && made.parts.back().kind == part_kind::text) {
            made.parts.back().words += out.str();
        } else {
            made.parts.push_back({part.is_, out.str(), std::string(part.key_), part.number_});
        }
    }
    return made;
}

void refuse(std::initializer_list<message_part> parts) { throw error(join(parts)); }

}  // namespace host::inline MYRIAD_ABI

}  // namespace myriad
