// SPDX-License-Identifier: MIT
// `solve` for models that are known only at run time: the library's own steps, in its order, with a kernel out of a
// shared object.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "interpreted.hpp"
#include "myriad/host/backend/cpu_kernel.hpp"
#include "myriad/host/backend/device.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/ensemble/sample_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/python/kernel_interface.hpp"

namespace myriad::python {

/// A shared object with a kernel, loaded for the life of the process: its code may be running.
class library {
public:
    /// Throws `error` if the file is no kernel library of this version, or not for this CPU.
    explicit library(const std::string& path);
    /// The interpreter with a model of that many shared values; `may_stop`: its hooks may end phases.
    library(const std::string& method, int shared, int shared_integers, bool may_stop,
            std::shared_ptr<const interpreted> model);
    const kernel_library& facts() const { return facts_; }
    /// What an interpreter runs; null for compiled kernels.
    const tape* model() const { return model_ ? &model_->get() : nullptr; }

private:
    kernel_library facts_;
    std::shared_ptr<const interpreted> model_;
};

/// The names of a model's components, in their order.
struct component_names {
    std::vector<std::string> states, parameters, shared, shared_integers, accessories, integer_accessories, events;
};

/// The shape of a model with names of its own.
struct named_shape : host::model_shape {
    named_shape(const kernel_library& of, component_names its_names);
    component_names names;
};

/// An ensemble of a model that is known by its shape.
template <class R>
struct ensemble {
    ensemble(const kernel_library& of, component_names names, std::int64_t size)
        : shape(std::make_unique<named_shape>(of, std::move(names))), data(*shape, size) {}

    std::unique_ptr<named_shape> shape;
    host::ensemble_data<R> data;
    host::sample_data<R> samples;
};

/// A report with its records.
template <class R>
struct report : report_of<R> {
    host::record_data<R> records;
    bool interrupted = false;  ///< by the progress function
};

/// Thrown by a progress function: the call ends with what is done.
struct interruption {};

/// Throws `error` if an option is invalid.
template <class R>
void check_options(const named_shape& shape, const kernel_library& kernel, const options& o);
/// Bytes of memory that an instance and a call for it take.
template <class R>
double bytes_per_instance(const named_shape& shape, const kernel_library& kernel, const options& o);

/// `solve`. Throws `error`.
template <class R>
std::unique_ptr<report<R>> solve(const library& kernel, const device& where, ensemble<R>& instances, const options& o);

}  // namespace myriad::python
