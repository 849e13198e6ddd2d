// SPDX-License-Identifier: MIT
// The map that an ensemble's accessors return: Eigen's, but values of another number than there are instances are
// refused, which Eigen itself looks at in builds with assertions alone. Host code only.
#pragma once

#include <cstdint>
#include <exception>

#include <Eigen/Core>

#include "myriad/host/core/error.hpp"
#include "myriad/host/model/numbering.hpp"

namespace myriad {

/// One component over all instances, contiguous and writable. Values are assigned from any expression of Eigen with as
/// many, or from a single one, which all instances take. Parts of it (`head`, `segment`, ...) are Eigen's own, and so
/// are their checks.
template <class T>
class component_map : public Eigen::Map<Eigen::Array<T, Eigen::Dynamic, 1>> {
    using base = Eigen::Map<Eigen::Array<T, Eigen::Dynamic, 1>>;

public:
    /// Values one by one, as in `map << 1, 2, 3`.
    class list {
    public:
        list(component_map& to, const T& first) : to_(to) { *this, first; }
        template <class Other>
        list(component_map& to, const Eigen::DenseBase<Other>& first) : to_(to) {
            *this, first;
        }
        list(const list&) = delete;
        list& operator=(const list&) = delete;
        ~list() noexcept(false) {
            if (std::uncaught_exceptions() == before_) to_.check(given_, given_);
        }
        list& operator,(const T& value) {
            to_.check(given_ + 1, given_ + 1 <= to_.size() ? to_.size() : given_ + 1);
            to_.coeffRef(given_++) = value;
            return *this;
        }
        template <class Other>
        list& operator,(const Eigen::DenseBase<Other>& values) {
            const Eigen::Array<T, Eigen::Dynamic, 1> all = values.derived().reshaped();
            for (const T& value : all) *this, value;
            return *this;
        }

    private:
        component_map& to_;
        Eigen::Index given_ = 0;
        int before_ = std::uncaught_exceptions();
    };

    /// Of `size` values; made by the accessors of an ensemble.
    component_map(T* values, std::int64_t size, const host::component_label& label)
        : base(values, size), label_(label) {}
    component_map(const component_map&) = default;

    /// Assigns an expression with one value per instance, or one value to all. Throws `error` for any other number of
    /// values.
    component_map& operator=(const component_map& values) { return assign(values); }
    template <class Other>
    component_map& operator=(const Eigen::EigenBase<Other>& values) {
        return assign(values.derived());
    }
    component_map& operator=(const T& of_all) {
        this->setConstant(of_all);
        return *this;
    }
    using base::setLinSpaced;
    /// Evenly spaced values from `first` to `last`; the number of values may be given, and must then be that of the
    /// instances.
    component_map& setLinSpaced(Eigen::Index size, const T& first, const T& last) {
        check(size, size);
        base::setLinSpaced(first, last);
        return *this;
    }
    /// These change nothing, as the length stays what it is.
    void resize(Eigen::Index size) const { check(size, size); }
    void resize(Eigen::Index rows, Eigen::Index columns) const { check(rows * columns, columns == 1 ? rows : -1); }
    /// Exchanges the values with another array of the same length; throws `error` for another length.
    template <class Other>
    void swap(Other&& other) {
        check(other);
        base::swap(other);
    }
    /// Starts a list of values, `map << 1, 2, 3;`, which must give one for each instance.
    list operator<<(const T& first) { return list(*this, first); }
    template <class Other>
    list operator<<(const Eigen::DenseBase<Other>& first) {
        return list(*this, first);
    }
#define MYRIAD_CHECKED_ASSIGNMENT(op)                                   \
    template <class Other>                                              \
    component_map& operator op(const Eigen::ArrayBase<Other>& values) { \
        check(values.derived());                                        \
        base::operator op(values.derived());                            \
        return *this;                                                   \
    }                                                                   \
    component_map& operator op(const T& of_all) {                       \
        base::operator op(of_all);                                      \
        return *this;                                                   \
    }
    MYRIAD_CHECKED_ASSIGNMENT(+=)
    MYRIAD_CHECKED_ASSIGNMENT(-=)
    MYRIAD_CHECKED_ASSIGNMENT(*=)
    MYRIAD_CHECKED_ASSIGNMENT(/=)
#undef MYRIAD_CHECKED_ASSIGNMENT

private:
    template <class Values>
    component_map& assign(const Values& values) {
        check(values);
        base::operator=(values);
        return *this;
    }
    /// A row vector is taken for a column, as by Eigen, if it is one by its type.
    template <class Values>
    void check(const Values& values) const {
        constexpr bool is_row = Values::RowsAtCompileTime == 1;
        check(values.rows() * values.cols(), is_row ? values.cols() : values.cols() == 1 ? values.rows() : -1);
    }
    /// `column`: the length, if they are one column.
    void check(Eigen::Index given, Eigen::Index column) const {
        require(column == this->size(), label_, " has ", this->size(), " values, one for each instance, but is given ",
                given, column < 0 ? " that are not one column" : "", host::cure,
                "give as many, or a single number for all instances");
    }

    host::component_label label_;
};

}  // namespace myriad
