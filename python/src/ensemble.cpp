// SPDX-License-Identifier: MIT
// Ensembles of models that are known by their shape, whose memory is used again: to get that of a million instances
// from the system takes longer than to integrate many a model.
#include <cstddef>
#include <mutex>
#include <utility>
#include <vector>

#include "myriad/host/core/left_behind.hpp"
#include "resident.hpp"
#include "run.hpp"

namespace myriad::python {

namespace {

/// The memory of ensembles that are gone.
template <class R>
class kept_memory {
    using data_type = host::ensemble_data<R>;

public:
    static kept_memory& all() {
        static kept_memory* const one = new kept_memory;  // never destroyed, as views may outlive it
        return *one;
    }

    data_type take(const host::model_shape& shape, std::int64_t size) {
        const std::lock_guard lock(mutex_);
        for (auto e = entries_.begin(); e != entries_.end(); ++e) {
            if (e->data.size != size || e->model != shape) continue;
            data_type found = std::move(e->data);
            const bool clean = e->clean;
            entries_.erase(e);
            found.shape = &shape;
            found.untouched = false;
            if (clean) {
                found.status.fill(status::not_started);
                found.untouched = true;
            } else {
                found.t.fill(data_type::unset);
            }
            found.restart();
#define MYRIAD_UNSET(kind, plural, words, type) found.kind.fill(detail::unset_value<type>);
            MYRIAD_ACCESSORY_KINDS(MYRIAD_UNSET)
            MYRIAD_SHARED_KINDS(MYRIAD_UNSET)
#undef MYRIAD_UNSET
            return found;
        }
        return data_type(shape, size);
    }
    /// `clean`: all that is kept between calls is as at first, but for statuses.
    void give(const host::model_shape& shape, data_type data, bool clean) {
        constexpr double too_much = 1 << 30;
        constexpr std::size_t most = 2;
        const std::int64_t size = data.size;
        if (size < 4096 || data_type::memory_of(shape, size).bytes() > too_much) return;
        if (!data.has_common_domain() || data.scales_tolerances()) return;
        const std::lock_guard lock(mutex_);
        if (entries_.size() == most) entries_.erase(entries_.begin());
        entries_.push_back({shape, std::move(data), clean});
    }

private:
    struct entry {
        detail::model_numbers model;
        data_type data;
        bool clean;
    };

    std::mutex mutex_;
    std::vector<entry> entries_;
};

}  // namespace

template <class R>
ensemble<R>::ensemble(const detail::model_numbers& of, component_names names, std::int64_t size)
    : ensemble(std::make_shared<named_shape>(of, std::move(names)), size) {}

template <class R>
ensemble<R>::ensemble(std::shared_ptr<named_shape> of, std::int64_t size)
    : shape(std::move(of)), data(kept_memory<R>::all().take(*shape, size)) {}

template <class R>
ensemble<R>::~ensemble() {
    const bool clean = gpu != nullptr ? gpu->left_bookkeeping(data) : data.untouched;
    kept_memory<R>::all().give(*shape, std::move(data), clean);
}

template struct ensemble<double>;
template struct ensemble<float>;

}  // namespace myriad::python
