#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs every "$ build/chaintrue ..." of the README, or of the document given as third argument, in their
# order in one folder, and compares the output with the document. With --update as fourth argument the
# document is written anew with what is printed now; after a change that is meant.
document=${3:-README.md}
update=${4:-}
source "$(dirname -- "${BASH_SOURCE[0]}")/workplace.sh" "$1" "$2"

commands=0
failures=0
command=''
shown=''
anew=''
compare() {
  [[ -n $command ]] || return
  commands=$((commands + 1))
  local printed line
  printed=$(bash -c "$command" 2>&1)
  if [[ $printed != "${shown%$'\n'}" ]]; then
    printf '$ %s\n' "$command"
    diff <(printf '%s\n' "${shown%$'\n'}") <(printf '%s\n' "$printed") | sed 's/^</shown  </; s/^>/prints >/'
    failures=$((failures + 1))
  fi
  if [[ -n $printed ]]; then
    while IFS= read -r line; do anew+="${line:+    $line}"$'\n'; done <<<"$printed"
  fi
  command=''
  shown=''
}
while IFS= read -r line; do
  case $line in
    '    $ build/chaintrue '* | '    $ printf '* | '    $ cp '*)
      compare
      command=${line#'    $ '}
      anew+="$line"$'\n'
      ;;
    '    '*)
      if [[ -n $command ]]; then shown+="${line#'    '}"$'\n'; else anew+="$line"$'\n'; fi
      ;;
    '')
      if [[ -n $command ]]; then shown+=$'\n'; else anew+=$'\n'; fi
      ;;
    *)
      blank=''
      while [[ $shown == $'\n' || $shown == *$'\n\n' ]]; do shown=${shown%$'\n'} blank+=$'\n'; done
      compare
      anew+="$blank$line"$'\n'
      ;;
  esac
done < <(cat "$2/$document"; echo end)
printf '%d commands of %s, %d print something else\n' "$commands" "$document" "$failures"
if [[ $update == --update ]]; then
  printf '%s' "${anew%end$'\n'}" >"$2/$document"
  exit 0
fi
((failures == 0 && commands > 0))
