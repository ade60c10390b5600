// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The list behind files_read(). Private to grid/files.
#pragma once

namespace chaintrue::grid::files {

/// Adds the regular file of an open descriptor to files_read().
void note_as_read(int descriptor);
/// The number of a file that was deleted may be that of the next one written.
void forget_files_read();

}  // namespace chaintrue::grid::files
