// SPDX-License-Identifier: MIT
// Another machine of the same name, in whose processes the numbers are those of this one's.
#pragma once

#include <fstream>
#include <string>

#include "myriad/study/store/file_system.hpp"

namespace tests {

/// The files of this machine, but that it was started another time.
class other_machine final : public myriad::studies::file_system {
public:
    /// `path`: of a file for the name of its start.
    explicit other_machine(std::string path, const std::string& boot = "another-start") : path_(std::move(path)) {
        std::ofstream(path_) << boot << '\n';
    }
    int open(const std::string& p, int flags) override {
        return file_system::open(p == "/proc/sys/kernel/random/boot_id" ? path_ : p, flags);
    }

private:
    std::string path_;
};

}  // namespace tests
