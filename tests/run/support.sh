# What the scripts here share; sourced with $densify and $work set.  $work is made anew, and the present folder is there.
rm -rf "$work" "$work.log"
mkdir -p "$work" "$work.log"
out=$work.log/stdout err=$work.log/stderr failures=0
export OMP_WAIT_POLICY=passive  # threads that spin would take the processor from each other
cd "$work"

fail() {
  echo "FAILED: $*" >&2
  failures=$((failures + 1))
}

finish() {
  [ "$failures" -eq 0 ] || exit 1
  echo "all as it should be"
}

# Names and contents of everything in the work folder.
inventory() { find . | LC_ALL=C sort && find . -type f -exec cksum {} + | LC_ALL=C sort; }

# run_code ARGUMENT...: runs the program, leaves its exit code in $code and what it says in $out and $err.
run_code() {
  code=0
  "$densify" "$@" >"$out" 2>"$err" || code=$?
}

# says CODE TEXT TEXT -- ARGUMENT...: the program ends with this code and one line of errors that holds both texts.
says() {
  due=$1 first=$2 second=$3
  shift 4
  run_code "$@"
  [ "$code" -eq "$due" ] || fail "densify $*: exit code $code instead of $due: $(cat "$err")"
  [ "$(wc -l <"$err")" -eq 1 ] || fail "densify $*: not one line of errors: $(cat "$err")"
  grep -qF -- "$first" "$err" || fail "densify $*: no \"$first\" in: $(cat "$err")"
  grep -qF -- "$second" "$err" || fail "densify $*: no \"$second\" in: $(cat "$err")"
}

# refuses TEXT TEXT -- ARGUMENT...: exit code 2, one line with both texts, no file made, changed or removed.
refuses() {
  inventory >"$work.log/before"
  says 2 "$@"
  inventory >"$work.log/after"
  cmp -s "$work.log/before" "$work.log/after" ||
    fail "$*: files changed: $(diff "$work.log/before" "$work.log/after" | grep '^[<>]')"
}

# same_end FOLDER FOLDER: two finished runs agree bit for bit.
same_end() {
  cmp "$1/history.csv" "$2/history.csv" || fail "$2: another history than $1"
  cmp "$1/checkpoint.h5" "$2/checkpoint.h5" || fail "$2: another final state than $1"
}

# crystal_here: $scenes/crystal.toml as periodic.toml with its 27 spheres, some of them larger.
crystal_here() {
  awk 'BEGIN { print "x,y,z,radius,material"
    for (i = 0; i < 3; i++) for (j = 0; j < 3; j++) for (k = 0; k < 3; k++)
      printf "%g,%g,%g,%g,NiAl\n", 4 * i + 2, 4 * j + 2, 4 * k + 2, 2.02 + 0.02 * ((i + 2 * j + k) % 3) }' >periodic.csv
  cp "$scenes/crystal.toml" periodic.toml
}
