#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks that a study which is killed or stopped goes on to the same results. Usage: check_run.sh DUFFING_STUDIES
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"
sed -e 's/0\.3, 64/0.3, 512/' -e 's/phases = 8/phases = 400/' -e '2i chunk = 16' "$here/small.toml" >study.toml
"$program" list >models
grep -q '^  states: *x, v$' models || fail 'the model is not listed'
expect 0 '' "$program" run study.toml --store whole --quiet
"$program" export whole whole.csv

# wait_for COUNT FOLDER: until so many chunks are done.
wait_for() {
    local i
    for ((i = 0; i < 3000; i++)); do
        (($(find "$2/myriad/chunks" -name '*.json' 2>/dev/null | wc -l) >= $1)) && return
        sleep 0.01
    done
    fail "there are no $1 chunks in $2"
}
"$program" run study.toml --store killed --quiet >/dev/null 2>&1 &
wait_for 5 killed
kill -9 $!
wait $! 2>/dev/null || true
"$program" info killed >facts
grep -q '^done: .* of 96 chunks' facts || fail 'info says nothing of chunks'
grep -q '^computed by: .*, g++ .*, Myriad .*, on ' facts || grep -q '^computed by: .*, Clang ' facts ||
    fail 'info does not say what computed it'
expect 1 'instances are not computed yet: nothing is written' \
    "$program" export killed part.csv --require-complete
[[ ! -e part.csv ]] || fail 'an incomplete study was exported'
expect 0 'incomplete: .* of 1536 instances are not computed yet' "$program" export killed part.csv
# stopped_by SIGNAL STATUS COUNT: ends with this status when so many chunks are done.
stopped_by() {
    local status=0
    # What a shell starts in the background ignores SIGINT otherwise.
    env --default-signal=INT "$program" resume killed --quiet >/dev/null 2>&1 &
    wait_for "$3" killed
    kill -s "$1" $!
    wait $! || status=$?
    [[ $status == "$2" ]] || fail "a study that SIG$1 stopped ends with $status"
}
stopped_by TERM 143 12
stopped_by INT 130 20
rm study.toml # the folder alone suffices
expect 0 '' "$program" resume killed --quiet
"$program" export killed killed.csv
cmp whole.csv killed.csv || fail 'the results differ'
expect 0 '' "$program" info killed --verify
"$program" resume killed --quiet >again
grep -q '^1536 instances, all done before; ' again || fail 'a finished study says that nothing is done'
expect 0 '' "$program" export killed k.npy --variable k

# Files that are exchanged are not read in silence.
cp killed/x/c.0.0 killed/x/c.1.0
expect 1 'c\.1\.0 is damaged .its checksum is .* in the record' "$program" export killed wrong.csv
expect 1 'damaged: chunk 1, x: ' "$program" info killed --verify
expect 0 '' "$program" resume killed --checksums --quiet
expect 0 '' "$program" info killed --verify
echo 'All checks passed.'
