#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the program `duffing` and its plot: exit statuses, messages, the file's form, and that no half-written file stays.
# Usage: check.sh PROGRAM
set -euo pipefail
program=$(realpath "$1")
plot=$(dirname "$(realpath "$0")")/plot.py
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
small=(--instances 40 --transient 3 --recorded 2)

fail() {
    printf 'FAILED: %s\n' "$*" >&2
    exit 1
}

# expect STATUS MESSAGE COMMAND...: MESSAGE is an extended regular expression for what is written to stderr.
expect() {
    local wanted=$1 message=$2 status=0
    shift 2
    "$@" >stdout 2>stderr || status=$?
    [[ $status == "$wanted" ]] || fail "exit status $status instead of $wanted: $* ($(<stderr))"
    [[ $(<stderr) =~ $message ]] || fail "no '$message' on stderr: $* ($(<stderr))"
    [[ -z $(find . -name '*.part') ]] || fail "a temporary file is left: $*"
}

expect 0 'Integrating 40 instances' "$program" "${small[@]}" --device cpu --output new/table.csv
grep -q '40 success' stdout || fail 'no report'
[[ $(grep -vc '^#' new/table.csv) == 81 ]] || fail 'a header and 80 rows were expected'
[[ $(grep -v '^#' new/table.csv | head -n 1) == instance,phase,k,B,x,v,x_local_max,v_second_zero,x_global_max,zeros,status ]] ||
    fail 'wrong header'
[[ $(tail -n 1 new/table.csv) == 39,4,0.3,0.3,*,success ]] || fail 'wrong last row'
if grep -v '^#' new/table.csv | grep -q nan; then fail 'values are missing'; fi

expect 0 '' "$program" "${small[@]}" --output one.csv --device cpu:1 --quiet
[[ ! -s stdout && ! -s stderr ]] || fail '--quiet is not quiet'
cmp one.csv new/table.csv || fail 'the result depends on the number of threads'

if ! nvidia-smi -L >/dev/null 2>&1; then
    expect 2 'device "cuda" is not available: .*use "cpu" or "auto"' "$program" "${small[@]}" --device cuda --output no.csv
    [[ ! -e no.csv ]] || fail 'a file without a result'
    expect 0 'Computing on cpu.*; no GPU: ' "$program" "${small[@]}" --output auto.csv
    cmp one.csv auto.csv || fail 'the result without a GPU is not that of the CPU'
fi

expect 2 'not expected: --bogus' "$program" --bogus
expect 2 'instances' "$program" --instances 0
expect 2 'recorded' "$program" --recorded many
expect 2 'unknown' "$program" --device abacus
expect 2 'no file name' "$program" --output ''
expect 2 'not a regular file' "$program" --output /dev/null
expect 2 'folder cannot be created' "$program" --output no/such/folder/table.csv
expect 2 'MB are needed' "$program" --instances 100000000 --recorded 100000000
echo old >old.csv
expect 2 'File too large' bash -c "ulimit -f 2; exec '$program' --instances 400 --transient 1 --recorded 2 --output old.csv"
[[ $(<old.csv) == old ]] || fail 'a file of an earlier run was harmed'

for python in python3 /usr/bin/python3; do
    "$python" -c 'import matplotlib' 2>/dev/null || continue
    expect 0 '' "$python" "$plot" new/table.csv pictures/table.png
    [[ $(head -c 4 pictures/table.png | tail -c 3) == PNG ]] || fail 'no picture'
    expect 2 'No such file' "$python" "$plot" missing.csv picture.png
    expect 2 'has the columns' "$python" "$plot" old.csv picture.png
    : >empty.csv
    expect 2 'is empty' "$python" "$plot" empty.csv picture.png
    [[ ! -e picture.png ]] || fail 'a picture of nothing'
    break
done
echo 'All checks passed.'
