#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks what bad input gets: exit status 2, the place and the key. Usage: check_input.sh DUFFING_STUDIES
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"
cp "$here/small.toml" good.toml

# bad MESSAGE EDIT...: the study after an edit by sed is refused with a message, an extended regular expression.
bad() {
    local message=$1
    shift
    sed "$@" good.toml >bad.toml
    cmp -s good.toml bad.toml && fail "the edit $* changes nothing"
    expect 2 "$message" "$program" run bad.toml
    [[ ! -e results ]] || fail "a study that was refused has left a folder: $*"
}
bad '^bad\.toml:17:1: options\.relative_tolerence: there is no such key: did you mean "relative_tolerance"\?$' \
    -e 's/relative_tolerance/relative_tolerence/'
bad '^bad\.toml:18:37: options\.record\.states: "y" is no component of duffing' -e 's/"x"\]}/"y"]}/'
bad '^bad\.toml:4:1: store: must be a string, and is an integer' -e 's/"results"/5/'
bad '^bad\.toml:16:1: options\.phases: must be a whole number, and is a string' -e 's/= 8/= "8"/'
bad '^bad\.toml:16:1: options\.phases: must be a whole number, and is 8\.5' -e 's/= 8/= 8.5/'
bad '^bad\.toml:8:6: axes\.k\.linspac: no axis is made in this way: did you mean "linspace"\?' -e 's/linspace/linspac/'
bad '^bad\.toml:8:6: axes\.k: must be \[first, last, number of values\]' -e 's/, 64\]/]/'
bad '^bad\.toml:12:1: set\.BB: "BB" is no component of duffing .*: did you mean "B"\?' -e 's/^B = /BB = /'
bad '^bad\.toml:10:2: parameter\.k has no value in any instance' -e '/^k = /d'
bad '^bad\.toml:17:1: relative_tolerance is -1e-0?9 \(must be ' -e 's/1e-9/-1e-9/'
bad '^bad\.toml:18:11: record\.from_phase is 40' -e 's/from_phase = 4/from_phase = 40/'
bad '^bad\.toml:21:8: keep\.end: "w" is no component of duffing' -e 's/"v", "t"/"w"/'
bad '^bad\.toml:5:1: time_domain: must be \[t_begin, t_end\]' -e 's/, "2 pi"//'
bad '^bad\.toml:5:19: time_domain: must be a number, and is the string "2 pie"' -e 's/2 pi/2 pie/'
bad '^bad\.toml:3:1: model: this program has no model "dufing": did you mean "duffing"\?' -e 's/"duffing"/"dufing"/'
bad '^bad\.toml:2:1: method: duffing was not compiled for cash_krap: did you mean "cash_karp"\?' \
    -e '2i method = "cash_krap"'
bad '^bad\.toml:2:1: devices: .*"gpu"' -e '2i devices = "gpu"'
bad '^bad\.toml:11:' -e 's/^\[set\]/[set/'
bad '^bad\.toml:9:1: axes\.k: paired axes have different lengths' \
    -e 's/^\[axes\]/[[axes]]/' -e '/^k = /{h;d}' -e '/^x = /{G}'
bad '^bad\.toml:10:1: axes\.k: parameter\.k is given twice' -e '/^k = /{p;s/^/[[axes]]\n/}' -e 's/^\[axes\]/[[axes]]/'
bad '^bad\.toml:18:1: reduce\.minimum: there is no such key: did you mean "minimum_of"\?' \
    -e '17i [[reduce]]\nminimum = "x"'
bad '^bad\.toml:22:1: reduce\.quantiles_of: needs quantiles' \
    -e '$a [[reduce]]\nquantiles_of = "x"\nedges = {linspace = [-2, 2, 9]}'
bad 'reduce\.quantiles: are for quantiles_of alone' \
    -e '$a [[reduce]]\nhistograms_of = "x"\nquantiles = [0.5]\nedges = {linspace = [-2, 2, 9]}'
bad 'reduce\.edges: a quantile of x is 50 \(must be from 0 to 1\)' \
    -e '$a [[reduce]]\nquantiles_of = "x"\nquantiles = [50]\nedges = {linspace = [-2, 2, 9]}'
bad '^bad\.toml:4:1: the .* chunks .*(free|disk)' -e 's/0\.3, 64/0.3, 1e11/' 
bad '^bad\.toml:4:1: .*is not empty and holds no study' -e 's/"results"/"."/'
sed 's/^k = .*/k = "2 pi"/' good.toml >bad.toml
expect 2 'bad\.toml:8:1: axes\.k: must be an array of values' "$program" run bad.toml
expect 2 'none\.toml: there is no such file' "$program" run none.toml
expect 2 '^\.: is a folder' "$program" run .
expect 2 '^/dev/null: is a device or a pipe' "$program" run /dev/null
bad '^bad\.toml:5:.*t_begin is set to inf' -e 's/\[0, "2 pi"/[inf, "2 pi"/'
expect 2 'folder' "$program" resume none
expect 2 'folder' "$program" info none

# Every option that the program shows is one that files may have.
"$program" options >shown || fail 'options are not shown'
options=$(sed -n 's/^\([a-z_]*\) (.*/\1/p' shown)
[[ $(wc -w <<<"$options") -gt 20 ]] || fail 'few options are shown'
for option in $options; do
    [[ $option == samples ]] && continue  # for which a method dense<...> is looked for first
    sed -e "/^$option = /d" -e "/^\[options\]/a $option = \"nonsense\"" good.toml >bad.toml
    expect 2 "options\.$option: " "$program" run bad.toml
    grep -q 'there is no such key' stderr && fail "no file may have $option"
done

# Reductions of each phase.
sed -e 's/"results"/"reduced"/' \
    -e '$a [[reduce]]\nhistograms_of = "x"\nquantiles_of = "x"\nquantiles = [0.5]\nedges = {linspace = [-2, 2, 9]}' \
    good.toml >reduced.toml
expect 0 '' "$program" run reduced.toml --quiet
"$program" info reduced >shown
for name in x_histograms x_histograms_outside x_quantiles; do grep -q "$name" shown || fail "there is no $name"; done

# A study of which nothing can be integrated, since nothing ends its phases.
sed -e 's/"2 pi"/inf/' -e 's/"results"/"invalid"/' good.toml >invalid.toml
expect 2 'all 192 instances are invalid_input' "$program" run invalid.toml --quiet
expect 2 'all 192 instances are invalid_input' "$program" resume invalid --quiet

# Another study in the same folder: what differs, and where.
expect 0 '' "$program" run good.toml --quiet
sed 's/1e-9/1e-8/' good.toml >other.toml
expect 2 '^other\.toml:17:1: .*another study' "$program" run other.toml
grep -q 'options\.relative_tolerance: \[1e-09\] in the store, \[1e-08\] here' stderr || fail 'what differs is not said'
sed 's/0\.3, 64/0.3, 65/' good.toml >other.toml
expect 2 '^other\.toml:7:2: .*another study' "$program" run other.toml
expect 2 'must end in \.nc' "$program" export results x.txt
expect 2 'there is no variable' "$program" export results x.npy --variable y
expect 2 '' "$program" frobnicate
[[ -s stderr ]] || fail 'no message for an unknown command'
echo 'All checks passed.'
