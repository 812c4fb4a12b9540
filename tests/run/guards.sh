#!/bin/sh
# Runs that stop by themselves: exit code 3, the cause with its particle, the process time, and a last checkpoint that is
# sound.  usage: guards.sh DENSIFY FOLDER_OF_SCENES WORK_FOLDER
set -eu
densify=$1 scenes=$2 work=$3
. "$scenes/support.sh"
cp "$scenes/lattice.csv" .

# stops NAME TEXT TEXT: the scene NAME.toml stops, and again in the same way when it is resumed.
stops() {
  says 3 "$2" "$3" -- run "$1.toml" --quiet --out "$1"
  grep -q "This was at process time [0-9.e+-]* s (step [0-9]*, stage \"[a-z]*\")\.  The last good checkpoint is $1/checkpoint.h5" \
    "$err" || fail "$1: no time or no checkpoint in $(cat "$err")"
  cp "$err" "$work.log/first"
  says 3 "$2" "$3" -- run "$1.toml" --quiet --resume --out "$1"
  cmp -s "$err" "$work.log/first" || fail "$1: another end after --resume: $(cat "$err" "$work.log/first")"
}

# The limit of Hertz springs falls as they are pressed: 0.33 s is stable at the start and not under 20 MPa.
sed 's/^mass_scaling = 1e17/&\nfixed_step = "0.33 s"/' "$scenes/lattice.toml" >later.toml
stops later 'integration.fixed_step' '(particle '

# 1 N on particle 0 is 400 times what the punch carries.
cat "$scenes/lattice.toml" - >escape.toml <<'TOML'
[[load]]
particle = 0
force = ["-1 N", "0 N", "0 N"]
ramp = "500 s"
TOML
stops escape 'particle 0 ' ' has left the wall x-'

cat "$scenes/lattice.toml" - >nan.toml <<'TOML'
[[load]]
particle = 5
force = ["1e300 N", "0 N", "0 N"]
ramp = "500 s"
TOML
stops nan 'particle 5 ' 'no longer finite'

# Two free spheres with 7e5 N/m between them under 70 N: 100 um of overlap are due, and the centres are 45 um apart.
printf 'x y z radius material\n0 0 0 22.5 NiAl\n45 0 0 22.5 NiAl\n' >two.csv
cat >through.toml <<'TOML'
[materials.NiAl]
library = "NiAl"
[specimen]
shape = "free"
[specimen.import]
file = "two.csv"
length_unit = "1 um"
[contact]
elasticity = "linear"
normal_stiffness = "7e5 N/m"
damping_ratio = 0.5
[process]
[[process.stage]]
name = "pressing"
duration = "1 ms"
[[load]]
particle = 0
force = ["70 N", "0 N", "0 N"]
ramp = "0.5 ms"
[[load]]
particle = 1
force = ["-70 N", "0 N", "0 N"]
ramp = "0.5 ms"
TOML
stops through 'particles 0 and 1 have gone too far into each other' 'overlap 1.5'
finish
