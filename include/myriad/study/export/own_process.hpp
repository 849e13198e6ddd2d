// SPDX-License-Identifier: MIT
// Work in a process of its own, for libraries that may end the process they run in, as HDF5 when a disk fails. Host
// code only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "myriad/host/core/error.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// What work in another process asks for, in numbers that both sides understand, and what fills the answer.
using data_request = std::array<std::int64_t, 3>;
using data_source = std::function<void(const data_request& wanted, std::span<std::byte> answer)>;

/// What went wrong in another process.
class process_error : public error {
public:
    process_error(std::string_view text, int code) : error(std::string(text)), code_(code) {}
    /// The errno of a call that failed there, 0 if it is not known.
    int code() const { return code_; }

private:
    int code_;
};

/// Calls `work` in a copy of this process, and returns when it is done. There are no other threads in a copy, so that
/// what they had locked stays locked: `work` gets a function for data of this process, which is answered by `source`
/// here. Throws what `source` throws, and `process_error` if `work` throws or a signal ends the process.
void in_own_process(const std::function<void(const data_source& ask)>& work, const data_source& source);

}  // namespace myriad::studies::inline MYRIAD_ABI
