// SPDX-License-Identifier: MIT
// Vectors whose length is that of the tape which the thread runs: what lets one kernel interpret models of any size. To
// be included before the kernel body.
#pragma once

#include <compare>

#include "tape.hpp"

// What loops of the kernel body go over: for names of numbers of components, those of the tape; and at most.
#define MYRIAD_LENGTH(n) (::myriad::python::length_of<(n)>())
#define MYRIAD_CAPACITY(n) (::myriad::python::extent(n).value)

namespace myriad::python {

enum class tape_kind {
#define MYRIAD_KIND_OF_TAPE(kind, most) kind,
    MYRIAD_TAPE_LENGTHS(MYRIAD_KIND_OF_TAPE)
#undef MYRIAD_KIND_OF_TAPE
        none
};

/// A number of components of the kernel body: a constant, or the name of a tape's number, which is only known when that
/// runs. It becomes a number by the macros above alone, so that loops and arrays that forget the difference do not
/// compile.
struct extent {
    tape_kind of_tape;
    int value;  ///< of a name: the most that there may be
    consteval extent(int number)
        : of_tape(tape_kind::none), value(number) {}  // not called with a variable: MYRIAD_LENGTH
    consteval extent(tape_kind of, int most) : of_tape(of), value(most) {}
    friend constexpr std::strong_ordering operator<=>(extent a, extent b) { return a.value <=> b.value; }
    friend constexpr bool operator==(extent a, extent b) = default;
    friend consteval extent operator-(extent a, extent b) {
        if (b.value == 0) return a;
        return a.of_tape == tape_kind::none ? a.value - b.value : throw "unknown before the tape is";
    }
};

namespace tape_extent {
#define MYRIAD_EXTENT_OF_TAPE(kind, most) inline constexpr extent kind{tape_kind::kind, most};
MYRIAD_TAPE_LENGTHS(MYRIAD_EXTENT_OF_TAPE)
#undef MYRIAD_EXTENT_OF_TAPE
}

template <extent n>
inline constexpr bool is_name = n.of_tape != tape_kind::none;
/// The length for which an extent stands.
template <extent n>
constexpr int length_of() {
    if constexpr (is_name<n>) {
        const tape_lengths& is = current_tape->length;
#define MYRIAD_LENGTH_OF_TAPE(kind, most) \
    if constexpr (n == tape_extent::kind) return is.kind;
        MYRIAD_TAPE_LENGTHS(MYRIAD_LENGTH_OF_TAPE)
#undef MYRIAD_LENGTH_OF_TAPE
    } else {
        return n.value;
    }
}

}  // namespace myriad::python
namespace myriad::detail {
using python::extent;
}

#include "myriad/kernel/core/macros.hpp"

// Such loops stay loops.
#undef MYRIAD_UNROLL
#define MYRIAD_UNROLL
#undef MYRIAD_UNROLL_UP_TO
#define MYRIAD_UNROLL_UP_TO(on_gpu, on_cpu)

#include <cstddef>
#include <new>
#include <type_traits>

#include "myriad/kernel/core/vec.hpp"

namespace myriad::python {

/// Memory for `count` values of kind T, uninitialised.
template <class T>
class tape_array {
public:
    static_assert(std::is_trivially_destructible_v<T> || std::is_default_constructible_v<T>);
    explicit tape_array(std::size_t count)
        : size_class_(tape_memory::class_of((count > 0 ? count : 1) * sizeof(T))),
          values_(static_cast<T*>(tape_memory::take(size_class_))) {}
    tape_array(tape_array&& other) noexcept : size_class_(other.size_class_), values_(other.values_) {
        other.values_ = nullptr;
    }
    tape_array& operator=(tape_array&& other) noexcept {
        T* const mine = values_;
        const int my_class = size_class_;
        values_ = other.values_, size_class_ = other.size_class_;
        other.values_ = mine, other.size_class_ = my_class;
        return *this;
    }
    ~tape_array() {
        if (values_ != nullptr) tape_memory::give(values_, size_class_);
    }
    T& operator[](std::ptrdiff_t i) { return values_[i]; }
    const T& operator[](std::ptrdiff_t i) const { return values_[i]; }
    T* data() { return values_; }

private:
    int size_class_;
    T* values_;
};

}  // namespace myriad::python

namespace myriad::inline MYRIAD_TARGET {

/// As `vec` of other sizes, but always initialised: numbers to zero, as each may be read before an interpreted model
/// without components of its kind has set it.
template <class S, detail::extent size>
struct tape_vec {
    tape_vec() : values_(count()) {
        if constexpr (plain) {
            __builtin_memset(static_cast<void*>(values_.data()), 0, count() * sizeof(S));
        } else {
            for (std::size_t c = 0; c < count(); ++c) ::new (static_cast<void*>(values_.data() + c)) S();
        }
    }
    tape_vec(const tape_vec& other) : values_(count()) {
        if constexpr (plain) {
            __builtin_memcpy(static_cast<void*>(values_.data()), other.values(), count() * sizeof(S));
        } else {
            for (std::size_t c = 0; c < count(); ++c) ::new (static_cast<void*>(values_.data() + c)) S(other[c]);
        }
    }
    tape_vec(tape_vec&& other) noexcept = default;
    tape_vec& operator=(const tape_vec& other) {
        if (this == &other) return *this;
        if constexpr (plain) {
            __builtin_memcpy(static_cast<void*>(values_.data()), other.values(), count() * sizeof(S));
        } else {
            for (std::size_t c = 0; c < count(); ++c) (*this)[c] = other[c];
        }
        return *this;
    }
    tape_vec& operator=(tape_vec&& other) noexcept = default;
    ~tape_vec() {
        if constexpr (!plain) {
            if (values_.data() == nullptr) return;
            for (std::size_t c = 0; c < count(); ++c) values_[static_cast<std::ptrdiff_t>(c)].~S();
        }
    }

    S& operator[](std::ptrdiff_t i) { return values_[i]; }
    const S& operator[](std::ptrdiff_t i) const { return values_[i]; }

private:
    static constexpr bool plain = std::is_trivially_copyable_v<S>;
    static std::size_t count() {
        const int length = python::length_of<size>();
        return static_cast<std::size_t>(length > 0 ? length : 1);
    }
    const void* values() const { return &values_[0]; }

    python::tape_array<S> values_;
};
#define MYRIAD_VEC_OF_TAPE(kind, most) \
    template <class S>                 \
    struct vec<S, python::tape_extent::kind> : tape_vec<S, python::tape_extent::kind> {};
MYRIAD_TAPE_LENGTHS(MYRIAD_VEC_OF_TAPE)
#undef MYRIAD_VEC_OF_TAPE

}  // namespace myriad::inline MYRIAD_TARGET
