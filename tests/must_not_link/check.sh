#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks that two models of one name are found: in two files by the linker, in a file and the program by the program.
# Usage: MYRIAD_LIBRARY=FILE check.sh COMPILER [FLAG...]
set -euo pipefail
here=$(dirname "$(realpath "$0")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LC_ALL=C

fail() {
    printf 'FAILED: %s\n' "$*" >&2
    exit 1
}
# compile SOURCE OBJECT [FLAG...]: one instance at a time, which takes a fraction of the time.
compile() { "${command[@]}" -DMYRIAD_SCALAR_LANES -O1 "${@:3}" -c "$here/$1" -o "$work/$2"; }
# link PROGRAM OBJECT...
link() { (cd "$work" && "${command[@]}" "${@:2}" "$MYRIAD_LIBRARY" -o "$1"); }

command=("$@")
compile one.cpp one.o
compile other.cpp other.o
compile main.cpp two.o -DMYRIAD_TEST_STATES=2
compile main.cpp three.o -DMYRIAD_TEST_STATES=3

link fits one.o two.o || fail 'a model and its program are not linked'
"$work/fits" >"$work/output" || fail "a model and its program do not run: $(<"$work/output")"

if link both one.o other.o two.o 2>"$work/output"; then fail 'two models of one name are linked'; fi
grep -q 'multiple definition.*instantiated_in_one_file_alone<.*oscillator' "$work/output" ||
    fail "not for the reason expected: $(<"$work/output")"

link differs one.o three.o || fail 'not linked'
status=0
"$work/differs" >"$work/output" || status=$?
((status == 3)) || fail "status $status of a program whose model has more components: $(<"$work/output")"
grep -q 'with other numbers of components' "$work/output" || fail "no reason: $(<"$work/output")"
echo 'All checks passed.'
