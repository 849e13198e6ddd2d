// SPDX-License-Identifier: MIT
// Sizes and checks of layouts.
#include "myriad/study/plan/layout.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "description.hpp"
#include "myriad/host/core/error.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

// The product, or an error that names what is too large.
std::int64_t product(std::int64_t a, std::int64_t b, std::string_view of) {
    std::int64_t result = 0;
    require(!__builtin_mul_overflow(a, b, &result), of, " is more than 2^63", host::cure, "make it smaller");
    return result;
}

// A name is a file's, a node's in Zarr and a variable's in netCDF at once.
void check_name(std::string_view name, std::string_view what) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
    bool good = !name.empty() && name.size() <= 200 && letter(name.front()) && !name.starts_with("__");
    for (const char c : name) good = good && (letter(c) || (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+');
    require(good, "the ", what, " \"", name,
            "\" cannot be stored: a name begins with a letter and has letters, digits, '_', '.', '+' and '-' alone");
}

class dimension_lengths {
public:
    void add(const dimension& added, std::string_view where) {
        check_name(added.name, "dimension");
        require(added.length > 0, "dimension ", added.name, " of ", where, " has length ", added.length,
                " (must be positive)");
        const auto [known, is_new] = lengths_.emplace(added.name, added.length);
        require(is_new || known->second == added.length, "dimension ", added.name, " of ", where, " has length ",
                added.length, ", and ", known->second, " elsewhere", host::cure, "give one of them another name");
    }
    bool has(const std::string& name) const { return lengths_.contains(name); }

private:
    std::map<std::string, std::int64_t> lengths_;
};

}  // namespace

std::size_t size_of(element type) {
    return with_type(type, [](auto value) { return sizeof value; });
}

std::string_view name_of(element type) {
    constexpr std::string_view names[] = {"float64", "float32", "int64", "int32",
                                          "uint8"};  // in the order of `element`
    return names[static_cast<std::size_t>(type)];
}

void fill(element type, void* values, std::size_t count) {
    with_type(type, [=]<class T>(T) {
        using limits = std::numeric_limits<T>;
        const T unset = std::is_floating_point_v<T> ? limits::quiet_NaN()
                        : std::is_unsigned_v<T>     ? limits::max()
                                                    : static_cast<T>(limits::min() + static_cast<T>(sizeof(T) / 4));
        std::fill_n(static_cast<T*>(values), count, unset);
    });
}

std::int64_t variable::values_per_item() const {
    std::int64_t values = 1;
    for (const dimension& d : inner) values = product(values, d.length, "the size of " + name);
    return values;
}

std::int64_t variable::item_bytes() const {
    return product(values_per_item(), static_cast<std::int64_t>(studies::size_of(type)), "the size of " + name);
}

coordinate with_values(std::string name, std::string dimension, std::vector<double> values,
                       std::vector<attribute> attributes) {
    const auto shared = std::make_shared<const std::vector<double>>(std::move(values));
    return {std::move(name), std::move(dimension),
            [shared](std::int64_t first, std::span<double> part) {
                require(first + static_cast<std::int64_t>(part.size()) <= static_cast<std::int64_t>(shared->size()),
                        "a coordinate has ", shared->size(), " values, and its dimension is longer");
                std::copy_n(shared->begin() + first, part.size(), part.begin());
            },
            std::move(attributes)};
}

std::int64_t layout::instances() const {
    std::int64_t count = 1;
    for (const dimension& axis : axes) count = product(count, axis.length, "the number of instances");
    return count;
}

std::int64_t layout::chunks() const { return chunk > 0 ? (instances() - 1) / chunk + 1 : 0; }

std::size_t layout::find(std::string_view name) const {
    for (std::size_t i = 0; i < variables.size(); ++i)
        if (variables[i].name == name) return i;
    std::string names;
    for (const variable& v : variables) names += (names.empty() ? "" : ", ") + v.name;
    host::refuse({"there is no variable ", name, " in the results, only ", names.empty() ? "none" : names});
}

std::int64_t layout::items(const variable& v) const {
    return v.extent == along::instances ? instances() : v.extent == along::chunks ? chunks() : 1;
}

std::int64_t layout::bytes() const {
    std::int64_t sum = 0;
    for (const variable& v : variables) {
        const std::int64_t size = product(items(v), v.item_bytes(), "the size of " + v.name);
        require(!__builtin_add_overflow(sum, size, &sum), "the size of the results is more than 2^63 bytes");
    }
    return sum;
}

void layout::check() const {
    dimension_lengths lengths;
    std::set<std::string> axis_names;
    for (const dimension& axis : axes) {
        lengths.add(axis, "the grid");
        require(axis_names.insert(axis.name).second, "axis ", axis.name, " is given twice");
    }
    const std::int64_t n = instances();
    require(chunk > 0 && chunk <= n, "a chunk has ", chunk, " instances (must be between 1 and their number, ", n, ')');
    lengths.add({"instance", n}, "the instances");
    lengths.add({"chunk", chunks()}, "the chunks");
    require(!variables.empty(), "there is nothing to be kept", host::cure, "name a variable");
    std::set<std::string> names{"myriad", "instance", "chunk"};
    const auto add_name = [&](const std::string& name, std::string_view what) {
        check_name(name, what);
        require(names.insert(name).second, "the name ", name,
                " is taken: variables and coordinates have names of their own, and none is myriad, instance or chunk");
    };
    for (const variable& v : variables) {
        add_name(v.name, "variable");
        for (const dimension& d : v.inner) lengths.add(d, v.name);
    }
    bytes();
    for (const coordinate& c : coordinates) {
        add_name(c.name, "coordinate");
        require(static_cast<bool>(c.values), "coordinate ", c.name, " has no values");
        require(c.dimension.empty() || lengths.has(c.dimension), "coordinate ", c.name, " is along ", c.dimension,
                ", which is no dimension of the results");
    }
    // A variable and a dimension may share a name only if it is the dimension's coordinate, else files cannot hold
    // both.
    for (const variable& v : variables)
        require(!lengths.has(v.name), "variable ", v.name, " has the name of a dimension: rename one of them");
    for (const coordinate& c : coordinates)
        require(!lengths.has(c.name) || c.name == c.dimension, "coordinate ", c.name,
                " has the name of a dimension that it is not along: rename one of them");
    require(is_json_object(description), "the description of the study is no JSON object");
}

chunk_range range_of(const layout& content, std::int64_t chunk) {
    require(chunk >= 0 && chunk < content.chunks(), "there is no chunk ", chunk, ": they are 0 to ",
            content.chunks() - 1);
    const std::int64_t first = chunk * content.chunk;
    return {first, std::min(content.chunk, content.instances() - first)};
}

std::string missing_text(const results& from) {
    const layout& content = from.content();
    std::int64_t missing = 0;
    for (std::int64_t chunk = 0; chunk < content.chunks(); ++chunk)
        if (!from.done(chunk)) missing += range_of(content, chunk).count;
    if (missing > 0) return message(missing, " of ", content.instances(), " instances are not computed yet");
    std::string names;
    for (const variable& v : content.variables)
        if (v.extent == along::nothing && !from.written(v.name)) names += (names.empty() ? "" : ", ") + v.name;
    return names.empty() ? "" : message("the final results are not computed yet (", names, ')');
}

}  // namespace myriad::studies::inline MYRIAD_ABI
