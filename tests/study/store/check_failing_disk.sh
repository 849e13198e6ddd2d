#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks that an export ends with an error, and the process in good order, whichever call to the disk fails: each write,
# truncation, fsync, closing and renaming of a file in turn, alone or with all that follow.
# Usage: check_failing_disk.sh STUDY_STORE_TEST FAILING_DISK
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export MYRIAD_TEST_FILES=$work
"$1" 'files for other programs are written' >"$work/said" || { cat "$work/said"; exit 1; }
failed=0 failures=0
# fail_at CALL NUMBER CODE: whether there are so many calls.
fail_at() {
    local status=0
    rm -rf "$work/out"
    MYRIAD_FAILING_DISK="$1 $2 $3" LD_PRELOAD=$preloaded "$test" 'an export fails and the process goes on' \
        >"$work/said" 2>&1 || status=$?
    if [[ $status == 0 ]] && grep -q '^exported$' "$work/said"; then return 1; fi
    failures=$((failures + 1))
    if [[ $status == 0 ]] && grep -q "^writing $work/out/run.nc failed: $reason: ." "$work/said"; then return 0; fi
    printf '%s %s: status %s: %s\n' "$1" "$2" "$status" "$(tail -n 5 "$work/said")" >&2
    failed=$((failed + 1))
}
test=$1 preloaded=$2
for call in write truncate fsync close rename; do
    for mode in ' ' +; do
        for error in '28 No space left on device' '5 Input/output error'; do
            reason=${error#* }
            number=1
            while fail_at "$call" "$number$mode" "${error%% *}"; do number=$((number + 1)); done
            ((number > 1)) || { echo "no $call was seen" >&2 && failed=$((failed + 1)); }
        done
    done
done
echo "$failures failures, $failed of them not as they should be"
((failed == 0))
