#!/bin/sh
# densify voxel-moduli on a result, on a scene and on random spheres, on one rank and two, and the mistakes of its user:
# one sentence each, no file made.  usage: voxel_moduli.sh DENSIFY FOLDER_OF_SCENES WORK_FOLDER
set -eu
densify=$1 scenes=$2 work=$3
. "$scenes/support.sh"

crystal_here

# A scene is run first; its result then needs no run.  The solid fraction of the voxels is the relative density
# (in a crystal many voxels are equally far from a sphere, and come together).
run_code voxel-moduli periodic.toml --out r --quiet --voxels 11 --voxels 17
[ "$code" -eq 0 ] || fail "voxel-moduli of a scene: $(cat "$err")"
[ "$(wc -l <r/voxel_moduli.csv)" -eq 5 ] || fail "not four snapshots: $(wc -l <r/voxel_moduli.csv)"
[ "$(wc -l <r/voxel_resolutions.csv)" -eq 9 ] || fail "not four snapshots of two resolutions"
[ -s r/voxel_moduli.h5 ] || fail "no voxel_moduli.h5"
awk -F, 'NR == 1 { for (c = 1; c <= NF; ++c) at[$c] = c; next }
  { d = $at["solid_fraction_1"] - $at["relative_density_1"]; if (d < -0.02 || d > 0.02) exit 1
    if ($at["drawn_fraction_1"] > $at["relative_density_1"] + 0.02) exit 1 }' r/voxel_resolutions.csv ||
  fail "solid fraction and relative density differ: $(cut -d, -f1-8 r/voxel_resolutions.csv)"

# Two ranks give the same moduli, to the tolerance of the solution.
run_code voxel-moduli r --at-time "300 s" --voxels 18 --out two --ranks 2 --quiet
[ "$code" -eq 0 ] || fail "two ranks: $(cat "$err")"
run_code voxel-moduli r --at-time "300 s" --voxels 18 --out one --quiet
[ "$code" -eq 0 ] || fail "one rank: $(cat "$err")"
modulus() { awk -F, 'NR == 1 { for (c = 1; c <= NF; ++c) if ($c == "youngs_modulus_Pa") k = c } END { print $k }' "$1/voxel_moduli.csv"; }
awk -v one="$(modulus one)" -v two="$(modulus two)" 'BEGIN { d = one / two - 1; exit !(d < 1e-4 && d > -1e-4) }' ||
  fail "ranks: $(modulus one), $(modulus two)"
run_code voxel-moduli r --at-time "300 s" --voxels 18 --out pores --pores --quiet
[ "$code" -eq 0 ] || fail "pores: $(cat "$err")"

run_code voxel-moduli --spheres pores --solid-fraction 0.8 --realisations 2 --voxels 12 --out spheres
[ "$code" -eq 0 ] || fail "random spheres: $(cat "$err")"
[ "$(wc -l <spheres/voxel_moduli.csv)" -eq 3 ] || fail "not two realisations"

# Mistakes.
refuses 'takes a RESULT or --spheres, one of the two' '' -- voxel-moduli --voxels 8
refuses '--spheres needs --solid-fraction' '' -- voxel-moduli --spheres solid --out none
refuses '--spheres needs --out' '' -- voxel-moduli --spheres solid --solid-fraction 0.7
refuses 'resists nothing; take more voxels or a denser packing' '' -- \
  voxel-moduli --quiet --spheres solid --solid-fraction 0.1 --voxels 12 --out none
refuses 'outside the run' '' -- voxel-moduli r --at-density 0.99 --out none
refuses 'no such result' '' -- voxel-moduli missing.h5 --out none
refuses '--solid-fraction goes with --spheres' '' -- voxel-moduli r --solid-fraction 0.5 --out none
refuses '--spheres takes no moments' '' -- voxel-moduli --spheres solid --solid-fraction 0.8 --pores --out none
refuses 'too few for a random body' 'take a box of' -- voxel-moduli --quiet --spheres pores --solid-fraction 0.999 --out none
refuses '--ranks none' 'from 1 to 4096' -- voxel-moduli r --ranks none --out none
run_code voxel-moduli periodic.toml --ranks 2 --out none
{ [ "$code" -eq 2 ] && grep -q 'several ranks take a result that is there' "$err"; } || fail "a scene on two ranks: $(cat "$err")"
cp "$scenes/lattice.csv" "$scenes/lattice.toml" .
run_code run lattice.toml --quiet --out die
[ "$code" -eq 0 ] || fail "the lattice: $(cat "$err")"
refuses 'die/result.h5: ' 'need a periodic cell' -- voxel-moduli die --voxels 8 --out none
finish
