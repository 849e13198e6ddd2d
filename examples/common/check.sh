# SPDX-License-Identifier: MIT
# What the checks of the example programs share: a folder of their own, expectations, the table and its picture. Sourced
# with the program as first argument, not run.
# shellcheck shell=bash
set -euo pipefail
program=$(realpath "$1")
here=$(dirname "$(realpath "$0")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

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

# check_table FILE ROWS HEADER: a table has this header and as many rows.
check_table() {
    local header
    header=$(sed -n '/^#/!{p;q}' "$1")
    [[ $header == "$3" ]] || fail "$1 has the header $header instead of $3"
    [[ $(grep -vc '^#' "$1") == $(($2 + 1)) ]] || fail "$1 has $(grep -vc '^#' "$1") lines instead of $2 and a header"
}

# rows FILE: the rows of a table, without comments and header.
rows() { grep -v '^#' "$1" | tail -n +2; }

# check_arguments: what every program refuses before it works.
check_arguments() {
    expect 0 '' "$program" --help
    local option
    for option in --instances --phases --device --output --plot --small --quiet; do
        grep -q -- "$option" stdout || fail "--help does not name $option"
    done
    expect 2 'not expected: --bogus' "$program" --bogus
    expect 2 'instances' "$program" --instances 0
    expect 2 'unknown' "$program" --device abacus
    expect 2 'not a regular file' "$program" --output /dev/null
}

# check_full_output ARGUMENT...: what standard output cannot take is an error, whether or not there is a file by then.
check_full_output() {
    expect 3 'standard output cannot be written' bash -c '"$0" "$@" >/dev/full' "$program" "$@"
    expect 2 'standard output cannot be written' bash -c '"$0" --help >/dev/full' "$program"
}

# check_small ROWS HEADER: the size for two cores gives such a table.
check_small() {
    expect 0 '' "$program" --small --quiet --output small.csv
    check_table small.csv "$@"
}

# A Python that has a module.
python_with() {
    local python
    for python in python3 /usr/bin/python3; do
        if "$python" -c "import $1" 2>/dev/null; then
            printf '%s' "$python"
            return
        fi
    done
    return 1
}
plotting_python() { python_with matplotlib; }

# check_plot TABLE [SCRIPT]: the example's script (default plot.py) draws the table, and refuses what is no such table.
check_plot() {
    local python script=$here/${2:-plot.py}
    python=$(plotting_python) || return 0
    expect 0 '' "$python" "$script" "$1" picture.png
    [[ $(head -c 4 picture.png | tail -c 3) == PNG ]] || fail 'no picture'
    expect 2 'No such file' "$python" "$script" missing.csv other.png
    echo a,b >wrong.csv
    expect 2 'has the columns' "$python" "$script" wrong.csv other.png
    [[ ! -e other.png ]] || fail 'a picture of nothing'
}
