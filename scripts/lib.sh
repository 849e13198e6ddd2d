# SPDX-License-Identifier: MIT
# Shared by the scripts: messages, installing missing packages, running steps and counting tests. Sourced, not run.
# shellcheck shell=bash

say() { printf '%s\n' "== $*"; }

# fail MESSAGE [STATUS]
fail() {
    printf '%s\n' "$1" >&2
    exit "${2:-1}"
}

# usage_error MESSAGE: for wrong options.
usage_error() {
    printf '%s\nTry %s --help\n' "$1" "$0" >&2
    exit 2
}

# A duration in seconds in human-readable form.
duration() {
    local seconds=$1
    if ((seconds < 60)); then
        printf '%d s' "$seconds"
    else
        printf '%d min %02d s' $((seconds / 60)) $((seconds % 60))
    fi
}

# ----------------------------------------------------------------------------------------------------------------------
# Packages
# ----------------------------------------------------------------------------------------------------------------------

has_command() { command -v "$1" >/dev/null 2>&1; }
has_header() { [[ -e /usr/include/$1 || -e /usr/local/include/$1 ]]; }

# The sanitizers of clang++ come in a package of their own.
has_clang_runtime() {
    has_command clang++ && [[ -e $(clang++ --print-resource-dir)/lib/linux/libclang_rt.tsan-$(uname -m).a ]]
}
has_clang_openmp() {
    has_command clang++ && printf '#include <omp.h>\n' | clang++ -fopenmp=libomp -E -x c++ - >/dev/null 2>&1
}

# A Python that has a module: the first on the PATH may not be the one that Debian's packages are for.
python_with() {
    local python
    for python in python3 /usr/bin/python3; do
        if "$python" -c "import $1" >/dev/null 2>&1; then
            printf '%s' "$python"
            return
        fi
    done
    return 1
}
plotting_python() { python_with matplotlib; }

# has_package NAME: whether the contents of the Debian package are there, from it or from elsewhere.
has_package() {
    case $1 in
        g++ | cmake | clang | python3) has_command "${1/clang/clang++}" ;;
        ninja-build) has_command ninja ;;
        libeigen3-dev) has_header eigen3/Eigen/Core ;;
        libxsimd-dev) has_header xsimd/xsimd.hpp ;;
        libcli11-dev) has_header CLI/CLI.hpp ;;
        libnetcdf-dev) has_header netcdf.h ;;
        libopenmpi-dev) has_command mpicxx ;;
        openmpi-bin) has_command mpirun ;;
        libtomlplusplus-dev) has_header toml++/toml.h ;;
        nlohmann-json3-dev) has_header nlohmann/json.hpp ;;
        libboost-dev) has_header boost/numeric/odeint.hpp ;;
        libsundials-dev) has_header cvode/cvode.h ;;
        catch2) has_header catch2/catch.hpp || has_header catch2/catch_test_macros.hpp ;;
        libomp-dev) has_clang_openmp ;;
        libclang-rt-dev) has_clang_runtime ;;
        python3-matplotlib | python3-scipy | python3-xarray) python_with "${1#python3-}" >/dev/null ;;
        python3-netcdf4) python_with netCDF4 >/dev/null ;;
        python3-dev) python3 -c 'import os, sysconfig
assert os.path.exists(os.path.join(sysconfig.get_path("include"), "Python.h"))' >/dev/null 2>&1 ;;
        python3-venv) python3 -c 'import ensurepip, venv' >/dev/null 2>&1 ;;
        doxygen) has_command doxygen ;;
        *) return 1 ;;
    esac
}

# How to run apt-get as root: nothing needed, sudo, or failure.
root_prefix() {
    if [[ $(id -u) == 0 ]]; then
        return 0
    elif has_command sudo && { sudo -n true 2>/dev/null || [[ -t 0 ]]; }; then # a password needs a terminal
        printf 'sudo'
    else
        return 1
    fi
}

# apt_get ARGUMENT...: quiet unless it fails.
apt_get() {
    local prefix log status=0
    prefix=$(root_prefix)
    log=$(mktemp)
    # env, since sudo passes no variables on.
    $prefix env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300 "$@" </dev/null >"$log" 2>&1 ||
        status=$?
    if ((status != 0)); then
        cat "$log" >&2
        printf 'apt-get %s failed.\n' "$*" >&2
    fi
    rm -f "$log"
    return "$status"
}

# require_packages NAME...: installs what is missing. Ends the script if that cannot be done.
require_packages() {
    local package missing=()
    for package in "$@"; do
        has_package "$package" || missing+=("$package")
    done
    if ((${#missing[@]} == 0)); then
        say "All packages needed are here."
        return
    fi
    if ! has_command apt-get; then
        fail "These are missing, under the names of Debian's packages: ${missing[*]}
There is no apt-get to install them with. Install them in your system's way, then run this again."
    fi
    if ! root_prefix >/dev/null; then
        fail "These packages are missing: ${missing[*]}
Installing them needs root or sudo. As root run
  apt-get update && apt-get install ${missing[*]}
then run this again."
    fi
    say "Installing ${missing[*]}"
    apt_get update || fail "The lists of packages could not be fetched: check the network, then run this again."
    # The sanitizer runtime has a name without version only in newer releases; its versioned name follows clang's.
    local plain=()
    for package in "${missing[@]}"; do
        [[ $package == libclang-rt-dev ]] || plain+=("$package")
    done
    if ((${#plain[@]})); then
        apt_get install --yes --no-install-recommends "${plain[@]}" || fail "Could not install ${plain[*]}."
    fi
    if [[ " ${missing[*]} " == *" libclang-rt-dev "* ]] && ! has_clang_runtime; then
        local version
        version=$(clang++ -dumpversion)
        apt_get install --yes --no-install-recommends "libclang-rt-${version%%.*}-dev" ||
            fail "Could not install libclang-rt-${version%%.*}-dev, the sanitizers of clang++."
    fi
    for package in "${missing[@]}"; do
        has_package "$package" ||
            fail "$package was installed, and what it should bring is still not found. Does the PATH name other tools?"
    done
}

# ----------------------------------------------------------------------------------------------------------------------
# Steps
# ----------------------------------------------------------------------------------------------------------------------

# dependency_options DIR: CMake's options for the dependencies in DIR, one per line: DIR/xsimd, DIR/CLI, DIR/json,
# DIR/sundials.
dependency_options() {
    if [[ -d $1/xsimd ]]; then printf -- '-DMYRIAD_XSIMD_INCLUDE_DIR=%s\n' "$PWD/$1"; fi
    if [[ -d $1/CLI ]]; then printf -- '-DMYRIAD_CLI11_INCLUDE_DIR=%s\n' "$PWD/$1"; fi
    if [[ -d $1/json ]]; then printf -- '-DCMAKE_PREFIX_PATH=%s\n' "$PWD/$1/json"; fi
    if [[ -d $1/sundials ]]; then printf -- '-DSUNDIALS_ROOT=%s\n' "$PWD/$1/sundials"; fi
}

# quietly LOG COMMAND...: output goes to the file LOG, and its end is shown if the command fails.
quietly() {
    local log=$1 status=0
    shift
    mkdir -p "$(dirname "$log")"
    "$@" </dev/null >"$log" 2>&1 || status=$?
    if ((status != 0)); then
        printf '%s\n' "failed: $*" >&2
        # The first errors, since a compiler that continues buries them.
        awk '/(^|[ :])(fatal )?error:|^FAILED:|^CMake Error/ && !seen[$0]++ && ++lines <= 20' "$log" >&2
        printf '%s\n' "--- end of $log ---" >&2
        tail -n 40 "$log" >&2
        printf '%s\n' "--------------------" >&2
    fi
    return "$status"
}

# Seconds that the processes which this one has waited for computed, all together: sets `computed`. `times` has to be
# called by this process itself.
read_computed() {
    mkdir -p build
    times >build/times.txt
    # shellcheck disable=SC2034 # for the scripts that source this
    computed=$(awk 'NR == 2 { gsub(",", "."); split($0, t, /[ms ]+/); printf "%d", 60 * (t[1] + t[3]) + t[2] + t[4] }' \
        build/times.txt)
}

# budget_of STEP: the most that it may compute for, in seconds; nothing if there is no budget.
budget_of() { awk -v name="$1" '$1 == name { print $2 }' scripts/budgets.txt; }

# count_tests LOG STATUS: "passed failed skipped" from ctest's output and exit status. A run that failed without saying
# how many tests did counts as one failure, so that nothing is lost.
count_tests() {
    local log=$1 status=$2 summary total=0 failed=0 skipped=0
    summary=$(grep -E '^[0-9]+% tests passed, [0-9]+ tests? failed out of [0-9]+' "$log" | tail -n 1 || true)
    if [[ $summary =~ passed,\ ([0-9]+)\ tests?\ failed\ out\ of\ ([0-9]+) ]]; then
        failed=${BASH_REMATCH[1]} total=${BASH_REMATCH[2]}
    fi
    skipped=$(grep -cE '^ *[0-9]+/[0-9]+ Test +#[0-9]+: .*\*\*\*(Skipped|Not Run \(Disabled\))' "$log" || true)
    if ((status != 0 && failed == 0)); then failed=1 total=$((total + 1)); fi
    printf '%d %d %d\n' $((total - failed - skipped)) "$failed" "$skipped"
}
