// SPDX-License-Identifier: MIT
// The extension module myriad_ode._core: what the Python side of the package calls. Private; the package checks names
// and shapes before it calls.
#include <algorithm>
#include <array>
#include <chrono>
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
#include "myriad/host/chunks/idle_engines.hpp"
#include "myriad/host/core/instruction_set.hpp"
#include "myriad/host/options/option_table.hpp"
#include "myriad/host/threads/parallel.hpp"
#include "myriad/kernel/methods/method_list.hpp"
#include "myriad/kernel/stepper/sparse_lu.hpp"
#include "myriad/version.hpp"
#include "resident.hpp"
#include "run.hpp"
#include "statement_caster.hpp"
#include "study.hpp"
#include "threads.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace myriad::python {
namespace {

/// A NumPy array of `count` values, which keeps its owner alive.
template <class T>
nb::object view(T* values, std::int64_t count, nb::handle owner) {
    return nb::cast(nb::ndarray<nb::numpy, std::remove_const_t<T>, nb::ndim<1>>(
                        const_cast<std::remove_const_t<T>*>(values), {static_cast<std::size_t>(count)}, owner),
                    nb::rv_policy::reference);
}
/// One of `rows` times `columns` values, of which column after column is in memory.
template <class T>
nb::object table(const T* values, std::int64_t rows, std::int64_t columns, nb::handle owner) {
    return nb::cast(nb::ndarray<nb::numpy, T, nb::ndim<2>>(
                        const_cast<T*>(values), {static_cast<std::size_t>(rows), static_cast<std::size_t>(columns)},
                        owner, {1, rows}),
                    nb::rv_policy::reference);
}

template <class T>
T& checked(T& array, int component) {
    require(component >= 0 && component < array.components(), "there is no component ", component);
    return array;
}

/// Calls `use(first value)` for one component of one kind of an ensemble's data.
template <class R, class Use>
auto with_component(ensemble<R>& e, const std::string& kind, int c, Use&& use) {
    auto& d = e.data;
    const auto of = [&](auto& array) { return use(checked(array, c).component(c)); };
    const auto counter = [&](auto which) { return use(const_cast<std::int64_t*>(d.counter(which).data())); };
    using arrays = typename host::ensemble_data<R>::arrays;
#define MYRIAD_OF_KIND(name, ...) \
    if (kind == #name) return of(d.name);
    MYRIAD_INSTANCE_KINDS(MYRIAD_OF_KIND)
#undef MYRIAD_OF_KIND
    if (kind == "t_begin") return of(d.own_domains().t_begin);
    if (kind == "t_end") return of(d.own_domains().t_end);
    if (kind == "tolerance_scale") return of(d.tolerance_scales());
    if (kind == "t") return of(d.t);
    if (kind == "phases_done") return of(d.phase);
    if (kind == "status") return use(reinterpret_cast<std::uint8_t*>(d.status.data()));
#define MYRIAD_OF_COUNTER(name, array, words) \
    if (kind == #name) return counter(&arrays::array);
    MYRIAD_COUNTERS(MYRIAD_OF_COUNTER)
#undef MYRIAD_OF_COUNTER
    throw error(message("there is no array ", kind));
}

/// One component of one kind of an ensemble's data as an array on the host.
template <class R>
nb::object component(nb::handle self, const std::string& kind, int c) {
    auto& e = nb::cast<ensemble<R>&>(self);
#define MYRIAD_OF_KIND(name, ...) \
    if (kind == #name) return view(e.data.name.data(), e.shape->n_##name, self);
    MYRIAD_SHARED_KINDS(MYRIAD_OF_KIND)
#undef MYRIAD_OF_KIND
    return with_component(e, kind, c, [&](auto* values) {
        const std::int64_t n = e.data.size;
        if (e.gpu) e.gpu->bring(values, static_cast<std::size_t>(n) * sizeof *values);
        return view(values, n, self);
    });
}

/// An array on a GPU, column after column in memory, which keeps its owner alive; None where it is not there.
template <class R, class T>
nb::object device_table(resident<R>* gpu, const T* values, std::int64_t rows, std::int64_t columns, nb::handle owner) {
    void* const there = gpu != nullptr ? gpu->on_device(values) : nullptr;
    if (there == nullptr) return nb::none();
    const auto n = static_cast<std::size_t>(rows);
    if (columns < 0)
        return nb::cast(nb::ndarray<T, nb::ndim<1>, nb::device::cuda>(there, {n}, owner, {1}, nb::dtype<T>(),
                                                                      nb::device::cuda::value, gpu->number()),
                        nb::rv_policy::reference);
    return nb::cast(
        nb::ndarray<T, nb::ndim<2>, nb::device::cuda>(there, {n, static_cast<std::size_t>(columns)}, owner, {1, rows},
                                                      nb::dtype<T>(), nb::device::cuda::value, gpu->number()),
        nb::rv_policy::reference);
}

/// The same for one component, where a GPU has it.
template <class R>
nb::object device_component(nb::handle self, const std::string& kind, int c) {
    auto& e = nb::cast<ensemble<R>&>(self);
    return with_component(e, kind, c,
                          [&](auto* values) { return device_table(e.gpu.get(), values, e.data.size, -1, self); });
}

template <class R>
R* settable(ensemble<R>& e, const std::string& kind, int c) {
    require(kind == "state" || kind == "parameter", "only states and parameters are set in this way");
    return kind == "state" ? checked(e.data.state, c).component(c) : checked(e.data.parameter, c).component(c);
}
/// Sets instance i of a state or parameter to `values[i / repeat % values.size()]`.
template <class R>
void spread(ensemble<R>& e, const std::string& kind, int c,
            const nb::ndarray<const R, nb::ndim<1>, nb::c_contig, nb::device::cpu>& values, std::int64_t repeat) {
    const auto n = static_cast<std::int64_t>(values.size());
    require(n > 0 && repeat > 0, "there are no values");
    if (n == 1) repeat = e.data.size;
    R* const to = settable(e, kind, c);
    const R* const from = values.data();
    host::in_parallel(e.data.size, 32'768, [=](std::int64_t first, std::int64_t last) {
        for (std::int64_t i = first; i < last;) {
            const std::int64_t k = i / repeat % n;
            if (repeat > 1) {
                const std::int64_t end = std::min(last, (i / repeat + 1) * repeat);
                std::fill(to + i, to + end, from[k]);
                i = end;
            } else {
                const std::int64_t count = std::min(last - i, n - k);
                std::copy_n(from + k, count, to + i);
                i += count;
            }
        }
    });
}
/// Has the call take a state or parameter from a GPU's memory.
template <class R>
void set_on_device(ensemble<R>& e, const std::string& kind, int c, std::uintptr_t values) {
    R* const here = settable(e, kind, c);
    (kind == "state" ? e.data.state : e.data.parameter).fill_component(c, 0);  // so that it passes the checks
    e.on_device.push_back({here, reinterpret_cast<const R*>(values)});
}

/// The same of an array of `device_table`: (address, shape, name of its type, device, distances of values).
nb::tuple facts_of_own_array(const nb::ndarray<nb::ro>& array) {
    nb::list shape, strides;
    for (std::size_t d = 0; d < array.ndim(); ++d) {
        shape.append(array.shape(d));
        strides.append(array.stride(d));
    }
    const auto type = array.dtype();
    const char* const kind = type.code == static_cast<std::uint8_t>(nb::dlpack::dtype_code::Float) ? "float"
                             : type.code == static_cast<std::uint8_t>(nb::dlpack::dtype_code::Int) ? "int"
                                                                                                   : "uint";
    return nb::make_tuple(reinterpret_cast<std::uintptr_t>(array.data()), nb::tuple(shape),
                          message(kind, int{type.bits}), array.device_id(), nb::tuple(strides));
}

/// Where an array is that another library has on a GPU, as (address, length, bytes between values, kind and bits of
/// its type, device).
nb::tuple facts_of_device_array(const nb::ndarray<nb::ro>& array) {
    require(array.device_type() == nb::device::cuda::value, "the array is not on an NVIDIA GPU");
    require(array.ndim() == 1, "the array has ", array.ndim(), " dimensions");
    const auto type = array.dtype();
    return nb::make_tuple(reinterpret_cast<std::uintptr_t>(array.data()), array.shape(0),
                          array.stride(0) * type.bits / 8,
                          type.code == static_cast<std::uint8_t>(nb::dlpack::dtype_code::Float) ? 'f' : '?',
                          int{type.bits}, array.device_id());
}

/// Calls Python's progress function, and looks for signals, a few times a second.
class watcher {
public:
    explicit watcher(nb::handle function) : function_(function) {}

    /// Throws `interruption` once Python has raised an exception, which is kept.
    void operator()(std::int64_t done, std::int64_t total) {
        const auto now = std::chrono::steady_clock::now();
        if (done < total && now - last_ < std::chrono::milliseconds{50}) return;
        last_ = now;
        const nb::gil_scoped_acquire locked;
        try {
            if (PyErr_CheckSignals() != 0) throw nb::python_error();
            if (!function_.is_none()) function_(done, total);
        } catch (nb::python_error& raised) {
            failure = nb::borrow(raised.value());
            throw interruption{};
        }
    }

    nb::object failure;

private:
    nb::handle function_;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

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

/// The samples of a state, or their times for -1, or those on the GPU.
template <class R>
nb::object sampled(nb::handle self, int state, bool on_device) {
    auto& e = nb::cast<ensemble<R>&>(self);
    auto& s = e.samples;
    const R* const values = state < 0 ? s.time.data() : s.component(state);
    if (on_device) return device_table(e.gpu.get(), values, s.size, s.capacity, self);
    if (e.gpu) e.gpu->bring(values, static_cast<std::size_t>(s.size * s.capacity) * sizeof(R));
    return table(values, s.size, s.capacity, self);
}

template <class R>
nb::object recorded(nb::handle self, const std::string& kind, int c, bool on_device) {
    auto& all = nb::cast<report<R>&>(self);
    auto& r = all.records;
    const auto of = [&](const auto& array, const std::vector<std::int16_t>& columns) {
        const auto* const values = array.component(r.find(columns, c, kind.c_str()));
        if (on_device) return device_table(all.gpu.get(), values, r.size, r.phases, self);
        if (all.gpu) all.gpu->bring(values, static_cast<std::size_t>(r.size * r.phases) * sizeof *values);
        return table(values, r.size, r.phases, self);
    };
#define MYRIAD_OF_KIND(name, plural, words, type) \
    if (kind == #name) return of(r.template of_type<type>(), r.name);
    MYRIAD_RECORDED_KINDS(MYRIAD_OF_KIND)
#undef MYRIAD_OF_KIND
    if (kind == "time") return of(r.values, {r.time});
    throw error(message("there are no records of ", kind));
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

/// The options of a struct, by their names: choices as text, tolerances and numbers of components as lists.
template <class Group>
void bind_options_of(nb::module_& m, const char* name) {
    nb::class_<Group> bound(m, name);
    bound.def(nb::init<>());
    host::for_each_option<Group>([&](const auto& e) {
        using T = typename std::decay_t<decltype(e)>::value_type;
        const auto member = e.member;
        if constexpr (std::is_enum_v<T>) {
            bound.def_prop_rw(
                e.name, [member](const Group& o) { return host::name_of_choice(o.*member); },
                [member](Group& o, const std::string& wanted) {
                    for (const auto& c : host::choices(T{}))
                        if (wanted == c.name) o.*member = c.value;
                });
        } else if constexpr (std::is_same_v<T, per_component>) {
            bound.def_prop_rw(
                e.name,
                [member](const Group& o) {
                    std::vector<double> all;
                    for (std::size_t i = 0; i < (o.*member).size(); ++i) all.push_back((o.*member)[i]);
                    return all;
                },
                [member](Group& o, std::vector<double> all) { o.*member = per_component(std::move(all)); });
        } else if constexpr (std::is_same_v<T, component_list>) {
            bound.def_prop_rw(
                e.name, [member](const Group& o) { return std::vector<int>((o.*member).begin(), (o.*member).end()); },
                [member](Group& o, const std::vector<int>& all) { o.*member = all; });
        } else if constexpr (!std::is_same_v<T, decltype(options::progress)>) {  // which is given to `solve`
            bound.def_rw(e.name, member);
        }
    });
}

void bind_options(nb::module_& m) {
    bind_options_of<event_options>(m, "EventOptions");
    bind_options_of<record_options>(m, "RecordOptions");
    bind_options_of<sample_options>(m, "SampleOptions");
    bind_options_of<options>(m, "Options");
    m.def(
        "option_rows",
        [] {
            nb::list rows;
            for (const host::option_row& r : host::option_rows()) {
                nb::dict row;
                row["name"] = r.name;
                row["type"] = r.type;
                row["choices"] = r.choices;
                row["initial"] = r.initial;
                row["range"] = r.range;
                row["unit"] = r.unit;
                row["of_call_alone"] = r.effect == host::option_effect::call;
                row["meaning"] = r.meaning;
                rows.append(row);
            }
            return rows;
        },
        nb::sig("def option_rows() -> list[dict[str, typing.Any]]"));
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
#define METHOD_NAME(method) #method,
    m.attr("methods") = std::vector<std::string>{MYRIAD_METHODS(METHOD_NAME)};
#undef METHOD_NAME
    m.def("tape_operations", &tape_operations);
    m.attr("component_kinds") = component_kinds();
    nb::dict sizes;
    for (const std::string& size : interpreter_sizes()) {
        nb::dict limits;
        const detail::model_numbers& most = interpreter(interpreted_methods().front(), size).facts.model;
#define MYRIAD_LIMIT_OF_KIND(kind, ...) limits[#kind] = most.n_##kind;
        MYRIAD_INSTANCE_KINDS(MYRIAD_LIMIT_OF_KIND)
#undef MYRIAD_LIMIT_OF_KIND
        limits["event"] = most.n_event;
        sizes[size.c_str()] = limits;
    }
#define MYRIAD_LIMIT_OF_STOPS(size, ...)                               \
    sizes[#size]["stop"] = static_cast<int>(tape_sizes::size::n_stop); \
    sizes[#size]["trigger"] = static_cast<int>(tape_sizes::size::n_trigger);
    MYRIAD_TAPE_SIZES(MYRIAD_LIMIT_OF_STOPS)
    m.attr("tape_sizes") = sizes;
    m.attr("tape_registers") = tape_registers;
    m.attr("tape_values") = tape_values;
    nb::class_<interpreted>(m, "Tape").def("__init__", [](interpreted* self, const tape_functions& functions,
                                                          const std::vector<int>& codes,
                                                          const std::vector<double>& values,
                                                          const std::vector<std::array<int, 4>>& registers,
                                                          const std::vector<int>& false_at_first,
                                                          const std::vector<int>& lapsing,
                                                          const std::array<int, 4>& queue, int due, std::int64_t seed) {
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
        new (self) interpreted(functions, std::move(steps),
                               {false_at_first, lapsing, {queue[0], queue[1], queue[2], queue[3]}, due, seed});
    });
    nb::class_<library>(m, "Library")
        .def("__init__",
             [](library* self, const std::string& path, const nb::bytes& made_from) {
                 new (self) library(path, {made_from.c_str(), made_from.size()});
             })
        .def("give_model", &library::give_model, "tape"_a, "method"_a, "mass_matrix"_a)
        .def(nb::init<const std::string&, const std::string&, int, int, bool, std::shared_ptr<interpreted>>())
        .def("__init__", [](library* self, const nb::bytes& image,
                            int device) { new (self) library(std::string(image.c_str(), image.size()), device); })
        .def_prop_ro("instruction_set", [](const library& l) {
            return std::string(host::name_of(static_cast<openmp::instruction_set>(l.cpu().instruction_set)));
        });
    bind_options(m);
    bind_precision<double>(m, "Ensemble64", "Report64");
    bind_precision<float>(m, "Ensemble32", "Report32");
    bind_study(m);
    bind_compile(m);
    known = PyDict_Copy(m.attr("__dict__").ptr());
}
