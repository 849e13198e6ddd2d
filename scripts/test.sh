#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what is missing, builds Myriad in all configurations that CI uses, and runs the tests.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=scripts/lib.sh
source scripts/lib.sh

all_steps=(ci programs python docs cuda strict asan tsan clang)
usual_steps=(ci python)
full_steps=(ci programs python docs cuda asan tsan)

usage() {
    cat <<'END'
Usage: scripts/test.sh [--quick] [--full] [--all] [--only STEP,...] [--jobs N] [--help]

Installs the packages that are missing (as root or with sudo), builds and runs the tests.
Its last line is "N passed, N failed"; the exit status is 0 if none failed.

Steps that run without options: what shows that a build is right.
  ci        g++, release, warnings are errors: the tests of the library, but for those of programs
  python    the Python package: its wheel is built, installed in a fresh virtual environment, and tested (skipped where
            the packages of PyPI that it is built with cannot be installed)

With --full, python runs all its tests, also those that take long and those with other packages, JAX and Dask among
them, and there are these steps. All run in the order ci, programs, python, and then as they stand here.
  programs  in the build of ci: examples, a benchmark beside peers, validation, projects outside that use the library,
            headers by themselves, what must not compile, compile times, derivatives of models, the texts of docs
  docs      the documentation as a site: warnings are errors, links within it lead somewhere (skipped where Sphinx
            cannot be installed)
  cuda      the tests' kernels compile for one GPU and as PTX, some within limits of registers and stack; a program with
            both backends runs without a GPU (skipped without nvcc)
  asan      address and undefined-behaviour sanitizer
  tsan      thread sanitizer

With --all every model, kernel, method, header, benchmark, case study and way to install is built and checked, kernels
as users have them, and there are these steps too.
  strict    all models in packs, for AVX2: events, output and reductions; scalar lanes and packs agree bit for bit
  clang     clang++, warnings are errors

Options:
  --quick          only ci
  --full           what continuous integration runs
  --all            all of them, thoroughly
  --only STEP,...  only these
  --jobs N         processes at a time (default: number of cores)
  --help           this text
END
}

steps=("${usual_steps[@]}")
thorough=OFF
other_packages=no
jobs=$(nproc)
while (($#)); do
    case $1 in
        --help | -h) usage; exit 0 ;;
        --quick) steps=(ci) ;;
        --full) steps=("${full_steps[@]}") other_packages=yes ;;
        --all) steps=("${all_steps[@]}") other_packages=yes thorough=ON ;;
        --only)
            (($# > 1)) || usage_error "--only needs steps: ${all_steps[*]}"
            IFS=, read -r -a wanted <<<"$2"
            ((${#wanted[@]})) || usage_error "--only needs steps: ${all_steps[*]}"
            for step in "${wanted[@]}"; do
                [[ " ${all_steps[*]} " == *" $step "* ]] ||
                    usage_error "There is no step '$step': choose from ${all_steps[*]}"
            done
            steps=()
            for step in "${all_steps[@]}"; do
                [[ " ${wanted[*]} " == *" $step "* ]] && steps+=("$step")
            done
            shift ;;
        --jobs)
            [[ ${2:-} =~ ^[1-9][0-9]*$ ]] || usage_error "--jobs needs a positive number"
            jobs=$2
            shift ;;
        *) usage_error "Unknown option '$1'" ;;
    esac
    shift
done
wants() { [[ " ${steps[*]} " == *" $1 "* ]]; }

packages=(g++ cmake ninja-build python3 libeigen3-dev libxsimd-dev catch2 libnetcdf-dev nlohmann-json3-dev)
if wants ci || wants programs || wants cuda || wants clang; then
    packages+=(libboost-dev libcli11-dev libopenmpi-dev libsundials-dev libtomlplusplus-dev openmpi-bin
        python3-matplotlib python3-scipy python3-netcdf4 python3-xarray)
fi
if wants ci || wants docs; then packages+=(doxygen); fi
if wants docs || wants python; then packages+=(python3-venv); fi
if wants python; then packages+=(python3-dev); fi
if wants clang || wants tsan; then packages+=(clang libomp-dev); fi
if wants tsan; then packages+=(libclang-rt-dev); fi

started=$SECONDS
passed=0
failed=0
summary=()
times_of_steps=()

# The tests of preset ci that belong to step programs, by their labels.
programs='^(benchmarks|compile_time|derivatives|docs|examples|headers|install|must_not_compile|validation)$'

# build STEP PRESET: sets `built`.
build() {
    local step=$1 preset=$2 options=() targets=()
    if [[ $thorough == ON ]]; then options+=(-DMYRIAD_THOROUGH=ON); fi
    if [[ $step == ci ]]; then targets=(--target tests/all); fi
    built=yes
    quietly "build/$preset/configure.log" cmake --preset "$preset" "${options[@]}" &&
        quietly "build/$preset/build-$step.log" \
            cmake --build --preset "$preset" --parallel "$jobs" "${targets[@]}" -- -k 0 || built=no
}

# The files whose kernels are compiled for GPUs without --all: one for each feature that the kernels in tests/cuda lack.
features=(dae function_values hooked_steps jumps queued random_draws stiff_tangents tangent_jumps with_events)

# The programs that test both backends in one program without a GPU, and with --all every kernel, for GPUs alone
# (tests/cuda/budgets.cu has the benchmarks' kernels, and scripts/case_studies.sh builds the case studies).
build_kernels() {
    local chosen
    chosen=(--except build/cuda/single_lanes.txt --files "/($(IFS='|' && echo "${features[*]}"))_[0-9a-f]+\\.cu")
    if [[ $thorough == ON ]]; then chosen=(); fi
    quietly build/cuda/configure.log \
        cmake --preset cuda -DMYRIAD_CUDA_ARCHITECTURES=90 -DMYRIAD_BUILD_VALIDATION=OFF \
        -DMYRIAD_THOROUGH="$thorough" &&
        quietly build/cuda/build.log \
            cmake --build --preset cuda --parallel "$jobs" --target solver_test duffing -- -k 0 &&
        quietly build/cuda/kernels.log tests/cuda/compile_kernels.py build/cuda --jobs "$jobs" "${chosen[@]}"
}

# The files that took longest to compile, as a budget to keep an eye on.
slowest_files() {
    local log=build/$1/.ninja_log
    [[ -r $log ]] || return 0
    awk -F'\t' '$4 ~ /\.o$/ { seconds = ($2 - $1) / 1000; if (seconds > most[$4]) most[$4] = seconds }
                END { for (file in most) printf "%.0f s %s\n", most[file], file }' "$log" | sort -rn |
        sed -nE 's|CMakeFiles/[^/]*\.dir/||; s|^|   slow to compile: |; 1,3p'
}

# Registers, stack and spills of every kernel that the tests compile.
kernel_table() {
    local log=build/cuda/Testing/Temporary/LastTest.log
    [[ -r $log ]] || return 0
    sed -nE 's/^(.*): ([0-9]+) registers, stack ([0-9]+), spill ([0-9]+).*/\2 \3 \4 \1/p' "$log" |
        sed -E 's/myriad:://g; s/, \(shared_placement\)1>$/>/' | sort -u -k4 |
        awk 'BEGIN { print "   registers stack spill kernel" }
             { printf "   %9s %5s %5s", $1, $2, $3; $1 = $2 = $3 = ""; print substr($0, 3) }'
}

# run_tests STEP PRESET [CTEST ARGUMENT...]: sets `result` and adds to the counts.
run_tests() {
    local step=$1 preset=$2 log=build/$2/tests-$1.log status=0 counts
    shift 2
    ctest --preset "$preset" --parallel "$jobs" "$@" </dev/null 2>&1 | tee "$log" |
        sed -nE '/\*\*\*|^(Errors|The following)|^[[:space:]]+[0-9]+ - |tests passed,/p' || status=$?
    read -r -a counts < <(count_tests "$log" "$status")
    passed=$((passed + counts[0]))
    failed=$((failed + counts[1]))
    result="${counts[0]} passed, ${counts[1]} failed"
    if ((counts[2])); then result+=", ${counts[2]} skipped"; fi
    if ((counts[1])); then
        printf '%s\n' "--- output of the tests that failed, from $log ---"
        awk '/Test +#[0-9]+: .*(Passed|Skipped) +[0-9.]+ sec/ || /tests passed,/ { shown = 0 }
             /Test +#[0-9]+: .*\*\*\*/ { shown = 1 }
             shown && !/^ +Start +[0-9]+:/ && ++lines <= 400' "$log"
    fi
}

# hold_budget STEP COMPUTED CLOCK: adds a line to the table of times. A step that computes for longer than its budget is
# a failure. The clock is not asked, since it depends on what else the machine does.
hold_budget() {
    local name=$1 budget
    if [[ $1 == python && $other_packages == yes ]]; then name=python_full; fi
    budget=$(budget_of "$name")
    if [[ $thorough == ON ]]; then budget=; fi
    times_of_steps+=("$(printf '%-9s %9d %9d %9s' "$1" "$2" "$3" "${budget:--}")")
    if [[ -n $budget ]] && (($2 > budget)); then
        failed=$((failed + 1))
        summary+=("$1: FAILED, it computed for $2 s, and its budget in scripts/budgets.txt is $budget s")
        say "${summary[-1]}"
    fi
}

run_step() {
    local step=$1 begin=$SECONDS result=""
    say "$step"
    mkdir -p build build/cuda
    case $step in
        docs)
            local status=0
            quietly build/docs.log scripts/docs.sh || status=$?
            if ((status == 77)); then
                say "docs: skipped, $(tail -n 1 build/docs.log)"
                summary+=("docs: SKIPPED, the site was not built: see build/docs.log")
                return
            elif ((status)); then
                failed=$((failed + 1)) result="failed"
            else
                passed=$((passed + 1)) result="$(tail -n 2 build/docs.log | head -n 1)"
            fi ;;
        python)
            local status=0 log=build/python.log
                    local more=()
            if [[ $other_packages == yes ]]; then more=(--others --full); fi
            if [[ $thorough == ON ]]; then more+=(--all); fi
            more+=(--durations=40)
            quietly "$log" scripts/python.sh "${more[@]}" || status=$?
            if ((status == 77)); then
                say "python: skipped, $(tail -n 1 "$log")"
                summary+=("python: SKIPPED, the package was not tested: see $log")
                return
            fi
            result=$(tail -n 1 "$log")
            if [[ $result =~ ([0-9]+)\ passed ]]; then passed=$((passed + BASH_REMATCH[1])); fi
            if [[ $result =~ ([0-9]+)\ failed ]]; then
                failed=$((failed + BASH_REMATCH[1]))
            elif ((status)); then
                failed=$((failed + 1)) result="failed"
            fi ;;
        cuda)
            if ! has_command nvcc; then
                say "cuda: skipped, nvcc is not on the PATH"
                summary+=("cuda: skipped, nvcc is not on the PATH")
                return
            fi
            if build_kernels; then
                run_tests cuda cuda --label-regex '^(cuda|solver|without_gpu)$'
                kernel_table
            else
                failed=$((failed + 1)) result="build failed"
            fi ;;
        *)
            local built preset=$step tests=()
            case $step in
                ci) tests=(--label-exclude "^cuda$|$programs") ;;
                programs) preset=ci tests=(--label-regex "$programs") ;;
            esac
            build "$step" "$preset"
            if [[ $built == yes || -e build/$preset/build.ninja ]]; then
                if [[ $step == ci ]]; then slowest_files ci; fi
                run_tests "$step" "$preset" "${tests[@]}"
            fi
            if [[ $built == no ]]; then
                failed=$((failed + 1))
                result="build failed${result:+, $result}"
            fi ;;
    esac
    summary+=("$step: $result ($(duration $((SECONDS - begin))))")
    say "${summary[-1]}"
}

require_packages "${packages[@]}"
mkdir -p build
for step in "${steps[@]}"; do
    read_computed
    computed_before=$computed begun=$SECONDS
    run_step "$step"
    read_computed
    hold_budget "$step" $((computed - computed_before)) $((SECONDS - begun))
done

say "Summary, after $(duration $((SECONDS - started)))"
printf '   %s\n' "${summary[@]}"
printf '   seconds:  processor     clock    budget\n'
printf '   %s\n' "${times_of_steps[@]}"
printf '%d passed, %d failed\n' "$passed" "$failed"
((failed == 0))
