#!/bin/sh
# What --resume makes of damaged checkpoints, of those of another scene, and of folders that a run left in the middle.
# usage: checkpoints.sh DENSIFY FOLDER_OF_SCENES WORK_FOLDER
set -eu
densify=$1 scenes=$2 work=$3
. "$scenes/support.sh"
cp "$scenes/lattice.toml" "$scenes/lattice.csv" .

run_code run lattice.toml --quiet --out whole
[ "$code" -eq 0 ] || fail "the lattice: $(cat "$err")"

# A run in the middle: it ends with an error when history.csv reaches 100 blocks of 512 bytes.
code=0
(ulimit -f 100; exec "$densify" run lattice.toml --quiet --out half 2>"$err") || code=$?
[ "$code" -eq 4 ] || fail "a history without room: exit code $code: $(cat "$err")"
[ -f half/checkpoint.h5 ] || fail "no checkpoint before the first step"

# damaged FILE COMMAND: the run in the middle with one file changed by a command that writes the new one from the old.
damaged() {
  rm -rf trial && cp -r half trial
  eval "$2" <"half/$1" >"trial/$1"
  refuses "trial/$1" 'start again without --resume' -- run lattice.toml --quiet --resume --out trial
}
damaged checkpoint.h5 'echo garbage'
damaged checkpoint.h5 'true'
damaged checkpoint.h5 'head -c 300'
damaged checkpoint.h5 'head -c 20000'
damaged checkpoint.h5 'tr "\\000" "\\001"'
damaged specimen.h5 'echo garbage'
damaged specimen.h5 'head -c 3000'
damaged history.csv 'head -c 100'  # shorter than its header: short for a checkpoint of any moment
damaged history.csv 'tr t T'
rm -rf trial && cp -r half trial && rm trial/specimen.h5
refuses 'trial/specimen.h5' 'start again without --resume' -- run lattice.toml --quiet --resume --out trial

# other_scene TEXT ARGUMENT...: the same folder with a scene that has another trajectory.
for change in contact.damping_ratio=0.2 process.stage.1.pressure="21 MPa" integration.mass_scaling=2e17 \
  specimen.import.length_unit="1.001 um" walls.thermal_expansion="0 1/K" 'specimen.size=["13 um", "12 um", "12 um"]'; do
  refuses 'half/checkpoint.h5' 'belongs to another scene' -- \
    run lattice.toml --quiet --resume --out half --set "$change"
done

# Title and output may change; the end is the same state.
rm -rf trial && cp -r half trial
run_code run lattice.toml --quiet --resume --out trial --set title="another title" \
  --set output.checkpoint_interval="1 h" --set output.visualisation=false
[ "$code" -eq 0 ] || fail "another title: $(cat "$err")"
same_end whole trial
# Unchanged, and on a copy in another place.
mkdir elsewhere && cp -r half elsewhere/half
run_code run lattice.toml --quiet --resume --out elsewhere/half
[ "$code" -eq 0 ] || fail "a copied folder: $(cat "$err")"
same_end whole elsewhere/half
# A finished run may be resumed: nothing happens twice.
run_code run lattice.toml --quiet --resume --out elsewhere/half
[ "$code" -eq 0 ] || fail "a finished run: $(cat "$err")"
same_end whole elsewhere/half

# What a run leaves that ends before its first checkpoint does not stand in the way of the next.
mkdir early && cp half/specimen.h5 early/ && head -n 1 half/history.csv >early/history.csv
echo part >early/checkpoint.h5.tmp
run_code run lattice.toml --quiet --out early
[ "$code" -eq 0 ] || fail "a folder without a checkpoint: $(cat "$err")"
same_end whole early
[ "$(ls early)" = "$(ls whole)" ] || fail "other files than of a whole run: $(ls early)"
finish
