#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs every example of every verb's --help, as pasted. Fails if a verb has none, or one fails.
source "$(dirname -- "${BASH_SOURCE[0]}")/workplace.sh" "$1" "$2"

# The verbs below "Subcommands:" of a help text.
verbs_of() { awk '/^Subcommands:/ {on = 1; next} on && /^  [a-z]/ {print $1} on && /^$/ {on = 0}'; }
# The indented lines after "Example:", continuation lines joined.
examples_of() {
  awk '/^Examples?:/ {on = 1; next} on && /^  / {sub(/^  +/, ""); print}' | sed -e ':a' -e '/\\$/N; s/\\\n//; ta'
}

failures=0
verbs=0
examples=0
check() {
  local help subverbs verb example
  help=$(build/chaintrue "$@" --help)
  subverbs=$(verbs_of <<<"$help")
  for verb in $subverbs; do check "$@" "$verb"; done
  if [[ -n $subverbs ]]; then return; fi
  verbs=$((verbs + 1))
  local before=$examples
  while IFS= read -r example; do
    [[ -n $example ]] || continue
    examples=$((examples + 1))
    if ! output=$(bash -c "$example" 2>&1); then
      printf 'chaintrue %s --help: this example fails:\n  %s\n%s\n' "$*" "$example" "$output"
      failures=$((failures + 1))
    fi
  done < <(examples_of <<<"$help")
  if ((examples == before)); then
    printf 'chaintrue %s --help has no example\n' "$*"
    failures=$((failures + 1))
  fi
}
for verb in $(build/chaintrue --help | verbs_of); do check "$verb"; done
printf '%d verbs, %d examples, %d failures\n' "$verbs" "$examples" "$failures"
((failures == 0 && verbs > 0))
