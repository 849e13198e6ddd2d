// SPDX-License-Identifier: MIT
// How much memory the program may still allocate: Linux overcommits memory, and kills a program that uses more than
// there is. So the library checks before it allocates much. Host code only.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "myriad/host/core/error.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Bytes in human-readable form: "1.53 GB".
std::string bytes_text(double bytes, int digits = 3);
/// Two of them, with enough digits to tell them apart.
std::pair<std::string, std::string> bytes_texts(double one, double other);

/// Memory that is left, and what limits it. Limits that cannot be read are ignored.
struct memory_left {
    double bytes = std::numeric_limits<double>::infinity();
    std::string of = {};

    void at_most(double other, const std::string& what);
};

/// Reads the system's files below `root`.
class memory_reader {
public:
    explicit memory_reader(std::string root = "") : root_(std::move(root)) {}

    /// The minimum of what is left in the machine and in the program's control groups (versions 1 and 2) with all their
    /// ancestors.
    memory_left left() const;

private:
    struct file_names;
    static const file_names version_1, version_2;

    /// The number after a word, or the file's only number.
    std::optional<double> entry(const std::string& file, const std::string& word = "") const;
    /// The group at `path` and all its ancestors. In a container a path may begin outside of it; groups that do not
    /// exist are skipped.
    void look_at_groups(memory_left& least, const std::string& mount, std::string path, const file_names& name,
                        double swap) const;

    std::string root_;
};

/// What is left now, including address space.
memory_left available_memory();

/// The memory that something is going to allocate, part by part.
class memory_need {
public:
    /// Parts of the same name are one.
    void add(const char* part, double bytes);
    double bytes() const {
        double sum = 0;
        for (const auto& part : parts_) sum += part.second;
        return sum;
    }
    /// Throws `error` unless that much is available; not checked for a few megabytes. `who` allocates it; `advice` says
    /// what to do.
    void check(const std::string& who, const message_part& advice,
               memory_left (*available)() = &available_memory) const;

private:
    std::vector<std::pair<const char*, double>> parts_;
};

}  // namespace myriad::host::inline MYRIAD_ABI
