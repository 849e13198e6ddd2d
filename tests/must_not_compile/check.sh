#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks that a program does not compile, and for the reason its author meant, not for a misspelt include.
#
#   check.sh COMPILER [FLAG...] FILE
#
# The file begins with one or more lines "// expect: <extended regular expression>"; the compiler's errors and notes must
# match each of them. Lines "// flags: <flag>..." below those give it further flags. Exit status 0 if so, else 1.
set -uo pipefail

file=${!#}
command=("${@:1:$#-1}")

mapfile -t expectations < <(sed -n '/^\/\//!q; s|^// expect: ||p' "$file")
if ((${#expectations[@]} == 0)); then
    echo "$file has no line '// expect: <regular expression>' at its beginning"
    exit 1
fi
read -r -a flags < <(sed -n '/^\/\//!q; s|^// flags: ||p' "$file" | tr '\n' ' '; echo)

# Not -fsyntax-only: some templates are instantiated only when code is made. Not -O0: the AVX-512 part of xsimd 8.1 needs
# optimisation. In the C locale the compiler's quotes are the same everywhere.
if output=$(LC_ALL=C "${command[@]}" "${flags[@]}" -O1 -fno-diagnostics-color -S -o /dev/null "$file" 2>&1); then
    echo "$file compiles, but must not"
    exit 1
fi

# A compiler also prints the source line, comments included: look at its own words only.
messages=$(grep -E '(error|note): ' <<<"$output")
if grep -qE "fatal error: .*(No such file|file not found)" <<<"$messages"; then
    echo "$file includes a file that was not found by the compiler:"
    echo "$messages"
    exit 1
fi
for expectation in "${expectations[@]}"; do
    if ! grep -qE -- "$expectation" <<<"$messages"; then
        echo "$file does not compile, but not for the reason expected."
        echo "expected: $expectation"
        echo "the compiler said:"
        echo "$output"
        exit 1
    fi
done
echo "refused as expected: $(grep -E -m 1 -- "${expectations[0]}" <<<"$messages")"
