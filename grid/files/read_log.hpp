// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The list behind files_read(). Private to grid/files.
#pragma once

namespace chaintrue::grid::files {

/// Adds the regular file of an open descriptor to files_read().
void note_as_read(int descriptor);

}  // namespace chaintrue::grid::files
