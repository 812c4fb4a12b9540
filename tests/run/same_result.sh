#!/bin/sh
# What must not change a run: output, threads, the place of the folder, --quiet; what the program says while it
# runs.  usage: same_result.sh DENSIFY FOLDER_OF_SCENES EXAMPLES WORK_FOLDER
set -eu
densify=$1 scenes=$2 examples=$3 work=$4
. "$scenes/support.sh"
cp "$scenes/lattice.toml" "$scenes/lattice.csv" "$scenes/small_press.toml" .

# run_to FOLDER ARGUMENT...: a quiet run that must go well and say nothing.
run_to() {
  folder=$1
  shift
  run_code run --quiet --out "$folder" "$@"
  [ "$code" -eq 0 ] || fail "$*: exit code $code: $(cat "$err")"
  [ ! -s "$out" ] && [ ! -s "$err" ] || fail "$*: --quiet says $(cat "$out" "$err")"
}

run_to one lattice.toml
# Two threads; the summary must say that two were at work, or this would compare a run with itself.
run_to press small_press.toml --threads 1
run_code run small_press.toml --out press_two --threads 2
[ "$code" -eq 0 ] || fail "two threads: exit code $code: $(cat "$err")"
grep -q ' on 2 threads' "$out" || fail "two threads were asked for: $(cat "$out")"
same_end press press_two
run_to again lattice.toml
same_end one again
mkdir -p elsewhere/deep && cp lattice.toml lattice.csv elsewhere/deep
(cd elsewhere/deep && "$densify" run lattice.toml --quiet)  # and the folder that is taken without --out
same_end one elsewhere/deep/results/lattice

# Rows and snapshots at other times: each row that both have is the same but for its rates and means over a row, and so
# is the last, bit for bit.
run_to few lattice.toml --set 'output.history_interval=100 s' --set 'output.snapshot_interval=1000 s' \
  --set output.visualisation=false --set 'output.checkpoint_interval=1 h'
[ ! -e few/paraview ] || fail "pictures that nobody wanted"
[ "$(wc -l <few/history.csv)" -lt 60 ] || fail "more rows than asked for"
steps() { tail -n 1 "$1/history.csv" | sed 's/.*,//'; }
[ "$(steps one)" = "$(steps few)" ] || fail "another number of steps with other output"
for column in relative_density stress_zz_Pa mean_neck_radius_m time_step_s; do
  for folder in one few; do
    awk -F, -v name=$column 'NR == 1 { for (c = 1; c <= NF; ++c) if ($c == name) k = c } END { if (k) print $k }' \
      $folder/history.csv >"$work.log/$folder"
    [ -s "$work.log/$folder" ] || fail "no column $column in $folder"
  done
  cmp -s "$work.log/one" "$work.log/few" || fail "$column at the end depends on the output"
done

# Without --quiet: progress line by line on a file, the summary on the standard output.
run_code run lattice.toml --out loud
[ "$code" -eq 0 ] || fail "loud: $(cat "$err")"
grep -q '% ' "$err" || fail "no progress: $(cat "$err")"
! grep -q "$(printf '\r')" "$err" || fail "a line that rewrites itself, in a file"
for text in 'relative density 0' 'where the time went' '^neighbour lists ' '^forces ' '^motion and step limits ' \
  'neighbour list builds' 'warnings: ' 'results in loud'; do
  grep -q "$text" "$out" || fail "no \"$text\" in the summary"
done

# Every shipped scene is valid.
for scene in "$examples"/*/scene*.toml; do
  # One that presses a specimen needs the program with finite elements, which the preset dem-only does not build.
  if grep -q '^\[press\]' "$scene" && [ ! -x "$(dirname "$densify")/densify-press" ]; then continue; fi
  run_code check "$scene"
  [ "$code" -eq 0 ] && grep -q '^the scene is valid$' "$out" || fail "check $scene: $(cat "$err")"
done
run_code check "$examples/two_copper_spheres"
[ "$code" -eq 0 ] || fail "check of a folder: $(cat "$err")"
finish
