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

# holds FOLDER FILE ARGUMENT...: a first program, stopped once the file is there, keeps the others out for as long.
holds() {
  folder=$1 file=$2
  shift 2
  "$densify" run lattice.toml --quiet --out "$folder" "$@" &
  pid=$!
  rounds=0
  until [ -f "$folder/$file" ] || [ "$rounds" -ge 3000 ]; do
    rounds=$((rounds + 1))
    sleep 0.01
  done
  kill -STOP "$pid"
  refuses "densify: --out $folder: " 'another run is at work in this folder' -- \
    run lattice.toml --quiet --out "$folder" "$@"
  refuses "densify: --out $folder: " 'another run is at work in this folder' -- \
    run lattice.toml --quiet --resume --out "$folder" "$@"
  kill -CONT "$pid"
  wait "$pid" || fail "the first program: exit code $?"
}
holds shared checkpoint.h5
same_end whole shared
holds ensemble realisation_001/checkpoint.h5 --set realisations=2 --set specimen.perturbation.size=1e-3

rounds=0
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
