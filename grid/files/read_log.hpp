// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What files_read() tells of. Private to grid/files.
#pragma once

namespace chaintrue::grid::files {

/// The regular file behind an open descriptor counts as read from here on.
void note_as_read(int descriptor);

}  // namespace chaintrue::grid::files
