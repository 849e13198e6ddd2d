// SPDX-License-Identifier: MIT
// From a study to its run.
#include "myriad/study/study.hpp"

#include <algorithm>
#include <iostream>
#include <limits>
#include <thread>

#include "myriad/host/core/error.hpp"
#include "myriad/host/memory/memory_need.hpp"
#include "myriad/host/report/status_names.hpp"
#include "myriad/study/plan/kinds.hpp"
#include "myriad/study/run/chunk_solver.hpp"
#include "myriad/study/run/result_keeper.hpp"
#include "myriad/study/run/runner.hpp"
#include "myriad/study/run/stop_signals.hpp"
#include "myriad/study/store/metadata.hpp"

namespace myriad {

namespace {

using studies::element;

/// Which devices set and reduce instances themselves, so that little of a chunk is in the host's memory.
struct kinds_of_devices {
    bool alone = false, on_host = false;
};
kinds_of_devices kinds_of(const studies::any_model& model, const studies::study_plan& plan,
                          const std::vector<device>& devices) {
    kinds_of_devices found;
    for (const device& d : devices) (model.make_device_solver(plan, d) != nullptr ? found.alone : found.on_host) = true;
    return found;
}

/// Instances of a chunk, and of them those to be integrated in the host's memory at a time, as far as that goes.
struct chunk_sizes {
    std::int64_t chunk, piece;
};
chunk_sizes choose_sizes(const studies::any_model& model, const studies::study_plan& plan, bool in_memory,
                         const std::vector<device>& devices) {
    const std::int64_t n = plan.content.instances();
    // Two threads for each device; half of what the results leave stays free.
    double free = host::available_memory().bytes;
    if (in_memory) free -= static_cast<double>(plan.content.bytes());
    const double of_thread = std::max(free, 0.0) / 2 / (2 * static_cast<double>(devices.size()));
    constexpr double enough = 256e6;  // bytes: more instances make no device faster
    // Fewer would be slow on any device. If even they do not fit, the run finds out how many do.
    const std::int64_t fewest = std::min<std::int64_t>(n, 1024);
    const auto fitting = [&](double bytes, double bytes_each) {
        return std::clamp(static_cast<std::int64_t>(std::min(bytes / std::max(bytes_each, 8.0), 1e18)), fewest, n);
    };
    const auto [alone, on_host] = kinds_of(model, plan, devices);
    const auto values = static_cast<double>(plan.bytes_per_instance());
    const std::int64_t piece =
        fitting(std::min(of_thread, enough), model.bytes_per_instance(plan.asked.options) + values);
    std::int64_t most = piece;
    if (alone) {
        // A GPU alone decides how large chunks are: a CPU beside it, which is slower, does them in pieces.
        most = fitting(std::min(of_thread, enough), static_cast<double>(plan.bytes_needed_on_host()));
        if (on_host) most = std::min(most, fitting(of_thread, values));
    }
    // Enough instances to keep all lanes and threads busy, and as many chunks as let little be lost.
    const bool has_gpu =
        std::any_of(devices.begin(), devices.end(), [](const device& d) { return d.which() != device::kind::cpu; });
    const auto threads = static_cast<std::int64_t>(std::max(std::thread::hardware_concurrency(), 1u));
    const std::int64_t least = has_gpu ? std::int64_t{1} << 20 : 256 * threads;
    return {std::min(std::max((n + 31) / 32, least), most), piece};
}

/// Refuses chunks whose values alone do not fit: they are in memory as a whole, however few instances are integrated at
/// a time. So are the sums of reductions, one for each parameter set, of chunks under way; in memory of all chunks.
void check_memory(double bytes_per_instance, const studies::layout& content, const std::vector<device>& devices,
                  bool in_memory, const host::message_part& advice) {
    host::memory_need need;
    need.add("values", bytes_per_instance * static_cast<double>(content.chunk));
    const std::int64_t at_once = std::min(2 * static_cast<std::int64_t>(devices.size()), content.chunks());
    need.add("values of other chunks at the same time", need.bytes() * static_cast<double>(at_once - 1));
    double sums = 0;
    for (const studies::variable& v : content.variables)
        if (v.extent == studies::along::chunks) sums += static_cast<double>(v.item_bytes());
    need.check(message("chunks of ", content.chunk, " instances"), advice);
    need.add("sums of reductions", sums * static_cast<double>(in_memory ? content.chunks() : 2 * at_once));
    need.check(message("reductions in ", content.chunks(), " chunks"),
               statement_of("reduce over more axes, or make chunks larger"));
}

}  // namespace

std::ostream& operator<<(std::ostream& stream, const study_result& r) {
    const std::int64_t all = r.content().instances();
    std::string text = r.complete && r.instances == 0 ? message(all, " instances, all done before")
                       : r.complete && r.instances < all
                           ? message(r.instances, " of ", all, " instances, the others done before: ")
                           : message(r.instances, " of ", all, " instances: ");
    bool first = true;
    for (int s = 0; s < status_count; ++s) {
        const std::int64_t count = r.count(static_cast<status>(s));
        if (count == 0) continue;
        text += message(first ? "" : ", ", count, ' ', name_of(static_cast<status>(s)));
        first = false;
    }
    text += message(first && r.instances > 0 ? "" : "; ", r.seconds, " s",
                    r.complete ? "" : "; stopped before all were done", '\n');
    for (const statement& note : r.notes) text += message("note: ", note, '\n');
    for (const std::string& warning : r.warnings) text += message("warning: ", warning, '\n');
    return stream << text;
}

std::size_t study_result::size_of(std::string_view name, element type, std::int64_t first, std::int64_t count) const {
    const studies::variable& v = content().variables[content().find(name)];
    require(v.type == type, name, " has values of type ", studies::name_of(v.type), ", not ", studies::name_of(type));
    const std::int64_t items = content().items(v);
    require(first >= 0 && count >= 0 && first <= items && count <= items - first, count, " items of ", name,
            " from item ", first, " on are asked for: there are ", items);
    host::memory_need need;
    need.add("values", static_cast<double>(count) * static_cast<double>(v.item_bytes()));
    need.check(message("reading ", count, " items of ", name), "read fewer at a time");
    return static_cast<std::size_t>(count * v.values_per_item());
}

std::vector<double> study_result::values_of_coordinate(const studies::coordinate& c) const {
    const std::int64_t length = studies::shape_of(content(), c).items();
    host::memory_need need;
    need.add("values", static_cast<double>(length) * sizeof(double));
    need.check(message("reading all of ", c.name), "compute them by the function that made the axis");
    std::vector<double> all(static_cast<std::size_t>(length));
    c.values(0, all);
    return all;
}

std::vector<double> study_result::values(std::string_view name) const {
    for (const studies::coordinate& c : content().coordinates)
        if (c.name == name) return values_of_coordinate(c);
    const studies::variable& v = content().variables[content().find(name)];
    const std::int64_t items = content().items(v), inner = v.values_per_item();
    host::memory_need need;
    need.add("values", static_cast<double>(items) * static_cast<double>(inner) * sizeof(double));
    need.check(message("reading all of ", name), "read parts of it by values_of");
    std::vector<double> all(static_cast<std::size_t>(items * inner));
    if (v.type == element::f64) {
        results_->read(name, 0, items, all.data());
        return all;
    }
    const auto convert = [&]<class T>(T) {
        constexpr std::int64_t at_a_time = 65'536;
        std::vector<T> part;
        T unset{};
        studies::fill(v.type, &unset, 1);
        for (std::int64_t first = 0; first < items; first += at_a_time) {
            const std::int64_t count = std::min(at_a_time, items - first);
            part.resize(static_cast<std::size_t>(count * inner));
            results_->read(name, first, count, part.data());
            std::transform(part.begin(), part.end(), all.begin() + first * inner, [&](T value) {
                return value == unset ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(value);
            });
        }
    };
    studies::with_type(v.type, convert);
    return all;
}

any_study::any_study(std::shared_ptr<const studies::any_model> model)
    : warning([](const std::string& text) { std::cerr << text << '\n'; }), model_(std::move(model)),
      axes_(model_->names()) {}
any_study::~any_study() = default;

void any_study::time_domain(double t_begin, double t_end) {
    set("t_begin", t_begin);
    set("t_end", t_end);
}

void any_study::reduce(ensemble_reduction r) {
    for (const ensemble_reduction& there : reductions_)
        require(there.definition().name != r.definition().name, "the reduction ", r.definition().name,
                " is given twice");
    reductions_.push_back(std::move(r));
}

void any_study::unit(std::string_view component, std::string unit) {
    if (component == "t") {
        units_["t"] = std::move(unit);
        return;
    }
    units_[model_->names().find(component, studies::model_kinds).full_name()] = std::move(unit);
}

void any_study::store(std::string folder, const studies::store_options& how) {
    require(!folder.empty(), host::named_option("store", "the folder"), " of a study has no name");
    folder_ = std::move(folder);
    store_options_ = how;
}

studies::study_request any_study::request() const {
    require(!options.progress, "options.progress is for solve", host::cure, "set the study's own progress instead");
    require(chunk >= 0, host::named_option("chunk"), " is ", chunk, " (must be positive, or 0 for a choice by memory)");
    myriad::options how = options;
    how.invalid_instances = invalid_instances::mark;
    return {.method = model_->method(),
            .real = model_->real(),
            .axes = axes_,
            .options = std::move(how),
            .keep = keep,
            .reductions = reductions_,
            .generator = model_->generator(),
            .notes = notes_,
            .units = units_,
            .title = title_,
            .generates_itself = model_->generates_itself()};
}

/// What a run begins with.
struct any_study::planned_run {
    studies::run_settings settings;
    studies::study_plan plan;
    double host_bytes;  // of the values of an instance
};

any_study::planned_run any_study::plan() const {
    studies::run_settings settings{.devices = devices, .progress = progress, .warning = warning};
    require(!chunk_counter || !folder_.empty(),
            "a study that several processes run together needs a folder that they share", host::cure,
            "give it one by store");
    if (settings.devices.empty()) settings.devices.push_back(device::best());
    for (const device& d : settings.devices) model_->check(d, options);
    studies::study_plan made = studies::plan_study(request());
    const chunk_sizes sizes = choose_sizes(*model_, made, folder_.empty(), settings.devices);
    made.content.chunk = chunk > 0 ? std::min(chunk, size()) : sizes.chunk;
    settings.piece = sizes.piece;
    const auto bytes = static_cast<double>(
        kinds_of(*model_, made, settings.devices).on_host ? made.bytes_per_instance() : made.bytes_needed_on_host());
    check_memory(bytes, made.content, settings.devices, folder_.empty(),
                 statement_of(host::cures::smaller_chunk, ", or keep less"));
    return {std::move(settings), std::move(made), bytes};
}

std::unique_ptr<studies::result_keeper> any_study::open_store(const planned_run& planned) const {
    studies::store_options options = store_options_;
    for (const device& d : planned.settings.devices)
        if (d.which() == device::kind::cpu) options.computed_by = model_->arithmetic_on(d);
    options.model = model_->behaviour(planned.plan, planned.settings.devices);
    auto keeper = studies::keep_in_store(folder_, planned.plan.content, options, chunk_counter);
    check_memory(planned.host_bytes, keeper->content(), planned.settings.devices, false,
                 statement_of("use fewer devices, or ", host::cures::new_folder));
    return keeper;
}

study_result any_study::result_of(const studies::result_keeper& keeper, studies::run_outcome outcome) {
    study_result made(keeper.kept());
    made.complete = outcome.complete;
    made.instances = outcome.instances;
    made.seconds = outcome.seconds;
    made.by_status = outcome.by_status;
    made.notes = std::move(outcome.notes);
    made.warnings = std::move(outcome.warnings);
    return made;
}

void any_study::check() const {
    const planned_run planned = plan();
    if (!folder_.empty()) open_store(planned);
}

study_result any_study::run() {
    const struct stop_once {  // also if it is asked for before the run
        std::atomic<bool>& stopped;
        ~stop_once() { stopped = false; }
    } once{stopped_};
    planned_run planned = plan();
    auto& settings = planned.settings;
    const auto keeper = folder_.empty() ? studies::keep_in_memory(planned.plan.content) : open_store(planned);
    std::unique_ptr<studies::stop_signals> signals;
    if (stop_on_signals) signals = std::make_unique<studies::stop_signals>();
    settings.stops = [&] { return stopped_ || (signals != nullptr && signals->came()); };
    return result_of(*keeper, studies::run_study(*model_, planned.plan, *keeper, settings));
}

studies::handed_out_run any_study::hand_out() {
    planned_run planned = plan();
    auto keeper = folder_.empty() ? studies::keep_in_memory(planned.plan.content) : open_store(planned);
    return {std::move(planned.plan), std::move(keeper)};
}

std::optional<studies::computed_chunk> any_study::compute(std::int64_t number, std::int64_t chunk_size) {
    const struct stop_once {
        std::atomic<bool>& stopped;
        ~stop_once() { stopped = false; }
    } once{stopped_};
    auto [settings, plan, host_bytes] = this->plan();
    require(chunk_size > 0 && chunk_size <= size(), "chunks of ", chunk_size,
            " instances are asked for, of a study of ", size());
    plan.content.chunk = chunk_size;
    require(number >= 0 && number < plan.content.chunks(), "there is no chunk ", number, " in a study of ",
            plan.content.chunks());
    check_memory(host_bytes, plan.content, settings.devices, false,
                 statement_of("use fewer devices, or ", host::cures::smaller_chunk));
    studies::one_chunk_keeper keeper(plan.content, number);
    settings.stops = [&] { return stopped_ || keeper.done(); };
    studies::run_outcome outcome = studies::run_study(*model_, plan, keeper, settings);
    if (!keeper.done()) return {};
    keeper.values.notes = std::move(outcome.notes);
    return std::move(keeper.values);
}

study_result any_study::finish(studies::handed_out_run& run) {
    const studies::run_settings settings{.devices = {}, .stops = [] { return true; }};
    studies::run_outcome outcome = studies::run_study(*model_, run.plan(), run.keeper(), settings);
    outcome.instances = run.instances();
    outcome.by_status = run.how().by_status;
    outcome.notes = run.how().notes;
    return result_of(run.keeper(), std::move(outcome));
}

}  // namespace myriad
