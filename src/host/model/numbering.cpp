// SPDX-License-Identifier: MIT
// What messages say about components.
#include "myriad/host/model/numbering.hpp"

#include <ostream>

#include "myriad/host/core/error.hpp"

namespace myriad::host::inline MYRIAD_ABI {

std::ostream& operator<<(std::ostream& out, const component_label& label) {
    out << label.what;
    if (label.number >= 0) out << ' ' << label.number;
    if (!label.enumerator.empty()) out << " (" << label.enumerator << ')';
    return out;
}

std::vector<std::string> names_in_units(std::span<const std::string_view> of_one, int units) {
    std::vector<std::string> names;
    for (int unit = 0; unit < units; ++unit)
        for (const std::string_view name : of_one)
            names.push_back(name.empty() ? std::string() : message(name, '_', unit));
    return names;
}

void check_component(std::int64_t number, int count, std::string_view what) {
    require(number >= 0 && number < count, what, " ", number, " does not exist: the model has ", count,
            " (numbered from 0); use the model's enumerators");
}

}  // namespace myriad::host::inline MYRIAD_ABI
