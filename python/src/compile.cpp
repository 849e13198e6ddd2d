// SPDX-License-Identifier: MIT
// What the Python package has of src/compile.
#include "compile.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "compile/compiled_cache.hpp"
#include "compile/compiler.hpp"
#include "compile/loaded_library.hpp"
#include "myriad/host/core/error.hpp"

namespace nb = nanobind;

namespace myriad::python {
namespace {

using namespace compiling;

/// Ctrl-C gives up what is waited for.
void check_signals() {
    const nb::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
}

/// A compiler, and how it compiles kernels with the headers of a folder.
class kernel_compiler {
public:
    kernel_compiler(compiler by, std::string include) : by_(std::move(by)), include_(std::move(include)) {}

    const compiler& by() const { return by_; }

    std::vector<std::string> flags() const {
        std::vector<std::string> flags = by_.kernel_flags(wanted_instruction_set());
        flags.insert(flags.end(), {"-fvisibility=hidden", "-I" + include_});
        return flags;
    }

    /// The text that stands for everything that a kernel depends on; the headers are in the same version anywhere.
    std::string made_from(const std::string& source) const {
        std::vector<std::string> all = flags();
        all.pop_back();
        return compiling::made_from(by_, all, MYRIAD_HEADERS_DIGEST, source);
    }

    /// Compiles a source to `model.so` in a folder, in so many seconds at the most; returns whether the headers were
    /// prepared.
    bool compile(const std::string& source, const std::string& folder, double seconds) const {
        const std::string file = folder + "/model.cpp", made = folder + "/model.so", output = folder + "/said.txt";
        write_file(file, source + digest_line(made_from(source)));
        const compiled_cache cache(check_signals);
        const std::vector<std::string> prepared = header().arguments(cache);
        const auto run = [&](const std::vector<std::string>& headers) {
            std::vector<std::string> words = by_.command;
            for (const auto& part : {flags(), headers, {"-shared", file, "-o", made}})
                words.insert(words.end(), part.begin(), part.end());
            std::filesystem::remove(made);
            child_process runs(words, output, ended_with::its_programs);
            require(runs.wait_for(seconds, check_signals), by_.name(), " has not compiled the model after ", seconds,
                    " s, and was ended", host::cure,
                    "give it more time by the environment variable MYRIAD_COMPILE_SECONDS, or use interpreted=True");
            const int status = runs.wait();
            return status == 0 || (status == child_process::unknown && std::filesystem::exists(made));
        };
        if (run(prepared)) return !prepared.empty();
        // They may be damaged, and messages are better without.
        const bool is_made = !prepared.empty() && run({});
        require(is_made, "the model does not compile (", by_.name(), "): ", first_error(read_file(output)));
        return true;
    }

    /// Has the compiler prepare the headers; returns whether it can.
    bool prepare() const {
        compiled_cache cache(check_signals);
        require(cache.objection().empty(), cache.objection());
        return header().make(cache, check_signals);
    }

private:
    prepared_header header() const {
        return {by_, flags(), include_ + "/myriad/python/kernel_library.hpp", MYRIAD_HEADERS_DIGEST};
    }

    compiler by_;
    std::string include_;
};

/// Calls a function of Python, whose `Error` is an `error`, which the cache may know what to do about.
nb::object call(const nb::callable& function, const std::string& path) {
    const nb::gil_scoped_acquire gil;
    try {
        return function(path);
    } catch (nb::python_error& e) {
        if (!e.matches(nb::module_::import_("myriad_ode.base.errors").attr("Error"))) throw;
        throw error(nb::cast<std::string>(nb::str(e.value())));
    }
}

/// What `load(path)` makes of what `make(folder)` writes as `model.so`, whether it was in the cache, why the cache is
/// not used, and whether that is because others could have put something there.
nb::object obtain(const nb::bytes& made_from, const nb::callable& make, const nb::callable& load) {
    nb::object loaded;
    bool was_there = false, is_distrusted = false;
    std::string objection;
    const std::string text(made_from.c_str(), made_from.size());
    {
        const nb::gil_scoped_release released;
        compiled_cache cache(check_signals);
        was_there = cache.obtain(
            text, [&](const std::filesystem::path& folder) { call(make, folder.string()); },
            [&](const std::string& path) { loaded = call(load, path); });
        objection = cache.objection();
        is_distrusted = cache.is_distrusted();
    }
    return nb::make_tuple(loaded, was_there, objection, is_distrusted);
}

}  // namespace

void bind_compile(nb::module_& m) {
    const auto released = nb::call_guard<nb::gil_scoped_release>();
    nb::class_<kernel_compiler>(m, "Compiler")
        .def_prop_ro("command", [](const kernel_compiler& c) { return nb::tuple(nb::cast(c.by().command)); })
        .def_prop_ro("kind", [](const kernel_compiler& c) { return c.by().kind; })
        .def_prop_ro("identity", [](const kernel_compiler& c) { return c.by().identity; })
        .def_prop_ro("name", [](const kernel_compiler& c) { return c.by().name(); })
        .def_prop_ro("flags", &kernel_compiler::flags)
        .def("made_from",
             [](const kernel_compiler& c, const std::string& source) {
                 const std::string text = c.made_from(source);
                 return nb::bytes(text.data(), text.size());
             })
        .def("compile", &kernel_compiler::compile, nb::arg("source"), nb::arg("folder"), nb::arg("seconds"), released)
        .def("prepare", &kernel_compiler::prepare, released);
    m.def(
        "find_compiler",
        [](const std::string& include, const std::string& zig) -> std::optional<kernel_compiler> {
            std::optional<compiler> found = find_compiler(zig);
            return found ? std::optional(kernel_compiler(std::move(*found), include)) : std::nullopt;
        },
        released);
    m.def("refuse_without_compiler", [] { throw no_compiler("or `pip install ziglang`, "); });
    m.def("first_error", &first_error);
    m.def("obtain", &obtain);
    m.def("load_library", [](const std::string& path, const nb::bytes& made_from) {
        return reinterpret_cast<std::uintptr_t>(loaded_library(path, {made_from.c_str(), made_from.size()}).keep());
    });
    m.def("cache_folder", [] { return compiled_cache::user_folder().string(); });
    m.def("clear_cache", [] { return compiled_cache().clear(); });
}

}  // namespace myriad::python
