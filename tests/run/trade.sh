#!/bin/sh
# densify trade: errors in trade.csv are those of the histories on disk, a ladder killed and resumed gives the same
# errors bit for bit, packings are shared, mistakes are refused.  usage: trade.sh DENSIFY FOLDER_OF_SCENES WORK_FOLDER
set -eu
densify=$1 scenes=$2 work=$3
. "$scenes/support.sh"
sed 's/number = 120/number = 30/; s/green_density = 0.5/green_density = 0.4/' "$scenes/small_press.toml" >press.toml
cat >ladder.toml <<'LADDER'
realisations = 2
[[rung]]
name = "fine"
converged = true
[[rung]]
name = "coarse"
set = ["integration.mass_scaling=1e20"]
LADDER

# field FILE ROW NAME: a field of a table without commas in its texts.
field() {
  awk -F, -v row="$2" -v name="$3" 'NR == 1 { for (c = 1; c <= NF; ++c) if ($c == name) k = c }
    NR == row + 1 { print $k }' "$1"
}

run_code trade press.toml --ladder ladder.toml --out whole --threads 2
[ "$code" -eq 0 ] || fail "whole: $(cat "$err")"
for text in 'converged' 'Pareto front' 'orders of convergence' 'cheapest for a density error' 'table in whole'; do
  grep -q "$text" "$out" || fail "no \"$text\" in $(cat "$out")"
done
[ "$(ls whole/packings | wc -l)" -eq 2 ] || fail "not one packing a seed: $(ls whole/packings)"
for name in wall_s cpu_s steps memory_bytes; do
  awk -v x="$(field whole/trade.csv 2 $name)" 'BEGIN { exit !(x > 0) }' || fail "no $name"
done
# The error at the end, from the last rows of the four histories.
for run in 01_001 01_002 02_001 02_002; do
  awk -F, 'NR == 1 { for (c = 1; c <= NF; ++c) if ($c == "relative_density") k = c } END { print $k }' \
    whole/runs/rung_$run/history.csv
done | awk -v told="$(field whole/trade.csv 2 '"error at cooling"')" '
  { x[NR] = $1 }
  END { e = (x[3] - x[1] + x[4] - x[2]) / 2 - told; exit !(NR == 4 && e * e < 1e-12) }' || # six digits are told
  fail "another error than $(field whole/trade.csv 2 '"error at cooling"')"

# Killed when one run has ended, and resumed; times on the clock differ, all else is the same.
"$densify" trade press.toml --ladder ladder.toml --out killed --threads 1 --quiet 2>"$err" &
pid=$!
rounds=0
until [ -f killed/runs/rung_01_001/run.txt ] || [ "$rounds" -ge 6000 ]; do
  rounds=$((rounds + 1))
  sleep 0.01
done
kill -KILL "$pid"
wait "$pid" 2>/dev/null && fail "the kill came too late"
[ ! -f killed/trade.csv ] || fail "the kill came too late"
cksum killed/runs/rung_01_001/* >"$work.log/before"
run_code trade press.toml --ladder ladder.toml --out killed --threads 2 --quiet --resume
[ "$code" -eq 0 ] || fail "resumed: $(cat "$err")"
cksum killed/runs/rung_01_001/* | cmp -s - "$work.log/before" || fail "a finished run was made again"
for folder in whole killed; do
  cut -d, -f 1-3,6- $folder/trade.csv >"$work.log/$folder"
done
cmp "$work.log/whole" "$work.log/killed" || fail "resumed: another table"

refuses "the folder is not empty" "--resume" -- trade press.toml --ladder ladder.toml --out whole
refuses "holds nothing to resume" "start without --resume" -- trade press.toml --out nowhere --resume
sed 's/mass_scaling/mass_scalin/' ladder.toml >wrong.toml
refuses 'rung "coarse"' 'did you mean "mass_scaling"' -- trade press.toml --ladder wrong.toml --out nowhere
finish
