#!/bin/sh
# SIGINT and SIGTERM: exit code 5, a checkpoint from which --resume ends bit for bit as an undisturbed run; while packing
# there is nothing to keep, and nothing in the way of a new start.
# usage: signals.sh DENSIFY FOLDER_OF_SCENES WORK_FOLDER
set -eu
densify=$1 scenes=$2 work=$3
. "$scenes/support.sh"
cp "$scenes/lattice.csv" .
sed 's/^mass_scaling = 1e17/mass_scaling = 1e16/' "$scenes/lattice.toml" >lattice.toml
cp "$scenes/small_press.toml" press.toml

# wait_for COMMAND...: until it holds; gives up after half a minute.
wait_for() {
  rounds=0
  until "$@" 2>/dev/null; do
    rounds=$((rounds + 1))
    [ "$rounds" -lt 3000 ] || { fail "$*: never"; return 0; }
    sleep 0.01
  done
}

run_code run lattice.toml --quiet --out whole
[ "$code" -eq 0 ] || fail "the lattice: $(cat "$err")"
for signal in INT TERM; do
  "$densify" run lattice.toml --quiet --out "$signal" 2>"$err" &
  pid=$!
  wait_for [ -f "$signal/snapshots/000001.h5" ]
  kill -"$signal" "$pid"
  code=0
  wait "$pid" || code=$?
  [ "$code" -eq 5 ] || fail "SIG$signal: exit code $code: $(cat "$err")"
  grep -q "^densify: interrupted at process time .* s; continue with --resume --out $signal$" "$err" ||
    fail "SIG$signal: $(cat "$err")"
  run_code run lattice.toml --quiet --resume --out "$signal"
  [ "$code" -eq 0 ] || fail "SIG$signal: does not go on: $(cat "$err")"
  same_end whole "$signal"
done

run_code run press.toml --quiet --out whole_press
[ "$code" -eq 0 ] || fail "the press: $(cat "$err")"
for signal in INT TERM KILL; do
  : >"$err" # or the word that is waited for is that of the round before
  "$densify" run press.toml --out press 2>"$err" &
  pid=$!
  wait_for grep -q packing "$err"
  kill -"$signal" "$pid"
  code=0
  wait "$pid" || code=$?
  if [ "$signal" = KILL ]; then
    [ "$code" -eq 137 ] || fail "SIGKILL while packing came too late: exit code $code"
    continue
  fi
  [ "$code" -eq 5 ] || fail "SIG$signal while packing: exit code $code: $(cat "$err")"
  grep -q '^densify: interrupted while packing; .* start the run again$' "$err" ||
    fail "SIG$signal while packing: $(cat "$err")"
  [ ! -e press ] || fail "SIG$signal while packing: leaves $(ls -d press press/*)"
done
run_code run press.toml --quiet --out press
[ "$code" -eq 0 ] || fail "after a kill while packing: $(cat "$err")"
same_end whole_press press
finish
