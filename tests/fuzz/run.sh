#!/bin/sh
# Fuzzes every target for some seconds, two at a time, and prints what was covered.
# usage: run.sh FOLDER_OF_TARGETS SECONDS     (findings stay in build/fuzz-findings)
set -eu
targets=$(readlink -f "$1") seconds=$2
sources=$(dirname "$(readlink -f "$0")")
root=$(readlink -f "$sources/../..")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
findings=$root/build/fuzz-findings
mkdir -p "$findings"

# seeds TARGET FILE...: the seed corpus, small files of the project beside those made for the purpose.
seeds() {
  mkdir -p "$work/seeds/$1"
  folder=$work/seeds/$1
  shift
  number=0
  for file in "$@"; do
    [ -f "$file" ] || continue
    number=$((number + 1))
    cp "$file" "$folder/$number"
  done
}
seeds scene "$root"/examples/*/*.toml "$root"/tests/run/*.toml "$sources"/corpus/scene/*
seeds table "$root"/tests/run/*.csv "$sources"/corpus/table/*
seeds lammps "$sources"/corpus/lammps/*
seeds checkpoint "$sources"/corpus/checkpoint/*

# fuzz TARGET: one target; its log is shown when it ends.
fuzz() {
  mkdir -p "$work/found/$1"
  code=0
  dictionary=$sources/corpus/$1.dict
  [ -f "$dictionary" ] && dictionary=-dict=$dictionary || dictionary=
  ASAN_OPTIONS=detect_leaks=1 "$targets/fuzz_$1" $dictionary -max_total_time="$seconds" -seed=1 -timeout=60 -rss_limit_mb=2048 \
    -max_len=16384 -print_final_stats=1 -artifact_prefix="$findings/$1-" "$work/found/$1" "$work/seeds/$1" \
    >"$work/$1.log" 2>&1 || code=$?
  edges=$(sed -n 's/.*Loaded 1 modules *(\([0-9]*\) inline.*/\1/p' "$work/$1.log" | head -n 1)
  covered=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$work/$1.log" | tail -n 1)
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$work/$1.log")
  echo "fuzz $1: ${runs:-?} inputs, ${covered:-?} of ${edges:-?} edges covered, $(ls "$work/found/$1" | wc -l) kept"
  if [ "$code" -ne 0 ]; then
    echo "fuzz $1: FOUND something (exit code $code)"
    tail -n 60 "$work/$1.log"
  fi
  return "$code"
}

failed=0
for pair in "scene table" "lammps checkpoint"; do
  set -- $pair
  fuzz "$1" &
  first=$!
  fuzz "$2" || failed=1
  wait "$first" || failed=1
done
exit $failed
