// SPDX-License-Identifier: MIT
// Calls that are made again and again, for both real types.
#include "repeated_call.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "ensemble_arrays.hpp"
#include "myriad/host/threads/parallel.hpp"
#include "myriad/kernel/core/status.hpp"
#include "run.hpp"
#include "statement_caster.hpp"
#include "watcher.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace myriad::python {
namespace {

/// The array of an ensemble that has a component, by kind and number.
using place = std::pair<std::string, int>;

/// Numbers of a caller, in its type.
struct numbers {
    void* data;
    bool single;  ///< float, and not double

    /// Calls `use` with the first of them.
    template <class Use>
    void typed(Use&& use) const {
        if (single) {
            use(static_cast<float*>(data));
        } else {
            use(static_cast<double*>(data));
        }
    }
};

/// A call of either real type.
class any_repeated_call {
public:
    virtual ~any_repeated_call() = default;
    /// Integrates for `rows` rows of values, [row][component], and sets the results, each [row][sample][quantity], or
    /// [row][quantity] without samples; NaN of instances that have failed. Throws `error`, and `interruption` if
    /// `watch` has kept a failure. Several threads may call at a time.
    virtual void run(std::int64_t rows, const numbers& values, const std::vector<numbers>& results,
                     watcher& watch) const = 0;
    virtual std::size_t results() const = 0;

    std::vector<std::string> events;  ///< names, for messages
};

template <class R>
class repeated_call final : public any_repeated_call {
public:
    /// `first` is an ensemble of one instance, which has all that the instances have but for the components `given`.
    repeated_call(const library& kernel, ensemble<R>& first, const options& o, const std::string& where,
                  std::vector<place> given, std::vector<std::vector<place>> results)
        : on_{{&kernel, device::parse(where)}}, first_(first), options_(o), given_(std::move(given)),
          results_(std::move(results)) {
        events = first.shape->names.events;
    }

    void run(std::int64_t rows, const numbers& values, const std::vector<numbers>& results,
             watcher& watch) const override {
        if (rows == 0) return;
        ensemble<R> all(first_.shape, rows);
        fill(all, values);
        options o = options_;
        o.progress = [&watch](std::int64_t done, std::int64_t total) { watch(done, total); };
        if (solve<R>(on_, all, o, results_are::on_host)->interrupted) throw interruption{};
        for (std::size_t r = 0; r < results_.size(); ++r)
            results[r].typed([&](auto* to) { copy(all, results_[r], to); });
    }
    std::size_t results() const override { return results_.size(); }

private:
    void fill(ensemble<R>& all, const numbers& values) const {
        auto& to = all.data;
        const auto& from = first_.data;
#define MYRIAD_FILL(kind, ...) \
    for (int c = 0; c < from.kind.components(); ++c) to.kind.fill_component(c, *from.kind.component(c));
        MYRIAD_INSTANCE_KINDS(MYRIAD_FILL)
#undef MYRIAD_FILL
#define MYRIAD_COPY(kind, ...) std::copy_n(from.kind.data(), first_.shape->n_##kind, to.kind.data());
        MYRIAD_SHARED_KINDS(MYRIAD_COPY)
#undef MYRIAD_COPY
        to.set_domain(from.common_begin, from.common_end);
        values.typed([&](const auto* of_rows) {
            const std::size_t columns = given_.size();
            for (std::size_t c = 0; c < columns; ++c) {
                R* const column = settable(all, given_[c].first, given_[c].second);
                for (std::int64_t i = 0; i < to.size; ++i)
                    column[i] = static_cast<R>(of_rows[static_cast<std::size_t>(i) * columns + c]);
            }
        });
    }

    template <class T>
    void copy(ensemble<R>& all, const std::vector<place>& from, T* to) const {
        const std::int64_t size = all.data.size, samples = options_.samples.empty() ? 0 : options_.samples.capacity;
        const std::int64_t rows_of_each = std::max<std::int64_t>(samples, 1);
        const auto columns = static_cast<std::int64_t>(from.size());
        const status* const ended = all.data.status.data();
        for (std::int64_t c = 0; c < columns; ++c) {
            const auto& [kind, number] = from[static_cast<std::size_t>(c)];
            const auto copy_column = [&](const auto* values) {
                host::in_parallel(size, 4096, [=](std::int64_t begin, std::int64_t end) {
                    for (std::int64_t i = begin; i < end; ++i)
                        for (std::int64_t s = 0; s < rows_of_each; ++s)
                            to[(i * rows_of_each + s) * columns + c] = is_failure(ended[i])
                                                                           ? std::numeric_limits<T>::quiet_NaN()
                                                                           : static_cast<T>(values[s * size + i]);
                });
            };
            if (samples > 0) {
                copy_column(all.samples.component(number));
            } else {
                with_component(all, kind, number, copy_column);
            }
        }
    }

    const std::vector<placed_kernel> on_;
    ensemble<R>& first_;
    const options options_;
    const std::vector<place> given_;
    const std::vector<std::vector<place>> results_;
};

// -- Called by programs of XLA's --------------------------------------------------------------------------------------

/// Calls by their numbers. They are kept for good, as programs do not tell when they are gone.
struct kept_calls {
    std::mutex mutex;
    std::vector<const any_repeated_call*> all;

    static kept_calls& here() {
        static auto* const one = new kept_calls;
        return *one;
    }
    std::int64_t add(const any_repeated_call& call) {
        const std::lock_guard lock(mutex);
        all.push_back(&call);
        return static_cast<std::int64_t>(all.size()) - 1;
    }
    const any_repeated_call& find(std::int64_t number) {
        const std::lock_guard lock(mutex);
        require(number >= 0 && number < static_cast<std::int64_t>(all.size()), "there is no function ", number,
                " in this process: trace the JAX function here");
        return *all[static_cast<std::size_t>(number)];
    }
};

/// Raises an error of the core in Python, with the names of events. The caller holds Python's lock.
[[noreturn]] void raise_in_python(const error& e, const std::vector<std::string>& events) {
    const nb::object said = nb::module_::import_("myriad_ode.base.core_words").attr("in_python")(e.said(), events);
    PyErr_SetObject(said.type().ptr(), said.ptr());
    throw nb::python_error();
}

/// What went wrong, as users of Python read it.
std::string in_words_of_python(const error& e, const std::vector<std::string>& events) {
    const nb::gil_scoped_acquire locked;
    try {
        raise_in_python(e, events);
    } catch (const nb::python_error& raised) {
        return nb::cast<std::string>(nb::str(raised.value()));
    }
}

/// Integrates for the function of that number. Returns 0, or 1 with a message. `single`: arrays are of float.
int call_by_number(std::int64_t number, int single, std::int64_t rows, void* values, void* const* results,
                   char* message, std::size_t most) {
    const std::vector<std::string>* events = nullptr;
    std::string said;
    try {
        const any_repeated_call& call = kept_calls::here().find(number);
        events = &call.events;
        std::vector<numbers> to;
        for (std::size_t r = 0; r < call.results(); ++r) to.push_back({results[r], single != 0});
        watcher watch{nb::handle(Py_None)};
        call.run(rows, {values, single != 0}, to, watch);
        return 0;
    } catch (const interruption&) {
        said = "the call was interrupted";
    } catch (const error& e) {
        said = in_words_of_python(e, events != nullptr ? *events : std::vector<std::string>{});
    } catch (const std::exception& e) {
        said = e.what();
    }
    const std::size_t length = std::min(said.size(), most - 1);
    std::memcpy(message, said.data(), length);
    message[length] = '\0';
    return 1;
}

// -- Called by Python -------------------------------------------------------------------------------------------------

using rows_of_python = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using result_for_python = nb::ndarray<double, nb::c_contig, nb::device::cpu>;

void call_from_python(const any_repeated_call& call, const rows_of_python& rows,
                      const std::vector<result_for_python>& results) {
    require(results.size() == call.results(), "the arrays are not those of the call");
    std::vector<numbers> to;
    for (const result_for_python& one : results) to.push_back({one.data(), false});
    watcher watch{nb::handle(Py_None)};
    try {
        const nb::gil_scoped_release unlocked;
        call.run(static_cast<std::int64_t>(rows.shape(0)), {const_cast<double*>(rows.data()), false}, to, watch);
    } catch (const interruption&) {
        PyErr_SetObject(watch.failure.type().ptr(), watch.failure.ptr());
        throw nb::python_error();
    } catch (const error& e) {
        raise_in_python(e, call.events);
    }
}

template <class R>
void bind(nb::module_& m, const char* name) {
    using call = repeated_call<R>;
    nb::class_<call>(m, name)
        .def(nb::init<const library&, ensemble<R>&, const options&, const std::string&, std::vector<place>,
                      std::vector<std::vector<place>>>(),
             "kernel"_a, "first"_a, "options"_a, "device"_a, "given"_a, "results"_a, nb::keep_alive<1, 2>(),
             nb::keep_alive<1, 3>())
        .def(
            "__call__",
            [](const call& c, const rows_of_python& rows, const std::vector<result_for_python>& results) {
                call_from_python(c, rows, results);
            },
            "rows"_a, "results"_a)
        .def("keep", [](nb::handle self) {
            self.inc_ref();
            return kept_calls::here().add(nb::cast<const call&>(self));
        });
}

}  // namespace

void bind_repeated_call(nb::module_& m) {
    bind<double>(m, "RepeatedCall64");
    bind<float>(m, "RepeatedCall32");
    m.attr("repeated_call") = reinterpret_cast<std::uintptr_t>(&call_by_number);
}

}  // namespace myriad::python
