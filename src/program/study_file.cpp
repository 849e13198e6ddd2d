// SPDX-License-Identifier: MIT
// From TOML to a study.
#include "program/study_file.hpp"

#include <algorithm>
#include <utility>

#include "myriad/host/backend/device.hpp"
#include "myriad/host/options/option_table.hpp"
#include "myriad/study/kinds.hpp"

namespace myriad::programs {

using studies::component;
using studies::component_kind;
using studies::component_names;
using studies::instance_kinds;
using studies::model_kinds;
using studies::recorded_kinds;
using studies::settable_kinds;
using enum studies::component_kind;

namespace {

constexpr std::string_view axis_choices =
    "must be an array of values, or one of {linspace = [first, last, number]}, {geomspace = [first, last, number]}, "
    "{values = [...]}, {uniform = [from, to]} and {normal = [mean, deviation]}";

/// The arguments of one of the functions that make axes.
std::vector<double> arguments_in(const toml_value& v, const std::string& key, std::size_t count, const char* form) {
    const auto* const array = v.as<toml_value::array>();
    if (array == nullptr || array->size() != count) throw wrong(v, key, message("must be ", form));
    return numbers_in(v, key);
}
axis_values spaced(const toml_value& v, const std::string& key,
                   axis_values (*make)(double first, double last, std::int64_t size)) {
    const std::vector<double> given = arguments_in(v, key, 3, "[first, last, number of values]");
    return make(given[0], given[1], integer_in((*v.as<toml_value::array>())[2], key));
}
axis_values drawn(const toml_value& v, const std::string& key, const char* form, axis_values (*make)(double, double)) {
    const std::vector<double> given = arguments_in(v, key, 2, form);
    return make(given[0], given[1]);
}

using axis_maker = axis_values (*)(const toml_value&, const std::string&);
constexpr std::pair<std::string_view, axis_maker> axis_makers[] = {
    {"linspace", [](const toml_value& v, const std::string& key) { return spaced(v, key, &linspace); }},
    {"geomspace", [](const toml_value& v, const std::string& key) { return spaced(v, key, &geomspace); }},
    {"values", [](const toml_value& v, const std::string& key) { return values(numbers_in(v, key)); }},
    {"uniform", [](const toml_value& v, const std::string& key) { return drawn(v, key, "[from, to]", &uniform); }},
    {"normal", [](const toml_value& v, const std::string& key) { return drawn(v, key, "[mean, deviation]", &normal); }},
};
const axis_maker* maker_of(std::string_view name) {
    for (const auto& [known, maker] : axis_makers)
        if (known == name) return &maker;
    return nullptr;
}

axis_values axis_in(const toml_value& v, const std::string& key) {
    const auto* const table = v.as<toml_value::table>();
    std::vector<axis_values> made;
    if (v.as<toml_value::array>() != nullptr) {
        placed(v, key, [&] { made.push_back(values(numbers_in(v, key))); });
    } else if (table != nullptr && table->size() == 1) {
        const toml_value::entry& e = table->front();
        const axis_maker* const make = maker_of(e.key);
        if (make == nullptr) {
            std::vector<std::string> names;
            for (const auto& [known, maker] : axis_makers) names.emplace_back(known);
            for (const auto& [old, name] :
                 {std::pair("logspace", "geomspace"), {"random_uniform", "uniform"}, {"random_normal", "normal"}})
                if (e.key == old) throw wrong(e.value, message(key, '.', e.key), message("is named ", name));
            throw wrong(e.value, message(key, '.', e.key), "no axis is made in this way" + suggestion(e.key, names));
        }
        placed(e.value, key, [&] { made.push_back((*make)(e.value, key)); });
    } else {
        throw wrong(v, key, axis_choices);
    }
    return made.front();
}

/// Whether `{name = ...}` are the components of a kind, and not the values of a component of that name.
bool is_kind(const toml_value::entry& e) {
    const auto* const table = e.value.as<toml_value::table>();
    if (table == nullptr ||
        std::any_of(table->begin(), table->end(), [](const auto& inner) { return maker_of(inner.key) != nullptr; }))
        return false;
    return std::any_of(model_kinds.begin(), model_kinds.end(), [&](component_kind k) { return name_of(k) == e.key; });
}

/// Calls a function for every component in a table, with its name and its key in messages. Components may be in tables
/// of their kind: `parameter.k` is a key of a table in TOML.
template <class Function>
void for_each_component(const toml_value& table, const std::string& path, Function&& function) {
    const section checked(table, path);  // that it is a table
    for (const toml_value::entry& e : *table.as<toml_value::table>()) {
        const std::string key = checked.full(e.key);
        if (!is_kind(e)) {
            function(e.key, e.value, key);
            continue;
        }
        for (const toml_value::entry& inner : *e.value.as<toml_value::table>())
            function(message(e.key, '.', inner.key), inner.value, message(key, '.', inner.key));
    }
}

std::vector<std::string> names_of(const component_names& all, std::initializer_list<component_kind> kinds) {
    std::vector<std::string> names;
    for (const component& c : all.all())
        if (!c.name.empty() && studies::among(kinds, c.kind)) names.push_back(c.name);
    return names;
}

/// Calls a function that looks for a component, and says which one may have been meant.
void with_component(const component_names& all, const std::string& name, const toml_value& v, const std::string& key,
                    std::initializer_list<component_kind> kinds, const std::function<void()>& function) {
    placed(v, key, [&] {
        try {
            function();
        } catch (const studies::unknown_component& e) {
            throw error(statement_of(e.said(), nearest_of(name, names_of(all, kinds))));
        }
    });
}

/// The numbers of components of one kind.
component_list components_in(const toml_value& v, const std::string& key, const component_names& all,
                             component_kind kind) {
    component_list list;
    for (const toml_value* const item : items_in(v)) {
        const std::string& name = text_in(*item, key);
        with_component(all, name, *item, key, {kind}, [&] { list.push_back(all.find(name, {kind}).number); });
    }
    return list;
}

}  // namespace

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

namespace {

/// The options of a study's file, by the table of options.
class option_reader {
public:
    explicit option_reader(const program_model& model) : model_(model) {}

    /// A table with the options of a struct.
    template <class Group>
    void read(const toml_value& table, const std::string& path, Group& to) const {
        section from(table, path);
        host::for_each_option<Group>([&](const auto& e) {
            using T = typename std::decay_t<decltype(e)>::value_type;
            T& value = to.*e.member;
            if constexpr (std::is_enum_v<T>) {
                from.read(e.name, value, host::choices(T{}));
            } else if constexpr (std::is_same_v<T, component_list>) {
                from.with(e.name, [&](const toml_value& v, const std::string& key) {
                    value = components_in(v, key, model_.names, kind_of(e.unit));
                });
            } else if constexpr (requires { from.read(e.name, value); }) {
                from.read(e.name, value);
            } else if constexpr (requires(const toml_value& v) { set(v, std::string(), value); }) {
                from.with(e.name, [&](const toml_value& v, const std::string& key) { set(v, key, value); });
            }  // else a function, which no file has
        });
        from.finish();
    }

private:
    static component_kind kind_of(std::string_view name) {
        return *std::find_if(recorded_kinds.begin(), recorded_kinds.end(),
                             [&](component_kind kind) { return name_of(kind) == name; });
    }

    void set(const toml_value& v, const std::string& key, std::vector<double>& to) const { to = numbers_in(v, key); }
    /// A number for all states, an array with one for each, or a table of states, where the others keep the default.
    void set(const toml_value& v, const std::string& path, per_component& to) const {
        if (v.as<toml_value::array>() != nullptr) {
            to = per_component(numbers_in(v, path));
            return;
        }
        const auto* const table = v.as<toml_value::table>();
        if (table == nullptr) {
            to = number_in(v, path);
            return;
        }
        std::vector<double> each;
        for (const component& c : model_.names.all())
            if (c.kind == state) each.push_back(to[0]);
        for (const toml_value::entry& e : *table) {
            const std::string name = message(path, '.', e.key);
            with_component(model_.names, e.key, e.value, name, {state}, [&] {
                each[static_cast<std::size_t>(model_.names.find(e.key, {state}).number)] = number_in(e.value, name);
            });
        }
        to = per_component(std::move(each));
    }
    /// A table for each event, in an array or under its name.
    void set(const toml_value& v, const std::string& path, std::vector<event_options>& to) const {
        const std::vector<std::string>& events = model_.events;
        to.assign(events.size(), event_options{});
        if (const auto* const array = v.as<toml_value::array>()) {
            if (array->size() != events.size())
                throw wrong(v, path,
                            message("has ", array->size(), " events, and the model has ", events.size(),
                                    ": give one table for each, or tables with their names"));
            for (std::size_t e = 0; e < array->size(); ++e) read((*array)[e], path, to[e]);
            return;
        }
        const section checked(v, path);
        for (const toml_value::entry& e : *v.as<toml_value::table>()) {
            const std::string key = checked.full(e.key);
            const auto found = std::find(events.begin(), events.end(), e.key);
            if (found == events.end())
                throw wrong(e.value, key, message("the model has no event \"", e.key, '"', suggestion(e.key, events)));
            read(e.value, key, to[static_cast<std::size_t>(found - events.begin())]);
        }
    }
    void set(const toml_value& v, const std::string& key, record_options& to) const { read(v, key, to); }
    void set(const toml_value& v, const std::string& key, sample_options& to) const {
        read(v, key, to);
        if (to.states.empty()) throw wrong(v, key, "names no states: write states = [...] with those that are sampled");
    }

    const program_model& model_;
};

}  // namespace

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
