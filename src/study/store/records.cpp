// SPDX-License-Identifier: MIT
// JSON of records.
#include "myriad/study/store/records.hpp"

#include <cstddef>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "json_numbers.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/study/store/sealed_text.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

std::string sealed_record(const char* kind, const group_checksum& group, const ordered_json& entries) {
    ordered_json all{{"kind", kind}, {"group", group}};
    all.update(entries);
    all[seal_key] = unsealed;
    return sealed(all.dump(1) + '\n');
}

// Calls read(entries) for a record that is whole and of this group; `what` begins its errors.
template <class Read>
auto read_record(const char* kind, std::string_view text, const group_checksum& group, const std::string& what,
                 Read&& read) {
    try {
        const ordered_json entries = ordered_json::parse(text);
        const seal its = seal_of(text);
        require(its.is_right(), what, " is damaged: its own checksum is ",
                its.computed.empty() ? "missing" : its.computed + " and should be " + its.stored);
        require(entries.at("kind") == kind, what, " is damaged: it is that of something else");
        require(entries.at("group") == group, what, " is that of another study");
        return read(entries);
    } catch (const nlohmann::json::parse_error&) {  // its text quotes the damaged bytes, which may be no characters
        host::refuse({what, " is damaged: it is no JSON"});
    } catch (const nlohmann::json::exception&) {
        host::refuse({what, " is damaged: an entry is missing, or of another kind"});
    } catch (const std::logic_error&) {
        host::refuse({what, " is damaged: a checksum is no number"});
    }
}

std::uint32_t checksum_in(const ordered_json& entry) {
    return static_cast<std::uint32_t>(std::stoul(entry.get<std::string>(), nullptr, 16));
}

ordered_json entries_of(const arithmetic& a) {
    return {{"instruction set", a.instruction_set}, {"compiler", a.compiler}, {"library", a.library}, {"host", a.host}};
}
arithmetic arithmetic_in(const ordered_json& entries) {
    return {entries.at("instruction set").get<std::string>(), entries.at("compiler").get<std::string>(),
            entries.at("library").get<std::string>(), entries.at("host").get<std::string>()};
}

}  // namespace

std::string record_json(const layout& content, const group_checksum& group, std::int64_t chunk,
                        const stored_chunk& stored) {
    ordered_json files = ordered_json::object(), statuses = ordered_json::object();
    std::size_t next = 0;
    for (const variable& v : content.variables)
        if (v.extent != along::nothing) files[v.name] = hexadecimal(stored.checksums.at(next++));
    for (const auto& [name, count] : stored.record.statuses) statuses[name] = count;
    return sealed_record("chunk", group,
                         {{"chunk", chunk},
                          {"instances", range_of(content, chunk).count},
                          {"device", stored.record.device},
                          {"arithmetic", entries_of(stored.record.computed_by)},
                          {"seconds", number(stored.record.seconds)},
                          {"statuses", statuses},
                          {"crc32c", files}});
}

stored_chunk record_of(std::string_view text, const layout& content, const group_checksum& group, std::int64_t chunk) {
    const std::string what = message("the record of chunk ", chunk);
    return read_record("chunk", text, group, what, [&](const ordered_json& read) {
        require(read.at("chunk") == chunk, what, " is that of another chunk");
        stored_chunk stored;
        stored.record.device = read.at("device").get<std::string>();
        stored.record.seconds = as_double(read.at("seconds"));
        if (read.contains("arithmetic")) stored.record.computed_by = arithmetic_in(read.at("arithmetic"));
        for (const auto& [name, count] : read.at("statuses").items())
            stored.record.statuses.emplace_back(name, count.template get<std::int64_t>());
        for (const variable& v : content.variables)
            if (v.extent != along::nothing) stored.checksums.push_back(checksum_in(read.at("crc32c").at(v.name)));
        return stored;
    });
}

std::string coordinates_json(const group_checksum& group, const coordinate_checksums& all) {
    ordered_json files = ordered_json::object();
    for (const auto& [name, checksums] : all) {
        files[name] = ordered_json::array();
        for (const std::uint32_t checksum : checksums) files[name].push_back(hexadecimal(checksum));
    }
    return sealed_record("coordinates", group, {{"crc32c", files}});
}

coordinate_checksums coordinates_of(std::string_view text, const group_checksum& group) {
    return read_record("coordinates", text, group, "the record of the coordinates", [&](const ordered_json& read) {
        coordinate_checksums all;
        for (const auto& [name, checksums] : read.at("crc32c").items())
            for (const ordered_json& checksum : checksums) all[name].push_back(checksum_in(checksum));
        return all;
    });
}

std::string result_json(const group_checksum& group, std::string_view variable, std::uint32_t checksum) {
    return sealed_record("result", group, {{"variable", variable}, {"crc32c", hexadecimal(checksum)}});
}

std::uint32_t result_of(std::string_view text, const group_checksum& group, std::string_view variable) {
    const std::string what = message("the record of ", variable);
    return read_record("result", text, group, what, [&](const ordered_json& read) {
        require(read.at("variable") == variable, what, " is that of another variable");
        return checksum_in(read.at("crc32c"));
    });
}

std::string model_json(const group_checksum& group, const model_behaviour& model) {
    ordered_json all = ordered_json::object();
    for (const auto& [name, places] : model.all()) {
        all[name] = ordered_json::array();
        for (const std::optional<double>& value : places) all[name].push_back(value ? number(*value) : ordered_json());
    }
    return sealed_record("model", group, {{"functions", all}});
}

model_behaviour model_of(std::string_view text, const group_checksum& group) {
    return read_record("model", text, group, "the record of the model", [](const ordered_json& read) {
        std::map<std::string, model_behaviour::values> all;
        for (const auto& [name, places] : read.at("functions").items())
            for (const ordered_json& value : places)
                all[name].push_back(value.is_null() ? std::nullopt : std::optional(as_double(value)));
        return model_behaviour(std::move(all));
    });
}

std::string arithmetic_json(const group_checksum& group, const arithmetic& a) {
    return sealed_record("arithmetic", group, {{"arithmetic", entries_of(a)}});
}

arithmetic arithmetic_of(std::string_view text, const group_checksum& group) {
    return read_record("arithmetic", text, group, "the record of the arithmetic",
                       [](const ordered_json& read) { return arithmetic_in(read.at("arithmetic")); });
}

}  // namespace myriad::studies::inline MYRIAD_ABI
