# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced: an empty folder that looks like the repository's root to a pasted command.
# $1 the command, $2 the repository.
set -u
workplace=$(mktemp -d)
trap 'rm -rf "$workplace"' EXIT
mkdir "$workplace/build"
ln -s "$1" "$workplace/build/chaintrue"
ln -s "$2/fixtures" "$workplace/fixtures"
cd "$workplace" || exit 1
