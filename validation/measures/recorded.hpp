// SPDX-License-Identifier: MIT
// Results stored as compact reference data: some instances of each run, for comparison with another backend.
#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "../problem.hpp"
#include "examples/common/csv_file.hpp"

namespace validation {

/// One of so many instances is stored.
inline constexpr std::size_t kept_one_of = 9;

inline std::string run_name(const problem& p, const method_entry& m, const char* kind, double setting) {
    std::ostringstream name;
    name << p.name << ' ' << m.name << ' ' << m.precision << ' ' << kind << ' ' << setting;
    return name.str();
}

struct recorded_result {
    double steps = 0;
    std::vector<double> end, accessory;
    std::vector<int> count;
};

/// Collects results and writes them: run, instance, steps, then end state, accessories and integer accessories.
class recorder {
public:
    void add(const std::string& run, const outcome& o) {
        for (std::size_t i = 0; i < o.instances.size(); i += kept_one_of) {
            std::string line = run + ',' + std::to_string(i) + ',' + number(o.accepted[i]);
            const solution& s = o.instances[i];
            line += ';';
            for (const double y : s.end) line += number(y) + ' ';
            line += ';';
            for (const double a : s.accessory) line += number(a) + ' ';
            line += ';';
            for (const int c : s.count) line += std::to_string(c) + ' ';
            lines_.push_back(line);
        }
    }
    void write(const std::string& path, const std::vector<std::string>& comments) const {
        examples::csv_file file(path);
        for (const auto& comment : comments) file.comment(comment);
        file.comment("run, instance, accepted steps; end state; accessories; integer accessories");
        for (const auto& line : lines_) file.row(line);
        file.commit();
    }

private:
    static std::string number(double value) {
        std::ostringstream text;
        text.precision(17);
        text << value;
        return text.str();
    }
    std::vector<std::string> lines_;
};

/// Reads such results.
class recorded {
public:
    explicit recorded(const std::string& path) {
        std::ifstream file(path);
        if (!file) throw std::runtime_error(path + " cannot be read: name a file that --record has written");
        std::string line;
        while (std::getline(file, line)) {
            if (line.empty()) continue;
            if (line[0] == '#') {
                comments_.push_back(line);
                continue;
            }
            std::vector<std::string> parts;
            std::istringstream fields(line);
            for (std::string part; std::getline(fields, part, ';');) parts.push_back(part);
            const auto last = parts.empty() ? std::string::npos : parts[0].rfind(',');
            const auto first = last == std::string::npos ? last : parts[0].rfind(',', last - 1);
            if (first == std::string::npos || parts.size() < 2)
                throw std::runtime_error(path + " has a line that is no result: " + line);
            parts.resize(4);
            recorded_result r;
            r.steps = std::stod(parts[0].substr(last + 1));
            r.end = numbers(parts[1]);
            r.accessory = numbers(parts[2]);
            for (const double c : numbers(parts[3])) r.count.push_back(static_cast<int>(c));
            results_[parts[0].substr(0, first)][std::stoul(parts[0].substr(first + 1, last - first - 1))] = r;
        }
        if (results_.empty())
            throw std::runtime_error(path + " holds no results: name a file that --record has written");
    }
    /// The results of a run by instance, or null.
    const std::map<std::size_t, recorded_result>* find(const std::string& run) const {
        const auto found = results_.find(run);
        found_ += found != results_.end();
        return found == results_.end() ? nullptr : &found->second;
    }

    /// Number of runs found.
    int found() const { return found_; }

private:
    static std::vector<double> numbers(const std::string& text) {
        std::vector<double> values;
        std::istringstream words(text);
        for (std::string word; words >> word;) values.push_back(std::stod(word));
        return values;
    }
    std::map<std::string, std::map<std::size_t, recorded_result>> results_;
    std::vector<std::string> comments_;
    mutable int found_ = 0;
};

}  // namespace validation
