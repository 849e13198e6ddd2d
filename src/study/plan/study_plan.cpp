// SPDX-License-Identifier: MIT
// From what a study was asked for to variables and their layout.
#include "myriad/study/plan/study_plan.hpp"

#include <algorithm>
#include <utility>

#include "description.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/report/status_names.hpp"
#include "myriad/study/plan/kinds.hpp"
#include "reduced_values.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

using enum component_kind;

std::string partial_name(const ensemble_reduction& r) { return r.definition().name + "_partial"; }

std::int64_t study_plan::bytes_per_instance() const {
    std::int64_t bytes = 0;
    for (const quantity& q : quantities) bytes += q.as.item_bytes();
    return bytes;
}

std::vector<bool> study_plan::needed_on_host() const {
    std::vector<bool> needed;
    for (const quantity& q : quantities) {
        bool reduced = false;
        for (std::size_t r = 0; r < reductions.size(); ++r) {
            if (reductions[r].on_device) continue;
            const auto& inputs = asked.reductions[r].definition().inputs;
            reduced = reduced || q.from == origin::status ||
                      std::find(inputs.begin(), inputs.end(), q.as.name) != inputs.end();
        }
        needed.push_back(q.stored || reduced);
    }
    return needed;
}
std::int64_t study_plan::bytes_needed_on_host() const {
    const std::vector<bool> needed = needed_on_host();
    std::int64_t bytes = 0;
    for (std::size_t q = 0; q < needed.size(); ++q)
        if (needed[q]) bytes += quantities[q].as.item_bytes();
    return bytes;
}

namespace {

/// "state x", or "state 3" without an enumerator.
std::string text_of(const component& c) {
    if (c.kind == t_begin) return "begin of the time domain";
    if (c.kind == t_end) return "end of the time domain";
    std::string kind(name_of(c.kind));
    std::replace(kind.begin(), kind.end(), '_', ' ');
    return message(kind, ' ', c.name.empty() ? std::to_string(c.number) : c.name);
}
std::string text_of_initial(const component& c) { return (c.kind == state ? "initial " : "") + text_of(c); }

/// What a variable is, for people, as CF asks.
std::string long_name(origin from, const component& what) {
    switch (from) {
        case origin::axis:
            return text_of_initial(what);
        case origin::record:
            return text_of(what) + " at the end of each recorded phase";
        case origin::record_time:
            return "time at the end of each recorded phase";
        case origin::sample:
            return text_of(what) + " at each sample";
        case origin::sample_time:
            return "time of each sample";
        case origin::stored_samples:
            return "number of samples";
        case origin::end:
            return "last value of " + text_of(what);
        case origin::end_time:
            return "time at which the last phase ended";
        case origin::status:
            return "how the integration ended";
        case origin::phases_done:
            return "number of phases done";
#define MYRIAD_WORDS_OF_COUNTER(name, array, words) \
    case origin::name:                              \
        return "number of " words;
            MYRIAD_COUNTERS(MYRIAD_WORDS_OF_COUNTER)
#undef MYRIAD_WORDS_OF_COUNTER
    }
    return "";
}

class planner {
public:
    explicit planner(study_plan& plan) : plan_(plan), asked_(plan.asked), names_(plan.asked.axes.names()) {}

    void make() {
        check_texts();
        check_inputs();
        add_axes();
        add_records();
        add_samples();
        for (const std::string& name : asked_.keep.end) add_end(name, true);
        add_work();
        add_status();
        for (const ensemble_reduction& r : asked_.reductions) add(r);
        for (const quantity& q : plan_.quantities)
            if (q.stored) plan_.content.variables.push_back(q.as);
        for (const variable& v : plan_.content.variables) {
            if (v.inner.empty() || v.inner[0].name != "phase") continue;
            add_numbers("phase", asked_.options.record.from_phase);
            break;
        }
    }

private:
    /// JSON has Unicode alone.
    void check_texts() const {
        const auto check = [](const std::string& what, const std::string& text) {
            require(is_utf8(text), what, " is no text in UTF-8", host::cure, "give it in that encoding");
        };
        check("the title", asked_.title);
        check("the generator's name", asked_.generator);
        for (const auto& [key, text] : asked_.notes) {
            check("the key of a note", key);
            check("the note " + key, text);
        }
        for (const auto& [component, text] : asked_.units) check("the unit of " + component, text);
        for (const ensemble_reduction& r : asked_.reductions) check("the name of a reduction", r.definition().name);
    }
    /// What every instance must have, unless a generator gives it.
    void check_inputs() const {
        require(asked_.options.samples.times_of_instances.empty(), host::named_option("samples.times_of_instances"),
                " has times for each instance of one call: a study has none, give times or "
                "evenly");
        require(asked_.options.time_limit == 0, host::named_option("time_limit"),
                " is given, but a study keeps what it has done and goes on where it was stopped", host::cure,
                "leave it out, stop the run when it is time, or bound the steps of an instance by max_steps");
        if (!asked_.generator.empty()) return;
        for (const component& c : names_.all()) {
            if (c.kind == accessory || is_integer(c.kind)) continue;
            const auto& entries = asked_.axes.entries();
            const bool is_set =
                std::any_of(entries.begin(), entries.end(), [&](const axes::entry& e) { return e.what == c; });
            require(is_set, host::named_component(c.full_name()), " has no value in any instance", host::cure,
                    "give it an axis, a value by ", host::named_option("set"), ", or a generator of instances");
        }
    }

    std::vector<attribute> unit_of(const std::string& component) const {
        const auto found = asked_.units.find(component);
        if (found == asked_.units.end()) return {};
        return {{"units", found->second}};
    }
    std::vector<attribute> unit_of(const component& c) const {
        return unit_of(c.kind == t_begin || c.kind == t_end ? "t" : c.full_name());
    }
    element type_of(const component& c) const { return is_integer(c.kind) ? element::i32 : asked_.real; }
    quantity& add(origin from, std::string name, element type, bool stored, std::vector<dimension> inner = {},
                  std::vector<attribute> attributes = {}, const component& what = {}) {
        for (const quantity& q : plan_.quantities)
            require(q.as.name != name, "two variables are called ", name, host::cure, "keep it once");
        attributes.insert(attributes.begin(), {"long_name", long_name(from, what)});
        plan_.quantities.push_back(
            {from, what, {std::move(name), type, std::move(inner), std::move(attributes)}, stored});
        return plan_.quantities.back();
    }

    void add_axes() {
        auto& content = plan_.content;
        for (const axes::dimension& d : asked_.axes.dimensions()) content.axes.push_back({d.name, d.length});
        for (const axes::entry& e : asked_.axes.entries()) {
            const std::string name = names_.initial_variable(e.what);
            if (e.values.random()) {
                add(origin::axis, name, type_of(e.what), asked_.keep.random, {}, unit_of(e.what), e.what).as.role =
                    role::coordinate;
                continue;
            }
            const std::string along = e.dimension ? content.axes[static_cast<std::size_t>(*e.dimension)].name : "";
            const auto write = [all = e.values](std::int64_t first, std::span<double> values) {
                for (std::size_t i = 0; i < values.size(); ++i) values[i] = all[first + static_cast<std::int64_t>(i)];
            };
            std::vector<attribute> attributes = unit_of(e.what);
            attributes.insert(attributes.begin(), {"long_name", text_of_initial(e.what)});
            content.coordinates.push_back({name, along, write, std::move(attributes)});
        }
    }
    /// A coordinate that counts.
    void add_numbers(const std::string& dimension, std::int64_t from) {
        const auto count = [from](std::int64_t first, std::span<double> values) {
            for (std::size_t i = 0; i < values.size(); ++i)
                values[i] = static_cast<double>(from + first + static_cast<std::int64_t>(i));
        };
        plan_.content.coordinates.push_back(
            {dimension, dimension, count, {{"long_name", "number of the " + dimension}}});
    }

    void add_records() {
        const record_options& o = asked_.options.record;
        if (o.empty()) return;
        const dimension phase{"phase", asked_.options.phases - o.from_phase};
        const auto add_all = [&](component_kind kind, const component_list& list) {
            for (const int number : list) {
                const component& c = names_.find(message(name_of(kind), '.', number), {kind});
                add(origin::record, names_.variable(c), type_of(c), asked_.keep.records, {phase}, unit_of(c), c);
            }
        };
#define MYRIAD_ADD_KIND(kind, plural, ...) add_all(kind, o.plural);
        MYRIAD_RECORDED_KINDS(MYRIAD_ADD_KIND)
#undef MYRIAD_ADD_KIND
        if (o.time) add(origin::record_time, "t", asked_.real, asked_.keep.records, {phase}, unit_of("t"));
    }
    void add_samples() {
        const sample_options& o = asked_.options.samples;
        if (o.empty()) return;
        const bool stored = asked_.keep.samples;
        const dimension sample{"sample", o.capacity};
        for (const int number : o.states) {
            const component& c = names_.find(message("state.", number), {state});
            add(origin::sample, names_.variable(c) + "_sample", asked_.real, stored, {sample}, unit_of(c), c);
        }
        add(origin::sample_time, "t_sample", asked_.real, stored, {sample}, unit_of("t"));
        add(origin::stored_samples, "stored_samples", element::i32, stored);
    }
    void add_end(const std::string& name, bool stored) {
        if (name == "t") {
            add(origin::end_time, "t_last", asked_.real, stored, {}, unit_of("t"));
            return;
        }
        const component& c = names_.find(name, instance_kinds);
        add(origin::end, names_.variable(c) + "_end", type_of(c), stored, {}, unit_of(c), c);
    }
    void add_work() {
        if (!asked_.keep.work) return;
        add(origin::phases_done, "phases_done", element::i32, true);
        if (asked_.options.counting == counting::off) return;
#define MYRIAD_ADD_COUNTER(name, ...) add(origin::name, #name, element::i64, true);
        MYRIAD_COUNTERS(MYRIAD_ADD_COUNTER)
#undef MYRIAD_ADD_COUNTER
    }
    void add_status() {
        std::vector<std::int64_t> values;
        std::string meanings;
        // Chunks with interrupted instances are not kept.
        constexpr int last = static_cast<int>(myriad::status::interrupted);
        static_assert(last == status_count - 1, "else the values listed would have a gap");
        for (int s = 0; s < last; ++s) {
            values.push_back(s);
            meanings += message(s == 0 ? "" : " ", myriad::name_of(static_cast<myriad::status>(s)));
        }
        add(origin::status, "status", element::u8, asked_.keep.status, {},
            {{"flag_values", values}, {"flag_meanings", meanings}});
    }

    /// The variable that a reduction reduces; an end value is computed if it is not kept.
    const variable& find(const std::string& name) {
        const auto known = [&]() -> const quantity* {
            for (const quantity& q : plan_.quantities)
                if (q.as.name == name) return &q;
            return nullptr;
        };
        if (known() == nullptr && name == "t_last") add_end("t", false);
        for (const component& c : names_.all()) {
            if (known() == nullptr && among(instance_kinds, c.kind) && name == names_.variable(c) + "_end")
                add_end(c.full_name(), false);
        }
        if (const quantity* const found = known()) return found->as;
        std::string all;
        for (const quantity& q : plan_.quantities) all += (all.empty() ? "" : ", ") + q.as.name;
        throw error(message("a reduction is asked for of \"", name, "\", which is not computed: there are ", all,
                            all.empty() ? "" : ", ", "and the last values of components, as ",
                            names_.variable(names_.all().front()), "_end"));
    }
    void add(const ensemble_reduction& r) {
        const studies::reduction_definition& d = r.definition();
        for (const std::string& name : d.inputs) find(name);  // which may add some
        std::vector<const variable*> inputs;
        for (const std::string& name : d.inputs) inputs.push_back(&find(name));
        reduction_plan made = d.plan(inputs);
        if (!d.over.empty()) made = reduced_over(d, made, asked_.axes.dimensions());
        auto& content = plan_.content;
        content.variables.push_back({.name = partial_name(r),
                                     .type = element::f64,
                                     .inner = {{d.name + "_part", made.partial_size}},
                                     .attributes = {},
                                     .extent = along::chunks});
        for (variable& v : made.results) {
            const bool has_unit = v.type != element::i64 && inputs.size() == 1;
            for (const attribute& a : has_unit ? inputs[0]->attributes : std::vector<attribute>{})
                if (a.name == "units") v.attributes.push_back(a);
            content.variables.push_back(v);
        }
        for (const coordinate& c : made.coordinates) {
            const bool known = std::any_of(content.coordinates.begin(), content.coordinates.end(),
                                           [&](const coordinate& other) { return other.name == c.name; });
            if (!known) content.coordinates.push_back(c);
        }
        plan_.reductions.push_back(std::move(made));
    }

    study_plan& plan_;
    const study_request& asked_;
    const component_names& names_;
};

}  // namespace

study_plan plan_study(const study_request& asked) {
    study_plan plan{asked, {}, {}, {}};
    planner(plan).make();
    plan.content.description = description_of(plan);
    return plan;
}

}  // namespace myriad::studies::inline MYRIAD_ABI
