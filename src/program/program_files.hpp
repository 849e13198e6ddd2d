// SPDX-License-Identifier: MIT
// Files that commands read, what they tell, and errors of the input. Host code only.
#pragma once

#include <string>

#include "myriad/host/core/error.hpp"
#include "myriad/study/store/file_system.hpp"
#include "myriad/study/store/store.hpp"
#include "program/toml_value.hpp"

namespace myriad::programs {

/// Files that belong to the program: the flags for models, and the script that draws.
std::string data_file(const char* name);
/// The text of a file. Throws `input_error` if it is none.
std::string read_file(const std::string& path);

/// For errors that are the input's, with exit status 2.
template <class Function>
auto as_input(Function&& function) {
    try {
        return function();
    } catch (const studies::file_error&) {
        throw;
    } catch (const input_error&) {
        throw;
    } catch (const error& e) {
        throw input_error(e.what());
    }
}

/// The results in a folder.
store open_store(const std::string& folder);
/// Writes a line of text to the standard error.
void tell(const std::string& text);

}  // namespace myriad::programs
