#!/bin/bash
# compare_with_lammps.sh [PACKING...]: times Densify and LAMMPS in turn on one core, on the same files, and prints both
# with their ratio.  Environment: DENSIFY (program), LMP (LAMMPS), CORE, REPEATS, CASES.
# LAMMPS's cost is the difference in user time of a long and a short run; medians over the repeats.
set -euo pipefail
here=$(cd "$(dirname "$(readlink -f "$0")")" && pwd)
densify=${DENSIFY:-$here/../../build/release/bin/densify}
lmp=${LMP:-lmp}
core=${CORE:-0}
repeats=${REPEATS:-5}
cases=${CASES:-A B}
short=100
declare -A step=([m2k]=3.2e-4 [m20k]=3.2e-4 [p1751]=8e-5) long=([m2k]=6000 [m20k]=700 [p1751]=7000)
export OMP_NUM_THREADS=1 LC_ALL=C

command -v "$lmp" >/dev/null || { echo "LAMMPS ($lmp) is not installed; on Debian: apt-get install lammps" >&2; exit 2; }
[ -x "$densify" ] || { echo "$densify: no such program; build it (./densify test) or name it in DENSIFY" >&2; exit 2; }

value() { sed -E "s/.*\"$1\": \"?([^,\"}]*).*/\1/"; }
median() { sort -g | awk '{v[NR] = $1} END {print v[int((NR + 1) / 2)]}'; }
user_seconds() { # of LAMMPS: packing case steps
  local TIMEFORMAT=%U
  { time taskset -c "$core" "$lmp" -log none -screen none -in "$here/in.lammps" -var pack "$here/packings/$1.data" \
      -var case "$2" -var dt "${step[$1]}" -var steps "$3" >/dev/null; } 2>&1
}

printf '%-7s %-5s %14s %14s %7s %16s\n' packing case densify lammps ratio 'bytes/particle'
for packing in "${@:-m2k m20k p1751}"; do for p in $packing; do for c in $cases; do
  ours='' theirs='' json=''
  for ((r = 0; r < repeats; ++r)); do
    json=$(taskset -c "$core" "$densify" bench --packing "$p" --case "$c" --json)
    ours+="$(value ns_per_contact_step <<<"$json")"$'\n'
    contacts=$(awk -v n="$(value particles <<<"$json")" -v z="$(value coordination_number <<<"$json")" \
      'BEGIN {print n * z / 2}')
    a=$(user_seconds "$p" "$c" $short) b=$(user_seconds "$p" "$c" "${long[$p]}")
    theirs+="$(awk -v d="$a $b" -v s="$((${long[$p]} - short))" -v c="$contacts" \
      'BEGIN {split(d, t, " "); print 1e9 * (t[2] - t[1]) / s / c}')"$'\n'
  done
  o=$(printf %s "$ours" | median) t=$(printf %s "$theirs" | median)
  printf '%-7s %-5s %8.1f ns/c/s %8.1f ns/c/s %7.2f %16.0f\n' "$p" "$c" "$o" "$t" \
    "$(awk -v o="$o" -v t="$t" 'BEGIN {print t / o}')" "$(value bytes_per_particle <<<"$json")"
done; done; done
