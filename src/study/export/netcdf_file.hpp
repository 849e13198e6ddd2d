// SPDX-License-Identifier: MIT
// Files by netCDF's C library: errors, types, names and attributes.
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <netcdf.h>

#include "myriad/host/core/error.hpp"
#include "myriad/study/plan/layout.hpp"
#include "myriad/study/store/file_system.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

inline int netcdf_type(element type) {
    constexpr int types[] = {NC_DOUBLE, NC_FLOAT, NC_INT64, NC_INT, NC_UBYTE};  // in the order of `element`
    return types[static_cast<std::size_t>(type)];
}

// A file that is open for writing, in a process that ends if this fails: HDF5 may end its process by a segmentation
// fault when it closes, or ends with, a file that it could not write.
class netcdf_file {
public:
    explicit netcdf_file(const std::string& path) {
        errno = 0;
        check(nc_create(path.c_str(), NC_NETCDF4 | NC_NOCLOBBER, &id_));
    }
    netcdf_file(const netcdf_file&) = delete;
    netcdf_file& operator=(const netcdf_file&) = delete;
    operator int() const { return id_; }

    static void check(int code) {
        if (code == NC_NOERR) return;
        // HDF5's errors are all one to netCDF.
        if (errno != 0 && (code == NC_EHDFERR || code > 0)) throw file_error("writing", "", errno);
        throw error(nc_strerror(code));
    }
    void close() {
        errno = 0;
        check(nc_close(id_));
    }

private:
    int id_ = -1;
};

// Attributes of numbers that are about a variable's values have its type, as CF asks.
inline bool is_about_values(const std::string& name) {
    for (const char* const known :
         {"flag_values", "flag_masks", "valid_range", "valid_min", "valid_max", "actual_range"})
        if (name == known) return true;
    return false;
}

inline void put_integers(int file, int variable, const attribute& a, const std::vector<std::int64_t>& values,
                         const element* type) {
    int stored = NC_INT64;
    if (type != nullptr && is_about_values(a.name)) {
        stored = netcdf_type(*type);
    } else if (std::all_of(values.begin(), values.end(),
                           [](std::int64_t v) { return v == static_cast<std::int32_t>(v); })) {
        stored = NC_INT;
    }
    const std::vector<long long> numbers(values.begin(), values.end());
    netcdf_file::check(nc_put_att_longlong(file, variable, a.name.c_str(), stored, numbers.size(), numbers.data()));
}

inline void put_attribute(int file, int variable, attribute a, const element* type = nullptr) {
    std::replace(a.name.begin(), a.name.end(), '/', '_');
    errno = 0;
    std::visit(
        [&](const auto& value) {
            using T = std::remove_cvref_t<decltype(value)>;
            const char* const name = a.name.c_str();
            if constexpr (std::is_same_v<T, std::string>) {
                netcdf_file::check(nc_put_att_text(file, variable, name, value.size(), value.data()));
            } else if constexpr (std::is_same_v<T, double>) {
                netcdf_file::check(nc_put_att_double(file, variable, name, NC_DOUBLE, 1, &value));
            } else if constexpr (std::is_same_v<T, std::vector<double>>) {
                netcdf_file::check(nc_put_att_double(file, variable, name, NC_DOUBLE, value.size(), value.data()));
            } else if constexpr (std::is_same_v<T, std::int64_t>) {
                put_integers(file, variable, a, {value}, type);
            } else {
                put_integers(file, variable, a, value, type);
            }
        },
        a.value);
}

// CF recommends letters, digits and underscores alone in names. The attribute description has all names as they are.
inline std::string global_name(std::string name) {
    for (char& c : name) {
        const bool kept = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (!kept) c = '_';
    }
    const bool begins_with_letter =
        !name.empty() && name.front() != '_' && !(name.front() >= '0' && name.front() <= '9');
    return begins_with_letter ? name : 'x' + name;
}

}  // namespace myriad::studies::inline MYRIAD_ABI
