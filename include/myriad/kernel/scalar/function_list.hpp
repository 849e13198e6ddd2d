// SPDX-License-Identifier: MIT
// The elementary functions and comparisons, as lists for kinds of number that treat all of a list alike. math.hpp says
// what each function computes.
#pragma once

/// Functions of one number that have a derivative wherever they are smooth.
#define MYRIAD_SMOOTH_FUNCTIONS(each)                                                                                  \
    each(sqrt) each(cbrt) each(abs) each(sin) each(cos) each(tan) each(asin) each(acos) each(atan) each(sinpi)         \
        each(cospi) each(sinh) each(cosh) each(tanh) each(exp) each(exp2) each(log) each(log2) each(log10) each(expm1) \
            each(log1p) each(reciprocal) each(rsqrt)
/// Functions of one number that are constant wherever they have a derivative.
#define MYRIAD_STEP_FUNCTIONS(each) each(floor) each(round) each(rint)
/// Functions of two numbers with derivatives by both.
#define MYRIAD_FUNCTIONS_OF_TWO(each) each(pow) each(powr) each(atan2) each(hypot) each(fmod) each(min) each(max)

#define MYRIAD_COMPARISONS(each) each(<) each(<=) each(>) each(>=) each(==) each(!=)
