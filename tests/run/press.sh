#!/bin/sh
# densify run of a scene with [press]: killed and resumed it is the run that was left alone, bit for bit; two ranks give the
# result of one; input that cannot be is refused in a sentence with exit code 2, and nothing is written.
# usage: press.sh DENSIFY FOLDER_OF_SCENES WORK_FOLDER
set -eu
densify=$1 scene=$2/press_scene.toml dem_scene=$2/small_press.toml work=$3
rm -rf "$work"
mkdir -p "$work"

fail() { echo "$*" >&2; exit 1; }
# refused WORDS COMMAND...: exit code 2, the words in what it says.
refused() {
  words=$1 code=0
  shift
  "$@" >"$work/said" 2>&1 || code=$?
  [ "$code" = 2 ] || fail "exit code $code, not 2: $*"
  grep -q "$words" "$work/said" || { cat "$work/said" >&2; fail "does not say \"$words\": $*"; }
}

"$densify" run "$scene" --quiet --out "$work/whole"
kills=0
"$densify" run "$scene" --quiet --out "$work/killed" &
pid=$!
while [ "$kills" -lt 2 ]; do
  rows=0
  while kill -0 "$pid" 2>/dev/null && [ "$rows" -lt $((20 + 40 * kills)) ]; do
    sleep 0.05
    [ ! -f "$work/killed/history.csv" ] || rows=$(wc -l <"$work/killed/history.csv")
  done
  kill -KILL "$pid" 2>/dev/null || fail "the run ended before it could be killed twice"
  wait "$pid" 2>/dev/null || true
  kills=$((kills + 1))
  "$densify" run "$scene" --quiet --resume --out "$work/killed" &
  pid=$!
done
wait "$pid"
cmp "$work/whole/history.csv" "$work/killed/history.csv"
[ -f "$work/whole/fields.pvd" ] || fail "no fields"

"$densify" run "$scene" --quiet --ranks 2 --out "$work/two"
for name in whole two; do tail -n 1 "$work/$name/history.csv" | cut -d, -f5,9; done |
  awk -F, '{d[NR] = $1; h[NR] = $2} END {a = d[1] - d[2]; b = h[1] / h[2] - 1; exit !(a*a < 1e-14 && b*b < 1e-14)}' ||
  fail "two ranks differ from one by more than 1e-7"

# Stopped on two ranks, it goes on on one.
"$densify" run "$scene" --quiet --ranks 2 --set press.elements_radial=5 --set press.elements_axial=3 --out "$work/crossed" &
pid=$!
rows=0
while [ "$rows" -lt 40 ]; do
  sleep 0.05
  [ ! -f "$work/crossed/history.csv" ] || rows=$(wc -l <"$work/crossed/history.csv")
done
kill -KILL "$pid" 2>/dev/null || true
wait "$pid" 2>/dev/null || true
pkill -KILL -f "$work/crossed" || true
"$densify" run "$scene" --quiet --resume --set press.elements_radial=5 --set press.elements_axial=3 --out "$work/crossed"
"$densify" run "$scene" --quiet --set press.elements_radial=5 --set press.elements_axial=3 --out "$work/straight"
for name in crossed straight; do tail -n 1 "$work/$name/history.csv" | cut -d, -f5,9; done |
  awk -F, '{d[NR] = $1; h[NR] = $2} END {a = d[1] - d[2]; b = h[1] / h[2] - 1; exit !(a*a < 1e-12 && b*b < 1e-12)}' ||
  fail "resumed at another number of ranks it differs by more than 1e-6"

refused "more than\|only 12 elements" "$densify" run "$scene" --ranks 13 --out "$work/many"
refused "\[press\]" "$densify" run "$dem_scene" --ranks 2 --out "$work/dem"
refused "press.die.friction" "$densify" run "$scene" --set press.die.friction=-1 --out "$work/negative"
refused "scene is not the one" "$densify" run "$scene" --set press.die.friction=0.2 --resume --out "$work/whole"
refused "whole" "$densify" run "$scene" --ranks 2 --out "$work/whole"
for name in many dem negative; do [ ! -e "$work/$name" ] || fail "$name was written"; done
