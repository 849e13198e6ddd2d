// SPDX-License-Identifier: MIT
// Looks for models and methods by their names.
#include "program/wanted_model.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "myriad/kernel/methods/method_list.hpp"
#include "program/program_files.hpp"

namespace myriad::programs {

namespace {

const program_model* registered_model(std::string_view name) {
    for (const program_model& m : registered_models())
        if (plain_name(m.names.model()) == plain_name(name)) return &m;
    return nullptr;
}
const program_method* method_of(const program_model& model, std::string_view name, studies::element real) {
    // The last one: what was compiled now, if a program has the same.
    for (auto m = model.methods.rbegin(); m != model.methods.rend(); ++m)
        if (m->real == real && m->name == plain_name(name)) return &*m;
    return nullptr;
}

/// The name of the method, dense where samples are wanted.
std::string method_wanted(const study_file::model_choice& wanted) {
    const bool is_dense = plain_name(wanted.method).starts_with("dense<");
    return wanted.samples && !is_dense ? "dense<" + wanted.method + '>' : wanted.method;
}

}  // namespace

input_error wrong_at(const text_place& place, const std::string& text) { return input_error(position(place) + text); }

const program_model& find_model(const study_file::model_choice& wanted) {
    if (wanted.model.empty())
        throw wrong_at(wanted.model_place, "no model is named: write model = \"...\", or give --model");
    const program_model* const model = registered_model(wanted.model);
    if (model == nullptr) {
        std::vector<std::string> names;
        for (const program_model& m : registered_models()) names.push_back(plain_name(m.names.model()));
        throw wrong_at(wanted.model_place, message("model: this program has no model \"", wanted.model, '"',
                                                   names.empty() ? ": name its header, header = \"model.hpp\""
                                                                 : suggestion(wanted.model, names)));
    }
    return *model;
}
const program_method& find_method(const program_model& model, const study_file::model_choice& wanted) {
    const std::string name = method_wanted(wanted);
    const program_method* const method = method_of(model, name, wanted.real);
    if (method != nullptr) return *method;
    // A study that names none takes the only one that the program has.
    if (wanted.method_place.line == 0 && !wanted.samples && model.methods.size() == 1 &&
        model.methods.front().real == wanted.real)
        return model.methods.front();
    std::vector<std::string> names;
    for (const program_method& m : model.methods)
        names.push_back(m.name + (m.real == studies::element::f32 ? " (float)" : ""));
    throw wrong_at(wanted.method_place,
                   message("method: ", plain_name(model.names.model()), " was not compiled for ", name,
                           wanted.real == studies::element::f32 ? " (float)" : "", suggestion(name, names)));
}

void compile_model(const study_file::model_choice& wanted, const model_source& source, compile_permission permission,
                   bool quiet) {
    const std::string name = wanted.model.substr(0, wanted.model.find('<'));
    const std::vector<std::string> structs = source.structs();
    const std::string last = name.substr(name.rfind(':') == std::string::npos ? 0 : name.rfind(':') + 1);
    if (wanted.model == name && std::find(structs.begin(), structs.end(), last) == structs.end())
        throw wrong_at(wanted.model_place,
                       message("model: ", source.name, " defines no \"", wanted.model, '"', suggestion(last, structs)));
#define METHOD_NAME(method) #method,
    constexpr const char* methods[] = {MYRIAD_METHODS(METHOD_NAME)};
#undef METHOD_NAME
    const std::string method = plain_name(wanted.method);
    const bool is_plain = method.find_first_of("<:") == std::string::npos;
    if (is_plain && std::find(std::begin(methods), std::end(methods), method) == std::end(methods) &&
        source.text.find(method) == std::string::npos)
        throw wrong_at(wanted.method_place,
                       message("method: there is no method \"", wanted.method, '"',
                               suggestion(method, std::vector<std::string>(std::begin(methods), std::end(methods)))));
    try {
        compile_and_load(
            {source, wanted.model, method_wanted(wanted), wanted.real}, data_file("model_flags.txt"), permission,
            [&](const std::string& text) {
                if (!quiet) tell(text);
            },
            &tell);
    } catch (const error& e) {
        throw wrong_at(wanted.header_place, e.what());
    }
}

}  // namespace myriad::programs
