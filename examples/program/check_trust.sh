#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks that no code runs that its user has not asked for: of headers, of the cache of compiled models, of Python's
# modules in the current folder. Usage: check_trust.sh MYRIAD
# shellcheck source=examples/common/check.sh
source "$(dirname "$(realpath "$0")")/../common/check.sh"
export MYRIAD_CACHE_DIR=$work/caches/of/mine TMPDIR=$work/temporary
mkdir temporary sources
cp "$here/../quickstart/model.hpp" sources
sed -e 's|\.\./quickstart/|sources/|' -e 's/0\.3, 4608/0.3, 64/' "$here/bifurcation.toml" >study.toml
# A compiler that compiles a file once: there are many compilations, of few files.
cat >g++ <<'END'
#!/usr/bin/env bash
in='' out='' previous=''
for word in "$@"; do
    [[ $previous == -c ]] && in=$word
    [[ $previous == -o ]] && out=$word
    previous=$word
done
[[ -n $in ]] || exec "$REAL_CXX" "$@"
known=$OBJECTS/$(sha256sum <"$in" | cut -d ' ' -f 1)
[[ -f $known ]] || "$REAL_CXX" "$@" || exit
[[ -f $known ]] || cp "$out" "$known"
cp "$known" "$out"
END
chmod +x g++
mkdir objects
OBJECTS=$work/objects REAL_CXX=$(command -v g++ || command -v clang++) MYRIAD_CXX=$work/g++
export OBJECTS REAL_CXX MYRIAD_CXX
# What a header runs when it is loaded.
printf '#include <fstream>\nstatic const bool ran = [] { std::ofstream("%s/ran"); return true; }();\n' "$work" \
    >>sources/model.hpp
cache=$MYRIAD_CACHE_DIR
# not_run COMMAND...: is refused, and runs nothing.
not_run() {
    rm -f ran
    expect 2 'was never compiled by you.*--compile' "$@"
    [[ ! -e ran ]] || fail "code of the header ran by: $*"
}

# 'run --check', 'list' and 'resume' compile no header that this user never compiled.
not_run "$program" run --check study.toml
not_run "$program" list study.toml
not_run "$program" list sources/model.hpp --model duffing
expect 0 '' "$program" list study.toml --compile
[[ -e ran ]] || fail 'the check of this test finds nothing'
rm -rf caches
(umask 0 && expect 0 'compiling' "$program" run study.toml)

# Under umask 0, the cache and its files are the user's alone.
[[ -z $(find caches -perm /077) ]] || fail "others may look into the cache: $(find caches -perm /077 | xargs ls -ld)"
[[ -z $(find caches temporary -name '*.lock' -o -name '*.work.*' -o -name 'myriad.*') ]] || fail 'something is left'

# What was run is known.
for command in 'run --check study.toml' 'list study.toml' 'resume bifurcation --quiet'; do
    # shellcheck disable=SC2086
    expect 0 '^$' "$program" $command
done
rm "$cache"/*.so # as after an update of the compiler
expect 0 '^compiling model\.hpp' "$program" resume bifurcation

# Results that came from elsewhere.
mv caches others
not_run "$program" resume bifurcation
expect 0 'compiling' "$program" resume bifurcation --compile
[[ -e ran ]] || fail 'the header was not compiled'
rm -rf caches
mv others caches

# A changed header is another one.
sed -i 's/static const bool/static  const bool/' bifurcation/myriad/model.hpp
not_run "$program" resume bifurcation
sed -i 's/static  const bool/static const bool/' bifurcation/myriad/model.hpp

# refused_cache MESSAGE: the cache is not used, with a message, and nothing of it is loaded; the study runs.
refused_cache() {
    not_run "$program" resume bifurcation
    [[ $(<stderr) =~ $1 ]] || fail "no '$1' on stderr: $(<stderr)"
    expect 0 "$1" "$program" run study.toml --quiet
    [[ -z $(ls temporary) ]] || fail 'something is left where models were compiled'
}
chmod 777 "$cache"
refused_cache 'others may write to it \(mode 777\).*chmod go-w'
chmod 720 "$cache"
refused_cache 'others may write to it \(mode 720\)'
chmod 700 "$cache"
expect 0 '^$' "$program" resume bifurcation --quiet
touch file
MYRIAD_CACHE_DIR=$PWD/file refused_cache 'it cannot be used \(.*set MYRIAD_CACHE_DIR'

# A file of the cache that others may write to, or that is none, is made again.
so=$(echo "$cache"/*.so)
recompiled() {
    expect 0 'compiling' "$program" run study.toml
    [[ -f $so && ! -L $so && $(stat -c %a "$so") == 600 ]] || fail 'the file of the cache was not replaced'
}
chmod 666 "$so"
recompiled
mv "$so" "$work/elsewhere.so"
ln -s "$work/elsewhere.so" "$so"
recompiled
rm "$so"
mkfifo "$so"
recompiled
if [[ $(id -u) == 0 ]]; then
    chown 12345 "$so"
    recompiled
    [[ $(stat -c %u "$so") == 0 ]] || fail "another user's file is loaded"
    chown 12345 "$cache"
    refused_cache 'it belongs to another user, of number 12345'
    chown 0 "$cache"
    ln -s "$cache" planted
    chown -h 12345 planted
    MYRIAD_CACHE_DIR=$PWD/planted refused_cache 'it belongs to another user, of number 12345'
fi

# Killed compilations leave folders until the next compilation, and failed ones nothing.
printf '#!/bin/sh\nkill -9 "$PPID"\n' >killing
chmod +x killing
rm "$so"
MYRIAD_CXX=$PWD/killing "$program" run study.toml >/dev/null 2>&1 || true
[[ -n $(ls "$cache"/*.work.*) ]] || fail 'nothing was killed'
expect 0 'compiling' "$program" run study.toml
sed -i 's/y\[v\], y\[x\]/y[w], y[x]/' sources/model.hpp
expect 2 'does not compile' "$program" run study.toml --store other
[[ -z $(find "$cache" -name '*.lock' -o -name '*.work.*') ]] || fail "something is left: $(ls "$cache")"

# A pipe and a device as headers.
rm sources/model.hpp
mkfifo sources/model.hpp
expect 2 'model\.hpp is no regular file' timeout 10 "$program" run study.toml --store other
ln -sf /dev/zero sources/model.hpp
expect 2 'model\.hpp is no regular file' timeout 10 "$program" run study.toml --store other

# 'plot' runs no module of the current folder, of PYTHONPATH, or that settings there name.
if plotting_python >/dev/null; then
    mkdir modules
    for module in matplotlib numpy netCDF4 figure argparse; do
        printf 'open("%s/ran", "w")\nraise ImportError\n' "$work" | tee $module.py >modules/$module.py
    done
    echo 'backend: module://planted' >matplotlibrc
    printf 'open("%s/ran", "w")\n' "$work" >planted.py
    rm -f ran
    PYTHONPATH=$PWD/modules expect 0 '' "$program" plot bifurcation
    [[ ! -e ran ]] || fail 'plot ran a module of the current folder'
fi
echo 'All checks passed.'
