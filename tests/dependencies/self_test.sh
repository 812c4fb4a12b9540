#!/bin/sh
# self_test.sh SCRATCH: check.sh is silent on a clean tree and finds every kind of breach, each alone.
set -eu
check=$(dirname "$(readlink -f "$0")")/check.sh
scratch=$1
count=0

# expect VERDICT FILE INCLUDE: VERDICT is `clean` or a piece of the complaint.
expect() {
  rm -rf "$scratch"
  mkdir -p "$scratch/$(dirname "$2")"
  printf '#pragma once\n#include %s\n' "$3" >"$scratch/$2"
  complaint=$(sh "$check" "$scratch") && status=0 || status=$?
  case "$1" in
    clean) [ "$status" = 0 ] && [ -z "$complaint" ] || { echo "wrongly refused: $2 $3: $complaint"; exit 1; } ;;
    *) case "$status $complaint" in
         0*) echo "not found: $2 $3"; exit 1 ;;
         *"$2:2: $3"*"$1"*) ;;
         *) echo "wrong complaint: $complaint"; exit 1 ;;
       esac ;;
  esac
  count=$((count + 1))
}

expect clean base/a.h '"base/b.h"'
expect clean base/a.h '<Eigen/Core>'
expect clean base/a.cc '<toml++/toml.h>'
expect clean dem/law/a.h '"base/b.h"'
expect clean dem/io/a.cc '<hdf5.h>'
expect clean app/a.cc '"dem/b.h"'
expect clean app/a.cc '<CLI/CLI.hpp>'
expect clean tests/dem/a.cc '"tests/support/b.h"'
expect 'base may include only base/' base/a.h '"dem/b.h"'
expect 'dem may include only' dem/law/a.cc '"app/b.h"'
expect 'dem may include only' dem/a.h '"fem/b.h"'
expect 'fem may include only' fem/a.h '"dem/b.h"'
expect 'nobody but the tests' dem/a.cc '"tests/support/b.h"'
expect 'nobody but the tests' app/a.cc '"tests/support/b.h"'
expect 'from the root' dem/law/a.h '"../state/b.h"'
expect 'from the root' dem/law/a.h '"b.h"'
expect 'never meets' dem/a.cc '<mpi.h>'
expect 'never meets' dem/a.cc '<petscksp.h>'
expect 'never meets' base/a.cc '<deal.II/base/tensor.h>'
expect 'only app' dem/a.cc '<CLI/CLI.hpp>'
expect 'base may not include HDF5' base/a.cc '<hdf5.h>'
expect 'base may not include Voro++' base/a.cc '<voro++/voro++.hh>'
expect 'too heavy' dem/io/a.h '<hdf5.h>'
expect 'too heavy' dem/measure/a.h '<voro++/voro++.hh>'
expect 'too heavy' base/a.h '<toml++/toml.h>'
expect 'too heavy' dem/a.h '<fmt/core.h>'
rm -rf "$scratch"
echo "$count cases as expected"
