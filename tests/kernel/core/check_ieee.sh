#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks that kernel/core/ieee.hpp refuses, at compile time or at the start, every part of -ffast-math that the compiler
# has, and nothing else.
# Usage: check_ieee.sh COMPILER INCLUDE
set -uo pipefail
compiler=$1 include=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat >"$work/main.cpp" <<'END'
#include "myriad/kernel/core/ieee.hpp"
int main() { return myriad::detail::computes_as_written() ? 0 : 3; }
END
failures=0

# judge EXPECTED FLAG...: what comes of the flags; "refused" or "taken".
judge() {
    local expected=$1 found
    shift
    if ! "$compiler" -std=c++20 "$@" -x c++ -E /dev/null -o /dev/null 2>/dev/null; then
        echo "skipped $*: the compiler does not know it"
        return
    fi
    if ! "$compiler" -std=c++20 -O2 -I "$include" "$@" "$work/main.cpp" -o "$work/main" 2>"$work/said"; then
        found="compile error"
        grep -q 'Myriad is compiled with -ffast-math' "$work/said" && found=refused
    else
        "$work/main"
        case $? in 0) found=taken ;; 3) found=refused ;; *) found="exit status $?" ;; esac
    fi
    if [[ $found == "$expected" ]]; then
        echo "ok      $*: $found"
    else
        echo "FAILED  $*: $found (expected $expected)"
        failures=$((failures + 1))
    fi
}

judge taken -O2
judge taken -fno-math-errno -ffp-contract=off
judge taken -ffast-math -fno-fast-math
judge refused -ffast-math
judge refused -Ofast
judge refused -ffinite-math-only
judge refused -funsafe-math-optimizations
judge refused -fassociative-math -fno-signed-zeros -fno-trapping-math
judge refused -freciprocal-math
judge refused -fno-honor-nans
judge refused -ffp-model=fast
exit $((failures > 0))
