#!/bin/sh
# `densify check` forecasts the number of steps of the shipped scenes, made cheap by a larger mass factor and a smaller
# specimen, within a factor of three of what the runs take; and it writes nothing.
# usage: forecast.sh DENSIFY FOLDER_OF_SCENES EXAMPLES WORK_FOLDER
set -eu
densify=$1 scenes=$2 examples=$3 work=$4
. "$scenes/support.sh"
cp "$scenes/lattice.toml" "$scenes/lattice.csv" "$scenes/small_press.toml" .

# forecast SCENE ARGUMENT...: prints forecast over taken.
number=0
forecast() {
  number=$((number + 1))
  inventory >"$work.log/before"
  run_code check "$@"
  inventory >"$work.log/after"
  cmp -s "$work.log/before" "$work.log/after" || fail "check $*: files written"
  [ "$code" -eq 0 ] && grep -q '^the scene is valid$' "$out" || fail "check $*: $(cat "$err")"
  due=$(sed -n 's/^steps *about \([0-9.e+]*\) of.*/\1/p' "$out")
  run_code run "$@" --quiet --out "run_$number" --set output.visualisation=false
  [ "$code" -eq 0 ] || fail "run $*: $(cat "$err")"
  taken=$(tail -n 1 "run_$number/history.csv" | sed 's/.*,//')
  awk -v f="$due" -v n="$taken" -v what="$*" 'BEGIN { printf "%.2f  %g / %g  %s\n", f / n, f, n, what
    exit !(f > n / 3 && f < 3 * n) }' || fail "$*: $due steps forecast, $taken taken"
}

forecast lattice.toml
forecast small_press.toml
for scene in scene scene_process_2 scene_second_reading; do
  forecast "$examples/hot_press_nial/$scene.toml" --set powder.1.number=500 --set 'specimen.diameter=46 um' \
    --set specimen.packing.green_density=0.64 --set integration.mass_scaling=1e19
done
forecast "$examples/two_copper_spheres/scene.toml" --set integration.mass_scaling=1e17
forecast "$examples/two_copper_spheres/scene_under_force.toml"
forecast "$examples/two_copper_spheres/scene_viscous.toml" --set integration.mass_scaling=1e19
forecast "$examples/bcc_copper/scene.toml" --set integration.mass_scaling=1e18

# A fixed step above the forecast of a specimen that is not packed yet: a warning, and the run refuses it.
run_code check small_press.toml --set 'integration.fixed_step=5 s'
[ "$code" -eq 0 ] && grep -q '^warning: integration.fixed_step is above' "$out" || fail "no warning: $(cat "$out" "$err")"
refuses 'integration.fixed_step' 'stability limit' -- run small_press.toml --quiet --set 'integration.fixed_step=5 s' --out new
run_code check small_press.toml --set 'integration.fixed_step=0.01 s'
[ "$code" -eq 0 ] && ! grep -q '^warning' "$out" || fail "a warning for a small step: $(cat "$out")"
finish
