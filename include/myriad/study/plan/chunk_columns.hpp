// SPDX-License-Identifier: MIT
// What was computed of a chunk of instances, before it is stored: for reductions. Host code only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "myriad/host/core/error.hpp"
#include "myriad/kernel/core/status.hpp"
#include "myriad/study/plan/layout.hpp"

namespace myriad {

/// The values of consecutive instances of a study: what a user's reduction is given.
class chunk_columns {
public:
    /// A variable and its values, in row-major order, the instance outermost.
    struct column {
        const studies::variable* what;     ///< its name, type and inner dimensions
        std::span<const std::byte> bytes;  ///< the values
    };

    /// Made by the library.
    chunk_columns(std::int64_t first, std::int64_t size, std::span<const column> columns)
        : first_(first), size_(size), columns_(columns), status_(values<std::uint8_t>("status")) {}

    /// The number of the first instance in the study.
    std::int64_t first() const { return first_; }
    /// How many instances they are.
    std::int64_t size() const { return size_; }
    /// How instance i of them ended.
    myriad::status status(std::int64_t i) const {
        return static_cast<myriad::status>(status_[static_cast<std::size_t>(i)]);
    }
    /// The values of a variable, instance by instance: phases, samples or one value of the first, then of the second.
    /// Throws `error` unless there is such a variable, of that type.
    template <class T>
    std::span<const T> values(std::string_view name) const {
        const column& c = find(name);
        require(c.what->type == studies::element_of<T>, "\"", name, "\" has values of type ",
                studies::name_of(c.what->type), ", not ", studies::name_of(studies::element_of<T>));
        return {reinterpret_cast<const T*>(c.bytes.data()), c.bytes.size() / sizeof(T)};
    }
    /// The variable of that name. Throws `error` if there is none.
    const column& find(std::string_view name) const;

private:
    std::int64_t first_, size_;
    std::span<const column> columns_;
    std::span<const std::uint8_t> status_;
};

}  // namespace myriad
