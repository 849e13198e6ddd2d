// SPDX-License-Identifier: MIT
// Results on disk: a folder that is a Zarr group (version 3) at any time, with one file per variable and chunk. A chunk
// counts as done when its record is there, which is written last, after everything else is durable. So a process that
// is killed loses only the chunks under way, and several processes can fill one folder.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "myriad/study/plan/layout.hpp"

namespace myriad {

namespace studies::inline MYRIAD_ABI {

class file_system;
class model_behaviour;

/// The values of a variable for one chunk.
struct column {
    std::string_view variable;
    element type;
    std::span<const std::byte> bytes;
};
/// A column of values in memory, which must stay there until it was written.
template <class T>
column column_of(std::string_view variable, std::span<const T> values) {
    return {variable, element_of<T>, std::as_bytes(values)};
}
template <class T>
column column_of(std::string_view variable, const std::vector<T>& values) {
    return column_of(variable, std::span<const T>(values));
}

/// What the last digits of results depend on, beside the study's description: on the CPU, kernels for other instruction
/// sets, other compilers and other libraries of mathematical functions round differently.
struct arithmetic {
    std::string instruction_set;  ///< of the CPU's kernel, as "avx2"; empty if the CPU computes nothing
    std::string compiler;         ///< of the kernel
    std::string library;          ///< of mathematical functions, and this one
    std::string host;             ///< where; two hosts may have the same arithmetic

    /// This process', for a kernel.
    static arithmetic of_kernel(std::string instruction_set, std::string compiler);
    /// Whether results have the same bits.
    bool same_as(const arithmetic& other) const {
        return instruction_set == other.instruction_set && compiler == other.compiler && library == other.library;
    }
    /// "avx2, g++ 12.2.0, Myriad 0.1.0, glibc 2.36".
    std::string text() const;
};

/// How a chunk was computed; kept in its record.
struct chunk_record {
    std::string device;                                               ///< the device's description
    double seconds = 0.0;                                             ///< that it took
    std::vector<std::pair<std::string, std::int64_t>> statuses = {};  ///< instances with each status, by its name
    arithmetic computed_by = {};
};

/// Something wrong with stored data.
struct damage {
    std::int64_t chunk = -1;  ///< -1: something that belongs to no chunk
    std::string variable;     ///< or coordinate, or a file as "zarr.json"; empty: the record of the chunk
    std::string reason;       ///< as "checksum 1f2e3d4c, 00000000 recorded"
};

/// How much of a study is done.
struct store_progress {
    std::int64_t chunks = 0;                                          ///< done, by any process
    std::int64_t all_chunks = 0;                                      ///< that there are
    std::int64_t instances = 0;                                       ///< in the chunks that are done
    std::int64_t all_instances = 0;                                   ///< that there are
    double seconds = 0.0;                                             ///< sum over chunks of what they took to compute
    std::vector<std::pair<std::string, std::int64_t>> statuses = {};  ///< instances with each status, sorted by name
    std::int64_t damaged = 0;  ///< chunks whose records are damaged, which the counts of instances leave out
};

/// What is checked of the chunks that are done when a study goes on.
enum class resume_check {
    sizes,      ///< that their files are there and as long as they should be
    checksums,  ///< everything that is stored is read: `store::verify`
};

/// What is done where another arithmetic computed what is there.
enum class other_arithmetic {
    refuse,  ///< the study is not gone on with
    warn,    ///< `store::warnings` says so
};

/// Options of a store.
struct store_options {
    /// A process of another machine that has given no sign of life for so long, as this one's clock tells, has lost its
    /// chunks to others. That one of this machine is dead is seen at once, and one that lives keeps them.
    std::chrono::milliseconds expiry = std::chrono::seconds(60);
    resume_check check = resume_check::sizes;  ///< what is looked at when a study goes on
    arithmetic computed_by = {};  ///< this process'; compared if it has an instruction set and chunks are left
    other_arithmetic others = other_arithmetic::refuse;  ///< what is done where the digits may differ
    /// What the study's model does; compared with that of the store, if it is given.
    std::shared_ptr<const model_behaviour> model = nullptr;
    /// For tests: what files are written and read by; null: the operating system.
    file_system* files = nullptr;
};

}  // namespace studies::inline MYRIAD_ABI

/// Results in a folder. All functions may be called by several threads at a time, and several processes may have the
/// folder open, also on several machines that share it.
///
/// A process takes a chunk by `claim_next` or `claim`, computes it, and hands it over by `commit`, which returns when
/// it is durable. Every function throws `error`: for a disk that is full or fails, with what to do. What was committed
/// before is never lost by that, and the study can be started again.
class store final : public studies::results {
public:
    /// Makes a new store in a folder that is empty or does not exist, or goes on with the one that is there if it is of
    /// the same study. Removes what processes that were killed left behind, and puts chunks with damaged files back to
    /// be done again (`put_back`). The chunk size of a store that exists stays (`content().chunk`). A store that is
    /// complete is opened for reading where nothing can be written.
    ///
    /// Throws `error` if the folder holds another study, with what differs; if it holds other files; if the layout is
    /// not consistent; if the disk has less free space than what is left to be written takes; and if another arithmetic
    /// computed what is there, unless the options allow that.
    static store create_or_resume(const std::string& folder, const studies::layout& content,
                                  const studies::store_options& options = {});
    /// Opens a store for reading, by anyone who may read the folder, also while a study runs. Throws `error` if there
    /// is none.
    static store open(const std::string& folder, studies::file_system* files = nullptr);
    /// The layout of the store in a folder, with the chunk size it was made with; nothing if the folder does not exist
    /// or is empty. Throws `error` if there is something else.
    static std::optional<studies::layout> content_of(const std::string& folder);

    /// Moved-from stores can only be destroyed or assigned to.
    store(store&& other) noexcept;
    /// The same.
    store& operator=(store&& other) noexcept;
    /// Gives claims back, and removes the traces of this process but its results.
    ~store() override;

    /// The layout, with the chunk size of the store. Coordinates are read from the folder.
    const studies::layout& content() const override;
    /// The folder, as an absolute path.
    const std::string& folder() const;

    /// Whether a chunk is done, as far as this process has seen: `claim_next` and `refresh` look at the folder.
    bool done(std::int64_t chunk) const override;
    /// Whether a variable with along::nothing has been written.
    bool written(std::string_view variable) const override;
    /// Whether all chunks are done, as far as this process has seen.
    bool complete() const;
    /// Looks which chunks other processes have done since.
    void refresh();
    /// How much is done, after a look at the folder. Reads the records that were not read before.
    studies::store_progress progress();

    /// The next chunk that is neither done nor claimed by a living process; it is this process' from then on. Nothing
    /// if there is none: then either the store is complete, or others are at work on the rest. Who waits for them asks
    /// again after a while, since the claims of dead processes are taken over.
    std::optional<std::int64_t> claim_next();
    /// Takes this chunk; false if it is done, or claimed by a living process.
    bool claim(std::int64_t chunk);
    /// Writes a chunk: a column for every variable with along::instances or along::chunks, with as many values as the
    /// chunk has, in any order. It is done and durable when this returns. The claim ends, also if this throws. Without
    /// a claim it does the same, for those who divide the chunks among themselves otherwise; two processes may write
    /// the same chunk.
    void commit(std::int64_t chunk, std::span<const studies::column> columns, const studies::chunk_record& record);
    /// Gives a claimed chunk back without a result.
    void release(std::int64_t chunk);
    /// Writes a variable with along::nothing, durably. Its value must follow from the chunks, since any process may
    /// write it.
    void write(const studies::column& values);

    /// Reads everything that is there, and returns what is damaged. Chunks that are damaged are put back to be done
    /// again, unless the store was opened for reading.
    std::vector<studies::damage> verify();
    /// What `create_or_resume` found damaged.
    const std::vector<studies::damage>& put_back() const;
    /// What `create_or_resume` allowed, by the options, that may be wrong.
    std::vector<std::string> warnings() const;

    /// See `studies::results`. Checksums are compared with the records.
    void read(std::string_view variable, std::int64_t first, std::int64_t count, void* values) const override;
    /// The values of items [first, first + count) of a variable of this type. Throws `error` if it has another one.
    template <class T>
    std::vector<T> read(std::string_view variable, std::int64_t first, std::int64_t count) const {
        std::vector<T> values(size_for(variable, studies::element_of<T>, first, count));
        read(variable, first, count, values.data());
        return values;
    }
    /// The devices that computed it, sorted.
    std::vector<std::string> devices() const override;
    /// The arithmetics that computed it, one for each host.
    std::vector<studies::arithmetic> arithmetics() const;

private:
    struct implementation;
    explicit store(std::unique_ptr<implementation> made);
    std::size_t size_for(std::string_view variable, studies::element type, std::int64_t first,
                         std::int64_t count) const;

    std::unique_ptr<implementation> self_;
};

}  // namespace myriad
