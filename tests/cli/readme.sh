#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs every "$ build/chaintrue ..." of the README, or of the document given as third argument, in their
# order in one folder, and compares the output with the document.
document=${3:-README.md}
source "$(dirname -- "${BASH_SOURCE[0]}")/workplace.sh" "$1" "$2"

commands=0
failures=0
command=''
shown=''
compare() {
  [[ -n $command ]] || return
  commands=$((commands + 1))
  local printed
  printed=$(bash -c "$command" 2>&1)
  if [[ $printed != "${shown%$'\n'}" ]]; then
    printf '$ %s\n' "$command"
    diff <(printf '%s\n' "${shown%$'\n'}") <(printf '%s\n' "$printed") | sed 's/^</shown  </; s/^>/prints >/'
    failures=$((failures + 1))
  fi
  command=''
  shown=''
}
while IFS= read -r line; do
  case $line in
    '    $ build/chaintrue '* | '    $ printf '* | '    $ cp '*) compare; command=${line#'    $ '} ;;
    '    '*) if [[ -n $command ]]; then shown+="${line#'    '}"$'\n'; fi ;;
    '') if [[ -n $command ]]; then shown+=$'\n'; fi ;;
    *) while [[ $shown == *$'\n\n' ]]; do shown=${shown%$'\n'}; done; compare ;;
  esac
done < <(cat "$2/$document"; echo end)
printf '%d commands of %s, %d print something else\n' "$commands" "$document" "$failures"
((failures == 0 && commands > 0))
