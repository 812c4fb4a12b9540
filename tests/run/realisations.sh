#!/bin/sh
# realisations = n: each is the run of its seed bit for bit, history.csv is their mean with the standard error
# sqrt(sum (x - mean)^2 / (n (n - 1))), an ensemble interrupted or killed and resumed is the undisturbed one bit for bit,
# and perturbations share one packing.  usage: realisations.sh DENSIFY FOLDER_OF_SCENES WORK_FOLDER
set -eu
densify=$1 scenes=$2 work=$3
. "$scenes/support.sh"
cp "$scenes/lattice.csv" "$scenes/lattice.toml" .
sed 's/number = 120/number = 30/; s/green_density = 0.5/green_density = 0.4/; s/checkpoint_interval = .*/checkpoint_interval = "0.02 s"/
s/mass_scaling = 1e18/mass_scaling = 1e17/
/^title/a realisations = 3' "$scenes/small_press.toml" >press.toml

# good FOLDER ARGUMENT...: a quiet run that must go well.
good() {
  folder=$1
  shift
  run_code run --quiet --out "$folder" "$@"
  [ "$code" -eq 0 ] || fail "$*: exit code $code: $(cat "$err")"
}

# same_ensemble FOLDER FOLDER NUMBER: two finished ensembles agree bit for bit.
same_ensemble() {
  for k in $(seq "$3"); do same_end "$1/realisation_00$k" "$2/realisation_00$k"; done
  cmp "$1/history.csv" "$2/history.csv" || fail "$2: another mean than $1"
  cmp "$1/realisations.csv" "$2/realisations.csv" || fail "$2: another table than $1"
}

# column FILE NAME: the last value.
column() {
  awk -F, -v name="$2" 'NR == 1 { for (c = 1; c <= NF; ++c) if ($c == name) k = c } END { if (k) print $k }' "$1"
}

good whole press.toml --threads 2
good alone press.toml --set realisations=1 --set specimen.packing.seed=3
same_end alone whole/realisation_003
cmp -s whole/realisation_001/history.csv whole/realisation_002/history.csv && fail "two seeds, one history"
for name in relative_density stress_zz_Pa coordination_number; do
  for k in 1 2 3; do column whole/realisation_00$k/history.csv $name; done |
    awk -v name=$name -v mean="$(column whole/history.csv $name)" \
      -v error="$(column whole/history.csv ${name}_standard_error)" '
      { x[NR] = $1; sum += $1 }
      function off(a, b) { d = a - b; return d < 0 ? -d : d }
      END {
        m = sum / 3
        for (k = 1; k <= 3; ++k) s += (x[k] - m) ^ 2
        e = sqrt(s / 6)
        size = m < 0 ? -m : m
        # awk prints and reads six digits of the numbers that it computes with, no more are compared
        if (NR != 3 || !(e > 0) || off(m, mean) > 1e-5 * size || off(e, error) > 1e-5 * size) {
          print name, m, mean, e, error
          exit 1
        }
      }' || fail "the mean or standard error of $name"
done

# Interrupted, then killed, then resumed to the end; then with a fourth realisation that had not been there.
for signal in INT KILL; do
  set -- press.toml --quiet --out stopped --threads 2
  [ ! -f stopped/realisation_001/checkpoint.h5 ] || set -- "$@" --resume
  "$densify" run "$@" 2>"$err" &
  pid=$!
  rounds=0
  until [ -f stopped/realisation_001/checkpoint.h5 ] || [ "$rounds" -ge 3000 ]; do
    rounds=$((rounds + 1))
    sleep 0.01
  done
  [ "$signal" = INT ] || sleep 0.1
  kill -"$signal" "$pid"
  code=0
  wait "$pid" || code=$?
  case $signal in
    INT) [ "$code" -eq 5 ] && grep -q 'continue with --resume --out stopped$' "$err" ;;
    KILL) [ "$code" -eq 137 ] ;;
  esac || fail "SIG$signal: exit code $code: $(cat "$err")"
  [ ! -f stopped/history.csv ] || fail "SIG$signal: came too late"
done
good stopped press.toml --resume --threads 2
same_ensemble whole stopped 3
good stopped press.toml --resume --set realisations=4
[ "$(wc -l <stopped/realisations.csv)" -eq 5 ] || fail "a fourth realisation is not there"
refuses "holds other results" "--resume" -- run press.toml --out whole

# Perturbations of one packing, and of imported particles.
set -- --set specimen.perturbation.size=1e-3
good shaken press.toml "$@" --set realisations=2
[ -f shaken/packing.h5 ] || fail "no packing that perturbations share"
good shaken_alone press.toml "$@" --set realisations=1 --set specimen.perturbation.seed=2
same_end shaken_alone shaken/realisation_002
cmp -s shaken/realisation_001/history.csv shaken/realisation_002/history.csv && fail "two perturbations, one history"
good lattice lattice.toml "$@" --set realisations=2
refuses "specimen.perturbation.size" "the same in every realisation" -- run lattice.toml --set realisations=2

# The summary.
run_code run press.toml --out told --set realisations=2
[ "$code" -eq 0 ] || fail "told: $(cat "$err")"
grep -q '^relative density 0\.[0-9]* +- 0\.[0-9]* numerical +- 0\.[0-9]* from the particle arrangement (from one to the next +- 0\.' "$out" || fail "$(cat "$out")"
finish
