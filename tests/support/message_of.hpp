// SPDX-License-Identifier: MIT
// The message of the error that a function throws.
#pragma once

#include <string>

#include <myriad/host/core/error.hpp>

namespace tests {

template <class Function>
std::string message_of(Function&& function) {
    try {
        function();
    } catch (const myriad::error& e) {
        return e.what();
    }
    return "nothing was thrown";
}

}  // namespace tests
