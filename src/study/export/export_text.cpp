// SPDX-License-Identifier: MIT
// Results as text with commas, and as arrays of NumPy.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>
#include <variant>

#include <unistd.h>

#include "myriad/host/core/error.hpp"
#include "myriad/host/report/status_names.hpp"
#include "myriad/study/export/export.hpp"
#include "myriad/study/store/file_system.hpp"
#include "myriad/study/store/metadata.hpp"

namespace myriad {

using namespace studies;

namespace {

constexpr std::size_t text_part = std::size_t{1} << 20;

// Calls write(file) and gives the file its name.
template <class F>
void export_file(const std::string& path, F write) {
    const std::string place = file_place(path);
    try {
        new_file file(file_system::real(), message(place, ".part-", ::getpid()));
        write(file);
        file.finish();
        file.rename_to(place);
        sync_folder(file_system::real(), folder_of(place));
    } catch (const file_error& failure) {
        throw failure.of_export();
    }
}

// The values of an axis' coordinate, in parts, since an axis can be as long as the study.
class axis_column {
public:
    axis_column(const dimension& axis, const coordinate* values, std::int64_t stride)
        : length_(axis.length), stride_(stride), values_(values) {}

    // Of an instance.
    double value(std::int64_t instance) {
        const std::int64_t place = instance / stride_ % length_;
        if (values_ == nullptr) return static_cast<double>(place);
        constexpr std::int64_t most = std::int64_t{1} << 16;
        if (part_.empty() || place / most * most != first_) {
            first_ = place / most * most;
            part_.resize(static_cast<std::size_t>(std::min(most, length_ - first_)));
            values_->values(first_, part_);
        }
        return part_[static_cast<std::size_t>(place - first_)];
    }

private:
    std::int64_t length_, stride_;
    const coordinate* values_;
    std::int64_t first_ = 0;
    std::vector<double> part_;
};

template <class T>
void append(std::string& text, T value) {
    char digits[32];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

template <class T>
void append_at(std::string& text, const std::byte* values, std::size_t place) {
    T value;
    std::memcpy(&value, values + place * sizeof(T), sizeof(T));
    if constexpr (std::is_floating_point_v<T>) {
        if (std::isnan(value)) {  // without the sign that it may have
            text += "nan";
            return;
        }
    }
    append(text, value);
}

void append_value(std::string& text, element type, const std::byte* values, std::size_t place) {
    with_type(type, [&]<class T>(T) { append_at<T>(text, values, place); });
}

// "x", or "x[0][0]" to "x[2][1]".
void append_names(std::string& text, const std::string& name, const std::vector<dimension>& inner,
                  std::size_t level = 0) {
    if (level == inner.size()) {
        text += (text.empty() ? "" : ",") + name;
        return;
    }
    for (std::int64_t i = 0; i < inner[level].length; ++i)
        append_names(text, message(name, '[', i, ']'), inner, level + 1);
}

/// The words that the numbers of a variable stand for, by CF's flags: those of statuses.
std::map<std::int64_t, std::string> words_of(const variable& v) {
    const std::vector<std::int64_t>* values = nullptr;
    const std::string* words = nullptr;
    for (const attribute& a : v.attributes) {
        if (a.name == "flag_values") values = std::get_if<std::vector<std::int64_t>>(&a.value);
        if (a.name == "flag_meanings") words = std::get_if<std::string>(&a.value);
    }
    std::map<std::int64_t, std::string> made;
    if (values == nullptr || words == nullptr) return made;
    std::istringstream text(*words);
    std::string word;
    for (const std::int64_t value : *values)
        if (text >> word) made[value] = word;
    return made;
}

/// One variable in the text: its bytes of the chunk, and what its numbers are called.
struct text_column {
    explicit text_column(const variable& of) : what(&of), words(words_of(of)) {
        // What has no status yet has not been started.
        const char* const not_started = name_of(status::not_started);
        for (const auto& [value, word] : words)
            if (word == not_started) missing = word;
    }

    void append(std::string& text, std::size_t place) const {
        if (!words.empty()) {
            std::int64_t value = 0;
            with_type(what->type, [&]<class T>(T number) {
                std::memcpy(&number, values.data() + place * sizeof(T), sizeof(T));
                value = static_cast<std::int64_t>(number);
            });
            if (const auto found = words.find(value); found != words.end()) {
                text += found->second;
                return;
            }
        }
        append_value(text, what->type, values.data(), place);
    }

    const variable* what;
    std::map<std::int64_t, std::string> words;
    std::string missing = "nan";
    std::vector<std::byte> values = {};
};

void write_csv(const results& from, new_file& file) {
    const layout& content = from.content();
    std::string text;
    std::vector<axis_column> axes;
    std::int64_t stride = content.instances();
    for (const dimension& axis : content.axes) {
        stride /= axis.length;
        bool has_coordinate = false;
        for (const coordinate& c : content.coordinates) {
            if (c.dimension != axis.name) continue;
            append_names(text, c.name, {});
            axes.emplace_back(axis, &c, stride);
            has_coordinate = true;
        }
        if (has_coordinate) continue;
        append_names(text, axis.name, {});
        axes.emplace_back(axis, nullptr, stride);
    }
    std::vector<text_column> columns;
    for (const variable& v : content.variables)
        if (v.extent == along::instances) columns.emplace_back(v);
    // What was drawn at random beside the axes.
    std::stable_partition(columns.begin(), columns.end(),
                          [](const text_column& c) { return c.what->role == role::coordinate; });
    for (const text_column& c : columns) append_names(text, c.what->name, c.what->inner);
    text += '\n';

    for (std::int64_t chunk = 0; chunk < content.chunks(); ++chunk) {
        const chunk_range range = range_of(content, chunk);
        const bool done = from.done(chunk);
        for (text_column& c : columns) {
            if (!done) break;
            c.values.resize(static_cast<std::size_t>(range.count * c.what->item_bytes()));
            from.read(c.what->name, range.first, range.count, c.values.data());
        }
        for (std::int64_t i = 0; i < range.count; ++i) {
            bool is_first = true;
            const auto separate = [&] {
                if (!is_first) text += ',';
                is_first = false;
            };
            for (axis_column& axis : axes) {
                separate();
                append(text, axis.value(range.first + i));
            }
            for (const text_column& c : columns) {
                const auto per_item = static_cast<std::size_t>(c.what->values_per_item());
                for (std::size_t j = 0; j < per_item; ++j) {
                    separate();
                    if (done)
                        c.append(text, static_cast<std::size_t>(i) * per_item + j);
                    else
                        text += c.missing;
                }
            }
            text += '\n';
            if (text.size() >= text_part) {
                file.write(text);
                text.clear();
            }
        }
    }
    file.write(text);
}

// What precedes the values in an NPY file, format 1.0: a magic string, the version, the length of the header, which
// ends on a multiple of 64 bytes.
std::string npy_header(element of, std::string_view name, const std::vector<dimension>& shape) {
    std::string lengths;
    for (const dimension& d : shape) lengths += message(d.length, ", ");
    // The name has the kind in front, as "float64"; a byte has no order.
    std::string header = message("{'descr': '", of == element::u8 ? '|' : '<', name_of(of)[0], size_of(of),
                                 "', 'fortran_order': False, 'shape': (", lengths, "), }");
    header.append(63 - (10 + header.size()) % 64, ' ');
    header += '\n';
    require(header.size() < 65536, "variable ", name, " has too many dimensions for an NPY file");
    std::string begin("\x93NUMPY\x01\x00", 8);
    begin += static_cast<char>(header.size() & 255);
    begin += static_cast<char>(header.size() >> 8);

    return begin + header;
}

void write_npy(const coordinate& c, const layout& content, new_file& file) {
    const array_shape shape = shape_of(content, c);
    file.write(npy_header(element::f64, c.name, shape.dimensions));
    std::vector<double> values;
    for (std::int64_t first = 0; first < shape.items(); first += shape.chunk) {
        values.resize(static_cast<std::size_t>(std::min(shape.chunk, shape.items() - first)));
        c.values(first, values);
        file.write(std::as_bytes(std::span(values)));
    }
}

void write_npy(const results& from, std::string_view name, new_file& file) {
    const layout& content = from.content();
    for (const coordinate& c : content.coordinates)
        if (c.name == name) return write_npy(c, content, file);
    const variable& v = content.variables[content.find(name)];
    std::vector<dimension> shape = v.inner;
    if (v.extent == along::chunks) shape.insert(shape.begin(), {"chunk", content.chunks()});
    if (v.extent == along::instances) shape.insert(shape.begin(), content.axes.begin(), content.axes.end());
    file.write(npy_header(v.type, v.name, shape));
    std::vector<std::byte> values;
    const auto write = [&](std::int64_t first, std::int64_t count) {
        values.resize(static_cast<std::size_t>(count * v.item_bytes()));
        from.read(v.name, first, count, values.data());
        file.write(values);
    };
    if (v.extent == along::nothing) return write(0, 1);
    for (std::int64_t chunk = 0; chunk < content.chunks(); ++chunk) {
        const chunk_range range = range_of(content, chunk);
        if (v.extent == along::chunks)
            write(chunk, 1);
        else
            write(range.first, range.count);
    }
}

}  // namespace

void export_csv(const results& from, const std::string& path) {
    export_file(path, [&](new_file& file) { write_csv(from, file); });
}

void export_npy(const results& from, std::string_view name, const std::string& path) {
    export_file(path, [&](new_file& file) { write_npy(from, name, file); });
}

}  // namespace myriad
