#!/bin/sh
# densify compare-moduli on results and on a scene, of one material and of two, and the mistakes of its user: one
# sentence each, no file made.  Voxel elements where they were built (WITH_FEM 1 or 0).
# usage: compare_moduli.sh DENSIFY FOLDER_OF_SCENES FOLDER_OF_EXAMPLES WORK_FOLDER WITH_FEM
set -eu
densify=$1 scenes=$2 examples=$3 work=$4 with_fem=$5
. "$scenes/support.sh"

crystal_here
# at CSV COLUMN ROUTE [RESULT]: the last value of a column in the rows of a route.
at() {
  awk -F, -v column="$2" -v route="$3" -v result="${4:-}" '
    NR == 1 { for (c = 1; c <= NF; ++c) if ($c == column) k = c; next }
    $2 == route && (result == "" || $1 == result) { value = $k } END { print value }' "$1"
}
# near VALUE DUE TOLERANCE WHAT
near() { awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN { d = a - b; exit !(a != "" && d <= t && d >= -t) }' || fail "$4: $1 instead of $2"; }

# A scene is run first, its result stands beside another one.
printf 'relative_density,youngs_modulus_GPa,poissons_ratio,strength_MPa\n0.54,60,0.25,2\n0.57,70,0.26,\n' >measured.csv
run_code compare-moduli periodic.toml --out c --no-voxels --quiet --measured measured.csv
[ "$code" -eq 0 ] || fail "compare-moduli of a scene: $(cat "$err")"
[ "$(wc -l <c/comparison.csv)" -eq 19 ] || fail "not two measurements and four snapshots of four models: $(wc -l <c/comparison.csv)"
[ "$(wc -l <c/curves.csv)" -eq 102 ] || fail "not 101 densities: $(wc -l <c/curves.csv)"
[ "$(wc -l <c/deviations.csv)" -eq 15 ] || fail "not two of the measurements, three of each of four models: $(wc -l <c/deviations.csv)"
# The moduli are those of densify moduli where E does not depend on temperature.
sed 's|^library = "NiAl"|&\nyoungs_modulus = "180 GPa"\npoissons_ratio = 0.3|' periodic.toml >constant.toml
run_code compare-moduli constant.toml --out k --no-voxels --at-time "300 s"
[ "$code" -eq 0 ] || fail "compare-moduli at a time: $(cat "$err")"
grep -q 'dense E 180 GPa, nu 0.3000' "$out" || fail "the dense body is not told: $(cat "$out")"
run_code moduli k/constant --at-time "300 s" --quiet --out m
due=$(awk -F, 'NR == 1 { for (c = 1; c <= NF; ++c) if ($c == "youngs_modulus_Pa") k = c } $1 == "series" { print $k }' m/moduli.csv)
[ "$(at k/comparison.csv youngs_modulus_Pa series)" = "$due" ] || fail "not the modulus of densify moduli, $due"
# A warmer body is softer, by the material's own factor: 188 GPa at 20 degC, 150 GPa at 1400 degC.
run_code compare-moduli c/periodic --out w --no-voxels --quiet --model series --temperature "1400 degC"
[ "$code" -eq 0 ] || fail "compare-moduli at a temperature: $(cat "$err")"
near "$(awk "BEGIN { print $(at w/comparison.csv youngs_modulus_Pa series) / $(at c/comparison.csv youngs_modulus_Pa series) }")" \
  0.798 0.005 "warm over cold modulus"

# Two materials by turns: 27 spheres, of 13 of which the second, with bounds of a composite at full density.
awk -F, 'BEGIN { OFS = "," } NR > 1 && NR % 2 { $5 = "Al2O3" } { print }' periodic.csv >mixed.csv
sed 's|^library = "NiAl"|&\n[materials.Al2O3]\nlibrary = "Al2O3"\n[[interface]]\nbetween = ["NiAl", "Al2O3"]\natomic_volume = "9.01e-30 m^3"\ndiffusion_prefactor = "3e-2 m^2/s"\nactivation_enthalpy = "280 kJ/mol"\ngrain_boundary_width = "0.5 nm"\nsurface_energy = "0 J/m^2"\ndihedral_angle = "137 deg"|; s/periodic.csv/mixed.csv/' periodic.toml >mixed.toml
run_code compare-moduli c/periodic mixed.toml --out two --no-voxels --model bonded_neck --at-time "300 s"
[ "$code" -eq 0 ] || fail "two results: $(cat "$err")"
grep -q 'of 2 materials (Reuss and Voigt 2[0-9.]* to [0-9.]* GPa' "$out" || fail "no bounds of the composite: $(cat "$out")"
awk -v a="$(at two/comparison.csv youngs_modulus_Pa bonded_neck periodic)" -v b="$(at two/comparison.csv youngs_modulus_Pa bonded_neck mixed)" \
  -v s="$(at two/comparison.csv solid_youngs_modulus_Pa bonded_neck mixed)" 'BEGIN { exit !(b > 0.5 * a && b < 1.5 * a && s > 240e9 && s < 320e9) }' ||
  fail "the composite: $(cat two/comparison.csv)"

# The example goes from below 0.70 to 0.99, and has the measured rows; moduli as its README says, to the scatter of one
# packing of 200 particles under another rounding (a standard deviation of 2 % at a density).
run_code compare-moduli "$examples/moduli_nial" --out e --no-voxels --quiet --model bonded_neck \
  --measured "$examples/moduli_nial/measured.csv"
[ "$code" -eq 0 ] || fail "the example: $(cat "$err")"
[ "$(grep -c '^measured,measured,' e/comparison.csv)" -eq 18 ] || fail "not 18 measurements: $(cat e/comparison.csv)"
awk -F, '$2 == "bonded_neck" && $4 > 0.78 && $4 < 0.82' e/comparison.csv | tail -1 >middle
awk -F, '$2 == "bonded_neck" { if (!first) first = $4; last = $4 } END { exit !(first < 0.7 && last > 0.98 && last < 1) }' e/comparison.csv ||
  fail "the example's densities: $(cut -d, -f1-5 e/comparison.csv)"
near "$(awk -F, '{ print $5 / 1e9 - 570 * ($4 - 0.8) }' middle)" 91 7 "the example's modulus at 0.80, moved there with its slope"

refuses 'densify: ' 'RESULT' -- compare-moduli --out n
refuses 'densify: ' '--out' -- compare-moduli c/periodic
refuses 'absent' 'no such scene file' -- compare-moduli absent.toml --no-voxels --out n
refuses '--model bonded_nek: ' 'did you mean "bonded_neck"' -- compare-moduli c/periodic --no-voxels --model bonded_nek --out n
refuses '--at-density 0.99: ' 'outside the run, whose snapshots go from 0.5' -- compare-moduli c/periodic --no-voxels --at-density 0.99 --out n
refuses '--temperature warm: ' '' -- compare-moduli c/periodic --no-voxels --temperature warm --out n
refuses '--temperature -300degC: ' 'absolute zero' -- compare-moduli c/periodic --no-voxels --temperature=-300degC --out n
refuses '--measured none.csv: ' 'cannot be read' -- compare-moduli c/periodic --no-voxels --measured none.csv --out n
sed 's/,2.0[0-9]*,/,1.9,/' periodic.csv >apart.csv
sed 's/periodic.csv/apart.csv/; s/"-1e-4 1/"0 1/g; s/"5 min"/"100 s"/' periodic.toml >apart.toml
run_code run apart.toml --quiet --out apart
refuses 'apart/result.h5: no network spans the cell at ' '0 contacts of 27 particles' -- compare-moduli apart --no-voxels --quiet --out n
says 4 '/proc/none' '' -- compare-moduli c/periodic --no-voxels --quiet --out /proc/none

# A program without its finite elements beside it says how to get them or to do without.
mkdir alone && cp "$densify" alone/densify
data=$(dirname "$densify")/../share/densify
whole=$densify densify=$work/alone/densify
export DENSIFY_DATA="$data"
refuses 'compare-moduli with voxel elements needs deal.II' 'leave them out with --no-voxels' -- compare-moduli c/periodic --out n
run_code compare-moduli c/periodic --no-voxels --quiet --out without
[ "$code" -eq 0 ] || fail "without voxel elements: $(cat "$err")"
unset DENSIFY_DATA
densify=$whole

if [ "$with_fem" -eq 1 ]; then
  # Voxels of all snapshots or of chosen ones, as densify voxel-moduli finds them.
  run_code compare-moduli constant.toml --out v --at-time "300 s" --at-time "100 s" --voxels 11 --voxels 17 --voxel-density 0.6 --model series
  [ "$code" -eq 0 ] || fail "voxels: $(cat "$err")"
  grep -q 'fewer than 4: too coarse to trust' "$out" || fail "coarse voxels are not told"
  [ "$(grep -c ',voxels,' v/comparison.csv)" -eq 1 ] || fail "not one row of voxels: $(cat v/comparison.csv)"
  grep -q '^constant,series,voxels,1,' v/deviations.csv || fail "the network is not held against voxels: $(cat v/deviations.csv)"
  time=$(at v/comparison.csv time_s voxels)
  run_code voxel-moduli v/constant --at-time "$time s" --voxels 11 --voxels 17 --quiet --out x
  due=$(awk -F, 'NR == 1 { for (c = 1; c <= NF; ++c) if ($c == "youngs_modulus_Pa") k = c } END { print $k }' x/voxel_moduli.csv)
  [ "$(at v/comparison.csv youngs_modulus_Pa voxels)" = "$due" ] || fail "voxels: $(at v/comparison.csv youngs_modulus_Pa voxels), not $due"
  refuses '--voxel-density 0.9: outside ' 'go from 0.5' -- compare-moduli c/periodic --voxel-density 0.9 --out n
  cp "$scenes/lattice.toml" "$scenes/lattice.csv" .
  refuses 'lattice.toml: voxel elements need a periodic cell' '--no-voxels' -- compare-moduli lattice.toml --out n
  run_code run lattice.toml --quiet --out box
  refuses 'box/result.h5: voxel elements need a periodic cell' '--no-voxels' -- compare-moduli box --out n
fi
finish
