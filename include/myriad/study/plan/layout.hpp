// SPDX-License-Identifier: MIT
// What is in the results of a study: its grid, its variables and coordinates. Plain data, the same for results in
// memory, in a store and in an exported file.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "myriad/kernel/core/abi.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// The type of a variable's values.
enum class element : std::uint8_t {
    f64,  ///< double
    f32,  ///< float
    i64,  ///< std::int64_t
    i32,  ///< std::int32_t
    u8,   ///< std::uint8_t
};

/// The bytes of one value.
std::size_t size_of(element type);
/// As Zarr and NumPy call it: "float64".
std::string_view name_of(element type);
/// What stands for a value that was not computed: NaN; for integers the same as netCDF's (the lowest int32 plus 1, the
/// lowest int64 plus 2, and 255).
void fill(element type, void* values, std::size_t count);

/// The C++ types of values.
template <class T>
concept element_type = std::same_as<T, double> || std::same_as<T, float> || std::same_as<T, std::int64_t> ||
    std::same_as<T, std::int32_t> || std::same_as<T, std::uint8_t>;

/// The element of a C++ type.
template <element_type T>
inline constexpr element element_of = std::same_as<T, double>         ? element::f64
                                      : std::same_as<T, float>        ? element::f32
                                      : std::same_as<T, std::int64_t> ? element::i64
                                      : std::same_as<T, std::int32_t> ? element::i32
                                                                      : element::u8;

/// Calls a function with a value of the C++ type of an element.
template <class Function>
decltype(auto) with_type(element type, Function&& function) {
    switch (type) {
        case element::f64:
            return function(double{});
        case element::f32:
            return function(float{});
        case element::i64:
            return function(std::int64_t{});
        case element::i32:
            return function(std::int32_t{});
        default:
            return function(std::uint8_t{});
    }
}

/// A named dimension. Names are unique in a layout: a dimension of the same name always has the same length.
struct dimension {
    std::string name;                                   ///< of an axis, "phase", "sample" or another
    std::int64_t length = 0;                            ///< the number of values along it
    bool operator==(const dimension&) const = default;  ///< the same name and length
};

/// Something that readers should know about a variable, as "units" or CF's "flag_values" and "flag_meanings".
struct attribute {
    std::string name;  ///< as readers know it
    /// A text, a number or numbers.
    std::variant<std::string, double, std::vector<double>, std::int64_t, std::vector<std::int64_t>> value;
    bool operator==(const attribute&) const = default;  ///< the same name and value
};

/// What there is one item of a variable for.
enum class along : std::uint8_t {
    instances,  ///< each instance: its outermost dimension is "instance"
    chunks,     ///< each chunk: partial results of a reduction, which only a store has, and no exported file
    nothing,    ///< the whole study: a final result, written once when all chunks are done
};

/// Whether a variable holds results, or where they belong to.
enum class role : std::uint8_t {
    data,        ///< a result
    coordinate,  ///< a place: what was drawn at random for each instance
};

/// An array of results. Its values are in row-major order, the instance (or chunk) outermost.
struct variable {
    std::string name;                          ///< unique in a layout
    element type = element::f64;               ///< of its values
    std::vector<dimension> inner = {};         ///< of one item, as {"phase", 32}; none: one value
    std::vector<attribute> attributes = {};    ///< what readers should know about it
    along extent = along::instances;           ///< what there is one item for
    studies::role role = studies::role::data;  ///< a result, or where results belong to

    /// The number of values of one item.
    std::int64_t values_per_item() const;
    /// The bytes of one item.
    std::int64_t item_bytes() const;
};

/// Values along one dimension (an axis of the grid or an inner dimension of variables), or a single number.
struct coordinate {
    std::string name;       ///< the name of its dimension, or another
    std::string dimension;  ///< its name; empty: a single number
    /// Writes the values of [first, first + size) to `values`. Called again when a study goes on, with equal results;
    /// possibly in parts, so that a long axis is never in memory as a whole.
    std::function<void(std::int64_t first, std::span<double> values)> values;
    std::vector<attribute> attributes = {};  ///< what readers should know about it
};

/// A coordinate with the given values.
coordinate with_values(std::string name, std::string dimension, std::vector<double> values,
                       std::vector<attribute> attributes = {});

/// The contents of results.
struct layout {
    /// The grid, the last axis varying fastest. The product of the lengths is the number of instances. Zipped axes are
    /// one dimension with several coordinates.
    std::vector<dimension> axes;
    /// Instances of a chunk, the last one may have fewer. What a store had from the start when a study goes on.
    std::int64_t chunk = 0;
    std::vector<variable> variables;      ///< all arrays of results
    std::vector<coordinate> coordinates;  ///< all values along dimensions
    /// A JSON object, as text, of all that determines the contents (model, axes, options, method, type, seed, version),
    /// and nothing else (no devices, threads, chunks): a study goes on only where it is equal. Objects may be nested.
    std::string description = "{}";

    /// The product of the axes' lengths.
    std::int64_t instances() const;
    /// The number of chunks.
    std::int64_t chunks() const;
    /// The number of items of a variable.
    std::int64_t items(const variable& v) const;
    /// The variable's place in `variables`. Throws `error` that lists the names if there is none.
    std::size_t find(std::string_view variable) const;
    /// The bytes of all variables together, as a store has them without file headers.
    std::int64_t bytes() const;
    /// Throws `error` unless it is complete and consistent: names, lengths, no overflow, a chunk size, a description
    /// that is a JSON object.
    void check() const;
};

/// The instances of a chunk.
struct chunk_range {
    std::int64_t first = 0;
    std::int64_t count = 0;
};
/// Those of a chunk from 0 to layout::chunks() - 1.
chunk_range range_of(const layout& content, std::int64_t chunk);

/// Results that can be read and exported: a store, or what a small study has in memory.
class results {
public:
    virtual ~results() = default;
    /// What is in them.
    virtual const layout& content() const = 0;
    /// Whether a chunk's values are there.
    virtual bool done(std::int64_t chunk) const = 0;
    /// Whether a variable with along::nothing has been written.
    virtual bool written(std::string_view variable) const = 0;
    /// Copies items [first, first + count) of a variable, instances or chunks (0 and 1 for a variable with
    /// along::nothing); what is not done gets the fill value. Throws `error` for an item or a name that there is not,
    /// and if stored data is damaged.
    virtual void read(std::string_view variable, std::int64_t first, std::int64_t count, void* values) const = 0;
    /// Names of the devices that computed them; empty if not known.
    virtual std::vector<std::string> devices() const { return {}; }
};

/// "31 of 35 instances are not computed yet", or which final results are not; empty if all is there.
std::string missing_text(const results& from);

}  // namespace myriad::studies::inline MYRIAD_ABI
