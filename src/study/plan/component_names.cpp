// SPDX-License-Identifier: MIT
// Looks up components by name.
#include "myriad/study/plan/component_names.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <utility>

#include "myriad/host/backend/arrays.hpp"
#include "myriad/study/plan/kinds.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

std::string exact_text(double value) {
    char text[32];
    return {text, std::to_chars(text, std::end(text), value).ptr};
}

const char* name_of(component_kind kind) {
    switch (kind) {
#define MYRIAD_NAME_OF_KIND(kind, ...) \
    case component_kind::kind:         \
        return #kind;
        MYRIAD_VALUE_KINDS(MYRIAD_NAME_OF_KIND)
#undef MYRIAD_NAME_OF_KIND
        case component_kind::t_begin:
            return "t_begin";
        case component_kind::t_end:
            return "t_end";
    }
    return "";
}

namespace {

bool is_time(component_kind kind) { return kind == component_kind::t_begin || kind == component_kind::t_end; }

/// Names that results use for something else.
bool is_reserved(std::string_view name) {
    constexpr std::string_view reserved[] = {"instance", "phase",  "sample",         "bin",
                                             "draw",     "chunk",  "status",         "t",
                                             "t_sample", "t_last", "stored_samples", "phases_done"};
#define MYRIAD_QUOTED(name, ...) #name,
    constexpr std::string_view counters[] = {MYRIAD_COUNTERS(MYRIAD_QUOTED)};
#undef MYRIAD_QUOTED
    const auto is_among = [&](const auto& names) {
        return std::find(std::begin(names), std::end(names), name) != std::end(names);
    };
    return is_among(reserved) || is_among(counters);
}

}  // namespace

std::string component::full_name() const {
    if (is_time(kind)) return name_of(kind);
    return message(name_of(kind), '.', name.empty() ? std::to_string(number) : name);
}

component_names::component_names(std::string model, std::vector<component> all)
    : model_(std::move(model)), all_(std::move(all)) {
    for (const component_kind end : {component_kind::t_begin, component_kind::t_end})
        all_.push_back({end, 0, name_of(end)});
    for (const component& c : all_) ++uses_[c.name];
}

const component& component_names::find(std::string_view name, std::initializer_list<component_kind> kinds) const {
    std::vector<const component*> found;
    for (const component& c : all_) {
        const bool is_it = c.name == name || c.full_name() == name ||
                           (!is_time(c.kind) && name == message(name_of(c.kind), '.', c.number));
        if (is_it && !name.empty() && among(kinds, c.kind)) found.push_back(&c);
    }
    // A component of a model may be called t_end too.
    if (found.size() > 1 && is_time(found.back()->kind)) found = {found.back()};
    if (found.empty())
        throw unknown_component(message('"', name, "\" is no component of ", model_,
                                        " that can be given here: there are ", choices(kinds)));
    if (found.size() > 1) {
        std::string all;
        for (const component* c : found) all += message(all.empty() ? "" : " or ", c->full_name());
        throw error(statement_of('"', name, "\" names several components of ", model_, host::cure, "write ", all));
    }
    return *found[0];
}

bool component_names::is_taken(std::string_view name) const {
    const auto is_of_another = [&](std::string_view ending) {
        return name.ends_with(ending) && uses_.contains(name.substr(0, name.size() - ending.size()));
    };
    return is_reserved(name) || is_of_another("_start") || is_of_another("_end") || is_of_another("_sample");
}

std::string component_names::variable(const component& c) const {
    if (is_time(c.kind)) return name_of(c.kind);
    if (!c.name.empty() && !is_taken(c.name) && uses_.at(c.name) == 1) return c.name;
    std::string full = c.full_name();
    std::replace(full.begin(), full.end(), '.', '_');
    return full;
}

std::string component_names::initial_variable(const component& c) const {
    return variable(c) + (among(recorded_kinds, c.kind) ? "_start" : "");
}

std::string component_names::choices(std::initializer_list<component_kind> kinds) const {
    constexpr std::size_t most = 64;  // a shared matrix may have thousands
    std::string text;
    std::size_t named = 0;
    for (const component_kind kind : kinds) {
        std::string of_kind;
        for (const component& c : all_) {
            if (c.kind != kind || ++named > most) continue;
            of_kind += message(of_kind.empty() ? "" : ", ", c.name.empty() ? std::to_string(c.number) : c.name);
        }
        if (of_kind.empty()) continue;
        text +=
            message(text.empty() ? "" : "; ", is_time(kind) ? "" : name_of(kind), is_time(kind) ? "" : " ", of_kind);
    }
    return text + (named > most ? ", ..." : "");
}

}  // namespace myriad::studies::inline MYRIAD_ABI
