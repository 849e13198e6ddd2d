// SPDX-License-Identifier: MIT
// Reductions over some axes of a study: one for each point of the others, a set of instances.
#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>

#include "myriad/host/core/error.hpp"
#include "myriad/study/plan/reduction.hpp"
#include "reduced_values.hpp"

namespace myriad {

namespace {

/// The sets of instances that agree in their places along the axes that are kept.
class instance_sets {
public:
    explicit instance_sets(std::vector<axes::dimension> kept) : kept_(std::move(kept)) {}

    std::int64_t count() const {
        std::int64_t sets = 1;
        for (const axes::dimension& d : kept_) sets *= d.length;
        return sets;
    }
    std::size_t set_of(std::int64_t instance) const {
        std::int64_t set = 0;
        for (const axes::dimension& d : kept_) set = set * d.length + instance / d.stride % d.length;
        return static_cast<std::size_t>(set);
    }
    /// The first instance after this one that may be of another set.
    std::int64_t next(std::int64_t instance) const {
        const std::int64_t run = kept_.back().stride;
        return (instance / run + 1) * run;
    }

private:
    std::vector<axes::dimension> kept_;  // the slowest first
};

/// A reduction of each set; sets without an instance so far have none.
class sets_state final : public reduction_state {
public:
    using start_one = std::function<std::unique_ptr<reduction_state>()>;

    sets_state(instance_sets sets, start_one start, std::vector<std::string> inputs)
        : sets_(std::move(sets)), start_(std::move(start)), inputs_(std::move(inputs)), none_(start_()->partial()),
          state_(static_cast<std::size_t>(sets_.count())) {
        inputs_.emplace_back("status");
    }

    void add(const chunk_columns& chunk) override {
        std::vector<chunk_columns::column> all, part;
        for (const std::string& name : inputs_) all.push_back(chunk.find(name));
        part = all;
        const std::int64_t end = chunk.first() + chunk.size();
        for (std::int64_t at = chunk.first(); at < end;) {
            const std::int64_t next = std::min(sets_.next(at), end);
            for (std::size_t c = 0; c < all.size(); ++c) {
                const std::size_t each = all[c].bytes.size() / static_cast<std::size_t>(chunk.size());
                part[c].bytes = all[c].bytes.subspan(static_cast<std::size_t>(at - chunk.first()) * each,
                                                     static_cast<std::size_t>(next - at) * each);
            }
            of_set(sets_.set_of(at)).add(chunk_columns(at, next - at, part));
            at = next;
        }
    }
    void add(std::span<const double> partial) override {
        for (std::size_t s = 0; s < state_.size(); ++s) {
            const auto of_one = partial.subspan(s * none_.size(), none_.size());
            if (!std::equal(of_one.begin(), of_one.end(), none_.begin())) of_set(s).add(of_one);
        }
    }
    std::vector<double> partial() override {
        std::vector<double> all;
        all.reserve(state_.size() * none_.size());
        for (const auto& one : state_) {
            const std::vector<double> of_one = one == nullptr ? none_ : one->partial();
            all.insert(all.end(), of_one.begin(), of_one.end());
        }
        return all;
    }
    std::vector<std::vector<double>> results() override {
        std::vector<std::vector<double>> all;
        for (std::size_t s = 0; s < state_.size(); ++s) {
            const auto found = of_set(s).results();
            all.resize(found.size());
            for (std::size_t r = 0; r < found.size(); ++r)
                all[r].insert(all[r].end(), found[r].begin(), found[r].end());
            state_[s].reset();
        }
        return all;
    }

private:
    reduction_state& of_set(std::size_t s) {
        if (state_[s] == nullptr) state_[s] = start_();
        return *state_[s];
    }

    instance_sets sets_;
    start_one start_;
    std::vector<std::string> inputs_;
    std::vector<double> none_;  // the partial result of no instance
    std::vector<std::unique_ptr<reduction_state>> state_;
};

}  // namespace

ensemble_reduction ensemble_reduction::over(std::vector<std::string> axes) const {
    studies::reduction_definition made = definition();
    require(!axes.empty(), "the reduction ", made.name, " is over no axis: name one, as \"path\"");
    made.over = std::move(axes);
    for (std::size_t a = 0; a < made.over.size(); ++a) made.description += (a == 0 ? " over " : ", ") + made.over[a];
    return ensemble_reduction(std::move(made));
}

reduction_plan reduced_over(const studies::reduction_definition& what, const reduction_plan& all,
                            const std::vector<axes::dimension>& axes) {
    std::string names;
    for (const axes::dimension& d : axes) names += (names.empty() ? "" : ", ") + d.name;
    for (auto name = what.over.begin(); name != what.over.end(); ++name) {
        require(std::any_of(axes.begin(), axes.end(), [&](const axes::dimension& d) { return d.name == *name; }),
                "the reduction ", what.name, " is over \"", *name, "\", and the study has no such axis: there are ",
                names.empty() ? "none" : names);
        require(std::find(what.over.begin(), name, *name) == name, "the reduction ", what.name, " is over \"", *name,
                "\" twice: name it once");
    }
    std::vector<axes::dimension> kept;
    std::vector<studies::dimension> in_front;
    double values = static_cast<double>(all.partial_size);
    for (const axes::dimension& d : axes) {
        if (std::find(what.over.begin(), what.over.end(), d.name) != what.over.end()) continue;
        kept.push_back(d);
        in_front.push_back({d.name, d.length});
        values *= static_cast<double>(d.length);
    }
    if (kept.empty()) return all;
    require(values < 0x1p53, "the reduction ", what.name,
            " would have sums of more parameter sets than any memory holds: reduce over more axes");
    const instance_sets sets(std::move(kept));
    reduction_plan made = all;
    made.partial_size = sets.count() * all.partial_size;
    for (variable& v : made.results) v.inner.insert(v.inner.begin(), in_front.begin(), in_front.end());
    made.on_device.reset();
    made.start = [sets, one = all.start, inputs = what.inputs] {
        return std::make_unique<sets_state>(sets, one, inputs);
    };
    return made;
}

}  // namespace myriad
