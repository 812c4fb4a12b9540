#!/bin/sh
# The scene of a table with coupling = "live": a whole pressing whose finite elements own their particles; killed and
# resumed it is the same bit for bit, on two ranks within what stresses of volume elements may be off their laws.
# usage: live.sh DENSIFY FOLDER_OF_SCENES WORK_FOLDER
set -eu
densify=$1 work=$3
rm -rf "$work"
mkdir -p "$work"
sed '/^relative_density/d; s/^coupling = .*/coupling = "live"/; s/^start_temperature.*/&\nstart_pressure = "1 MPa"/' \
  "$2/tabulate_scene.toml" >"$work/scene.toml"
printf '[output]\ncheckpoint_interval = "0.1 s"\n' >>"$work/scene.toml"

fail() { echo "$*" >&2; exit 1; }
# In a subshell or behind &.
run() {
  exec "$densify" run "$work/scene.toml" --quiet --set press.live.tolerance=5e-3 --set press.steps.accuracy=2e-2 "$@"
}
density() { tail -n 1 "$work/$1/history.csv" | cut -d, -f5; }

(run --out "$work/whole")
awk -v density="$(density whole)" 'BEGIN { exit !(density > 0.9 && density < 1) }' || fail "ends at $(density whole)"

run --out "$work/killed" &
pid=$!
while [ ! -e "$work/killed/checkpoint.h5" ]; do
  kill -0 $pid 2>/dev/null || fail "ended before it wrote a checkpoint"
  sleep 0.1
done
kill -KILL $pid
wait $pid && fail "ended before it could be killed"
(run --resume --out "$work/killed")
cmp "$work/whole/history.csv" "$work/killed/history.csv"

(run --ranks 2 --out "$work/two")
awk -v a="$(density whole)" -v b="$(density two)" 'BEGIN { d = a - b; exit !(d < 5e-3 && d > -5e-3) }' ||
  fail "$(density two) on two ranks, $(density whole) on one"
