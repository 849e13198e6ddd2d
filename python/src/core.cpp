// SPDX-License-Identifier: MIT
// The extension module myriad_ode._core: what the Python side of the package calls. Private; the package checks names
// and shapes before it calls.
#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include "compile.hpp"
#include "cuda_driver.hpp"
#include "ensemble_arrays.hpp"
#include "myriad/host/chunks/idle_engines.hpp"
#include "myriad/host/core/instruction_set.hpp"
#include "myriad/kernel/stepper/sparse_lu.hpp"
#include "myriad/kernel/stepper/step.hpp"
#include "myriad/methods.hpp"
#include "myriad/version.hpp"
#include "option_bindings.hpp"
#include "repeated_call.hpp"
#include "resident.hpp"
#include "run.hpp"
#include "statement_caster.hpp"
#include "study.hpp"
#include "threads.hpp"
#include "watcher.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace myriad::python {
namespace {

/// What the package asks of a method: its stages, whether it takes fixed steps alone, whether it solves linear systems,
/// the noise that it takes, which is none of a method for ordinary equations, whether it follows paths, and whether it
/// estimates the errors of steps along them.
template <class Method>
nb::tuple facts_of() {
    const char* noise = "none";
    bool follows_paths = false;
    if constexpr (detail::stochastic_method<Method>) {
        follows_paths = Method::strong_order > 0;
        switch (Method::noise) {
            case noise_taken::any:
                noise = "any";
                break;
            case noise_taken::additive:
                noise = "additive";
                break;
            case noise_taken::diagonal:
                noise = "diagonal";
                break;
        }
    }
    return nb::make_tuple(Method::stages, Method::embedded_order == 0, detail::solves_linear_systems<Method>, noise,
                          follows_paths, detail::estimates_error<Method>);
}

/// The report, and the exception that ended the call early or None.
template <class R>
nb::tuple solve_from_python(const std::vector<std::pair<const library*, std::string>>& kernels, ensemble<R>& instances,
                            options o, nb::handle progress) {
    std::vector<placed_kernel> on;
    for (const auto& [kernel, where] : kernels) on.push_back({kernel, device::parse(where)});
    watcher watch(progress);
    o.progress = [&watch](std::int64_t done, std::int64_t total) { watch(done, total); };
    std::unique_ptr<report<R>> made;
    {
        const nb::gil_scoped_release unlocked;
        made = solve<R>(on, instances, o);
    }
    const nb::object failure = watch.failure ? watch.failure : nb::none();
    return nb::make_tuple(nb::cast(std::move(made)), failure);
}

template <class R>
void bind_precision(nb::module_& m, const char* ensemble_name, const char* report_name) {
    nb::class_<ensemble<R>>(m, ensemble_name)
        .def("__init__",
             [](ensemble<R>* self, const library& kernel, const names_of_kinds& names, std::int64_t size) {
                 new (self) ensemble<R>(kernel.facts().model, names_from(names), size);
             })
        .def("array", &component<R>, "kind"_a, "component"_a = 0)
        .def("device_array", &device_component<R>, "kind"_a, "component"_a = 0)
        .def("spread", &spread<R>, "kind"_a, "component"_a, "values"_a, "repeat"_a = 1)
        .def("set_on_device", &set_on_device<R>, "kind"_a, "component"_a, "address"_a)
        .def("set_domain", [](ensemble<R>& e, R begin, R end) { e.data.set_domain(begin, end); })
        .def("stored_samples",
             [](nb::handle self) {
                 auto& e = nb::cast<ensemble<R>&>(self);
                 auto& s = e.samples;
                 if (e.gpu) e.gpu->bring(s.stored.data(), static_cast<std::size_t>(s.size) * sizeof(std::int32_t));
                 return view(s.stored.data(), s.size, self);
             })
        .def("samples", &sampled<R>, "state"_a, "on_device"_a = false);
    using all = report<R>;
    nb::class_<all>(m, report_name)
        .def_ro("instances", &all::instances)
        .def_ro("by_status", &all::by_status)
        .def_ro("first_failed", &all::first_failed)
#define MYRIAD_BIND_COUNTER(name, ...) .def_ro(#name, &all::name)
            MYRIAD_COUNTERS(MYRIAD_BIND_COUNTER)
#undef MYRIAD_BIND_COUNTER
        .def_ro("lanes", &all::lanes)
        .def_ro("threads", &all::threads)
        .def_ro("seconds", &all::seconds)
        .def_ro("device", &all::device)
        .def_ro("instruction_set", &all::instruction_set)
        .def_ro("kernel_seconds", &all::kernel_seconds)
        .def_ro("matrix", &all::matrix)
        .def_prop_ro("registers", [](const all& r) { return r.kernel.registers; })
        .def_prop_ro("block_size", [](const all& r) { return r.kernel.block_size; })
        .def_prop_ro("threads_per_instance", [](const all& r) { return r.kernel.threads_per_instance; })
        .def_ro("notes", &all::notes)
        .def_ro("interrupted", &all::interrupted)
        .def_prop_ro("failed", [](const all& r) { return r.failed(); })
        .def_prop_ro("idle_share", [](const all& r) { return r.idle_share(); })
        .def("records", &recorded<R>, "kind"_a, "component"_a = 0, "on_device"_a = false)
        .def("__str__", [](const all& r) {
            report_of<R> without_notes = r;  // which Python has in its own words
            without_notes.notes.clear();
            std::ostringstream text;
            text << without_notes;
            return text.str();
        });
    m.def("make_consistent", &make_consistent<R>, "kernel"_a, "ensemble"_a, nb::call_guard<nb::gil_scoped_release>());
    m.def("solve", &solve_from_python<R>, "kernels"_a, "ensemble"_a, "options"_a, "progress"_a.none() = nb::none());
}

/// What Python knows of every kind of components: name, plural, words in messages, whether its values are integers, and
/// whether they can be recorded, and each instance has its own.
nb::list component_kinds() {
    using R = double;
    const std::set<std::string_view> recorded{
#define MYRIAD_NAME_KIND(kind, ...) #kind,
        MYRIAD_RECORDED_KINDS(MYRIAD_NAME_KIND)};
    const std::set<std::string_view> of_instances{MYRIAD_INSTANCE_KINDS(MYRIAD_NAME_KIND)};
#undef MYRIAD_NAME_KIND
    nb::list all;
#define MYRIAD_ADD_KIND(kind, plural, words, type)                                                       \
    all.append(nb::make_tuple(#kind, #plural, words, std::is_integral_v<type>, recorded.contains(#kind), \
                              of_instances.contains(#kind)));
    MYRIAD_COMPONENT_KINDS(MYRIAD_ADD_KIND)
#undef MYRIAD_ADD_KIND
    return all;
}

/// The number of entries in the factors of a matrix with the given entries, {row, column}, and a full diagonal, in the
/// order of pivots that kernels have; -1 if they would factorise it as a dense one.
int factor_entries(int states, const std::vector<std::pair<int, int>>& entries) {
    constexpr int most = 128;
    if (states > most) return -1;
    std::vector<jacobian_entry> all;
    for (const auto& [row, column] : entries) {
        require(row >= 0 && row < states && column >= 0 && column < states, "an entry is beyond the states");
        all.push_back({row, column});
    }
    // Rows beyond the states have no entries, and so no part in the factors.
    const detail::symbolic_lu<most> found(all, static_cast<int>(all.size()));
    return found.updates <= detail::most_updates ? states + found.lower + found.upper : -1;
}

}  // namespace
}  // namespace myriad::python

NB_MODULE(_core, m) {
    using namespace myriad;
    using namespace myriad::python;
    // Imported anew, as after its names were taken out of sys.modules, the module has what it had: types exist once.
    static PyObject* known = nullptr;
    if (known != nullptr) {
        if (PyDict_Merge(m.attr("__dict__").ptr(), known, 0) != 0) throw nb::python_error();
        return;
    }
    nb::set_leak_warnings(false);  // what other libraries still have at the end of the process is theirs
    nb::register_exception_translator(
        [](const std::exception_ptr& thrown, void*) {
            try {
                std::rethrow_exception(thrown);
            } catch (const error& e) {
                const nb::object said = nb::module_::import_("myriad_ode.base.core_words").attr("in_python")(e.said());
                PyErr_SetObject(said.type().ptr(), said.ptr());
            }
        },
        nullptr);
    m.attr("version") = MYRIAD_VERSION;
    m.attr("headers") = MYRIAD_HEADERS_DIGEST;
    m.def("instruction_set", [] {
        for (const auto set : host::all_instruction_sets)
            if (host::cpu_has(set)) return std::string(host::name_of(set));
        return std::string("generic");
    });
    m.def("cures", [] {
        std::vector<std::string> names;
        for (const host::known_cure& c : host::all_cures) names.emplace_back(c.name);
        return names;
    });
    m.def("status_names", [] {
        std::vector<std::string> names;
        for (int s = 0; s < status_count; ++s) names.emplace_back(name_of(static_cast<status>(s)));
        return names;
    });
    nb::class_<matrix_facts>(m, "MatrixFacts")
        .def_ro("states", &matrix_facts::states)
        .def_ro("jacobian_entries", &matrix_facts::jacobian_entries)
        .def_ro("factor_entries", &matrix_facts::factor_entries)
        .def_ro("jacobian_evaluations", &matrix_facts::jacobian_evaluations)
        .def_ro("lacks_pattern", &matrix_facts::lacks_pattern);
    m.def("factor_entries", &factor_entries, "states"_a, "entries"_a);
    m.def("check_device", [](const std::string& name) { return device::parse(name).name(); });
    m.def("gpu", [](int device) {
        const gpu_facts facts = facts_of_gpu(device);
        return nb::make_tuple(facts.name, facts.capability, facts.shared_bytes);
    });
    m.def("no_gpu", &device::no_gpu);
    m.def("wait_for_gpu", &wait_for_gpu, nb::call_guard<nb::gil_scoped_release>());
    m.def(
        "copy_on_gpu",
        [](int device, std::uintptr_t stream, const std::vector<std::array<std::size_t, 3>>& all) {
            std::vector<copy_of_bytes> copies;
            for (const auto& [to, from, bytes] : all) copies.push_back({to, from, bytes});
            copy_on_gpu(device, stream, copies);
        },
        "device"_a, "stream"_a, "copies"_a, nb::call_guard<nb::gil_scoped_release>());
    using host_array = nb::ndarray<nb::c_contig, nb::device::cpu>;
    nb::class_<gpu_memory>(m, "GpuMemory")
        .def(nb::init<int, std::size_t>(), "device"_a, "bytes"_a)
        .def_prop_ro("address", &gpu_memory::address)
        .def_prop_ro("bytes", &gpu_memory::bytes)
        .def("write",
             [](gpu_memory& m, std::size_t to, const host_array& from) { m.write(to, from.data(), from.nbytes()); })
        .def("read",
             [](const gpu_memory& m, std::size_t from, const host_array& to) { m.read(from, to.data(), to.nbytes()); });
    nb::class_<gpu_kernel>(m, "GpuKernel")
        .def("__init__",
             [](gpu_kernel* self, const nb::bytes& image, const std::string& name, int device) {
                 new (self) gpu_kernel(std::string(image.c_str(), image.size()), name, device);
             })
        .def("run", [](const gpu_kernel& k, const nb::bytes& argument, std::int64_t size) {
            const std::string bytes(argument.c_str(), argument.size());
            const nb::gil_scoped_release released;
            k.run(bytes, size);
        });
    m.def("facts_of_device_array", &facts_of_device_array);
    m.def("facts_of_own_array", &facts_of_own_array);
    m.def("may_use_gpus", &host::may_use_gpus);
    m.def("driver_version", &gpu::driver_version);
    m.def("interpreted_methods", &interpreted_methods);
    nb::dict methods;
#define MYRIAD_ADD_METHOD(method) methods[#method] = facts_of<method>();
    MYRIAD_METHODS(MYRIAD_ADD_METHOD)
#undef MYRIAD_ADD_METHOD
    m.attr("methods") = methods;
    m.def("tape_operations", &tape_operations);
    m.attr("component_kinds") = component_kinds();
    nb::dict limits;
    limits["event"] = static_cast<int>(tape_events);
    limits["stop"] = static_cast<int>(tape_stops);
    limits["trigger"] = static_cast<int>(tape_triggers);
    m.attr("tape_limits") = limits;
    m.attr("tape_registers") = most_registers;
    m.attr("tape_values") = tape_values;
    nb::class_<interpreted>(m, "Tape").def("__init__", [](interpreted* self, const tape_functions& functions,
                                                          const std::vector<int>& codes,
                                                          const std::vector<double>& values,
                                                          const std::vector<std::array<int, 4>>& registers,
                                                          const std::array<int, 7>& length, const tape_entries& entries,
                                                          bool autonomous, const std::vector<int>& false_at_first,
                                                          const std::vector<int>& lapsing,
                                                          const std::array<int, 4>& queue, int due, std::int64_t seed,
                                                          const std::vector<std::array<int, 3>>& delays,
                                                          bool constant_lags) {
        require(codes.size() == values.size() && codes.size() == registers.size(), "a tape's parts differ in length");
        std::vector<tape_step> steps;
        for (std::size_t i = 0; i < codes.size(); ++i) {
            const auto narrow = [&](std::size_t k) {
                require(registers[i][k] >= 0 && registers[i][k] <= 0xffff, "the interpreter has no component ",
                        registers[i][k], host::cure, "install a C++ compiler");
                return static_cast<std::uint16_t>(registers[i][k]);
            };
            steps.push_back({values[i], narrow(0), narrow(1), narrow(2), narrow(3), static_cast<tape_code>(codes[i])});
        }
        require(queue[3] <= tape_values, "actions that wait have at most ", tape_values, " values");
        std::vector<tape_delay> past;
        for (const auto& [state, same_lag, is_slope] : delays) past.push_back({state, same_lag, is_slope != 0});
        new (self) interpreted(functions, std::move(steps),
                               {{length[0], length[1], length[2], length[3], length[4], length[5], length[6]},
                                entries,
                                autonomous,
                                false_at_first,
                                lapsing,
                                {queue[0], queue[1], queue[2], queue[3]},
                                due,
                                seed,
                                past,
                                constant_lags});
    });
    nb::class_<library>(m, "Library")
        .def("__init__",
             [](library* self, const std::string& path, const nb::bytes& made_from) {
                 new (self) library(path, {made_from.c_str(), made_from.size()});
             })
        .def("give_model", &library::give_model, "tape"_a, "method"_a, "mass_matrix"_a)
        .def(nb::init<const std::string&, int, int, bool, std::shared_ptr<interpreted>>())
        .def("__init__", [](library* self, const nb::bytes& image,
                            int device) { new (self) library(std::string(image.c_str(), image.size()), device); })
        .def_prop_ro("instruction_set", [](const library& l) {
            return std::string(host::name_of(static_cast<openmp::instruction_set>(l.cpu().instruction_set)));
        });
    bind_options(m);
    bind_precision<double>(m, "Ensemble64", "Report64");
    bind_precision<float>(m, "Ensemble32", "Report32");
    bind_repeated_call(m);
    bind_study(m);
    bind_compile(m);
    known = PyDict_Copy(m.attr("__dict__").ptr());
}
