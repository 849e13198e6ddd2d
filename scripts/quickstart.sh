#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# From a fresh checkout to a bifurcation diagram: installs what is missing, builds a release, runs the sweep, plots it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=scripts/lib.sh
source scripts/lib.sh

usage() {
    cat <<'END'
Usage: scripts/quickstart.sh [--help]

Installs the packages that are missing (as root or with sudo), builds the example as a release in
build/release, integrates the Duffing sweep to results/duffing.nc and draws its bifurcation diagram,
results/duffing.png. Takes a few minutes on two cores.
END
}

while (($#)); do
    case $1 in
        --help | -h) usage; exit 0 ;;
        *) usage_error "Unknown option '$1'" ;;
    esac
done

started=$SECONDS
require_packages g++ cmake ninja-build libeigen3-dev libxsimd-dev libcli11-dev libnetcdf-dev \
    nlohmann-json3-dev python3-matplotlib python3-netcdf4

say "Building the example in build/release"
# The other parts need further packages; 'cmake --preset release' switches them on again.
quietly build/release/configure.log cmake --preset release \
    -DMYRIAD_BUILD_TESTS=OFF -DMYRIAD_BUILD_BENCHMARKS=OFF -DMYRIAD_BUILD_VALIDATION=OFF ||
    fail "The configuration failed, see above."
quietly build/release/build.log cmake --build --preset release --parallel "$(nproc)" --target duffing ||
    fail "The build failed, see above."

say "Integrating the Duffing sweep to results/duffing.nc"
mkdir -p results
build/release/examples/duffing/duffing --output results/duffing.nc

say "Drawing results/duffing.png"
"$(plotting_python)" examples/duffing/plot.py results/duffing.nc results/duffing.png

say "Done after $(duration $((SECONDS - started))): results/duffing.nc and results/duffing.png"
