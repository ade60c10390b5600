#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# module.sh CHAINTRUE SOURCE PYTHON: a map of the shop's marks as a module of Klipper, run against the stub.
set -euo pipefail
chaintrue=$1 source=$2 python=$3
folder=$(mktemp -d)
trap 'rm -rf -- "$folder"' EXIT
"$chaintrue" fit "$source/fixtures/start/marks.csv" --machine "$source/fixtures/machines/groundcontrol.json" \
  -o "$folder/map.json" >/dev/null 2>&1
"$python" "$source/tests/klipper/run_module.py" "$chaintrue" "$folder/map.json"
