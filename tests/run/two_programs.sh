#!/bin/sh
# Two programs in one folder of results: the second is refused, whether it starts or resumes, and the first ends as if it
# had been alone; a program that was killed leaves no lock behind.
# usage: two_programs.sh DENSIFY FOLDER_OF_SCENES WORK_FOLDER
set -eu
densify=$1 scenes=$2 work=$3
. "$scenes/support.sh"
cp "$scenes/lattice.csv" .
sed "s/^mass_scaling = 1e17/mass_scaling = 1e16/" "$scenes/lattice.toml" >lattice.toml

run_code run lattice.toml --quiet --out whole
[ "$code" -eq 0 ] || fail "the lattice: $(cat "$err")"

# Stopped in the middle, so that it holds the folder for as long as the others try.
"$densify" run lattice.toml --quiet --out shared &
pid=$!
rounds=0
until [ -f shared/checkpoint.h5 ] || [ "$rounds" -ge 3000 ]; do
  rounds=$((rounds + 1))
  sleep 0.01
done
kill -STOP "$pid"
refuses 'densify: --out shared: ' 'another run is at work in this folder' -- run lattice.toml --quiet --out shared
refuses 'densify: --out shared: ' 'another run is at work in this folder' -- run lattice.toml --quiet --resume --out shared
kill -CONT "$pid"
wait "$pid" || fail "the first program: exit code $?"
same_end whole shared

"$densify" run lattice.toml --quiet --out killed &
pid=$!
until [ -f killed/checkpoint.h5 ] || [ "$rounds" -ge 3000 ]; do
  rounds=$((rounds + 1))
  sleep 0.01
done
kill -KILL "$pid"
wait "$pid" || true
run_code run lattice.toml --quiet --resume --out killed
[ "$code" -eq 0 ] || fail "after a kill: $(cat "$err")"
same_end whole killed
finish
