// SPDX-License-Identifier: MIT
// Results as netCDF-4, by netCDF's C library, with the conventions of CF.
#if defined(MYRIAD_WITHOUT_NETCDF)

#include "myriad/host/core/error.hpp"
#include "myriad/study/export/export.hpp"

namespace myriad {

void export_netcdf(const studies::results&, const std::string& path, const netcdf_options&) {
    throw error(
        statement_of(path, " is not written, as the library was built without netCDF", host::cure,
                     "install it (Debian package libnetcdf-dev) and build again, or use export_csv or export_npy"));
}

}  // namespace myriad

#else

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <map>
#include <mutex>
#include <set>
#include <span>
#include <type_traits>

#include <fcntl.h>
#include <netcdf.h>
#include <unistd.h>

#include "grid_boxes.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/study/export/export.hpp"
#include "myriad/study/export/own_process.hpp"
#include "myriad/study/store/file_system.hpp"
#include "myriad/study/store/metadata.hpp"
#include "myriad/version.hpp"
#include "netcdf_file.hpp"

namespace myriad {

using namespace studies;

namespace {

constexpr std::int64_t chunk_values = std::int64_t{1} << 17;  // 1 MB of doubles: what readers decompress at a time
constexpr std::int64_t coordinate_part = std::int64_t{1} << 20;

// The path of a file that is removed at the end unless it got its name.
class unfinished_file {
public:
    explicit unfinished_file(const std::string& path) : path_(path), temporary_(message(path, ".part-", ::getpid())) {
        ::unlink(temporary_.c_str());  // a killed process may have left it
    }
    unfinished_file(const unfinished_file&) = delete;
    unfinished_file& operator=(const unfinished_file&) = delete;
    ~unfinished_file() {
        if (!temporary_.empty()) ::unlink(temporary_.c_str());
    }
    const std::string& temporary() const { return temporary_; }

    void finish() {
        file_system& files = file_system::real();
        open_file written(files, temporary_, O_RDONLY);
        if (files.fsync(written.descriptor()) < 0 || files.rename(temporary_, path_) < 0)
            throw file_error("writing", path_, errno);
        temporary_.clear();
        sync_folder(files, folder_of(path_));
    }

private:
    std::string path_, temporary_;
};

// As CF's attribute history has it.
std::string time_now() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    ::gmtime_r(&now, &parts);
    char text[32] = {};
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text;
}

// Writes a file, and asks for values as {is_coordinate, number, first item}.
class exporter {
public:
    // Looks at the results, for what must not be asked in another process.
    exporter(const results& from, const netcdf_options& options)
        : content_(from.content()), options_(options), missing_(missing_text(from)) {
        for (std::int64_t chunk = 0; chunk < content_.chunks(); ++chunk) {
            done_.push_back(from.done(chunk));
            if (!done_.back()) ++missing_chunks_;
        }
        for (const variable& v : content_.variables)
            if (v.extent == along::nothing && from.written(v.name)) written_.insert(v.name);
        for (const std::string& name : from.devices()) devices_ += (devices_.empty() ? "" : ", ") + name;
        for (const dimension& axis : content_.axes) grid_.push_back(static_cast<std::size_t>(axis.length));
    }

    void run(const std::string& path, const data_source& ask) {
        netcdf_file file(path);
        file_ = file;
        ask_ = &ask;
        define();
        for (std::size_t c = 0; c < content_.coordinates.size(); ++c)
            if (ids_.contains(content_.coordinates[c].name)) write_coordinate(c);
        for (std::int64_t chunk = 0; chunk < content_.chunks(); ++chunk) {
            if (!done_[static_cast<std::size_t>(chunk)]) continue;
            const chunk_range range = range_of(content_, chunk);
            for (std::size_t v = 0; v < content_.variables.size(); ++v)
                if (content_.variables[v].extent == along::instances) write_items(v, range);
        }
        for (std::size_t number = 0; number < content_.variables.size(); ++number) {
            const variable& v = content_.variables[number];
            if (v.extent != along::nothing || !written_.contains(v.name)) continue;
            get(number, 0, 1);
            std::vector<std::size_t> start(v.inner.size(), 0), count;
            for (const dimension& d : v.inner) count.push_back(static_cast<std::size_t>(d.length));
            put(v.name, start, count, buffer_.data());
        }
        file.close();
    }

    // Answers what `run` asks for.
    static void read(const results& from, const data_request& wanted, std::span<std::byte> to) {
        const auto [is_coordinate, number, first] = wanted;
        const layout& content = from.content();
        if (is_coordinate != 0) {
            const std::span values(reinterpret_cast<double*>(to.data()), to.size() / sizeof(double));
            return content.coordinates[static_cast<std::size_t>(number)].values(first, values);
        }
        const variable& v = content.variables[static_cast<std::size_t>(number)];
        from.read(v.name, first, static_cast<std::int64_t>(to.size()) / v.item_bytes(), to.data());
    }

private:
    int dimension_id(const dimension& d) {
        const auto [known, is_new] = dimensions_.emplace(d.name, -1);
        errno = 0;
        if (is_new)
            netcdf_file::check(nc_def_dim(file_, d.name.c_str(), static_cast<std::size_t>(d.length), &known->second));
        return known->second;
    }

    // A variable of the file along dimensions, compressed in pieces that are contiguous.
    int define_variable(const std::string& name, element type, const std::vector<dimension>& dimensions,
                        const std::vector<attribute>& attributes) {
        std::vector<int> ids;
        for (const dimension& d : dimensions) ids.push_back(dimension_id(d));
        int id = -1;
        errno = 0;
        netcdf_file::check(
            nc_def_var(file_, name.c_str(), netcdf_type(type), static_cast<int>(ids.size()), ids.data(), &id));
        ids_[name] = id;
        if (!dimensions.empty()) {
            std::vector<std::size_t> piece(dimensions.size());
            std::int64_t most = chunk_values;
            for (std::size_t d = dimensions.size(); d-- > 0;) {
                const std::int64_t length = dimensions[d].length;
                const std::int64_t pieces = (length - 1) / std::min(length, most) + 1;
                const std::int64_t part = (length - 1) / pieces + 1;
                piece[d] = static_cast<std::size_t>(part);
                most = part == length ? std::max<std::int64_t>(1, most / part) : 1;
            }
            netcdf_file::check(nc_def_var_chunking(file_, id, NC_CHUNKED, piece.data()));
            // Values come in the order of the pieces, so that memory for two of them is enough.
            std::size_t held = 2 * size_of(type);
            for (const std::size_t n : piece) held *= n;
            netcdf_file::check(nc_set_var_chunk_cache(file_, id, held, 521, 1.0F));
            if (options_.deflate > 0) netcdf_file::check(nc_def_var_deflate(file_, id, 1, 1, options_.deflate));
        }
        for (const attribute& a : attributes) put_attribute(file_, id, a, &type);
        return id;
    }

    // Where a coordinate is: nothing if only a store has it.
    bool find_dimensions(const coordinate& c, std::vector<dimension>& found) const {
        if (c.dimension.empty()) return true;
        if (c.dimension == "chunk") return false;
        std::vector<dimension> all = content_.axes;
        for (const variable& v : content_.variables)
            if (v.extent != along::chunks) all.insert(all.end(), v.inner.begin(), v.inner.end());
        const auto named =
            std::find_if(all.begin(), all.end(), [&](const dimension& d) { return d.name == c.dimension; });
        if (named != all.end())
            found = {*named};
        else if (c.dimension == "instance")
            found = content_.axes;
        else
            return false;
        return true;
    }

    void define() {
        std::map<std::string, std::vector<dimension>> auxiliary;  // coordinates that are not dimensions' own
        for (const dimension& axis : content_.axes) dimension_id(axis);
        for (const coordinate& c : content_.coordinates) {
            std::vector<dimension> dimensions;
            if (!find_dimensions(c, dimensions)) continue;
            define_variable(c.name, element::f64, dimensions, c.attributes);
            if (c.name != c.dimension) auxiliary[c.name] = dimensions;
        }
        for (const variable& v : content_.variables)
            if (v.role == role::coordinate && v.extent != along::chunks) auxiliary[v.name] = dimensions_of(v);
        for (const variable& v : content_.variables) {
            if (v.extent == along::chunks) continue;
            const std::vector<dimension> dimensions = dimensions_of(v);
            const int id = define_variable(v.name, v.type, dimensions, v.attributes);
            // Readers take numbers with this attribute for floating-point ones, so integers have it only at need.
            const bool is_real = v.type == element::f64 || v.type == element::f32;
            if (is_real || (v.extent == along::instances ? missing_chunks_ > 0 : !written_.contains(v.name))) {
                std::byte value[8];
                fill(v.type, value, 1);
                netcdf_file::check(nc_def_var_fill(file_, id, NC_FILL, value));
            }
            if (v.role == role::coordinate) continue;
            std::string names;
            for (const auto& [name, needed] : auxiliary) {
                const bool has_all = std::all_of(needed.begin(), needed.end(), [&](const dimension& d) {
                    return std::find(dimensions.begin(), dimensions.end(), d) != dimensions.end();
                });
                if (has_all) names += (names.empty() ? "" : " ") + name;
            }
            if (!names.empty()) put_attribute(file_, id, {"coordinates", names});
        }
        define_global();
        netcdf_file::check(nc_enddef(file_));
    }

    void define_global() {
        put_attribute(file_, NC_GLOBAL, {"Conventions", "CF-1.10"});
        put_attribute(file_, NC_GLOBAL, {"source", "Myriad " MYRIAD_VERSION});
        for (attribute& a : attributes_of(content_.description)) {
            a.name = global_name(a.name);
            put_attribute(file_, NC_GLOBAL, a);
        }
        put_attribute(file_, NC_GLOBAL, {"history", message(time_now(), " exported by Myriad " MYRIAD_VERSION)});
        put_attribute(file_, NC_GLOBAL, {"description", content_.description});
        if (!devices_.empty()) put_attribute(file_, NC_GLOBAL, {"devices", devices_});
        if (!missing_.empty()) put_attribute(file_, NC_GLOBAL, {"incomplete", missing_ + ": they have _FillValue"});
    }

    std::vector<dimension> dimensions_of(const variable& v) const {
        std::vector<dimension> dimensions = v.extent == along::instances ? content_.axes : std::vector<dimension>{};
        dimensions.insert(dimensions.end(), v.inner.begin(), v.inner.end());
        return dimensions;
    }

    void put(const std::string& name, const std::vector<std::size_t>& start, const std::vector<std::size_t>& count,
             const void* values) {
        errno = 0;
        netcdf_file::check(nc_put_vara(file_, ids_.at(name), start.data(), count.data(), values));
    }

    void put_places(const std::string& name, std::size_t first, std::size_t count,
                    const std::vector<std::size_t>& inner, std::size_t item_bytes) {
        const std::byte* from = buffer_.data();
        for_boxes(grid_, first, count, [&](std::vector<std::size_t> start, std::vector<std::size_t> box) {
            std::size_t items = 1;
            for (const std::size_t n : box) items *= n;
            start.resize(grid_.size() + inner.size(), 0);
            box.insert(box.end(), inner.begin(), inner.end());
            put(name, start, box, from);
            from += items * item_bytes;
        });
    }

    // Items of a variable, into the buffer.
    void get(std::size_t number, std::int64_t first, std::int64_t count) {
        const variable& v = content_.variables[number];
        buffer_.resize(static_cast<std::size_t>(count * v.item_bytes()));
        (*ask_)({0, static_cast<std::int64_t>(number), first}, buffer_);
    }

    void write_items(std::size_t number, const chunk_range& range) {
        const variable& v = content_.variables[number];
        get(number, range.first, range.count);
        std::vector<std::size_t> inner;
        for (const dimension& d : v.inner) inner.push_back(static_cast<std::size_t>(d.length));
        put_places(v.name, static_cast<std::size_t>(range.first), static_cast<std::size_t>(range.count), inner,
                   static_cast<std::size_t>(v.item_bytes()));
    }

    void write_coordinate(std::size_t number) {
        const coordinate& c = content_.coordinates[number];
        std::vector<dimension> dimensions;
        find_dimensions(c, dimensions);
        std::int64_t length = 1;
        for (const dimension& d : dimensions) length *= d.length;
        for (std::int64_t first = 0; first < length; first += coordinate_part) {
            const auto count = static_cast<std::size_t>(std::min(coordinate_part, length - first));
            buffer_.resize(count * sizeof(double));
            (*ask_)({1, static_cast<std::int64_t>(number), first}, buffer_);
            if (dimensions.size() > 1) {
                put_places(c.name, static_cast<std::size_t>(first), count, {}, sizeof(double));
            } else {
                const std::vector<std::size_t> start(dimensions.size(), static_cast<std::size_t>(first));
                put(c.name, start, std::vector<std::size_t>(dimensions.size(), count), buffer_.data());
            }
        }
    }

    const layout& content_;
    netcdf_options options_;
    std::vector<bool> done_;         // chunks
    std::set<std::string> written_;  // variables of the whole study
    std::string devices_, missing_;
    int file_ = -1;
    const data_source* ask_ = nullptr;
    std::vector<std::size_t> grid_;
    std::int64_t missing_chunks_ = 0;
    std::map<std::string, int> dimensions_, ids_;
    std::vector<std::byte> buffer_;
};

}  // namespace

void export_netcdf(const results& from, const std::string& path, const netcdf_options& options) {
    require(options.deflate >= 0 && options.deflate <= 9, "deflate is ", options.deflate, " (must be 0 to 9)");
    // The libraries below are not made for several threads.
    static std::mutex one_at_a_time;
    const std::lock_guard lock(one_at_a_time);
    const std::string place = file_place(path);
    require(place.find('\\') == place.npos, "the path ", place, " has a backslash, which netCDF takes for a slash",
            host::cure, "give another path");
    unfinished_file file(place);
    try {
        exporter writes(from, options);
        in_own_process([&](const data_source& ask) { writes.run(file.temporary(), ask); },
                       [&](const data_request& wanted, std::span<std::byte> to) { exporter::read(from, wanted, to); });
        file.finish();
    } catch (const process_error& failure) {
        if (failure.code() != 0) throw file_error("writing", place, failure.code()).of_export();
        host::refuse({"writing ", place, " failed: ", failure.what(), host::cure,
                      "give a place that you may write to and that has space, and export again"});
    } catch (const file_error& failure) {
        throw failure.of_export();
    }
}

}  // namespace myriad

#endif
