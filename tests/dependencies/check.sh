#!/bin/sh
# check.sh [ROOT]: who includes whom.  base includes base; dem includes base and dem; app any room; nobody but the tests
# includes tests/.  Headers of base and dem stay light, and neither room ever meets deal.II, PETSc or MPI.
set -eu
cd "${1:-.}"

for room in base dem fem coupling app tests; do
  [ -d "$room" ] && find "$room" -name '*.h' -o -name '*.cc'
done | sort | xargs -r awk '
  function complain(why) { printf "%s:%d: %s: %s\n", FILENAME, FNR, included, why; failed = 1 }
  FNR == 1 {
    split(FILENAME, parts, "/"); room = parts[1]
    core = room == "base" || room == "dem"
    header = FILENAME ~ /\.h$/
  }
  !/^[ \t]*#[ \t]*include/ { next }
  {
    included = $0
    sub(/^[ \t]*#[ \t]*include[ \t]*/, "", included)
    sub(/[ \t]*\/\/.*/, "", included)
    split(included, parts, /["<>\/]/); first = parts[2]
    if (included ~ /^"/) {
      if (first !~ /^(base|dem|fem|coupling|app|tests)$/ || included ~ /\/\.\.\// || included !~ /\//)
        complain("write the path from the root of the project")
      else if (first == "tests" && room != "tests") complain("nobody but the tests includes tests/")
      else if (room == "base" && first != "base") complain("base may include only base/")
      else if (room == "dem" && first != "base" && first != "dem") complain("dem may include only base/ and dem/")
      else if (room == "fem" && first != "base" && first != "fem") complain("fem may include only base/ and fem/")
      else if (room == "coupling" && first == "app") complain("coupling may not include app/")
      next
    }
    if (core && included ~ /<(deal\.II\/|petsc|slepc|mpi)/) complain(room " never meets deal.II, PETSc or MPI")
    if (core && included ~ /<CLI\//) complain("only app may include CLI11")
    if (room == "base" && included ~ /<(hdf5|H5)/) complain("base may not include HDF5")
    if (room == "base" && included ~ /<voro/) complain("base may not include Voro++")
    if (core && header && included ~ /<(toml\+\+|toml\.h|fmt\/|hdf5|H5|voro\+\+)/) complain("too heavy for a header, include it in the .cc")
  }
  END { exit failed }'
