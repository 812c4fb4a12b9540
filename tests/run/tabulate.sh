#!/bin/sh
# densify tabulate and a pressing by its table: any number of threads makes the same file; without a table, with one of another
# powder, or where it ends, the run is refused in a sentence.
# usage: tabulate.sh DENSIFY FOLDER_OF_SCENES WORK_FOLDER
set -eu
densify=$1 work=$3
rm -rf "$work"
mkdir -p "$work"
cp "$2/tabulate_scene.toml" "$work/scene.toml"
scene=$work/scene.toml

fail() { echo "$*" >&2; exit 1; }
# refused CODE WORDS COMMAND...: that exit code, the words in what it says.
refused() {
  due=$1 words=$2 code=0
  shift 2
  "$@" >"$work/said" 2>&1 || code=$?
  [ "$code" = "$due" ] || { cat "$work/said" >&2; fail "exit code $code, not $due: $*"; }
  grep -q "$words" "$work/said" || { cat "$work/said" >&2; fail "does not say \"$words\": $*"; }
}

refused 2 "there is no such table; densify tabulate" "$densify" run "$scene" --out "$work/none"
"$densify" tabulate "$scene" --quiet
"$densify" tabulate "$scene" --quiet --threads 1 --out "$work/one.h5"
cmp "$work/table.h5" "$work/one.h5"
"$densify" run "$scene" --quiet --out "$work/result"
last=$(tail -n 1 "$work/result/history.csv" | cut -d, -f5)
awk -v density="$last" 'BEGIN { exit !(density > 0.8 && density < 1) }' || fail "ends at a relative density of $last"

# Where nothing says how dense the powder is, it is what the table has at the pressure that the process begins with.
start() { "$densify" run "$scene" --quiet --set press.relative_density= --set process.start_pressure="$1" --out "$2"; }
start "5 MPa" "$work/pressed"
first=$(sed -n 2p "$work/pressed/history.csv" | cut -d, -f5)
awk -v density="$first" 'BEGIN { exit !(density > 0.6 && density < 0.7) }' || fail "begins at $first under 5 MPa"
refused 2 "start_pressure.*says nothing of loose powder under 900 MPa" start "900 MPa" "$work/none"
refused 2 "relative_density is missing" start "0 MPa" "$work/none"

sed 's/materials.NiAl/materials.other/; s/material = "NiAl"/material = "other"/' "$scene" >"$work/other.toml"
refused 2 "is a table of NiAl, and \[rve\] is of other" "$densify" run "$work/other.toml" --out "$work/other"
refused 3 "is outside the table" "$densify" run "$scene" --set press.table.extrapolate=refuse \
  --set press.relative_density=0.6 --out "$work/outside"
refused 2 "do not grow" "$densify" tabulate "$scene" --set 'tabulate.pressure_factors=[2, 1]' --out "$work/no.h5"
refused 2 "nothing to tabulate" "$densify" tabulate "$scene" --set rve.contact.sintering= --out "$work/no.h5"
refused 2 "volume element" "$densify" tabulate "$2/press_scene.toml" --out "$work/no.h5"
[ ! -e "$work/no.h5" ] || fail "a refused table is there"
