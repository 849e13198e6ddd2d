// SPDX-License-Identifier: MIT
// The library's studies, of models that are known only at run time: a model out of a shared object or a tape behind the
// interface that studies have for models, and the classes that the Python side calls.
#include "study.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include "myriad/host/backend/device.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/study/export/export.hpp"
#include "myriad/study/plan/axes.hpp"
#include "myriad/study/plan/reduction.hpp"
#include "myriad/study/store/store.hpp"
#include "myriad/study/study.hpp"
#include "opened_results.hpp"
#include "run.hpp"
#include "statement_caster.hpp"
#include "studied.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace myriad::python {
namespace {

using studies::element;

/// Those that a study sets and keeps: tables have values already.
std::vector<studies::component> components_of(const model_of_study& model) {
    std::vector<studies::component> all;
    const auto add = [&](component_kind kind, const std::vector<std::string>& names, std::size_t but) {
        for (std::size_t c = 0; c + but < names.size(); ++c) all.push_back({kind, static_cast<int>(c), names[c]});
    };
#define MYRIAD_ADD_NAMES(kind, plural, ...)       \
    add(component_kind::kind, model.names.plural, \
        component_kind::kind == component_kind::shared ? model.tables.size() : 0);
    MYRIAD_INSTANCE_KINDS(MYRIAD_ADD_NAMES)
    MYRIAD_SHARED_KINDS(MYRIAD_ADD_NAMES)
#undef MYRIAD_ADD_NAMES
    return all;
}

/// What results call components and outputs, by their names in Python, where no two have the same.
std::map<std::string, std::string> result_names(const names_of_kinds& names, const std::vector<std::string>& outputs) {
    const studies::component_names all("", components_of({names_from(names), {}, {}}));
    std::map<std::string, std::string> called;
    for (const studies::component& c : all.all())
        if (c.kind != component_kind::t_begin && c.kind != component_kind::t_end) called[c.name] = all.variable(c);
    for (const std::string& output : outputs) called[output] = all.is_taken(output) ? "output_" + output : output;
    return called;
}

/// A model whose real type is known only at run time: for studies, and what kernels are added to.
struct made_model {
    std::shared_ptr<const studies::any_model> studied;
    std::shared_ptr<study_model> kernels;
};
made_model model_from(model_of_study model, element real, std::string name, std::string method) {
    studies::component_names names(std::move(name), components_of(model));
    const auto make = [&]<class R>(R) -> made_model {
        const auto made = std::make_shared<study_model_of<R>>(std::move(model), std::move(names), std::move(method));
        return {made, made};
    };
    return real == element::f64 ? make(double{}) : make(float{});
}

/// Calls Python's progress function and looks for signals; an exception ends the run and is kept.
class study_watcher {
public:
    study_watcher(any_study& study, nb::handle function) : study_(study), function_(function) {}

    void operator()(const work_progress& now) {
        const nb::gil_scoped_acquire locked;
        try {
            if (PyErr_CheckSignals() != 0) throw nb::python_error();
            if (function_.is_none() || failure) return;
            nb::dict statuses;
            for (int s = 0; s < status_count; ++s)
                if (const std::int64_t count = now.by_status[static_cast<std::size_t>(s)]; count > 0)
                    statuses[studies_name(s).c_str()] = count;
            function_(now.done, now.total, now.earlier, now.seconds, statuses);
        } catch (nb::python_error& raised) {
            if (!failure) failure = nb::borrow(raised.value());
            study_.stop();
        }
    }

    nb::object failure;

private:
    static std::string studies_name(int s) { return std::string(name_of(static_cast<status>(s))); }
    any_study& study_;
    nb::handle function_;
};

/// A function of Python that C++ may copy and destroy in any thread.
std::shared_ptr<nb::object> shared_function(const nb::object& function) {
    return {new nb::object(function), [](nb::object* p) {
                const nb::gil_scoped_acquire locked;
                delete p;
            }};
}
ensemble_reduction sum_by_python(const std::string& name, const std::vector<std::string>& inputs, std::int64_t size,
                                 const nb::object& function) {
    return sum_of(
        name, inputs, size,
        [name, inputs, call = shared_function(function)](const chunk_columns& chunk, std::span<double> sums) {
            const nb::gil_scoped_acquire locked;
            nb::dict given;
            const auto give = [&](const std::string& input) {
                const auto& column = chunk.find(input);
                given[input.c_str()] = studies::with_type(column.what->type, [&]<class T>(T) {
                    const auto values = chunk.values<T>(input);
                    return array_of(std::vector<T>(values.begin(), values.end()),
                                    shape_of(*column.what, static_cast<std::size_t>(chunk.size())));
                });
            };
            for (const std::string& input : inputs) give(input);
            give("status");
            const nb::object made = (*call)(given);
            const auto numpy = nb::module_::import_("numpy");
            const auto values = nb::cast<std::vector<double>>(
                numpy.attr("atleast_1d")(numpy.attr("asarray")(made, "dtype"_a = "float64")).attr("tolist")());
            require(values.size() == sums.size(), "the function of the sum ", name, " gives ", values.size(),
                    " numbers, and ", sums.size(), " are expected", host::cure, "change its size");
            for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += values[i];
        });
}

nb::object or_none(const nb::object& o) { return o.is_valid() ? o : nb::none(); }

/// A study from Python.
struct python_study {
    explicit python_study(const made_model& of) : kernels(of.kernels), study(of.studied) {}
    std::shared_ptr<study_model> kernels;
    any_study study;

    void set_run(const std::vector<std::string>& devices, std::int64_t chunk) {
        study.devices.clear();
        for (const std::string& name : devices) study.devices.push_back(device::parse(name));
        study.chunk = chunk;
        // On a CPU the numbers of steps, of which nothing is kept, are for the note about stiffness.
        const bool on_cpu = std::any_of(study.devices.begin(), study.devices.end(),
                                        [](const device& d) { return d.which() == device::kind::cpu; });
        const bool counts = study.keep.work || (on_cpu && study.options.advice == advice::on);
        study.options.counting = counts ? counting::on : counting::off;
        study.warning = [](const std::string&) {};  // the result has them
    }
    void set_store(const std::string& folder, double expiry, bool checksums, bool any_arithmetic) {
        if (folder.empty()) return;
        studies::store_options how;
        how.expiry = std::chrono::milliseconds(std::llround(expiry * 1000));
        how.check = checksums ? studies::resume_check::checksums : studies::resume_check::sizes;
        how.others = any_arithmetic ? studies::other_arithmetic::warn : studies::other_arithmetic::refuse;
        study.store(folder, how);
    }
    static nb::object result_of(study_result made) {
        nb::dict statuses;
        for (int s = 0; s < status_count; ++s)
            if (made.count(static_cast<status>(s)) > 0)
                statuses[std::string(name_of(static_cast<status>(s))).c_str()] = made.count(static_cast<status>(s));
        const std::shared_ptr<const studies::results> all(std::make_shared<study_result>(made), &made.results());
        nb::dict facts;
        facts["complete"] = made.complete;
        facts["instances"] = made.instances;
        facts["seconds"] = made.seconds;
        facts["by_status"] = statuses;
        facts["notes"] = made.notes;
        facts["warnings"] = made.warnings;
        return nb::make_tuple(opened_results{all}, facts);
    }
    nb::object run(nb::handle progress) {
        study_watcher watch(study, progress);
        study.progress = [&watch](const work_progress& now) { watch(now); };
        std::optional<study_result> made;
        {
            const nb::gil_scoped_release unlocked;
            made = study.run();
        }
        return nb::make_tuple(result_of(std::move(*made)), or_none(watch.failure));
    }
    nb::object compute(std::int64_t chunk, std::int64_t chunk_size) {
        study_watcher watch(study, nb::none());
        study.progress = [&watch](const work_progress& now) { watch(now); };
        std::optional<studies::computed_chunk> made;
        {
            const nb::gil_scoped_release unlocked;
            made = study.compute(chunk, chunk_size);
        }
        if (watch.failure) {
            PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(watch.failure.ptr())), watch.failure.ptr());
            throw nb::python_error();
        }
        require(made.has_value(), "chunk ", chunk, " was stopped");
        nb::list columns;
        for (const auto& [name, bytes] : made->columns)
            columns.append(nb::make_tuple(name, nb::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size())));
        const studies::arithmetic& by = made->record.computed_by;
        return nb::make_tuple(columns, made->record.device, made->record.seconds, made->record.statuses, made->notes,
                              nb::make_tuple(by.instruction_set, by.compiler, by.library, by.host));
    }
};

using sent_chunk = std::tuple<std::vector<std::pair<std::string, nb::bytes>>, std::string, double,
                              std::vector<std::pair<std::string, std::int64_t>>, std::vector<statement>,
                              std::tuple<std::string, std::string, std::string, std::string>>;

void commit(studies::handed_out_run& run, std::int64_t chunk, const sent_chunk& sent) {
    studies::computed_chunk values;
    for (const auto& [name, bytes] : std::get<0>(sent)) {
        const auto* const begin = reinterpret_cast<const std::byte*>(bytes.c_str());
        values.columns.emplace_back(name, std::vector<std::byte>(begin, begin + bytes.size()));
    }
    const auto& [instruction_set, compiler, math_library, host_name] = std::get<5>(sent);
    values.record = {
        std::get<1>(sent), std::get<2>(sent), std::get<3>(sent), {instruction_set, compiler, math_library, host_name}};
    values.notes = std::get<4>(sent);
    const nb::gil_scoped_release unlocked;
    run.commit(chunk, values);
}

}  // namespace

void bind_study(nb::module_& m) {
    nb::class_<axis_values>(m, "AxisValues")
        .def("__len__", [](const axis_values& v) { return v.size(); })
        .def_prop_ro("random", &axis_values::random)
        .def("array", [](const axis_values& v) {
            std::vector<double> all(static_cast<std::size_t>(v.size()));
            for (std::size_t i = 0; i < all.size(); ++i) all[i] = v[static_cast<std::int64_t>(i)];
            const std::size_t size = all.size();
            return array_of(std::move(all), {size});
        });
    m.def("linspace", &linspace);
    m.def("geomspace", &geomspace);
    m.def("values", [](std::vector<double> list) { return values(std::move(list)); });
    m.def("uniform", &uniform);
    m.def("normal", &normal);
    nb::class_<ensemble_reduction>(m, "Reduction").def("over", &ensemble_reduction::over);
    m.def("histogram_of", &histogram_of);
    m.def("histograms_of", &histograms_of);
    m.def("quantiles_of", &quantiles_of);
    for (const auto& [name, make] : studies::named_reductions)
        m.def(name, [reduction = make](const std::string& variable) { return reduction(variable); });
    m.def("covariance_of", &covariance_of);
    m.def("sum_of", &sum_by_python);

    m.def("result_names", &result_names);

    nb::class_<opened_results>(m, "Results")
        .def_prop_ro("axes", [](const opened_results& r) { return dimensions_of(r.content().axes); })
        .def_prop_ro("instances", [](const opened_results& r) { return r.content().instances(); })
        .def_prop_ro("chunk", [](const opened_results& r) { return r.content().chunk; })
        .def_prop_ro("variables", &opened_results::variables)
        .def_prop_ro("coordinates", &opened_results::coordinates)
        .def_prop_ro("description", [](const opened_results& r) { return r.content().description; })
        .def_prop_ro("devices", [](const opened_results& r) { return r.all->devices(); })
        .def_prop_ro("instances_done", &opened_results::instances_done)
        .def("written", [](const opened_results& r, const std::string& name) { return r.all->written(name); })
        .def("read", &opened_results::read)
        .def("coordinate", &opened_results::coordinate)
        .def("write_csv", [](const opened_results& r, const std::string& path) {
            const nb::gil_scoped_release unlocked;
            export_csv(*r.all, path);
        });
    m.def("open_store",
          [](const std::string& folder) { return opened_results{std::make_shared<const store>(store::open(folder))}; });
    m.def("verify_store", [](const std::string& folder) {
        std::vector<studies::damage> found;
        {
            const nb::gil_scoped_release unlocked;
            found = store::open(folder).verify();
        }
        nb::list made;
        for (const studies::damage& d : found) made.append(nb::make_tuple(d.chunk, d.variable, d.reason));
        return made;
    });

    m.def("load_study_kernels", [](const nb::bytes& image, int device) {
        load_study_kernels({image.c_str(), image.size()}, device);
    });

    using run = studies::handed_out_run;
    nb::class_<run>(m, "HandedOut")
        .def_prop_ro("chunk", [](const run& r) { return r.content().chunk; })
        .def_prop_ro("chunks", [](const run& r) { return r.content().chunks(); })
        .def_prop_ro("instances", [](const run& r) { return r.content().instances(); })
        .def_prop_ro("committed", &run::instances)
        .def("claim_next", &run::claim_next, nb::call_guard<nb::gil_scoped_release>())
        .def("commit", &commit)
        .def("release", &run::release)
        .def("complete", &run::complete, nb::call_guard<nb::gil_scoped_release>())
        .def("instances_done", &run::instances_done, nb::call_guard<nb::gil_scoped_release>());

    nb::class_<python_study>(m, "Study")
        .def("__init__",
             [](python_study* self, const names_of_kinds& names, std::vector<double> tables, std::string generator,
                const std::string& real, std::string name, std::string method) {
                 new (self)
                     python_study(model_from({names_from(names), std::move(tables), std::move(generator)},
                                             real == studies::name_of(element::f64) ? element::f64 : element::f32,
                                             std::move(name), std::move(method)));
             })
        .def(
            "add_kernel",
            [](python_study& s, const std::string& where, const library& kernel, const names_of_kinds& names) {
                s.kernels->add_kernel(device::parse(where), kernel, names_from(names));
            },
            nb::keep_alive<1, 3>())
        .def("axis", [](python_study& s, const std::string& name, const axis_values& v) { s.study.axis(name, v); })
        .def("zip",
             [](python_study& s, const std::vector<std::pair<std::string, axis_values>>& all) { s.study.zip(all); })
        .def("repeat",
             [](python_study& s, std::int64_t count, const std::string& name) { s.study.repeat(count, name); })
        .def("set", [](python_study& s, const std::string& name, double value) { s.study.set(name, value); })
        .def("seed", [](python_study& s, std::uint64_t seed) { s.study.seed(seed); })
        .def("unit",
             [](python_study& s, const std::string& name, const std::string& unit) { s.study.unit(name, unit); })
        .def("title", [](python_study& s, const std::string& text) { s.study.title(text); })
        .def("note",
             [](python_study& s, const std::string& key, const std::string& value) { s.study.note(key, value); })
        .def("reduce", [](python_study& s, const ensemble_reduction& r) { s.study.reduce(r); })
        .def("options", [](python_study& s, const options& o) { s.study.options = o; })
        .def("keep", [](python_study& s, const std::vector<std::string>& end, bool records, bool samples, bool random,
                        bool status, bool work) { s.study.keep = {end, records, samples, random, status, work}; })
        .def_prop_ro("size", [](const python_study& s) { return s.study.size(); })
        .def("set_run", &python_study::set_run)
        .def("set_store", &python_study::set_store)
        .def("run", &python_study::run, "progress"_a.none())
        .def("compute", &python_study::compute)
        .def("hand_out",
             [](python_study& s) {
                 const nb::gil_scoped_release unlocked;
                 return s.study.hand_out();
             })
        .def("finish", [](python_study& s, run& r) {
            std::optional<study_result> made;
            {
                const nb::gil_scoped_release unlocked;
                made = s.study.finish(r);
            }
            return python_study::result_of(std::move(*made));
        });
}

}  // namespace myriad::python
