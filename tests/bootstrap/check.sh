#!/bin/sh
# check.sh SCRIPT SCRATCH: the root script against stand-ins for dpkg-query, apt-get, sudo and cmake that write down how
# they were called.  The stand-in build makes a program that prints its working directory and its arguments.
set -eu
unset DENSIFY_PRESET DENSIFY_NO_INSTALL
rm -rf "$2"
mkdir -p "$2/elsewhere" "$2/bin" "$2/house"
scratch=$(readlink -f "$2")
house=$scratch/house
calls=$scratch/calls
mkdir -p "$house/base" "$house/dem" "$house/fem" "$house/coupling" "$house/app" "$house/cmake"
touch "$house/CMakeLists.txt" "$house/CMakePresets.json" "$house/dem/law.h"
cp "$1" "$house/densify"
ln -s "$house/densify" "$scratch/bin/linked"

stand_in() {
  printf '#!/bin/sh\n%s\n' "$2" >"$scratch/bin/$1"
  chmod +x "$scratch/bin/$1"
}
stand_in dpkg-query 'for package; do :; done; grep -qx "$package" '"$scratch/installed"' && echo "install ok installed"'
stand_in apt-get "echo apt-get \"\$@\" >>$calls"
stand_in sudo 'exec "$@"'
stand_in ctest "echo ctest \"\$@\" >>$calls; pwd"
stand_in cmake "echo cmake \"\$@\" >>$calls
[ ! -f $scratch/broken ] || { echo 'law.h:1: a compiler error'; exit 1; }
[ \"\$1\" = --build ] || exit 0
mkdir -p \$2/bin
printf '#!/bin/sh\necho at \$(pwd): \"\$@\"\n' >\$2/bin/densify
chmod +x \$2/bin/densify"
PATH=$scratch/bin:$PATH
: >"$scratch/installed"
cd "$scratch/elsewhere"

# call EXPECTED_STATUS ARGUMENT...: leaves output, messages and calls in files.
call() {
  expected=$1
  shift
  : >"$calls"
  status=0
  "$house/densify" "$@" >"$scratch/out" 2>"$scratch/err" || status=$?
  [ "$status" = "$expected" ] || fail "exit code $status, expected $expected"
}
fail() {
  echo "FAILED: $1"
  tail -n +1 "$scratch/out" "$scratch/err" "$calls"
  exit 1
}
holds() { grep -qe "$2" "$scratch/$1" || fail "no '$2' in $1"; }
lacks() { ! grep -qe "$2" "$scratch/$1" || fail "'$2' in $1"; }

# Nothing may be installed: names what is missing, touches nothing, exit code 2.
DENSIFY_NO_INSTALL=1 call 2 run scene.toml
holds err 'missing Debian packages: g++ cmake ninja-build libeigen3-dev'
holds err 'DENSIFY_NO_INSTALL forbids'
[ ! -s "$calls" ] || fail "something was called"

# Who needs the particles alone need not install the finite elements.
DENSIFY_NO_INSTALL=1 DENSIFY_PRESET=dem-only call 2 run scene.toml
lacks err 'deal.ii'

# One package is there: lists read once, before the others are installed, which are announced; the tests' are not among
# them; then the program gets its arguments in the caller's folder and has the screen to itself.
echo cmake >"$scratch/installed"
call 0 run 'a scene.toml' --set x=1
holds calls '^apt-get .*update$'
holds calls '^apt-get .*install -y --no-install-recommends g++ ninja-build libeigen3-dev'
holds calls 'libdeal.ii-dev openmpi-bin$'
lacks calls 'gtest'
lacks calls 'install.* cmake'
holds err 'installing the Debian packages g++ ninja-build'
holds calls '^cmake --preset release -D DENSIFY_TESTS=OFF$'
[ "$(cat "$scratch/out")" = "at $scratch/elsewhere: run a scene.toml --set x=1" ] || fail "arguments or folder differ"

# Second call: straight to the program, also through a link, without a word.
call 0 help
[ ! -s "$calls" ] && [ ! -s "$scratch/err" ] || fail "not straight to the program"
: >"$calls"
[ "$("$scratch/bin/linked" help)" = "at $scratch/elsewhere: help" ] && [ ! -s "$calls" ] || fail "link does not work"

# A newer source, or a file that was removed: builds again, once.
DENSIFY_NO_INSTALL=1
export DENSIFY_NO_INSTALL
echo "g++ cmake ninja-build libeigen3-dev libhdf5-dev libtomlplusplus-dev libcli11-dev libfmt-dev voro++-dev
libdeal.ii-dev openmpi-bin libgtest-dev python3-numpy python3-h5py" | tr ' ' '\n' >"$scratch/installed"
touch "$house/dem/law.h"
call 0 help
holds calls '^cmake --build .*build/release --target densify'
call 0 help
[ ! -s "$calls" ] || fail "built twice"
rm "$house/dem/law.h"
call 0 help
holds calls '^cmake --build'

# A build that fails: the end of the log, exit code 1, and the stale program is not run; next time it is tried again.
touch "$house/app/main.cc" "$scratch/broken"
call 1 help
holds err 'law.h:1: a compiler error'
[ ! -s "$scratch/out" ] || fail "the stale program ran"
call 1 help
rm "$scratch/broken"
call 0 help

# The tests: all targets, of the preset asked for; the caller's arguments reach ctest last.
DENSIFY_PRESET=sanitize call 0 test -R Check
holds calls '^cmake --preset sanitize -D DENSIFY_TESTS=ON$'
holds calls '^cmake --build .*build/sanitize --target all'
holds calls '^ctest --test-dir .*build/sanitize .* -R Check$'
echo "the root script does as it says"
