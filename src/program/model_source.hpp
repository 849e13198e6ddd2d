// SPDX-License-Identifier: MIT
// A model's header as one text, with the headers of its own that it includes: what is compiled, kept in the folder of
// results, and compared when a study goes on. Host code only.
#pragma once

#include <string>
#include <vector>

namespace myriad::programs {

/// The text of a model.
struct model_source {
    std::string name;  ///< of the header, without folders
    std::string text;  ///< with the files that it includes in quotes put in their place, and lines that say so
    /// Stands for the text, without those lines: the same wherever the files are.
    std::string digest() const;
    /// The names of the structs that it defines, also by another name for one.
    std::vector<std::string> structs() const;
};

/// Reads a header. Files that it includes in quotes are looked for beside the file that includes them; those that are
/// not there are left to the compiler. Throws `error` if a file cannot be read.
model_source read_model_source(const std::string& path);

}  // namespace myriad::programs
