// SPDX-License-Identifier: MIT
// From TOML to a study.
#include "program/study_file.hpp"

#include <algorithm>
#include <utility>

#include "myriad/host/backend/device.hpp"
#include "program/component_tables.hpp"
#include "program/option_reader.hpp"

namespace myriad::programs {

using studies::instance_kinds;
using studies::settable_kinds;

study_file::study_file(std::string path, std::string_view text)
    : path_(std::move(path)), document_(parse_toml(text, path_)), root_(document_, "") {
    read_model();
    read_store();
}

void study_file::read_model() {
    const text_place whole{path_, 0, 0};
    model_.model_place = model_.header_place = model_.method_place = whole;
    const auto read = [&](std::string_view key, std::string& to, text_place& place) {
        root_.with(key, [&](const toml_value& v, const std::string& name) {
            to = text_in(v, name);
            if (to.empty()) throw wrong(v, name, "is empty");
            place = v.place;
        });
    };
    read("model", model_.model, model_.model_place);
    read("header", model_.header, model_.header_place);
    read("method", model_.method, model_.method_place);
    root_.read("real", model_.real, {{"double", studies::element::f64}, {"float", studies::element::f32}});
    if (const toml_value* const o = root_.find("options"); o != nullptr && o->as<toml_value::table>() != nullptr)
        model_.samples = section(*o, "options").find("samples") != nullptr;
}

void study_file::read_store() {
    const toml_value* const v = root_.find("store");
    if (v == nullptr) return;
    if (v->as<toml_value::table>() == nullptr) {
        folder_ = text_in(*v, "store");
        return;
    }
    section from(*v, "store");
    from.read("folder", folder_);
    double expiry = 60;
    from.with("expiry", [&](const toml_value& value, const std::string& name) {
        expiry = number_in(value, name);
        if (!(expiry >= 1e-3 && expiry <= 1e9)) throw wrong(value, name, message("is ", expiry, ": give seconds"));
    });
    store_options_.expiry = std::chrono::milliseconds(static_cast<std::int64_t>(1000 * expiry));
    from.read("check", store_options_.check,
              {{"sizes", studies::resume_check::sizes}, {"checksums", studies::resume_check::checksums}});
    from.read("arithmetic", store_options_.others,
              {{"same", studies::other_arithmetic::refuse}, {"any", studies::other_arithmetic::warn}});
    from.finish();
}

void study_file::set_up(any_study& study, const program_model& model, const std::vector<device>& instead) {
    names_ = &model.names;
    events_ = model.events;
    read_axes(study);
    read_values(study);
    read_options(study, model);
    root_.with("keep", [&](const toml_value&, const std::string&) { read_kept(study.keep); });
    read_reductions(study);
    read_texts("units",
               [&](const std::string& component, std::string unit) { study.unit(component, std::move(unit)); });
    read_texts("notes", [&](const std::string& key, std::string text) { study.note(key, std::move(text)); });
    root_.with("title", [&](const toml_value& v, const std::string& name) { study.title(text_in(v, name)); });
    root_.with("seed", [&](const toml_value& v, const std::string& name) {
        const std::int64_t seed = integer_in(v, name);
        if (seed < 0) throw wrong(v, name, message("is ", seed, " (must not be negative)"));
        study.seed(static_cast<std::uint64_t>(seed));
    });
    root_.with("chunk", [&](const toml_value& v, const std::string& name) {
        study.chunk = integer_in(v, name);
        if (study.chunk < 0)
            throw wrong(v, name, message("is ", study.chunk, " (must be positive, or 0 for a choice)"));
    });
    root_.with("devices", [&](const toml_value& v, const std::string& key) {
        for (const toml_value* const item : items_in(v)) {
            const std::string& name = text_in(*item, key);
            if (instead.empty()) placed(*item, key, [&] { study.devices.push_back(device::parse(name)); });
        }
    });
    if (!instead.empty()) study.devices = instead;
    root_.finish();
}

// ---------------------------------------------------------------------------------------------------------------------
// Instances
// ---------------------------------------------------------------------------------------------------------------------

void study_file::read_axes(any_study& study) {
    root_.with("axes", [&](const toml_value& v, const std::string& path) {
        if (const auto* const array = v.as<toml_value::array>()) {  // one dimension each
            for (const toml_value& dimension : *array) read_dimension(study, dimension, path);
            return;
        }
        for_each_component(v, path, [&](const std::string& name, const toml_value& given, const std::string& key) {
            const axis_values all = axis_in(given, key);
            with_component(*names_, name, given, key, settable_kinds, [&] { study.axis(name, all); });
        });
    });
    root_.with("repeat", [&](const toml_value& v, const std::string& name) {
        placed(v, name, [&] { study.repeat(integer_in(v, name)); });
    });
}

void study_file::read_dimension(any_study& study, const toml_value& table, const std::string& path) {
    std::vector<std::pair<std::string, axis_values>> paired;
    std::vector<std::pair<const toml_value*, std::string>> places;
    for_each_component(table, path, [&](const std::string& name, const toml_value& given, const std::string& key) {
        paired.emplace_back(name, axis_in(given, key));
        places.emplace_back(&given, key);
    });
    if (paired.empty()) throw wrong(table, path, "this axis has no component: write k = {linspace = [0, 1, 11]}");
    if (paired.size() == 1) {
        const auto& [name, all] = paired[0];
        with_component(*names_, name, *places[0].first, places[0].second, settable_kinds,
                       [&] { study.axis(name, all); });
        return;
    }
    std::vector<std::string> full_names;
    for (std::size_t i = 0; i < paired.size(); ++i) {
        const std::string& name = paired[i].first;
        with_component(*names_, name, *places[i].first, places[i].second, settable_kinds,
                       [&] { full_names.push_back(names_->find(name, settable_kinds).full_name()); });
    }
    try {
        study.zip(paired);
    } catch (const error& e) {
        const statement_part* const subject = e.said().subject();
        const auto found = std::find(full_names.begin(), full_names.end(), subject != nullptr ? subject->key : "");
        const std::size_t i = found != full_names.end() ? static_cast<std::size_t>(found - full_names.begin()) : 0;
        throw wrong(*places[i].first, places[i].second, in_words_of_files(e.said()));
    }
}

void study_file::read_values(any_study& study) {
    root_.with("set", [&](const toml_value& v, const std::string& path) {
        for_each_component(v, path, [&](const std::string& name, const toml_value& given, const std::string& key) {
            const double value = number_in(given, key);
            with_component(*names_, name, given, key, settable_kinds, [&] { study.set(name, value); });
        });
    });
    root_.with("time_domain", [&](const toml_value& v, const std::string& key) {
        const std::vector<double> ends = arguments_in(v, key, 2, "[t_begin, t_end]");
        placed(v, key, [&] { study.time_domain(ends[0], ends[1]); });
    });
}

// ---------------------------------------------------------------------------------------------------------------------
// Options
// ---------------------------------------------------------------------------------------------------------------------

void study_file::read_options(any_study& study, const program_model& model) {
    root_.with("options", [&](const toml_value& v, const std::string& path) {
        option_reader(model).read(v, path, study.options);
    });
}

// ---------------------------------------------------------------------------------------------------------------------
// What is kept
// ---------------------------------------------------------------------------------------------------------------------

void study_file::read_kept(kept_values& keep) {
    const toml_value& v = *root_.find("keep");
    section from(v, "keep");
    from.with("end", [&](const toml_value& list, const std::string& key) {
        keep.end = texts_in(list, key);
        for (const toml_value* const item : items_in(list)) {
            const std::string& name = text_in(*item, key);
            if (name != "t")
                with_component(*names_, name, *item, key, instance_kinds,
                               [&] { static_cast<void>(names_->find(name, instance_kinds)); });
        }
    });
    from.read("records", keep.records);
    from.read("samples", keep.samples);
    from.read("random", keep.random);
    from.read("status", keep.status);
    from.read("work", keep.work);
    from.finish();
}

void study_file::read_reductions(any_study& study) {
    root_.with("reduce", [&](const toml_value& v, const std::string& path) {
        for (const toml_value* const item : items_in(v)) {
            section from(*item, path);
            bool has_any = false;
            std::string known;
            const toml_value* const edges = from.find("edges");
            const toml_value* const quantiles = from.find("quantiles");
            using with_edges = std::function<ensemble_reduction(const std::string&, const axis_values&)>;
            const auto by_histogram = [&](const char* key, const with_edges& make) {
                known += message(known.empty() ? "" : ", ", key);
                from.with(key, [&](const toml_value& names, const std::string& full_key) {
                    if (edges == nullptr)
                        throw wrong(names, full_key,
                                    "a histogram needs edges: write edges = {linspace = [-1, 1, 101]}");
                    has_any = true;
                    const axis_values all = axis_in(*edges, from.full("edges"));
                    for (const std::string& name : texts_in(names, full_key))
                        placed(*edges, from.full("edges"), [&] { study.reduce(make(name, all)); });
                });
            };
            by_histogram("histogram_of", histogram_of);
            by_histogram("histograms_of", histograms_of);
            bool has_quantiles = false;
            by_histogram("quantiles_of", [&](const std::string& name, const axis_values& all) {
                if (quantiles == nullptr)
                    throw wrong(*item, from.full("quantiles_of"),
                                "needs quantiles: write quantiles = [0.05, 0.5, 0.95]");
                has_quantiles = true;
                return quantiles_of(name, numbers_in(*quantiles, from.full("quantiles")), all);
            });
            if (edges != nullptr && !has_any)
                throw wrong(*edges, from.full("edges"), "are for histogram_of, histograms_of and quantiles_of alone");
            if (quantiles != nullptr && !has_quantiles)
                throw wrong(*quantiles, from.full("quantiles"), "are for quantiles_of alone");
            for (const auto& [key, make] : studies::named_reductions) {
                known += message(", ", key);
                from.with(key, [&, reduction = make](const toml_value& names, const std::string& full_key) {
                    has_any = true;
                    for (const std::string& name : texts_in(names, full_key))
                        placed(names, full_key, [&] { study.reduce(reduction(name)); });
                });
            }
            from.finish();
            if (!has_any) throw wrong(*item, path, message("has none of ", known, ": give one"));
        }
    });
}

void study_file::read_texts(std::string_view key, const std::function<void(const std::string&, std::string)>& set) {
    root_.with(key, [&](const toml_value& v, const std::string& path) {
        for_each_component(v, path, [&](const std::string& name, const toml_value& text, const std::string& full_key) {
            placed(text, full_key, [&] { set(name, text_in(text, full_key)); });
        });
    });
}

// ---------------------------------------------------------------------------------------------------------------------
// Places of errors
// ---------------------------------------------------------------------------------------------------------------------

namespace {

/// The entry of a table; null if there is none, or if the value is no table.
const toml_value* entry_of(const toml_value& v, std::string_view key) {
    const auto* const table = v.as<toml_value::table>();
    if (table == nullptr) return nullptr;
    for (const toml_value::entry& e : *table)
        if (e.key == key) return &e.value;
    return nullptr;
}

/// As far as the words of "options.record.states" are keys, each of a table in the last one: the last of them.
const toml_value* follow(const toml_value& from, std::string_view path) {
    const toml_value* found = nullptr;
    for (const toml_value* at = &from; at != nullptr && !path.empty();) {
        const std::size_t end = std::min(path.find('.'), path.size());
        at = entry_of(*at, path.substr(0, end));
        if (at != nullptr) found = at;
        path.remove_prefix(std::min(end + 1, path.size()));
    }
    return found;
}

}  // namespace

input_error study_file::placed_error(const error& found) const {
    // The first option that the message names and the file gives.
    const toml_value* key = nullptr;
    for (const statement_part& p : found.said().parts) {
        if (p.kind != part_kind::option || key != nullptr) continue;
        for (const std::string_view table : {"options", "keep", ""}) {
            const toml_value* const from = table.empty() ? &document_ : entry_of(document_, table);
            if (key == nullptr && from != nullptr) key = follow(*from, p.key);
        }
    }
    return input_error(position(key != nullptr ? key->place : text_place{path_, 0, 0}) + told(found));
}

}  // namespace myriad::programs
