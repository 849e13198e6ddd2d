#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks that a program does not compile, and for the reason its author meant, not for a misspelt include.
#
#   check.sh [--case NAME | --without-cases] COMPILER [FLAG...] FILE
#
# The file begins with one or more lines "// expect: <extended regular expression>"; the compiler's errors and notes
# must match each of them. Lines "// flags: <flag>..." give it further flags. A file of several wrong programs has a
# line "// case: NAME" above the lines of each; that program is compiled with -DCASE_NAME. With --without-cases the file
# must compile, which shows that nothing but the cases is wrong with it. Exit status 0 if all is as expected, else 1.
set -uo pipefail

name='' without_cases=''
case $1 in
    --case) name=$2 && shift 2 ;;
    --without-cases) without_cases=yes && shift ;;
esac
file=${!#}
# In the C locale the compiler's quotes are the same everywhere.
command=(env LC_ALL=C "${@:1:$#-1}" -fno-diagnostics-color)

if [[ $without_cases ]]; then
    if ! output=$("${command[@]}" -O1 -fsyntax-only "$file" 2>&1); then
        printf '%s does not compile even without its cases:\n%s\n' "$file" "$output"
        exit 1
    fi
    exit 0
fi

# The lines of the head that speak of this program: those below its own "// case:", or all where there are no cases.
head=$(sed -n '/^\/\//!q; p' "$file")
if [[ $name ]]; then
    head=$(awk -v name="$name" '/^\/\/ case: / { own = $3 == name } own' <<<"$head")
    command+=("-DCASE_$name")
fi
mapfile -t expectations < <(sed -n 's|^// expect: ||p' <<<"$head")
if ((${#expectations[@]} == 0)); then
    echo "$file has no line '// expect: <regular expression>' at its beginning" "${name:+"below '// case: $name'"}"
    exit 1
fi
read -r -a flags < <(sed -n 's|^// flags: ||p' <<<"$head" | tr '\n' ' '; echo)

# Not -fsyntax-only: some templates are instantiated only when code is made. Not -O0: the AVX-512 part of xsimd 8.1
# needs optimisation.
if output=$("${command[@]}" "${flags[@]}" -O1 -S -o /dev/null "$file" 2>&1); then
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
