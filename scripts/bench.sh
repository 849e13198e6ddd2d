#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds and runs the CPU benchmark against Boost.odeint and CVODE, writes results/bench_<compiler>.csv and a plot of
# it, and prints it as a table.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=scripts/lib.sh
source scripts/lib.sh

usage() {
    cat <<'END'
Usage: scripts/bench.sh [--compiler NAME] [--arch LIST] [--threads LIST] [--deps DIR] [--quick | --check] [--help]

Installs the packages that are missing (as root or with sudo), builds the benchmark in build/bench-NAME-ARCH, runs it,
writes results/bench_NAME.csv and .png and prints the table. See benchmarks/README.md. CVODE takes part if SUNDIALS 6 or
7 is installed or in DIR/sundials; then there is results/bench_stiff_NAME_ARCH.csv, too.

Options:
  --compiler NAME  compiler, g++ (default) or clang++
  --arch LIST      instruction sets of models and peers, as in -march=, comma-separated: native (default),
                   x86-64-v3, ...
  --threads LIST   numbers of threads to show the scaling with, comma-separated, such as 1,2,4,8,16 (default: not shown)
  --deps DIR       folder with what is not installed: DIR/xsimd, DIR/CLI, DIR/sundials (default: .deps, if it is there)
  --quick          fewer instances and repetitions, no growth with the number of instances
  --check          only check what is promised of Myriad's speed; exit status 1 if it is not kept
  --help           this text
END
}

compiler=g++
archs=(native)
threads=
deps=.deps
arguments=()
check=no
quick=no
while (($#)); do
    case $1 in
        --help | -h) usage; exit 0 ;;
        --compiler)
            [[ ${2:-} == *g++* || ${2:-} == *clang++* ]] || usage_error "--compiler needs g++ or clang++"
            compiler=$2
            shift ;;
        --arch)
            [[ -n ${2:-} && $2 != -* ]] || usage_error "--arch needs instruction sets, such as native,x86-64-v3"
            IFS=, read -ra archs <<<"$2"
            shift ;;
        --threads)
            [[ ${2:-} =~ ^[1-9][0-9]*(,[1-9][0-9]*)*$ ]] || usage_error "--threads needs numbers, such as 1,2,4"
            threads=$2
            shift ;;
        --deps)
            [[ -d ${2:-} ]] || usage_error "--deps needs a folder"
            deps=$2
            shift ;;
        --quick) quick=yes arguments+=(--quick) ;;
        --check) check=yes arguments+=(--check) ;;
        *) usage_error "Unknown option '$1'" ;;
    esac
    shift
done

started=$SECONDS
packages=(g++ cmake ninja-build libeigen3-dev libboost-dev)
options=()
if [[ -d $deps/xsimd ]]; then
    options+=("-DMYRIAD_XSIMD_INCLUDE_DIR=$(realpath "$deps")")
else
    packages+=(libxsimd-dev)
fi
if [[ -d $deps/CLI ]]; then
    options+=("-DMYRIAD_CLI11_INCLUDE_DIR=$(realpath "$deps")")
else
    packages+=(libcli11-dev)
fi
if [[ -d $deps/sundials ]]; then options+=("-DSUNDIALS_ROOT=$(realpath "$deps/sundials")"); fi
if [[ $compiler == *clang++* ]]; then packages+=(clang libomp-dev); fi
require_packages "${packages[@]}"
has_command "$compiler" || fail "There is no $compiler on the PATH."
name=$(basename "$compiler")

# Waiting threads must not take cores from working ones.
export OMP_WAIT_POLICY=passive
if [[ -d $deps/sundials ]]; then export LD_LIBRARY_PATH="$deps/sundials/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"; fi

# build ARCH: sets `program`, and `stiff_program`, which is there if CVODE is. No contraction in Myriad's own code, so
# that results do not depend on the width of the packs; the other libraries may contract.
build() {
    local folder=build/bench-$name-$1
    say "Building the benchmark in $folder"
    quietly "$folder/configure.log" cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release \
        -DCMAKE_CXX_COMPILER="$compiler" -DMYRIAD_BUILD_TESTS=OFF -DMYRIAD_BUILD_EXAMPLES=OFF \
        -DMYRIAD_BUILD_VALIDATION=OFF -DMYRIAD_BUILD_BENCHMARKS=ON -DMYRIAD_BENCHMARK_HIGH_ORDER=ON \
        -DMYRIAD_ARCH="$1" -DMYRIAD_FP_CONTRACT=off ${options[@]+"${options[@]}"} ||
        fail "The configuration failed, see above."
    local targets=(cpu_peers)
    if grep -q '^MYRIAD_SUNDIALS_cvode:FILEPATH=/' "$folder/CMakeCache.txt"; then targets+=(stiff_peers); fi
    quietly "$folder/build.log" cmake --build "$folder" --target "${targets[@]}" --parallel "$(nproc)" ||
        fail "The build failed, see above."
    program=$folder/benchmarks/cpu_peers/cpu_peers
    stiff_program=$folder/benchmarks/stiff_peers/stiff_peers
}

output=results/bench_$name.csv
worst=0
# measure OPTION...: adds the rows of one run to the output; the names of the columns only once.
measure() {
    local status=0
    "$program" "$@" >"$output.run" || status=$?
    if ((status > 1)); then
        rm -f "$output.run" "$output.part"
        fail "The benchmark failed." "$status"
    fi
    if ((status > worst)); then worst=$status; fi
    if [[ -s $output.part ]]; then sed -i '/^case,implementation,/d' "$output.run"; fi
    cat "$output.run" >>"$output.part"
    rm "$output.run"
}

mkdir -p results
rm -f "$output.part"
for arch in "${archs[@]}"; do
    build "$arch"
    if [[ $check == yes ]]; then
        "$program" "${arguments[@]}" || worst=$?
        continue
    fi
    say "Running the benchmark for $arch to $output"
    measure ${arguments[@]+"${arguments[@]}"}
    measure --equal-error --repetitions 3 ${arguments[@]+"${arguments[@]}"}
    if [[ $quick == no ]]; then
        measure --cases lorenz_rk4 --implementations odeint,myriad --repetitions 3 \
            --instances 1,4,16,64,256,1024,4096,16384,65536
    fi
    if [[ -x $stiff_program ]]; then
        say "Running stiff_peers for $arch to results/bench_stiff_${name}_$arch.csv"
        "$stiff_program" | tee "results/bench_stiff_${name}_$arch.csv" || worst=$?
    fi
    # The same number of instances for every number of threads, enough for the largest.
    if [[ -n $threads ]]; then
        measure --implementations myriad --repetitions 3 --threads "$threads" --instances-scale "${threads##*,}"
    fi
done
if [[ $check == yes ]]; then exit "$worst"; fi
mv "$output.part" "$output"

grep '^#' "$output" | awk '!seen[$0]++' || true
awk -F, '!/^#/ { printf "%-36s %-19s %-7s %3s %7s %7s %10s %8s %7s %7s %9s %7s %6s\n",
                 $1, $2, $4 == "instruction_set" ? "set" : $4,
                 $5 == "threads" ? "thr" : $5, $6 == "instances" ? "N" : $6, $7 == "tolerance" ? "tol" : $7,
                 $8 == "milliseconds" ? "ms" : $8, $10 == "nanoseconds_per_step" ? "ns/step" : $10,
                 $11 == "ratio_to_odeint" ? "odeint" : $11, $12 == "ratio_to_cvode" ? "cvode" : $12,
                 $14 == "median_difference" ? "med_diff" : $14, $16 == "idle_lanes" ? "idle" : $16,
                 $17 == "fma_peak_share" ? "fma" : $17 }' "$output"
if ((worst)); then fail "Instances failed or results are wrong, see above."; fi
if python=$(plotting_python); then
    "$python" benchmarks/cpu_peers/plot.py "$output" "${output%.csv}.png"
else
    say "No picture, as there is no Python with matplotlib (Debian, Ubuntu: python3-matplotlib)"
fi
say "Done after $(duration $((SECONDS - started))): $output"
