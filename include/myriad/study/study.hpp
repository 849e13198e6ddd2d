// SPDX-License-Identifier: MIT
// The study that users see, but for its model: what its instances are, what is kept, on which devices it runs, where
// the results go. Host code only.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "myriad/host/backend/device.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/progress.hpp"
#include "myriad/host/report/status_names.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/core/status.hpp"
#include "myriad/study/plan/axes.hpp"
#include "myriad/study/plan/layout.hpp"
#include "myriad/study/plan/reduction.hpp"
#include "myriad/study/plan/study_plan.hpp"
#include "myriad/study/run/handed_out_run.hpp"
#include "myriad/study/store/store.hpp"

namespace myriad {

namespace studies::inline MYRIAD_ABI {
class any_model;
class result_keeper;
struct run_outcome;
struct run_settings;
}  // namespace studies::inline MYRIAD_ABI

/// The results of a study, in memory or in its store.
class study_result {
public:
    /// Made by `any_study::run`.
    explicit study_result(std::shared_ptr<const studies::results> results) : results_(std::move(results)) {}

    /// All values of a variable as doubles, the instance outermost. A chunk that was not computed has NaN. The
    /// last value for the grid is that of the last axis, then of the phase or sample. Of an axis, or another
    /// coordinate: its values. Throws `error` for an unknown name, and if there is not enough memory.
    std::vector<double> values(std::string_view variable) const;
    /// The values of instances [first, first + count) in the variable's own type. Throws `error` if it has another one.
    template <class T>
    std::vector<T> values_of(std::string_view variable, std::int64_t first, std::int64_t count) const {
        std::vector<T> read(size_of(variable, studies::element_of<T>, first, count));
        results_->read(variable, first, count, read.data());
        return read;
    }
    /// What is in the results: dimensions, variables, coordinates.
    const studies::layout& content() const { return results_->content(); }
    /// The results themselves, for exports.
    const studies::results& results() const { return *results_; }

    bool complete = false;       ///< whether all instances are done; not if the run was stopped
    std::int64_t instances = 0;  ///< that this run has finished
    double seconds = 0;          ///< that it took
    /// Instances of this run with each status.
    std::array<std::int64_t, status_count> by_status{};
    std::vector<statement> notes;       ///< of the reports of `solve`, each once
    std::vector<std::string> warnings;  ///< devices that failed, memory that was short

    /// Number of instances of this run with that status.
    std::int64_t count(status s) const { return by_status[static_cast<std::size_t>(s)]; }
    /// Instances of this run with a failure status.
    std::int64_t failed() const { return host::failed_in(by_status); }

private:
    std::size_t size_of(std::string_view variable, studies::element type, std::int64_t first, std::int64_t count) const;
    std::vector<double> values_of_coordinate(const studies::coordinate& c) const;

    std::shared_ptr<const studies::results> results_;
};

/// Prints how many instances ended in which way, the time, notes and warnings.
std::ostream& operator<<(std::ostream& stream, const study_result& r);

/// A parameter study of any model; see `study`. An instance's result depends on its own values and the options alone:
/// not on chunks, devices of one kind, their order, nor on how often the study was stopped and started again.
class any_study {
public:
    /// Made by `study`.
    explicit any_study(std::shared_ptr<const studies::any_model> model);
    any_study(const any_study&) = delete;
    any_study& operator=(const any_study&) = delete;
    ~any_study();

    // -- Instances ----------------------------------------------------------------------------------------------------
    // Components are named as in the model, "k", or where several have that name with their kind, "parameter.k";
    // without enumerators by number, "parameter.0". The ends of the time domain are "t_begin" and "t_end".

    /// An axis of the grid, the last one varying fastest, or a random value for each instance. Throws `error` as
    /// `axes::add`.
    void axis(std::string_view component, axis_values values) { axes_.add(component, std::move(values)); }
    /// Components that vary together, along one axis. Throws `error` as `axes::zip`.
    void zip(const std::vector<std::pair<std::string, axis_values>>& paired) { axes_.zip(paired); }
    /// `count` instances for each point of the other axes, as for random draws.
    void repeat(std::int64_t count, std::string_view name = "draw") { axes_.repeat(count, name); }
    /// A value for all instances.
    void set(std::string_view component, double value) { axes_.set(component, value); }
    /// The same time domain for all instances.
    void time_domain(double t_begin, double t_end);
    /// The seed of random values: see `axes::seed`.
    void seed(std::uint64_t seed) { axes_.seed(seed); }
    /// The number of instances.
    std::int64_t size() const { return axes_.size(); }

    // -- Integration and results --------------------------------------------------------------------------------------

    /// As for `solve`, but that instances whose inputs are not finite are always marked, and not refused, and that
    /// `progress` is the study's own.
    myriad::options options;
    kept_values keep;  ///< what is kept of every instance
    /// A reduction over all instances.
    void reduce(ensemble_reduction r);
    /// The unit of a component, or of time, "t": the attribute "units" of variables.
    void unit(std::string_view component, std::string unit);
    /// A title for exported files, which is part of the study's description.
    void title(std::string text) { title_ = std::move(text); }
    /// Something that tells this study from others, such as the version of the model: a store that was made with
    /// another value is refused.
    void note(std::string key, std::string value) { notes_[std::move(key)] = std::move(value); }
    /// Keeps the results in a folder, in which the study goes on if it is started again, instead of in memory. Several
    /// processes may run the study with one folder, and share the work. See `store`.
    void store(std::string folder, const studies::store_options& options = {});

    // -- The run ------------------------------------------------------------------------------------------------------

    std::vector<device> devices = {};  ///< all at the same time; none: `device::best()`
    std::int64_t chunk = 0;  ///< instances that are computed and stored together; 0: by memory and number. A store that
                             ///< exists keeps its own
    /// For processes that run the study together and share a counter, as over MPI: each call gives one of them the next
    /// number, from 0 on, or a negative one if the counter has failed. Chunks are claimed in that order, and looked for
    /// only when it is at its end. Needs a folder. Called by several threads.
    std::function<std::int64_t()> chunk_counter = {};
    bool stop_on_signals = false;  ///< SIGINT and SIGTERM end the run as `stop` does
    /// Called in the thread of `run` several times a second, the last time when it ends. An exception ends the run as
    /// `stop` does, and is rethrown. `progress_line()` shows a line.
    std::function<void(const work_progress&)> progress = {};
    /// Called in the thread of `run` for a device that failed or memory that was short; by default prints on standard
    /// error.
    std::function<void(const std::string&)> warning;

    /// What `run` does first. Throws `error` if something is wrong with the study. With a folder, makes it or looks at
    /// the one that is there: throws `error` if it holds another study or something else, and if the disk has too
    /// little free space.
    void check() const;
    /// Computes what is not there yet. Throws `error` if something is wrong with the study, if the store is of another
    /// one or fails, or if all devices fail; what is in the store stays there.
    study_result run();
    /// Begins a run whose chunks others compute: objects of the same study by `compute`, as in other processes. Uses
    /// `devices` for the size of chunks alone. Throws `error` as `run`.
    studies::handed_out_run hand_out();
    /// Computes one chunk of `chunk_size` instances, the last one possibly fewer, for the process that handed it out;
    /// what is handed back may be sent there as bytes. `progress` is called with the instances of the chunk that are
    /// done alone. Nothing if the run was stopped. Throws `error` as `run`.
    std::optional<studies::computed_chunk> compute(std::int64_t chunk, std::int64_t chunk_size);
    /// The results of a run that was handed out, when all chunks that were claimed are committed or released: with the
    /// reductions, if all are done. Throws `error` if the store fails.
    study_result finish(studies::handed_out_run& run);
    /// Ends the run when the chunks under way are done, for other threads and for callbacks: this one, or if there is
    /// none the next. A chunk that takes more than ten seconds longer is given up.
    void stop() { stopped_ = true; }

private:
    struct planned_run;

    studies::study_request request() const;
    planned_run plan() const;
    std::unique_ptr<studies::result_keeper> open_store(const planned_run& planned) const;
    static study_result result_of(const studies::result_keeper& kept, studies::run_outcome outcome);

    std::shared_ptr<const studies::any_model> model_;
    axes axes_;
    std::vector<ensemble_reduction> reductions_;
    std::map<std::string, std::string> notes_, units_;
    std::string title_, folder_;
    studies::store_options store_options_;
    std::atomic<bool> stopped_{false};
};

}  // namespace myriad
