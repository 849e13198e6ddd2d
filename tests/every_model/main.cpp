// SPDX-License-Identifier: MIT
// Checks the derivatives of the models of one file, and says what it found.
#include <iostream>

#include "tests/every_model/derivatives.hpp"

int main() {
    int failures = 0;
    for (const every_model::check& one : every_model::all_checks()) {
        const every_model::outcome found = one.run();
        std::cout << one.model << ": " << found.pattern << ", " << found.samples << " samples\n";
        if (found.samples == 0) std::cout << "    no sample had finite derivatives\n";
        failures += found.samples == 0;
        for (std::size_t i = 0; i < found.wrong.size() && i < 10; ++i) std::cout << "    " << found.wrong[i] << '\n';
        if (one.is_wrong) {
            if (found.wrong.empty()) std::cout << "    it is wrong, and this was not found\n";
            failures += found.wrong.empty();
        } else {
            failures += static_cast<int>(found.wrong.size());
        }
    }
    if (every_model::all_checks().empty()) {
        std::cout << "the file has no model\n";
        return 1;
    }
    return failures == 0 ? 0 : 1;
}
