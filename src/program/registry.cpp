// SPDX-License-Identifier: MIT
// The models that the program knows.
#include <utility>

#include "myriad/host/core/error.hpp"
#include "myriad/program.hpp"

namespace myriad::programs::inline MYRIAD_ABI {

namespace {

std::vector<program_model>& all_models() {  // made before any file registers one
    static std::vector<program_model> all;
    return all;
}

}  // namespace

void add_model(program_model added, std::size_t sizes) {
    require(sizes == sizes_of_shared_types, "the model ", added.names.model(),
            " was compiled with headers of another Myriad than this program: build the program again");
    for (program_model& there : all_models()) {
        if (there.names.model() != added.names.model()) continue;
        for (program_method& m : added.methods) there.methods.push_back(std::move(m));
        return;
    }
    all_models().push_back(std::move(added));
}

const std::vector<program_model>& registered_models() { return all_models(); }

std::string plain_name(std::string_view type) {
    std::string name(type);
    constexpr std::string_view library = "myriad::";
    for (std::size_t at = 0; (at = name.find(library, at)) != std::string::npos;) {
        const bool begins = at == 0 || std::string_view("<, ").find(name[at - 1]) != std::string_view::npos;
        if (begins) {
            name.erase(at, library.size());
        } else {
            at += library.size();
        }
    }
    return name;
}

}  // namespace myriad::programs::inline MYRIAD_ABI
