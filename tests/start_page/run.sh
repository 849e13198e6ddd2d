#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The commands of docs/start.md, word for word, in a copy of the sources; then checks what they have made.
# Usage: run.sh SOURCE WORK
set -euo pipefail
source_dir=$1
work=$2
rm -rf "$work"
mkdir -p "$work"
tar -C "$source_dir" --exclude=./build --exclude=./.git --exclude=./results -cf - . | tar -C "$work" -xf -
cd "$work"
has_matplotlib() { python3 -c 'import matplotlib' >/dev/null 2>&1; }
if ! has_matplotlib && /usr/bin/python3 -c 'import matplotlib' >/dev/null 2>&1; then
    PATH=/usr/bin:$PATH # a Python of its own may come first
fi

# snippet: library
cmake -S . -B build/library -DMYRIAD_BUILD_TESTS=OFF -DMYRIAD_BUILD_EXAMPLES=OFF \
      -DMYRIAD_BUILD_BENCHMARKS=OFF -DMYRIAD_BUILD_VALIDATION=OFF
cmake --build build/library --parallel "$(nproc)"
cmake --install build/library --prefix build/prefix
# end of snippet

# snippet: build
cmake -S examples/quickstart -B build/quickstart -DCMAKE_PREFIX_PATH="$PWD/build/prefix" \
      -DCMAKE_BUILD_TYPE=Release -DMYRIAD_ARCH=native
cmake --build build/quickstart
# end of snippet

{
# snippet: run
build/quickstart/quickstart > duffing.csv
# end of snippet
} 2>report
cat report

# The commands build for the machine's own instruction set.
case $(g++ -march=native -dM -E -x c++ /dev/null) in
    *__AVX512F__*) best=avx512 ;;
    *__AVX2__*) best=avx2 ;;
    *) best='' ;;
esac
grep -q "lanes, $best" report

[[ $(wc -l <duffing.csv) == $((4608 * 32 + 1)) ]] # a row for each instance and recorded phase
if ! has_matplotlib; then
    printf 'The picture is not drawn: there is no matplotlib\n'
    exit
fi

# snippet: plot
python3 examples/quickstart/plot.py duffing.csv duffing.png
# end of snippet

[[ $(head -c 4 duffing.png | tail -c 3) == PNG ]]
printf 'The page holds\n'
