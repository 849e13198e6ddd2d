#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks that a study has the same results on one process and on four ranks, also if a rank is killed: by the survivors
# where mpirun lets them go on, otherwise when it is started again. Usage: check.sh MPI_STUDY
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"
mpirun=$here/../common/mpirun.sh
instances=4096

same() {
    local variable
    for variable in k x status; do
        diff -rq "whole/$variable" "$1/$variable" || fail "the results of $1 are others"
    done
}
chunks() { find "$1/myriad/chunks" -name '*.json' 2>/dev/null | wc -l; }

# process_of RANK FOLDER: the number of a rank's process, which has the folder open.
process_of() {
    local writer number
    for writer in "$2"/myriad/writers/*; do
        number=$(basename "$writer" | cut -d '~' -f 4)
        if tr '\0' '\n' <"/proc/$number/environ" 2>/dev/null | grep -qx "OMPI_COMM_WORLD_RANK=$1"; then
            echo "$number"
            return
        fi
    done
    return 1
}

# run_and_kill RANK FOLDER OPTION...: kills the rank when some chunks are done, and waits for the others; sets `status`.
run_and_kill() {
    local rank=$1 folder=$2 i number=
    shift 2
    "$mpirun" -n 4 "$@" "$program" "$folder" "$instances" >"$folder.txt" 2>&1 &
    for ((i = 0; i < 3000; i++)); do
        if (($(chunks "$folder") >= 4)) && number=$(process_of "$rank" "$folder"); then break; fi
        sleep 0.01
    done
    [[ -n $number ]] || fail "rank $rank of $folder is not found"
    kill -9 "$number"
    status=0
    wait $! || status=$?
    if grep -q "^rank $rank of" "$folder.txt"; then fail "rank $rank of $folder was not killed in time"; fi
}

expect 0 '' "$program" whole "$instances"
grep -q "^rank 0 of 1, .*: $instances of $instances instances" stdout || fail 'one process alone has not done all'

# Four ranks, by the job script, with a program in place of SLURM's.
mkdir bin
printf '#!/bin/sh\nwhile [ "${1#--}" != "$1" ]; do shift; done\nexec "%s" -n 4 "$@" duffing_mpi %s\n' \
    "$mpirun" "$instances" >bin/srun
chmod +x bin/srun
ln -s "$program" mpi_study
PATH=$PWD/bin:$PATH sh "$here/job.slurm" >four.txt 2>&1 || fail "four ranks fail: $(<four.txt)"
same duffing_mpi
cmp whole.npy duffing_mpi.npy || fail 'the export is another'
awk -v all="$instances" '/^rank . of 4/ { sum += $6; ranks++ } END { exit !(sum == all && ranks == 4) }' four.txt ||
    fail "four ranks have not divided the instances among themselves: $(<four.txt)"

# As by default: mpirun ends the job, and started again it goes on.
run_and_kill 2 ended
((status != 0)) || fail 'a job whose rank was killed ends well'
before=$(chunks ended)
((before >= 4)) || fail 'chunks were lost'
"$mpirun" -n 4 "$program" ended "$instances" >ended.txt 2>&1 || fail "the second job fails: $(<ended.txt)"
same ended
awk -v most=$(((64 - before) * instances / 64)) '/^rank . of 4/ { sum += $6 } END { exit !(sum <= most) }' ended.txt ||
    fail "the second job has done again what was done: $(<ended.txt)"

# The survivors go on, even without the rank that has the counter.
run_and_kill 0 survived --enable-recovery
if [[ $(mpirun --version) == *"Open MPI) 4."* ]]; then
    ((status == 0)) || fail "the survivors fail: $(<survived.txt)"
    (($(chunks survived) == 64)) || fail 'the survivors have not done all'
    (($(grep -c '; a rank was lost$' survived.txt) == 3)) || fail "not all survivors know it: $(<survived.txt)"
fi
"$mpirun" -n 2 "$program" survived "$instances" >second.txt 2>&1 || fail "the second job fails: $(<second.txt)"
same survived

# What rank 0 finds wrong.
"$mpirun" -n 2 "$program" survived 100 >other.txt 2>&1 && fail 'another study in the folder is not refused'
grep -q '^the folder .* holds the results of another study' other.txt || fail "no reason is given: $(<other.txt)"
echo 'All checks passed.'
