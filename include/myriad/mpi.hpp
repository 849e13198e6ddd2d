// SPDX-License-Identifier: MIT
// Studies that the ranks of an MPI job run together. Needs the target myriad::mpi.
#pragma once

#include "myriad/host/core/host_only.hpp"

#include <string>
#include <vector>

#include <mpi.h>

#include "myriad/host/backend/device.hpp"
#include "myriad/study/study.hpp"

namespace myriad {

/// The ranks of an MPI job, to run studies together: a counter that all of them reach by one-sided communication hands
/// out the chunks, and each rank computes on devices of its own. The results go to the study's folder, which all ranks
/// must share.
///
/// Ranks may die while a study runs: see `lost`. All ranks make the object, and call `run` for the same studies. While
/// `run` is at work, no other thread of the rank may call MPI.
class mpi_ranks {
public:
    /// Initialises MPI unless the program has done so, which must be with MPI_THREAD_SERIALIZED or
    /// MPI_THREAD_MULTIPLE: throws `error` if not. Keeps a duplicate of the communicator.
    explicit mpi_ranks(MPI_Comm ranks = MPI_COMM_WORLD);
    mpi_ranks(const mpi_ranks&) = delete;
    mpi_ranks& operator=(const mpi_ranks&) = delete;
    /// Finalizes MPI if it has initialised it, unless a rank is lost: see `lost`.
    ~mpi_ranks();

    /// The number of this rank.
    int rank() const { return rank_; }
    /// How many there are.
    int size() const { return size_; }
    /// What this rank computes on. With GPUs, those whose number on the machine is this rank's number there, modulo the
    /// number of ranks there; if there are more ranks than GPUs, one GPU, the rank's number modulo the number of GPUs.
    /// Without, the CPU with this rank's share of the cores: of those that it may use, each shared with the other ranks
    /// of the machine that may use it, and one at least.
    const std::vector<device>& devices() const { return devices_; }

    /// Runs the study with the other ranks and returns when it ends, with the results of all and the counts of this
    /// rank. If `devices` of the study is empty, it is what `devices()` gives for this run. Throws `error` as
    /// `any_study::run`: where the study cannot start, rank 0 says why, and the others that it does not. A rank that
    /// throws later waits for the others, who do its chunks.
    study_result run(any_study& s);

    /// Whether another rank has died, as far as `run` has seen. The study ends without it, where the job goes on
    /// without it. But MPI cannot be finalized any more, since that waits for all ranks: the program then ends without.
    bool lost() const { return lost_; }

private:
    std::vector<device> own_devices() const;
    void begin(any_study& s) const;

    MPI_Comm ranks_ = MPI_COMM_NULL;
    bool finalizes_ = false, lost_ = false;
    int rank_ = 0, size_ = 1;
    std::vector<device> devices_;
    std::vector<std::string> processes_;  // of all ranks: `studies::process_identity`
};

}  // namespace myriad
