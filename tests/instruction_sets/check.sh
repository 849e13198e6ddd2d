#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks that a program compiled for several instruction sets takes the best that the CPU has, or the one that it is
# told to, with the bits of programs compiled for that one alone, and that its kernels share no function.
# Usage: check.sh ALL AVX2 AVX512 OBJECT...   (programs; objects of ALL)
set -euo pipefail
all=$1
declare -A alone=([avx2]=$2 [avx512]=$3)
shift 3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
    printf 'FAILED: %s\n' "$*" >&2
    exit 1
}

best=
for set in avx2 avx512; do
    if ! "${alone[$set]}" >"$work/$set" 2>"$work/stderr"; then
        grep -q "compiled for $set, which this CPU lacks" "$work/stderr" || fail "$set alone: $(cat "$work/stderr")"
        if MYRIAD_INSTRUCTION_SET=$set "$all" 2>"$work/stderr"; then fail "$set was run on a CPU that lacks it"; fi
        continue
    fi
    [[ $(head -n 1 "$work/$set") == "# $set" ]] || fail "the program for $set says $(head -n 1 "$work/$set")"
    MYRIAD_INSTRUCTION_SET=$set "$all" >"$work/chosen" || fail "$set cannot be chosen"
    cmp "$work/$set" "$work/chosen" || fail "$set gives other results beside other sets than alone"
    best=$set
done
if [[ -z $best ]]; then
    echo 'This CPU has none of the instruction sets.'
    exit 77
fi
"$all" | cmp - "$work/$best" || fail "the best instruction set is $best, and another was taken"
if MYRIAD_INSTRUCTION_SET=mmx "$all" 2>"$work/stderr"; then fail 'a set that there is not was taken'; fi
grep -q 'MYRIAD_INSTRUCTION_SET is "mmx"' "$work/stderr" || fail "no reason: $(cat "$work/stderr")"

# A function that two objects define, and the linker keeps one of, must carry its instruction set in its name: else code
# for AVX-512 may run on any CPU. (That of clang++ only ends the program.)
for object in "$@"; do
    nm -C --defined-only "$object" | awk '$2 == "W"' |
        grep -v 'openmp_\|instruction_set)\|__clang_call_terminate' >"$work/shared" || true
    [[ ! -s $work/shared || $object == *main.cpp* ]] || fail "$object shares functions: $(cat "$work/shared")"
done
echo 'All checks passed.'
