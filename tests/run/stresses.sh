#!/bin/sh
# densify stresses on results and on a scene, and the mistakes of its user: one sentence each, no file made.
# usage: stresses.sh DENSIFY FOLDER_OF_SCENES WORK_FOLDER
set -eu
densify=$1 scenes=$2 work=$3
. "$scenes/support.sh"
cp "$scenes/lattice.toml" "$scenes/lattice.csv" .

# column NAME FILE: values of a column of numbers, a line each; no field of these tables is quoted.
column() {
  awk -F, -v name="$1" 'NR == 1 { for (c = 1; c <= NF; c++) if ($c == name) at = c; if (!at) exit 1; next } { print $at }' "$2"
}

# A scene is run first; its result then needs no run.
run_code stresses lattice.toml --out r
[ "$code" -eq 0 ] || fail "stresses of a scene: $(cat "$err")"
grep -q 'macroscopic stress \[MPa\]' "$out" || fail "no macroscopic stress: $(cat "$out")"
grep -q 'sintering, short of equilibrium' "$out" || fail "no necks: $(cat "$out")"
for table in macroscopic_stress particle_stress neck_stress stress_histograms; do
  [ -s "r/$table.csv" ] || fail "no $table.csv"
done
[ -s r/stresses.h5 ] || fail "no stresses.h5"
if grep -q 'no plot' "$out"; then
  echo "no matplotlib, no pictures"
else
  for picture in particle_stress neck_stress macroscopic_stress; do
    [ -s "r/$picture.png" ] || fail "no $picture.png"
    [ -s "r/$picture.svg" ] || fail "no $picture.svg"
  done
fi

# The table has the stress of the history, whose digits give back every bit, at the end: apart from rounding.
history=$(column stress_zz_Pa r/history.csv | tail -1)
stress=$(awk -F, '$2 == "specimen"' r/macroscopic_stress.csv | tail -1 >last_row
  (head -1 r/macroscopic_stress.csv; cat last_row) >last.csv
  column total_zz_Pa last.csv)
awk -v a="$history" -v b="$stress" 'BEGIN { d = a - b; exit !(d * d <= 1e-20 * a * a && a < 0) }' ||
  fail "the history says $history, the table $stress"
# Every particle in one bin of its histogram, every moment: 27.
awk -F, 'NR > 1 && $2 == "particles" && $3 == "total mean" { n[$6] += $9 }
  END { for (t in n) if (n[t] != 27) exit 1; exit length(n) < 3 }' r/stress_histograms.csv ||
  fail "histograms do not hold all particles"

# Chosen moments; the same rows as among all.
run_code stresses r --at-time "600 s" --out one --quiet
[ "$code" -eq 0 ] || fail "stresses at a time: $(cat "$err")"
[ ! -s "$out" ] || fail "not quiet: $(cat "$out")"
[ ! -e one/particle_stress.png ] || fail "pictures of a quiet call"
grep -vxF -f r/particle_stress.csv one/particle_stress.csv && fail "a chosen snapshot differs from the same one among all"
run_code stresses r/result.h5 --at-density 0.512 --out two --quiet
[ "$code" -eq 0 ] || fail "stresses at a density: $(cat "$err")"

# A free pair, elastic: no necks, no walls, no table of necks.
cat >pair.toml <<'END'
[materials.NiAl]
library = "NiAl"
[specimen]
shape = "free"
[specimen.import]
file = "pair.csv"
length_unit = "1 um"
[process]
start_temperature = "20 degC"
[[process.stage]]
name = "apart, at last"
duration = "1 ns"
END
printf 'x,y,z,radius,material\n0,0,0,2,NiAl\n3.99,0,0,2,NiAl\n' >pair.csv
run_code stresses pair.toml --out pair
[ "$code" -eq 0 ] || fail "stresses of a pair: $(cat "$err")"
[ ! -e pair/neck_stress.csv ] || fail "a table of necks that there are not"
grep -q '^"apart, at last",specimen,all,' pair/macroscopic_stress.csv || fail "a stage with a comma: $(cat pair/macroscopic_stress.csv)"

refuses 'densify: ' 'RESULT' -- stresses
refuses 'absent' 'no such scene file' -- stresses absent.toml --out new
refuses 'absent.h5: ' 'no such result' -- stresses absent.h5
mkdir empty
refuses 'empty: ' 'neither result.h5 nor scene.toml' -- stresses empty
refuses '--at-time 10 um: ' 'time' -- stresses r --at-time "10 um"
refuses '--at-time 10 d: ' 'outside the result' -- stresses r --at-time "10 d"
refuses '--at-density 0.99: ' 'outside the run' -- stresses r --at-density 0.99
refuses '--set integration.mass_scaling=1: ' 'r is a result' -- stresses r --set integration.mass_scaling=1
# A result of another version, without wall contacts: refused before any file is made.
if command -v python3 >/dev/null && python3 -c 'import h5py' 2>/dev/null; then
  mkdir old
  cp r/result.h5 old/
  python3 -c 'import h5py
with h5py.File("old/result.h5", "r+") as f:
  for s in f["snapshots"].values(): del s["wall_contacts"]'
  refuses 'old/result.h5: ' 'run the scene again' -- stresses old --out new
fi
says 4 '/proc/none' '' -- stresses r --quiet --out /proc/none
finish
