#!/bin/sh
# densify moduli on results and on a scene, and the mistakes of its user: one sentence each, no file made.
# usage: moduli.sh DENSIFY FOLDER_OF_SCENES WORK_FOLDER
set -eu
densify=$1 scenes=$2 work=$3
. "$scenes/support.sh"

crystal_here

# A scene is run first; its result then needs no run.
run_code moduli periodic.toml --out r --quiet
[ "$code" -eq 0 ] || fail "moduli of a scene: $(cat "$err")"
[ "$(wc -l <r/moduli.csv)" -eq 17 ] || fail "not four snapshots of four models: $(wc -l <r/moduli.csv)"
[ "$(wc -l <r/viscosities.csv)" -eq 5 ] || fail "not four snapshots: $(wc -l <r/viscosities.csv)"
[ -s r/moduli.h5 ] || fail "no moduli.h5"
cp r/moduli.csv all.csv
run_code moduli r --at-time "300 s" --model series --out last --soft-modes
[ "$code" -eq 0 ] || fail "moduli of a result: $(cat "$err")"
grep -q 'motions without resistance' "$out" || fail "soft modes are not told"
# The same to the last bit of everything but times and counts: the first twenty columns hold densities and moduli.
tail -1 last/moduli.csv | cut -d, -f1-20 >one
tail -1 all.csv | cut -d, -f1-20 >other
cmp one other || fail "a chosen snapshot differs from the same one among all"
run_code moduli r/result.h5 --at-density 0.59 --at-density 0.63 --model bonded_neck --tangential 0.5 --out two
[ "$code" -eq 0 ] || fail "moduli at densities: $(cat "$err")"

refuses 'densify: ' 'RESULT' -- moduli
refuses 'absent' 'no such scene file' -- moduli absent.toml --out new
refuses 'absent.h5: ' 'no such result' -- moduli absent.h5
mkdir empty several several/realisation_001
: >several/realisation_001/result.h5
refuses 'empty: ' 'neither result.h5 nor scene.toml' -- moduli empty
refuses 'several: ' 'realisation_001' -- moduli several
refuses '--model bonded_nek: ' 'did you mean "bonded_neck"' -- moduli r --model bonded_nek
refuses '--at-time 10 um: ' 'time' -- moduli r --at-time "10 um"
refuses '--at-time 1 h: ' 'go from 0 s to 300 s' -- moduli r --at-time "1 h"
refuses '--at-density 0.99: ' 'outside the run, whose snapshots go from 0.5' -- moduli r --at-density 0.99
refuses '--tangential' '' -- moduli r --tangential=-1
refuses '--rigid' '' -- moduli r --rigid 0.1
refuses '--set integration.mass_scaling=1: ' 'r is a result' -- moduli r --set integration.mass_scaling=1
# What has no network that spans, no cell, no inner region, no spring.
sed 's/,2.0[0-9]*,/,1.9,/' periodic.csv >apart.csv
sed 's/periodic.csv/apart.csv/; s/"-1e-4 1/"0 1/g; s/"5 min"/"100 s"/' periodic.toml >apart.toml
run_code run apart.toml --quiet --out apart
refuses 'no network spans the cell at ' '0 contacts of 27 particles' -- moduli apart
sed '/cell/,/^z/d; s/"periodic"/"free"/' periodic.toml >free.toml
run_code run free.toml --quiet --out free
refuses 'free/result.h5: ' 'neither a periodic cell nor walls' -- moduli free
cp "$scenes/lattice.toml" "$scenes/lattice.csv" .
run_code run lattice.toml --quiet --out box
refuses 'box/result.h5: ' 'no region lies two mean diameters from every wall' -- moduli box
sed 's/^damping_ratio = 0.3/&\nmodel = "viscous"/' periodic.toml >viscous.toml
run_code run viscous.toml --quiet --out viscous
[ "$code" -eq 0 ] || fail "the viscous run: $(cat "$err")"
refuses '--model normal_spring: ' 'has no spring' -- moduli viscous --model normal_spring
run_code moduli viscous --quiet --out of_viscous
[ "$code" -eq 0 ] || fail "moduli of a viscous result: $(cat "$err")"
# Springs along the lines of a crystal hardly hold it: with particles off their places by 1e-4 of the edge rows glide against
# 1e-8 of a spring, so little that rounding shows.  That model has no number, the others have theirs.
awk -F, 'NR > 1 { $1 += 1e-3 * (NR * 7919 % 13 - 6) / 6; $2 += 1e-3 * (NR * 104729 % 11 - 5) / 5 }
  { print $1 "," $2 "," $3 "," $4 "," $5 }' periodic.csv >shaken.csv
sed 's/periodic.csv/shaken.csv/' periodic.toml >shaken.toml
run_code run shaken.toml --quiet --out shaken
run_code moduli shaken --at-time "0 s" --model normal_spring --model bonded_neck
[ "$code" -eq 0 ] || fail "moduli of a crystal that springs hardly hold: $(cat "$err")"
grep -q '^warning: normal_spring at relative density 0.58.* is nan: stress times rate' "$out" ||
  fail "not told that a model failed: $(cat "$out")"
awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == "youngs_modulus_Pa") c = k }
  NR == 2 && $c != "nan" || NR == 3 && !($c > 1e9) { exit 1 }' shaken/moduli.csv ||
  fail "not one model nan and the other a number: $(cut -d, -f1-20 shaken/moduli.csv)"
says 4 '/proc/none' '' -- moduli r --quiet --out /proc/none
finish
