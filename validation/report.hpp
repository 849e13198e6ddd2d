// SPDX-License-Identifier: MIT
// The rows of the report: each measured value with its bounds and their reason; and the verdict over all rows.
#pragma once

#include <cmath>
#include <iomanip>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "examples/common/csv_file.hpp"

namespace validation {

/// Bounds of a value. NaN is within no bounds but `none`.
struct bounds {
    static constexpr double infinite = std::numeric_limits<double>::infinity();
    double low = -infinite, high = infinite;

    static bounds none() { return {}; }
    static bounds at_most(double high) { return {-infinite, high}; }
    static bounds within(double low, double high) { return {low, high}; }
    bool judged() const { return low > -infinite || high < infinite; }
    bool holds(double value) const { return !judged() || (value >= low && value <= high); }
};

/// The subject of a row: `setting` is a tolerance or a step, 0 if neither.
struct subject {
    std::string problem, method, precision, device;
    double setting = 0;
};

class report {
public:
    struct row {
        subject about;
        std::string measure;
        double value;
        bounds allowed;
        std::string reason;
    };

    explicit report(std::ostream& log) : log_(log) {}

    /// Logs missed bounds at once.
    void add(const subject& about, const std::string& measure, double value, bounds allowed = bounds::none(),
             const std::string& reason = "") {
        rows_.push_back({about, measure, value, allowed, reason});
        if (allowed.holds(value)) return;
        ++missed_;
        log_ << "MISSED: " << about.problem << ", " << about.method << ' ' << about.precision << ", " << about.device
             << ", at " << about.setting << ": " << measure << ' ' << std::setprecision(6) << value
             << " is not within [" << allowed.low << ", " << allowed.high << "] (" << reason << ")\n";
    }

    const std::vector<row>& rows() const { return rows_; }
    int missed() const { return missed_; }
    int judged() const {
        int count = 0;
        for (const row& r : rows_) count += r.allowed.judged();
        return count;
    }

    void write(const std::string& path, const std::vector<std::string>& comments) const {
        examples::csv_file file(path);
        for (const auto& comment : comments) file.comment(comment);
        file.row("problem", "method", "precision", "device", "setting", "measure", "value", "low", "high", "verdict",
                 "reason");
        const auto quoted = [](const std::string& text) { return '"' + text + '"'; };
        for (const row& r : rows_)
            file.row(quoted(r.about.problem), r.about.method, r.about.precision, r.about.device, r.about.setting,
                     quoted(r.measure), r.value, r.allowed.low, r.allowed.high,
                     !r.allowed.judged()        ? ""
                     : r.allowed.holds(r.value) ? "within"
                                                : "MISSED",
                     quoted(r.reason));
        file.commit();
    }

private:
    std::ostream& log_;
    std::vector<row> rows_;
    int missed_ = 0;
};

}  // namespace validation
