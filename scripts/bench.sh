#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds and runs the CPU benchmark beside Boost.odeint, writes results/bench_<compiler>.csv and prints it as a table.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=scripts/lib.sh
source scripts/lib.sh

usage() {
    cat <<'END'
Usage: scripts/bench.sh [--compiler NAME] [--quick | --check] [--help]

Installs the packages that are missing (as root or with sudo), builds the benchmark in build/bench-NAME,
runs it, writes results/bench_NAME.csv and prints it as a table. See benchmarks/README.md.

Options:
  --compiler NAME  compiler, g++ (default) or clang++
  --quick          fewer instances and repetitions
  --check          only check what is promised of Myriad's speed; exit status 1 if it is not kept
  --help           this text
END
}

compiler=g++
arguments=()
check=no
while (($#)); do
    case $1 in
        --help | -h) usage; exit 0 ;;
        --compiler)
            [[ ${2:-} == *g++* || ${2:-} == *clang++* ]] || usage_error "--compiler needs g++ or clang++"
            compiler=$2
            shift ;;
        --quick) arguments+=(--quick) ;;
        --check) check=yes arguments+=(--check) ;;
        *) usage_error "Unknown option '$1'" ;;
    esac
    shift
done

started=$SECONDS
packages=(g++ cmake ninja-build libeigen3-dev libxsimd-dev libcli11-dev libboost-dev)
if [[ $compiler == *clang++* ]]; then packages+=(clang libomp-dev); fi
require_packages "${packages[@]}"
has_command "$compiler" || fail "There is no $compiler on the PATH."

name=$(basename "$compiler")
build=build/bench-$name
say "Building the benchmark in $build"
# No contraction in Myriad's own code, so that results do not depend on the width of the packs; the peers may contract.
quietly "$build/configure.log" cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" \
    -DMYRIAD_BUILD_TESTS=OFF -DMYRIAD_BUILD_EXAMPLES=OFF -DMYRIAD_BUILD_VALIDATION=OFF -DMYRIAD_BUILD_BENCHMARKS=ON \
    -DMYRIAD_ARCH=native -DMYRIAD_FP_CONTRACT=off || fail "The configuration failed, see above."
quietly "$build/build.log" cmake --build "$build" --target cpu_peers --parallel "$(nproc)" || fail "The build failed, see above."

# Threads that wait must not take the cores from those that work.
export OMP_WAIT_POLICY=passive
if [[ $check == yes ]]; then
    "$build/benchmarks/cpu_peers/cpu_peers" "${arguments[@]}"
    exit
fi

output=results/bench_$name.csv
mkdir -p results
say "Running the benchmark to $output"
status=0
"$build/benchmarks/cpu_peers/cpu_peers" "${arguments[@]}" >"$output.part" || status=$?
if ((status > 1)); then
    rm -f "$output.part"
    fail "The benchmark failed." "$status"
fi
mv "$output.part" "$output"

grep '^#' "$output" || true
awk -F, '!/^#/ { printf "%-24s %-16s %9s %10s %8s %8s %9s %13s %7s\n", $1, $2, $4, $5 == "milliseconds" ? "ms" : $5,
                 $6 == "nanoseconds_per_step" ? "ns/step" : $6, $7 == "ratio_to_odeint" ? "ratio" : $7,
                 $8 == "max_difference" ? "max_diff" : $8, $9, $10 == "idle_lanes" ? "idle" : $10 }' "$output"
if ((status)); then fail "Instances failed or results are wrong, see above."; fi
say "Done after $(duration $((SECONDS - started))): $output"
