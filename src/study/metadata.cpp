// SPDX-License-Identifier: MIT
// JSON of groups, arrays and records.
#include "myriad/study/metadata.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <type_traits>

#include "myriad/host/core/error.hpp"
#include "myriad/study/json_value.hpp"
#include "myriad/version.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

using list = json_value::list;
using object = json_value::object;

constexpr std::int64_t coordinate_chunk = std::int64_t{1} << 20;  // 8 MB
constexpr int store_format = 1;

// JSON has no NaN and no infinity: as Zarr writes them.
json_value number(double value) {
    if (std::isnan(value)) return "NaN";
    if (std::isinf(value)) return value > 0 ? "Infinity" : "-Infinity";
    return value;
}

json_value fill_value(element type) {
    return with_type(type, [type]<class T>(T value) -> json_value {
        if constexpr (std::is_floating_point_v<T>) {
            return "NaN";
        } else {
            fill(type, &value, 1);
            return value;
        }
    });
}

json_value as_json(const std::vector<attribute>& attributes) {
    json_value all = object{};
    for (const attribute& a : attributes)
        all[a.name] = std::visit(
            [](const auto& value) -> json_value {
                using T = std::remove_cvref_t<decltype(value)>;
                if constexpr (std::is_same_v<T, double>) {
                    return number(value);
                } else if constexpr (std::is_same_v<T, std::vector<double>>) {
                    list values;
                    for (const double v : value) values.push_back(number(v));
                    return values;
                } else {
                    return value;
                }
            },
            a.value);
    return all;
}

// A number that may be written as text.
bool is_number(const json_value& value) {
    return value.is_number() || value == "NaN" || value == "Infinity" || value == "-Infinity";
}
double as_double(const json_value& value) {
    if (value.is_number()) return value.number();
    return value == "NaN" ? std::nan("") : value == "Infinity" ? HUGE_VAL : -HUGE_VAL;
}

std::vector<attribute> attributes_from(const json_value& all) {
    std::vector<attribute> attributes;
    for (const auto& [name, value] : all.members()) {
        const auto is_list_of = [&list = value](auto condition) {
            return list.is_list() && std::all_of(list.items().begin(), list.items().end(), condition);
        };
        if (value.is_integer()) {
            attributes.push_back({name, value.integer()});
        } else if (value.is_large()) {
            attributes.push_back({name, value.text_of()});
        } else if (is_number(value)) {
            attributes.push_back({name, as_double(value)});
        } else if (value.is_string()) {
            attributes.push_back({name, value.string()});
        } else if (is_list_of([](const json_value& v) { return v.is_integer(); })) {
            std::vector<std::int64_t> values;
            for (const json_value& v : value.items()) values.push_back(v.integer());
            attributes.push_back({name, values});
        } else if (is_list_of(is_number)) {
            std::vector<double> values;
            for (const json_value& v : value.items()) values.push_back(as_double(v));
            attributes.push_back({name, values});
        } else {
            attributes.push_back({name, value.text_of()});
        }
    }
    return attributes;
}

json_value as_json(const std::vector<dimension>& dimensions) {
    list all;
    for (const dimension& d : dimensions) all.push_back(list{d.name, d.length});
    return all;
}

std::vector<dimension> dimensions_from(const json_value& all) {
    std::vector<dimension> dimensions;
    for (const json_value& d : all.items()) dimensions.push_back({d.at(0).string(), d.at(1).integer()});
    return dimensions;
}

template <class E, std::size_t n>
E named(const json_value& name, const std::pair<E, const char*> (&names)[n]) {
    for (const auto& [value, known] : names)
        if (name == known) return value;
    host::refuse({"unknown entry ", name.text_of()});
}
template <class E, std::size_t n>
const char* name_in(E value, const std::pair<E, const char*> (&names)[n]) {
    for (const auto& [known, name] : names)
        if (known == value) return name;
    return "";
}
constexpr std::pair<along, const char*> extent_names[] = {
    {along::instances, "instances"}, {along::chunks, "chunks"}, {along::nothing, "nothing"}};
constexpr std::pair<role, const char*> role_names[] = {{role::data, "data"}, {role::coordinate, "coordinate"}};
constexpr std::pair<element, const char*> element_names[] = {{element::f64, "float64"},
                                                             {element::f32, "float32"},
                                                             {element::i64, "int64"},
                                                             {element::i32, "int32"},
                                                             {element::u8, "uint8"}};

// What Zarr calls a name with a configuration.
json_value configured(const char* name, const char* key, json_value value) {
    return object{{"name", name}, {"configuration", object{{key, std::move(value)}}}};
}

json_value array_metadata(const array_shape& shape, const std::vector<attribute>& attributes) {
    list lengths, parts, names;
    for (const dimension& d : shape.dimensions) {
        parts.push_back(lengths.empty() ? shape.chunk : d.length);
        lengths.push_back(d.length);
        names.push_back(d.name);
    }
    return object{{"zarr_format", 3},
                  {"node_type", "array"},
                  {"shape", lengths},
                  {"data_type", name_of(shape.type)},
                  {"chunk_grid", configured("regular", "chunk_shape", parts)},
                  {"chunk_key_encoding", configured("default", "separator", ".")},
                  {"fill_value", fill_value(shape.type)},
                  {"codecs", list{configured("bytes", "endian", "little"), object{{"name", "crc32c"}}}},
                  {"attributes", as_json(attributes)},
                  {"dimension_names", names}};
}

// Adds what differs to a list, by the path of keys.
void compare(const std::string& path, const json_value& stored, const json_value& here,
             std::vector<std::string>& found) {
    if (stored == here) return;
    if (stored.is_object() && here.is_object()) {
        const std::string prefix = path.empty() ? "" : path + '.';
        const json_value nothing;
        for (const auto& [key, value] : stored.members()) {
            const json_value* const other = here.find(key);
            compare(prefix + key, value, other != nullptr ? *other : nothing, found);
        }
        for (const auto& [key, value] : here.members())
            if (stored.find(key) == nullptr) compare(prefix + key, nothing, value, found);
        return;
    }
    const auto shown = [](const json_value& value) {
        std::string text = value.is_null() ? "nothing" : value.text_of();
        if (text.size() > 100) text = text.substr(0, 97) + "...";
        return text;
    };
    found.push_back(path + ": " + shown(stored) + " in the store, " + shown(here) + " here");
}

// What must agree of a layout, by name and not by place.
json_value comparable(const layout& content) {
    json_value axes = object{}, variables = object{}, coordinates = object{};
    for (const dimension& d : content.axes) axes[d.name] = d.length;
    for (const variable& v : content.variables)
        variables[v.name] = object{{"type", name_of(v.type)},
                                   {"inner", as_json(v.inner)},
                                   {"along", name_in(v.extent, extent_names)},
                                   {"role", name_in(v.role, role_names)}};
    for (const coordinate& c : content.coordinates) coordinates[c.name] = c.dimension;
    return object{{"description", json_value::parse(content.description)},
                  {"grid", axes},
                  {"order of the grid", content.axes.size() > 1 ? as_json(content.axes) : json_value()},
                  {"variables", variables},
                  {"coordinates", coordinates}};
}

// What Myriad has written for itself in the metadata of a group.
json_value own_part(std::string_view group, const std::string& path) {
    json_value read;
    try {
        read = json_value::parse(group);
    } catch (const json_error&) {
        host::refuse({path, " is no JSON, so it is damaged: restore it, or give another folder"});
    }
    const json_value* const attributes = read.is_object() ? read.find("attributes") : nullptr;
    const json_value* const own = attributes != nullptr ? attributes->find("myriad") : nullptr;
    require(own != nullptr, path, " is not from a study of Myriad: give another folder");
    return *own;
}

void flatten(const std::string& name, const json_value& value, json_value& flat) {
    if (value.is_object()) {
        for (const auto& [key, inner] : value.members()) flatten(name.empty() ? key : name + '.' + key, inner, flat);
    } else if (value.is_bool()) {
        flat[name] = value.boolean() ? "true" : "false";
    } else if (!value.is_null()) {
        flat[name] = value;
    }
}

}  // namespace

bool is_json_object(std::string_view text) {
    try {
        return json_value::parse(text).is_object();
    } catch (const json_error&) {
        return false;
    }
}

std::string hexadecimal(std::uint32_t value) {
    char text[9];
    std::snprintf(text, sizeof text, "%08x", value);
    return text;
}

std::int64_t array_shape::items() const { return dimensions.empty() ? 1 : dimensions.front().length; }

std::int64_t array_shape::item_bytes() const {
    auto bytes = static_cast<std::int64_t>(size_of(type));
    for (std::size_t d = 1; d < dimensions.size(); ++d) bytes *= dimensions[d].length;
    return bytes;
}

std::int64_t array_shape::file_bytes() const { return chunk * item_bytes() + 4; }

std::int64_t array_shape::files() const { return (items() - 1) / chunk + 1; }

std::string array_shape::file_name(std::int64_t file) const {
    std::string name = "c";
    for (std::size_t d = 0; d < dimensions.size(); ++d) name += '.' + std::to_string(d == 0 ? file : 0);
    return name;
}

array_shape shape_of(const layout& content, const variable& v) {
    array_shape shape{v.type, v.inner, 1};
    if (v.extent == along::instances) {
        shape.dimensions.insert(shape.dimensions.begin(), {"instance", content.instances()});
        shape.chunk = content.chunk;
    } else if (v.extent == along::chunks) {
        shape.dimensions.insert(shape.dimensions.begin(), {"chunk", content.chunks()});
    } else {
        shape.chunk = shape.items();
    }
    return shape;
}

array_shape shape_of(const layout& content, const coordinate& c) {
    array_shape shape{element::f64, {}, 1};
    if (c.dimension.empty()) return shape;
    const auto find = [&](const std::vector<dimension>& dimensions) {
        for (const dimension& d : dimensions)
            if (d.name == c.dimension && shape.dimensions.empty()) shape.dimensions.push_back(d);
    };
    find(content.axes);
    find({{"instance", content.instances()}, {"chunk", content.chunks()}});
    for (const variable& v : content.variables) find(v.inner);
    shape.chunk = std::min(shape.items(), coordinate_chunk);
    return shape;
}

std::string array_json(const array_shape& shape, const std::vector<attribute>& attributes) {
    return array_metadata(shape, attributes).text_of(1) + '\n';
}

std::string group_json(const layout& content) {
    json_value arrays = object{};
    list variables, coordinates;
    for (const coordinate& c : content.coordinates) {
        arrays[c.name] = array_metadata(shape_of(content, c), c.attributes);
        coordinates.push_back(
            object{{"name", c.name}, {"dimension", c.dimension}, {"attributes", as_json(c.attributes)}});
    }
    for (const variable& v : content.variables) {
        arrays[v.name] = array_metadata(shape_of(content, v), v.attributes);
        variables.push_back(object{{"name", v.name},
                                   {"type", name_of(v.type)},
                                   {"inner", as_json(v.inner)},
                                   {"along", name_in(v.extent, extent_names)},
                                   {"role", name_in(v.role, role_names)},
                                   {"attributes", as_json(v.attributes)}});
    }
    const json_value own = object{{"format", store_format},
                                  {"version", MYRIAD_VERSION},
                                  {"axes", as_json(content.axes)},
                                  {"chunk", content.chunk},
                                  {"variables", variables},
                                  {"coordinates", coordinates},
                                  {"description", json_value::parse(content.description)}};
    const json_value group =
        object{{"zarr_format", 3},
               {"node_type", "group"},
               {"attributes", object{{"myriad", own}}},
               {"consolidated_metadata", object{{"kind", "inline"}, {"must_understand", false}, {"metadata", arrays}}}};
    return group.text_of(1) + '\n';
}

layout layout_of(std::string_view group, const std::string& path) {
    layout content;
    try {
        const json_value own = own_part(group, path);
        require(own.at("format") == store_format, path, " has format ", own.at("format").text_of(),
                ", and this version of Myriad knows ", store_format, ": use the version that wrote it, ",
                own.at("version").text_of());
        content.axes = dimensions_from(own.at("axes"));
        content.chunk = own.at("chunk").integer();
        content.description = own.at("description").text_of();
        for (const json_value& v : own.at("variables").items())
            content.variables.push_back({v.at("name").string(), named(v.at("type"), element_names),
                                         dimensions_from(v.at("inner")), attributes_from(v.at("attributes")),
                                         named(v.at("along"), extent_names), named(v.at("role"), role_names)});
        for (const json_value& c : own.at("coordinates").items())
            content.coordinates.push_back({c.at("name").string(), c.at("dimension").string(),
                                           [](std::int64_t, std::span<double>) {},
                                           attributes_from(c.at("attributes"))});
        content.check();
    } catch (const json_error& failure) {
        host::refuse({path, " is damaged (", failure.what(), "): restore the file, or give another folder"});
    }
    return content;
}

std::vector<std::string> differences(const layout& stored, const layout& here) {
    const json_value a = comparable(stored), b = comparable(here);
    std::vector<std::string> found;
    compare("", a.at("description"), b.at("description"), found);
    for (const char* const part : {"grid", "order of the grid", "variables", "coordinates"}) {
        // The order matters only if the rest of the grid agrees.
        if (found.empty() || std::string_view(part) != "order of the grid")
            compare(part, a.at(part), b.at(part), found);
    }
    return found;
}

std::vector<attribute> attributes_of(std::string_view description) {
    json_value flat = object{};
    flatten("", json_value::parse(description), flat);
    return attributes_from(flat);
}

std::string record_json(const layout& content, std::int64_t chunk, const stored_chunk& stored) {
    json_value files = object{}, statuses = object{};
    std::size_t next = 0;
    for (const variable& v : content.variables)
        if (v.extent != along::nothing) files[v.name] = hexadecimal(stored.checksums.at(next++));
    for (const auto& [name, count] : stored.record.statuses) statuses[name] = count;
    const json_value all = object{{"chunk", chunk},
                                  {"instances", range_of(content, chunk).count},
                                  {"device", stored.record.device},
                                  {"seconds", number(stored.record.seconds)},
                                  {"statuses", statuses},
                                  {"crc32c", files}};
    return all.text_of(1) + '\n';
}

stored_chunk record_of(std::string_view text, const layout& content, std::int64_t chunk) {
    stored_chunk stored;
    try {
        const json_value read = json_value::parse(text);
        require(read.at("chunk") == chunk, "it is that of another chunk");
        stored.record.device = read.at("device").string();
        stored.record.seconds = as_double(read.at("seconds"));
        for (const auto& [name, count] : read.at("statuses").members())
            stored.record.statuses.emplace_back(name, count.integer());
        for (const variable& v : content.variables)
            if (v.extent != along::nothing)
                stored.checksums.push_back(
                    static_cast<std::uint32_t>(std::stoul(read.at("crc32c").at(v.name).string(), nullptr, 16)));
    } catch (const json_error& failure) {
        host::refuse({"the record of chunk ", chunk, " is damaged: ", failure.what()});
    } catch (const std::logic_error&) {
        host::refuse({"the record of chunk ", chunk, " is damaged: a checksum is no number"});
    }
    return stored;
}

}  // namespace myriad::studies::inline MYRIAD_ABI
