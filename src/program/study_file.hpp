// SPDX-License-Identifier: MIT
// A study as a TOML file describes it: which model it is of, and all that `any_study` takes. Host code only.
#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "myriad/program.hpp"
#include "myriad/study/plan/axes.hpp"
#include "myriad/study/study.hpp"
#include "program/section.hpp"
#include "program/toml_value.hpp"

namespace myriad::programs {

/// A file that describes a study. First `choose_model` says which model is needed; with it, `set_up` sets the study.
class study_file {
public:
    /// Throws `input_error` where the text is no TOML. `path` is its name in messages.
    study_file(std::string path, std::string_view text);
    study_file(const study_file&) = delete;
    study_file& operator=(const study_file&) = delete;

    /// What the file says of the model.
    struct model_choice {
        std::string model, header;           ///< empty if the file does not say
        std::string method = "tsitouras_5";  ///< docs/methods.md#the-default
        studies::element real = studies::element::f64;
        bool samples = false;  ///< whether samples are wanted, for which the method must be dense<...>
        text_place model_place, header_place, method_place;  ///< of the keys, or of the file
    };
    const model_choice& model() const { return model_; }
    /// The folder of the results, as the file has it; empty if it does not say.
    const std::string& folder() const { return folder_; }
    const studies::store_options& store_options() const { return store_options_; }

    /// Sets all that the file says, but for devices if others are given. Throws `input_error` for what is wrong,
    /// unknown keys too.
    void set_up(any_study& study, const program_model& model, const std::vector<device>& instead = {});
    /// An error that the study has found, with the place of the key that it is about, as far as that can be told.
    input_error placed_error(const error& found) const;
    /// What an error of the study says, in the words of study files.
    std::string told(const error& found) const { return in_words_of_files(found.said(), events_); }

private:
    void read_model();
    void read_store();
    void read_axes(any_study& study);
    void read_dimension(any_study& study, const toml_value& table, const std::string& path);
    void read_values(any_study& study);
    void read_options(any_study& study, const program_model& model);
    void read_kept(kept_values& keep);
    void read_reductions(any_study& study);
    void read_texts(std::string_view key, const std::function<void(const std::string&, std::string)>& set);

    const std::string path_;
    const toml_value document_;
    section root_;
    model_choice model_;
    std::string folder_;
    studies::store_options store_options_;
    const studies::component_names* names_ = nullptr;
    std::vector<std::string> events_;
};

}  // namespace myriad::programs
