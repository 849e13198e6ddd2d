// SPDX-License-Identifier: MIT
// Headers of models as one text.
#include "program/model_source.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>

#include "compile/compiled_cache.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/study/store/file_system.hpp"

namespace myriad::programs {

namespace {

namespace fs = std::filesystem;

std::string contents_of(const fs::path& path) {
    const auto refuse = [&](const std::string& why) {
        throw error(message("the header ", path.string(), why, ": give the path of a file with the model"));
    };
    std::error_code unknown;
    if (fs::exists(path, unknown) && !fs::is_regular_file(path, unknown)) refuse(" is no regular file");
    int problem = ENOENT;
    try {
        if (std::optional<std::string> text = studies::read_text(studies::file_system::real(), path)) return *text;
    } catch (const studies::file_error& failure) {
        problem = failure.code();
    }
    refuse(message(" cannot be read (", std::generic_category().message(problem), ')'));
    return "";
}

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// The words of a directive without the #: "include "x.hpp"" of `#  include "x.hpp"`; empty for another line.
std::string_view directive(std::string_view line) {
    line = trimmed(line);
    if (line.empty() || line[0] != '#') return {};
    return trimmed(line.substr(1));
}

/// The file that a line includes in quotes; empty for another line.
std::string_view quoted_file(std::string_view line) {
    std::string_view words = directive(line);
    if (!words.starts_with("include")) return {};
    words = trimmed(words.substr(std::string_view("include").size()));
    if (words.empty() || words[0] != '"') return {};
    words.remove_prefix(1);
    return words.substr(0, words.find('"'));
}

class joiner {
public:
    explicit joiner(const fs::path& header) : folder_(fs::weakly_canonical(header).parent_path()) {}

    void add(const fs::path& path, int depth = 0) {
        require(depth < 100, path.string(), " includes itself: put #pragma once at its beginning");
        const fs::path place = fs::weakly_canonical(path);
        if (once_.contains(place)) return;
        const std::string text = contents_of(path);
        const std::string name = place.lexically_relative(folder_).string();
        say_line(1, name);
        int number = 0;
        for (std::size_t at = 0; at < text.size();) {
            const std::size_t end = std::min(text.find('\n', at), text.size());
            const std::string_view line(text.data() + at, end - at);
            at = end + 1;
            ++number;
            if (directive(line) == "pragma once") {
                once_.insert(place);
                joined += '\n';
                continue;
            }
            const fs::path included = path.parent_path() / quoted_file(line);
            std::error_code unknown;
            if (quoted_file(line).empty() || !fs::exists(included, unknown)) {
                joined += line;
                joined += '\n';
                continue;
            }
            add(included, depth + 1);
            say_line(number + 1, name);
        }
    }

    std::string joined;

private:
    void say_line(int number, const std::string& name) { joined += message("#line ", number, " \"", name, "\"\n"); }

    fs::path folder_;
    std::set<fs::path> once_;
};

}  // namespace

model_source read_model_source(const std::string& path) {
    const fs::path header = fs::absolute(path);
    joiner all(header);
    all.add(header);
    return {header.filename().string(), std::move(all.joined)};
}

std::vector<std::string> model_source::structs() const {
    std::vector<std::string> names;
    const auto is_of_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    const std::string_view all = text;
    for (const std::string_view word : {"struct", "class", "using"}) {
        for (std::size_t at = 0; (at = all.find(word, at)) != all.npos;) {
            const bool begins = at == 0 || !is_of_name(all[at - 1]);
            at += word.size();
            const std::size_t begin = std::min(all.find_first_not_of(" \t\r\n", at), all.size());
            std::size_t end = begin;
            while (end < all.size() && is_of_name(all[end])) ++end;
            std::string_view rest = all.substr(end);
            rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r\n"), rest.size()));
            // What follows tells a definition from a template's parameter, a declaration, and a word in a comment.
            const bool defines = word == "using" ? rest.starts_with('=')
                                                 : rest.starts_with('{') || rest.starts_with("final") ||
                                                       (rest.starts_with(':') && !rest.starts_with("::"));
            if (begins && begin > at && end > begin && defines) names.emplace_back(all.substr(begin, end - begin));
        }
    }
    return names;
}

std::string model_source::digest() const {
    std::string own;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
        if (!text.substr(at, 6).starts_with("#line ")) own.append(text, at, end - at);
        at = end;
    }
    return compiling::text_hash(own);
}

}  // namespace myriad::programs
