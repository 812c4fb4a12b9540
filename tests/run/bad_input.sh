#!/bin/sh
# Mistakes of a user, each through the command line: exit code 2, one sentence that names file, line and key, and no
# file made, changed or removed.  usage: bad_input.sh DENSIFY FOLDER_OF_SCENES WORK_FOLDER
set -eu
densify=$1 scenes=$2 work=$3
. "$scenes/support.sh"
cp "$scenes/lattice.toml" "$scenes/lattice.csv" .
sed 's/number = 120/number = 30/' "$scenes/small_press.toml" >press.toml
mkdir empty

# mistake FROM TO LINE TEXT: the lattice with one line changed; LINE is the start of the message.
mistake() {
  sed "s|^$1\$|$2|" lattice.toml >mistake.toml
  ! cmp -s lattice.toml mistake.toml || fail "no line $1"
  refuses "densify: mistake.toml:$3: " "$4" -- run mistake.toml --out new
  refuses "densify: mistake.toml:$3: " "$4" -- check mistake.toml
}
# press_mistake FROM TO TEXT: the same with a powder.
press_mistake() {
  sed "s|^$1\$|$2|" press.toml >mistake.toml
  ! cmp -s press.toml mistake.toml || fail "no line $1"
  refuses "densify: mistake.toml:" "$3" -- run mistake.toml --quiet --out new
}
# particle LINE TEXT: the lattice whose first particle is this one; it stands in line 3.
particle() {
  sed "3s|.*|$1|" "$scenes/lattice.csv" >lattice.csv
  refuses "lattice.csv:3: " "$2" -- run lattice.toml --out new
  refuses "lattice.csv:3: " "$2" -- check lattice.toml
  cp "$scenes/lattice.csv" lattice.csv
}

mistake 'damping_ratio = 0.1' 'damping_ration = 0.1' 19 'contact.damping_ration: unknown key; did you mean "damping_ratio"'
mistake 'coefficient = 0.2' 'coeficient = 0.2' 21 'contact.friction.coefficient: missing'
mistake 'duration = "10 min"' 'duration = "10 kg"' 32 'process.stage.1.duration'
mistake 'duration = "10 min"' 'duration = 600' 32 'process.stage.1.duration: a bare number'
mistake 'damping_ratio = 0.1' 'normal_stiffness = "-7e5 N/m"\nelasticity = "linear"' 19 'normal_stiffness: must be > 0'
mistake 'library = "NiAl"' 'library = "NiAl"\npoissons_ratio = 2' 6 'poissons_ratio'
mistake 'temperature = "1300 degC"' 'temperature = "300 degC"' 30 'sintering would never start'
mistake 'rate = "30 K/min"' 'end = "5 min"' 37 'goes back in time'
mistake 'file = "lattice.csv"' 'file = "absent.csv"' 12 'absent.csv'
mistake 'file = "lattice.csv"' 'file = "."' 12 'specimen.import.file'

particle '2,2,2,-2,NiAl' 'radius'
particle 'nan,2,2,2,NiAl' 'finite'
particle '2,2,2,2,NiAI' 'did you mean "NiAl"'
particle '1,2,2,1.8,NiAl' 'outside the container'
particle '5,2,2,2,NiAl' 'overlap'
particle '2,2,2,2' 'columns'

press_mistake 'mean = "4 um"' 'mean = "-4 um"' 'powder.1.mean: must be > 0'
press_mistake 'minimum = "2.5 um"' 'minimum = "0 um"' 'powder.1.minimum: must be > 0'
press_mistake 'number = 30' 'number = 0' 'powder.1.number: must be >= 1'
press_mistake 'green_density = 0.5' 'green_density = 0.9' 'specimen.packing.green_density: 0.9'
press_mistake 'number = 30' 'number = 1' 'specimen.packing.green_density'

# The command line itself.
refuses 'densify: ' 'command' --
refuses '"rum" is not a command' 'did you mean "run"' -- rum lattice.toml
refuses 'densify: ' 'SCENE' -- run
refuses 'densify: ' '--threads' -- run lattice.toml --threads 0 --out new
refuses 'densify: ' '--threads' -- run lattice.toml --threads two --out new
refuses 'densify: ' '--frobnicate' -- run lattice.toml --frobnicate --out new
refuses 'densify: no.toml: ' 'no such scene file' -- run no.toml --out new
refuses 'densify: empty/scene.toml: ' 'no such scene file' -- run empty --out new
refuses 'densify: ' 'lattice.csv' -- run lattice.csv --out new
refuses 'densify: --set contact.fricton.coefficient=0.1: ' 'did you mean' -- \
  run lattice.toml --set contact.fricton.coefficient=0.1 --out new
refuses 'densify: --set contact: ' 'path.to.key=value' -- run lattice.toml --set contact --out new
refuses 'densify: --set integration.mass_scaling=heavy: ' 'integration.mass_scaling' -- \
  run lattice.toml --set integration.mass_scaling=heavy --out new
sed 's/^mass_scaling = 1e17/fixed_step = "1 s"\n&/' lattice.toml >mistake.toml
refuses 'densify: mistake.toml:46: integration.fixed_step: ' 'stability limit' -- run mistake.toml --quiet --out new
refuses 'densify: mistake.toml:46: integration.fixed_step: ' 'stability limit' -- check mistake.toml
refuses 'densify: --set integration.fixed_step=50 s: ' '50 s is above the stability limit of 0.35' -- \
  run lattice.toml --quiet --set 'integration.fixed_step=50 s' --out new

# The folder of the results.
mkdir other && echo 'precious' >other/notes.txt
refuses 'densify: --out other: ' 'nothing was changed' -- run lattice.toml --out other
refuses 'densify: --out lattice.csv: ' 'not a folder' -- run lattice.toml --out lattice.csv
refuses 'densify: --resume: absent ' 'start the run without --resume' -- run lattice.toml --resume --out absent
refuses 'densify: --resume: empty ' 'start the run without --resume' -- run lattice.toml --resume --out empty
refuses 'densify: --resume: other ' 'in another folder' -- run lattice.toml --resume --out other
run_code run lattice.toml --quiet --out done
[ "$code" -eq 0 ] || fail "the lattice: $(cat "$err")"
refuses 'densify: --out done: ' 'continue that run with --resume' -- run lattice.toml --out done
rm done/checkpoint.h5
refuses 'densify: --out done: ' 'the folder holds other results' -- run lattice.toml --out done
refuses 'densify: --resume: done ' 'in another folder' -- run lattice.toml --resume --out done
if [ "$(id -u)" -ne 0 ]; then  # root may write everywhere
  mkdir locked && chmod a-w locked
  says 4 'locked' '--out' -- run lattice.toml --quiet --out locked/here
  chmod u+w locked
fi
says 4 '/proc/none' '--out' -- run lattice.toml --quiet --out /proc/none
finish
