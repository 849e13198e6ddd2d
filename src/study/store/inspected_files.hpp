// SPDX-License-Identifier: MIT
// A store's files with what is known of them: which chunks are done, and what is damaged.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "chunk_ledger.hpp"
#include "described_files.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

class inspected_files : public described_files {
public:
    inspected_files(file_system& used, std::string where, const found_group& of)
        : described_files(used, std::move(where), of), ledger(content) {}

    chunk_ledger ledger;

    // Looks which chunks are done.
    void refresh();
    // Reads the records that were not read yet; adds those that are damaged.
    void count_all(std::vector<damage>* problems = nullptr);
    // A chunk is to be done again.
    void put_back(std::int64_t chunk);
    // Add what is damaged, and put it back if it can be written.
    void check_chunks(bool checksums, std::vector<damage>& problems);
    void check_rest(bool checksums, std::vector<damage>& problems);
    // Whether a chunk that another process may have written at the same time has the files of its record. With one
    // arithmetic the bits are the same; else it is put back if the files are of both.
    bool is_consistent(std::int64_t chunk);
    // Whether there is nothing to write.
    bool is_whole(resume_check check);
    // An error unless the disk has space for what is left. Before anything is written, and when chunks were put back.
    void check_space() const;
};

}  // namespace myriad::studies::inline MYRIAD_ABI
