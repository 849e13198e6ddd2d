// SPDX-License-Identifier: MIT
// A derivative that is written down instead of computed: a function called with numbers `dual<S, recorded<S>>` leaves a
// list of the linear steps by which its results' derivatives follow from its arguments'. Gone through backwards, the
// list gives products with the transposed Jacobian (reverse accumulation; Griewank and Walther, Evaluating Derivatives,
// ch. 3), at a cost that does not depend on the number of arguments. The rules are those of kernel/scalar/dual.hpp.
#pragma once

#include <cstddef>

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/scalar/dual.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// weight * d, but zero where one of them is, even if the other is not finite.
template <class S>
struct transposed_product {
    static MYRIAD_FUNCTION S of(const S& weight, const S& d) {
        const S zero(real_of<S>(0));
        return select((weight == zero) | (d == zero), zero, weight * d);
    }
};
template <class S>
struct transposed_product<dual<S>> {
    static MYRIAD_FUNCTION dual<S> of(const dual<S>& weight, const dual<S>& d) {
        using product = transposed_product<S>;
        return dual<S>(product::of(weight.value, d.value),
                       product::of(weight.value, d.derivative) + product::of(weight.derivative, d.value));
    }
};

/// The list. Each step makes a derivative of at most two earlier ones.
template <class S>
class derivative_list {
public:
    derivative_list() = default;
    derivative_list(const derivative_list&) = delete;
    derivative_list& operator=(const derivative_list&) = delete;
    ~derivative_list() { delete[] steps_; }

    /// Forgets all steps; `count` arguments are the first ones.
    void begin(int count) {
        size_ = 0;
        for (int i = 0; i < count; ++i) add({}, S(real_of<S>(0)), {}, S(real_of<S>(0)));
    }
    /// One derivative of a step, by its place; -1: zero.
    struct place {
        int number = -1;
    };
    place add(place a, const S& by_a, place b, const S& by_b) {
        if (size_ == capacity_) grow();
        steps_[size_] = {{a.number, b.number}, {by_a, by_b}, S(real_of<S>(0))};
        return {size_++};
    }
    /// The derivative of the final result by the one at that place.
    S& result_by(place at) { return steps_[at.number].result_by_it; }
    /// Goes through all steps, from the derivatives of the final result by the last ones to those by the arguments.
    void transpose() {
        for (int i = size_; i-- > 0;) {
            const step& its = steps_[i];
            for (int k = 0; k < 2; ++k)
                if (its.from[k] >= 0) {
                    S& sum = steps_[its.from[k]].result_by_it;
                    sum = sum + transposed_product<S>::of(its.weight[k], its.result_by_it);
                }
        }
    }

private:
    struct step {
        int from[2];
        S weight[2];
        S result_by_it;
    };
    step* steps_ = nullptr;
    int size_ = 0, capacity_ = 0;

    MYRIAD_RARE_FUNCTION void grow() {
        capacity_ = capacity_ == 0 ? 256 : 2 * capacity_;
        step* const larger = new step[static_cast<std::size_t>(capacity_)];
        for (int i = 0; i < size_; ++i) larger[i] = steps_[i];
        delete[] steps_;
        steps_ = larger;
    }
};

/// A derivative in a list, or zero.
template <class S>
struct recorded {
    using follows_own_rules = S;
    using list = derivative_list<S>;
    using place = typename list::place;

    list* in = nullptr;
    place at;

    MYRIAD_FUNCTION bool is_zero() const { return at.number < 0; }
    /// by_a * a + by_b * b
    static MYRIAD_FUNCTION recorded sum(const S& by_a, const recorded& a, const S& by_b, const recorded& b) {
        list* const in = a.is_zero() ? b.in : a.in;
        if (in == nullptr) return {};
        return {in, in->add(a.at, by_a, b.at, by_b)};
    }
    static MYRIAD_FUNCTION recorded scaled(const S& by, const recorded& a) { return sum(by, a, by, {}); }
    static MYRIAD_FUNCTION S one() { return S(real_of<S>(1)); }

    friend MYRIAD_FUNCTION recorded operator-(const recorded& a) { return scaled(-one(), a); }
    friend MYRIAD_FUNCTION recorded operator+(const recorded& a, const recorded& b) {
        return a.is_zero() ? b : b.is_zero() ? a : sum(one(), a, one(), b);
    }
    friend MYRIAD_FUNCTION recorded operator-(const recorded& a, const recorded& b) {
        return b.is_zero() ? a : sum(one(), a, -one(), b);
    }
    friend MYRIAD_FUNCTION recorded operator*(const recorded& a, const S& by) { return scaled(by, a); }
    friend MYRIAD_FUNCTION recorded operator*(const S& by, const recorded& a) { return scaled(by, a); }
    friend MYRIAD_FUNCTION recorded operator/(const recorded& a, const S& by) { return scaled(one() / by, a); }
    friend MYRIAD_FUNCTION recorded select(const mask_of<S>& first, const recorded& a, const recorded& b) {
        const S zero(real_of<S>(0));
        return sum(myriad::select(first, one(), zero), a, myriad::select(first, zero, one()), b);
    }
    friend MYRIAD_FUNCTION recorded add_product(const recorded& a, const S& by, const recorded& c) {
        return a.is_zero() ? c : sum(by, a, one(), c);
    }
    friend MYRIAD_FUNCTION recorded add_product(const S& by, const recorded& a, const recorded& c) {
        return add_product(a, by, c);
    }
    // That they are is not known before the list is gone through.
    friend MYRIAD_FUNCTION mask_of<S> derivative_is_finite(const recorded&) { return mask_of<S>(true); }
    friend MYRIAD_FUNCTION mask_of<S> derivative_is_infinite(const recorded&) { return mask_of<S>(false); }
};

template <class S>
struct derivative_of_constant<recorded<S>> {
    static MYRIAD_FUNCTION recorded<S> get() { return {}; }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
