// SPDX-License-Identifier: MIT
// `solve` for models that are known only at run time: the library's own steps, in its order, with a kernel out of a
// shared object.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "device_library.hpp"
#include "interpreted.hpp"
#include "myriad/host/backend/device.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/ensemble/sample_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/host/solve/solve_call.hpp"
#include "myriad/python/kernel_interface.hpp"

namespace myriad::python {

/// A kernel of a model, loaded for the life of the process, as its code may be running: a shared object, the
/// interpreter, or a program for GPUs.
class library {
public:
    /// Throws `error` if the file is no kernel library of this version, not for this CPU, or was made from something
    /// else.
    library(const std::string& path, std::string_view made_from);
    /// The interpreter with a model of that many shared values; `may_stop`: its hooks may end phases.
    library(const std::string& method, int shared, int shared_integers, bool may_stop,
            std::shared_ptr<const interpreted> model);
    /// A program that NVRTC made, loaded on a GPU. Throws `error` if its driver refuses it.
    library(std::string image, int device);

    const compiled_facts& facts() const { return cpu_.facts; }
    /// The kernel of a shared object or the interpreter.
    const kernel_library& cpu() const { return cpu_; }
    /// What an interpreter runs, or the model of a GPU's program for checks and notes; null where there is none.
    const tape* model() const { return model_ ? &model_->get() : nullptr; }
    /// Gives checks and notes of a GPU's program the model's functions, unless this CPU cannot run tapes. `method`: as
    /// in `facts`; `mass_matrix`: row by row, or empty.
    void give_model(std::shared_ptr<const interpreted> model, const std::string& method,
                    std::vector<double> mass_matrix);
    /// Null where there is none.
    const double* mass_matrix() const { return mass_matrix_.empty() ? nullptr : mass_matrix_.data(); }
    /// See `instance_functions`.
    double (*stability_limit() const)() { return stability_limit_; }
    /// The program for GPUs; null for the CPU's kernels.
    device_program* gpu() const { return gpu_; }

private:
    kernel_library cpu_{};
    std::shared_ptr<const interpreted> model_;
    std::vector<double> mass_matrix_;
    double (*stability_limit_)() = nullptr;
    device_program* gpu_ = nullptr;  // never destroyed
};

/// The names of a model's components, in their order.
struct component_names {
#define MYRIAD_DECLARE_NAMES(kind, plural, ...) std::vector<std::string> plural;
    MYRIAD_COMPONENT_KINDS(MYRIAD_DECLARE_NAMES)
#undef MYRIAD_DECLARE_NAMES
};

/// Names by kind, as Python has them.
using names_of_kinds = std::map<std::string, std::vector<std::string>>;
/// The same by member. Throws `std::out_of_range` if a kind is missing.
component_names names_from(const names_of_kinds& all);

/// The shape of a model with names of its own.
struct named_shape : host::model_shape {
    named_shape(const detail::model_numbers& of, component_names its_names);
    component_names names;
    host::model_components components;
};

/// An array of a component's values, one per instance, in the memory of a GPU.
template <class R>
struct device_input {
    R* component;     ///< the component in the ensemble's own memory
    const R* values;  ///< on the device; there until the call ends
};

/// The part of a call whose results stay on a GPU until they are asked for (resident.hpp).
template <class R>
class resident;

/// An ensemble of a model that is known by its shape. Its memory is kept for the next one of its kind.
template <class R>
struct ensemble {
    ensemble(const detail::model_numbers& of, component_names names, std::int64_t size);
    /// Of a shape that several ensembles have.
    ensemble(std::shared_ptr<named_shape> of, std::int64_t size);
    ensemble(const ensemble&) = delete;
    ensemble& operator=(const ensemble&) = delete;
    ~ensemble();

    std::shared_ptr<named_shape> shape;
    host::ensemble_data<R> data;
    host::sample_data<R> samples;
    std::vector<device_input<R>> on_device;
    std::shared_ptr<resident<R>> gpu;  ///< null if all results are in the memory above
};
extern template struct ensemble<double>;
extern template struct ensemble<float>;

/// A report with its records.
template <class R>
struct report : report_of<R> {
    host::record_data<R> records;
    bool interrupted = false;          ///< by the progress function
    std::shared_ptr<resident<R>> gpu;  ///< has the records; null if they are in the memory above
};

/// Thrown by a progress function: the call ends with what is done.
struct interruption {};

/// A model and its kernel as calls on that device see them.
template <class R>
host::called_model<R> called_for(const library& kernel, const named_shape& shape, const device& where,
                                 const options& o);

/// Changes initial states so that they satisfy the algebraic equations of a model with a mass matrix. Throws `error`.
template <class R>
void make_consistent(const library& kernel, ensemble<R>& instances);

/// Where the results of a GPU are after a call.
enum class results_are {
    anywhere,  ///< on the GPU until they are asked for, if it has the room
    on_host,
};

/// A kernel for a device.
struct placed_kernel {
    const library* kernel;
    device where;
};

/// `solve` on one device, or on several GPUs at a time, whose results are on the host. Throws `error`.
template <class R>
std::unique_ptr<report<R>> solve(const std::vector<placed_kernel>& on, ensemble<R>& instances, const options& o,
                                 results_are results = results_are::anywhere);

}  // namespace myriad::python
