// SPDX-License-Identifier: MIT
// Launches the kernels of studies, and owns the device memory that they need beside the arrays of the chunk.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

#include "myriad/cuda/resources.cuh"
#include "myriad/cuda/study_arguments.hpp"
#include "myriad/host/backend/backend.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::cuda {

inline std::size_t bytes_of(value_type type) {
    return type == value_type::u8 ? 1 : type == value_type::f32 || type == value_type::i32 ? 4 : 8;
}
template <class T>
value_type value_type_of(const T*) {
    return std::is_same_v<T, double>         ? value_type::f64
           : std::is_same_v<T, float>        ? value_type::f32
           : std::is_same_v<T, std::int64_t> ? value_type::i64
           : std::is_same_v<T, std::int32_t> ? value_type::i32
                                             : value_type::u8;
}

class study_work {
public:
    /// An array of the chunk: its place on the device, and the type of its values.
    struct place {
        void* values = nullptr;
        value_type type = value_type::f64;
    };

    /// Sets the components; `find` gives the place of a host's array.
    template <class Find>
    void fill(const study_kernels& by, const std::shared_ptr<const generation>& how, Find&& find,
              const instance_range& range, std::uint8_t* ended, status* statuses, gpu::stream_handle stream) {
        upload_tables(how, stream);
        fill_arguments all{};
        all.seed = how->seed;
        all.first = range.first_index;
        all.size = range.size;
        all.ended = ended;
        all.how = statuses;
        for (std::size_t c = 0; c < how->components.size(); ++c) {
            const generated_component& is = how->components[c];
            const place to = find(is.array);
            using valid = generated_component::valid;
            all.components[all.count++] = {with_table(is.rule, c),
                                           static_cast<std::byte*>(to.values) +
                                               bytes_of(to.type) * static_cast<std::size_t>(is.component * range.size),
                                           to.type, is.must_be == valid::finite, is.must_be == valid::not_nan};
            if (all.count < fill_arguments::most && c + 1 < how->components.size()) continue;
            launch(by.fill_components, blocks_for(range.size), 0, stream, all);
            all.count = 0;
        }
    }
    /// Calls the model's `generate`; the pointers are those on the device.
    template <class R>
    void generate(const study_kernels& by, const instance_arrays<array_pointer, R>& arrays, const instance_range& range,
                  const shared_parameters<R>& shared, std::uint64_t seed, gpu::stream_handle stream) {
        require(by.generate_instances != nullptr, "the model's kernel has no generate to set instances");
        launch(by.generate_instances, blocks_for(range.size), 0, stream, arrays, range, shared, seed);
    }
    /// The values of a rule in all instances of a chunk, in memory of this object.
    value_array values_of(const study_kernels& by, const device_values& what, const instance_range& range,
                          gpu::stream_handle stream) {
        drawn_.reserve(bytes_of(what.type) * static_cast<std::size_t>(range.size));
        fill_arguments one{};
        one.count = 1;
        one.seed = what.seed;
        one.first = range.first_index;
        one.size = range.size;
        one.components[0] = {*what.rule, drawn_.data(), what.type, false, false};
        launch(by.fill_components, blocks_for(range.size), 0, stream, one);
        return {drawn_.data(), what.type, range.size, 1};
    }
    /// The values, one instance after the other, somewhere on the device.
    const void* gathered(const study_kernels& by, const value_array& all, gpu::stream_handle stream) {
        if (all.inner == 1 && all.phases == nullptr) return all.values;
        const std::size_t bytes = bytes_of(all.type);
        gathered_.reserve(bytes * static_cast<std::size_t>(all.size * all.inner));
        constexpr std::int32_t missing = std::numeric_limits<std::int32_t>::min() + 1;
        launch(by.gather_values, blocks_for(all.size), 0, stream, all, missing, static_cast<int>(bytes),
               gathered_.data());
        return gathered_.data();
    }
    /// Waits for the result.
    std::vector<std::int64_t> reduce(const study_kernels& by, const value_array& all, const status* how,
                                     const device_reduction& what, gpu::stream_handle stream) {
        std::vector<std::int64_t> words(static_cast<std::size_t>(what.words(all.inner)));
        const std::size_t bytes = words.size() * sizeof(std::int64_t);
        words_.reserve(bytes);
        MYRIAD_GPU_CALL(gpu::fill(words_.data(), 0, bytes, stream));
        reduce_arguments a{all, how, what.kind, nullptr, 0, false, static_cast<unsigned long long*>(words_.data())};
        std::size_t shared = (sum_digits + 1) * sizeof(unsigned long long);
        gpu::grid blocks = blocks_for(all.size);
        const bool of_each = what.kind != reduction_kind::histogram && what.kind != reduction_kind::statuses;
        if (of_each) {  // inner value
            constexpr std::int64_t most = 65'535;
            blocks.y = static_cast<unsigned>(std::min(all.inner, most));
            if (all.inner > 1) blocks.x = std::min(blocks.x, 256u);
        }
        if (what.kind == reduction_kind::histogram || what.kind == reduction_kind::histograms) {
            const std::size_t edges = what.edges.size() * sizeof(double);
            edges_.reserve(edges);
            MYRIAD_GPU_CALL(gpu::copy(edges_.data(), what.edges.data(), edges, gpu::direction::to_device, stream));
            a.edges = static_cast<const double*>(edges_.data());
            a.bins = static_cast<std::int64_t>(what.edges.size()) - 1;
            constexpr std::size_t every_block_has = 48 * 1024;
            const std::size_t counts = (what.edges.size() + 2) * sizeof(unsigned);
            a.in_shared_memory = counts <= every_block_has;
            shared = a.in_shared_memory ? counts : 0;
        }
        launch(by.reduce_values, blocks, shared, stream, a);
        MYRIAD_GPU_CALL(gpu::copy(words.data(), words_.data(), bytes, gpu::direction::to_host, stream));
        check(gpu::synchronise(stream), "a reduction on the GPU");
        return words;
    }

    std::size_t bytes() const {
        return tables_.bytes() + drawn_.bytes() + gathered_.bytes() + words_.bytes() + edges_.bytes();
    }
    void release() {
        of_tables_.reset();
        for (device_memory* m : {&tables_, &drawn_, &gathered_, &words_, &edges_}) m->release();
    }

private:
    static constexpr unsigned threads = 256;

    /// Enough to fill any GPU, each with several instances if there are many, so that what a block adds up is worth it.
    static gpu::grid blocks_for(std::int64_t size) {
        constexpr std::int64_t most = 4096;
        return {static_cast<unsigned>(std::clamp((size + threads - 1) / threads, std::int64_t{1}, most))};
    }
    template <class... Arguments>
    static void launch(const void* kernel, gpu::grid blocks, std::size_t shared, gpu::stream_handle stream,
                       const Arguments&... arguments) {
        void* all[] = {const_cast<Arguments*>(&arguments)...};
        check(gpu::launch(kernel, blocks, threads, all, shared, stream), "the launch of a kernel for a study");
    }

    void upload_tables(const std::shared_ptr<const generation>& how, gpu::stream_handle stream) {
        if (of_tables_ == how) return;
        offsets_.clear();
        std::size_t values = 0;
        for (const generated_component& c : how->components) {
            offsets_.push_back(values);
            if (c.rule.table != nullptr) values += static_cast<std::size_t>(c.rule.length);
        }
        check(gpu::synchronise(stream), "the integration on the GPU");  // which may use what is replaced
        tables_.reserve(values * sizeof(double));
        for (std::size_t c = 0; c < how->components.size(); ++c) {
            const axis_rule& rule = how->components[c].rule;
            if (rule.table == nullptr) continue;
            MYRIAD_GPU_CALL(gpu::copy(static_cast<double*>(tables_.data()) + offsets_[c], rule.table,
                                      static_cast<std::size_t>(rule.length) * sizeof(double), gpu::direction::to_device,
                                      stream));
        }
        of_tables_ = how;
    }
    axis_rule with_table(axis_rule rule, std::size_t component) const {
        if (rule.table != nullptr) rule.table = static_cast<const double*>(tables_.data()) + offsets_[component];
        return rule;
    }

    std::shared_ptr<const generation> of_tables_;
    std::vector<std::size_t> offsets_;  // of each component's table
    device_memory tables_, drawn_, gathered_, words_, edges_;
};

}  // namespace myriad::cuda
