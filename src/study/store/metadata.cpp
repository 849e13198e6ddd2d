// SPDX-License-Identifier: MIT
// JSON of groups, arrays and records.
#include "myriad/study/store/metadata.hpp"

#include <algorithm>
#include <cstdio>
#include <type_traits>

#include "json_numbers.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/study/store/sealed_text.hpp"
#include "myriad/version.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

using json = ordered_json;

constexpr std::int64_t coordinate_chunk = std::int64_t{1} << 20;  // 8 MB
constexpr int store_format = 2;

json fill_value(element type) {
    return with_type(type, [type]<class T>(T value) -> json {
        if constexpr (std::is_floating_point_v<T>) {
            return "NaN";
        } else {
            fill(type, &value, 1);
            return value;
        }
    });
}

json as_json(const std::vector<attribute>& attributes) {
    json all = json::object();
    for (const attribute& a : attributes)
        all[a.name] = std::visit(
            [](const auto& value) -> json {
                using T = std::remove_cvref_t<decltype(value)>;
                if constexpr (std::is_same_v<T, double>) {
                    return number(value);
                } else if constexpr (std::is_same_v<T, std::vector<double>>) {
                    json values = json::array();
                    for (const double v : value) values.push_back(number(v));
                    return values;
                } else {
                    return value;
                }
            },
            a.value);
    return all;
}

std::vector<attribute> attributes_from(const json& all) {
    std::vector<attribute> attributes;
    for (const auto& [name, value] : all.items()) {
        const auto every = [&items = value](auto condition) {
            return std::all_of(items.begin(), items.end(), condition);
        };
        if (value.is_number_unsigned() && !std::in_range<std::int64_t>(value.get<std::uint64_t>())) {
            attributes.push_back({name, value.dump()});
        } else if (value.is_number_integer()) {
            attributes.push_back({name, value.get<std::int64_t>()});
        } else if (is_number(value)) {
            attributes.push_back({name, as_double(value)});
        } else if (value.is_string()) {
            attributes.push_back({name, value.get<std::string>()});
        } else if (value.is_array() && every([](const json& v) { return v.is_number_integer(); })) {
            attributes.push_back({name, value.get<std::vector<std::int64_t>>()});
        } else if (value.is_array() && every(is_number)) {
            std::vector<double> values;
            for (const json& v : value) values.push_back(as_double(v));
            attributes.push_back({name, values});
        } else {
            attributes.push_back({name, value.dump()});
        }
    }
    return attributes;
}

json as_json(const std::vector<dimension>& dimensions) {
    json all = json::array();
    for (const dimension& d : dimensions) all.push_back({d.name, d.length});
    return all;
}

std::vector<dimension> dimensions_from(const json& all) {
    std::vector<dimension> dimensions;
    for (const json& d : all) dimensions.push_back({d.at(0).get<std::string>(), d.at(1).get<std::int64_t>()});
    return dimensions;
}

template <class E, std::size_t n>
E named(const json& name, const std::pair<E, const char*> (&names)[n]) {
    for (const auto& [value, known] : names)
        if (name == known) return value;
    host::refuse({"unknown entry ", name.dump()});
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
element element_named(const json& name) {
    for (const element type : {element::f64, element::f32, element::i64, element::i32, element::u8})
        if (name == name_of(type)) return type;
    host::refuse({"unknown entry ", name.dump()});
}

json array_metadata(const array_shape& shape, const std::vector<attribute>& attributes) {
    json lengths = json::array(), parts = json::array(), names = json::array();
    for (const dimension& d : shape.dimensions) {
        parts.push_back(lengths.empty() ? shape.chunk : d.length);
        lengths.push_back(d.length);
        names.push_back(d.name);
    }
    return {{"zarr_format", 3},
            {"node_type", "array"},
            {"shape", lengths},
            {"data_type", name_of(shape.type)},
            {"chunk_grid", {{"name", "regular"}, {"configuration", {{"chunk_shape", parts}}}}},
            {"chunk_key_encoding", {{"name", "default"}, {"configuration", {{"separator", "."}}}}},
            {"fill_value", fill_value(shape.type)},
            {"codecs", {{{"name", "bytes"}, {"configuration", {{"endian", "little"}}}}, {{"name", "crc32c"}}}},
            {"attributes", as_json(attributes)},
            {"dimension_names", names}};
}

constexpr const char* restore_advice =
    "start the study again, which restores it from its copy myriad/group.json, or give another folder";

bool all_objects(const json& list) {
    return list.is_array() && std::all_of(list.begin(), list.end(), [](const json& v) { return v.is_object(); });
}

// Adds what differs to a list, by the path of keys. The order of keys is no difference.
void compare(const std::string& path, const json& stored, const json& here, std::vector<statement>& found) {
    if (stored == here) return;
    if (stored.is_object() && here.is_object()) {
        const std::string prefix = path.empty() ? "" : path + '.';
        for (const auto& [key, value] : stored.items())
            compare(prefix + key, value, here.contains(key) ? here.at(key) : json(), found);
        for (const auto& [key, value] : here.items())
            if (!stored.contains(key)) compare(prefix + key, json(), value, found);
        return;
    }
    if (all_objects(stored) && all_objects(here) && stored.size() == here.size()) {
        for (std::size_t i = 0; i < stored.size(); ++i)
            compare(path + '[' + std::to_string(i) + ']', stored[i], here[i], found);
        return;
    }
    const auto shown = [](const json& value) {
        std::string text = value.is_null() ? "nothing" : value.dump();
        if (text.size() > 100) text = text.substr(0, 97) + "...";
        return text;
    };
    found.push_back(
        statement_of(host::named_option(path), ": ", shown(stored), " in the store, ", shown(here), " here"));
}

// What must agree of a layout, by name and not by place.
json comparable(const layout& content) {
    json all = json::parse(content.description);
    json axes = json::object(), variables = json::object(), coordinates = json::object();
    for (const dimension& d : content.axes) axes[d.name] = d.length;
    for (const variable& v : content.variables)
        variables[v.name] = {{"type", name_of(v.type)},
                             {"inner", as_json(v.inner)},
                             {"along", name_in(v.extent, extent_names)},
                             {"role", name_in(v.role, role_names)}};
    for (const coordinate& c : content.coordinates) coordinates[c.name] = c.dimension;
    return {{"description", all},
            {"grid", axes},
            {"order of the grid", axes.size() > 1 ? as_json(content.axes) : json()},
            {"variables", variables},
            {"coordinates", coordinates}};
}

void flatten(const std::string& name, const json& value, json& flat) {
    if (value.is_object()) {
        for (const auto& [key, inner] : value.items()) flatten(name.empty() ? key : name + '.' + key, inner, flat);
    } else if (value.is_boolean()) {
        flat[name] = value.get<bool>() ? "true" : "false";
    } else if (!value.is_null()) {
        flat[name] = value;
    }
}

}  // namespace

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
    return array_metadata(shape, attributes).dump(1) + '\n';
}

namespace {

// As the given version of this library wrote it, without its checksum.
json unsealed_group(const layout& content, const std::string& version) {
    json arrays = json::object(), variables = json::array(), coordinates = json::array();
    for (const coordinate& c : content.coordinates) {
        arrays[c.name] = array_metadata(shape_of(content, c), c.attributes);
        coordinates.push_back({{"name", c.name}, {"dimension", c.dimension}, {"attributes", as_json(c.attributes)}});
    }
    for (const variable& v : content.variables) {
        arrays[v.name] = array_metadata(shape_of(content, v), v.attributes);
        variables.push_back({{"name", v.name},
                             {"type", name_of(v.type)},
                             {"inner", as_json(v.inner)},
                             {"along", name_in(v.extent, extent_names)},
                             {"role", name_in(v.role, role_names)},
                             {"attributes", as_json(v.attributes)}});
    }
    json own = {{"format", store_format},
                {"version", version},
                {"axes", as_json(content.axes)},
                {"chunk", content.chunk},
                {"variables", variables},
                {"coordinates", coordinates},
                {"description", json::parse(content.description)}};
    own[seal_key] = unsealed;
    // The checksum at the end, after all names that users give.
    return {{"zarr_format", 3},
            {"node_type", "group"},
            {"consolidated_metadata", {{"kind", "inline"}, {"must_understand", false}, {"metadata", arrays}}},
            {"attributes", {{"myriad", own}}}};
}

}  // namespace

std::string group_json(const layout& content) { return sealed(unsealed_group(content, MYRIAD_VERSION).dump(1) + '\n'); }

stored_group group_of(std::string_view text, const std::string& path) {
    const json read = json::parse(text, nullptr, false);
    require(!read.is_discarded(), path, " is no JSON, so it is damaged: ", restore_advice);
    require(read.is_object() && read.contains("attributes") && read.at("attributes").contains("myriad"), path,
            " is not from a study of Myriad", host::cure, "give another folder");
    stored_group group;
    layout& content = group.content;
    try {
        const json& own = read.at("attributes").at("myriad");
        require(own.at("format") == store_format, path, " has format ", own.at("format").dump(),
                ", and this version of Myriad knows ", store_format, host::cure, "use the version that wrote it, ",
                own.at("version").dump());
        const seal its = seal_of(text);
        require(its.is_right(), path, " is damaged (its checksum is ",
                its.stored.empty() ? "missing" : its.computed + " and should be " + its.stored, "): ", restore_advice);
        group.checksum = its.stored;
        content.axes = dimensions_from(own.at("axes"));
        content.chunk = own.at("chunk").get<std::int64_t>();
        content.description = own.at("description").dump();
        for (const json& v : own.at("variables"))
            content.variables.push_back({v.at("name").get<std::string>(), element_named(v.at("type")),
                                         dimensions_from(v.at("inner")), attributes_from(v.at("attributes")),
                                         named(v.at("along"), extent_names), named(v.at("role"), role_names)});
        for (const json& c : own.at("coordinates"))
            content.coordinates.push_back({c.at("name").get<std::string>(), c.at("dimension").get<std::string>(),
                                           [](std::int64_t, std::span<double>) {},
                                           attributes_from(c.at("attributes"))});
        content.check();
    } catch (const nlohmann::json::exception&) {
        host::refuse({path, " is damaged (an entry is missing, or of another kind): ", restore_advice});
    }
    return group;
}

std::string contents_json(const layout& content) {
    json axes = json::array(), arrays = json::object();
    for (const dimension& axis : content.axes) axes.push_back(axis.name);
    const auto add = [&](const auto& array, role its_role) {
        json names = json::array();
        for (const dimension& d : shape_of(content, array).dimensions) {
            if (d.name == "instance")
                names.insert(names.end(), axes.begin(), axes.end());
            else
                names.push_back(d.name);
        }
        arrays[array.name] = {
            {"dimensions", names}, {"role", name_in(its_role, role_names)}, {"attributes", as_json(array.attributes)}};
    };
    for (const coordinate& c : content.coordinates) add(c, role::coordinate);
    for (const variable& v : content.variables)
        if (v.extent != along::chunks) add(v, v.role);
    return json{{"axes", axes}, {"arrays", arrays}}.dump(1) + '\n';
}

bool same_json(std::string_view a, std::string_view b) {
    if (a.find('\0') != a.npos) return false;  // where the parser here ends, and others refuse the text
    const json read = json::parse(a, nullptr, false);
    return !read.is_discarded() && read == json::parse(b, nullptr, false);
}

std::vector<statement> differences(const layout& stored, const layout& here) {
    const json a = comparable(stored), b = comparable(here);
    std::vector<statement> found;
    compare("", a.at("description"), b.at("description"), found);
    for (const char* const part : {"grid", "order of the grid", "variables", "coordinates"}) {
        // The order matters only if the rest of the grid agrees.
        if (found.empty() || std::string_view(part) != "order of the grid")
            compare(part, a.at(part), b.at(part), found);
    }
    return found;
}

bool differ_in_notes_alone(const layout& stored, const layout& here) {
    const auto without_notes = [](layout content) {
        json all = json::parse(content.description);
        all.erase("notes");
        content.description = all.dump();
        return content;
    };
    return differences(without_notes(stored), without_notes(here)).empty();
}

std::vector<attribute> attributes_of(std::string_view description) {
    json flat = json::object();
    flatten("", json::parse(description), flat);
    return attributes_from(flat);
}

}  // namespace myriad::studies::inline MYRIAD_ABI
