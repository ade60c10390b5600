// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/linuxcnc_kinematics.hpp"

#include "grid/files/linuxcnc_source.hpp"

namespace chaintrue::grid::files {

tl::expected<LinuxcncKinematics, MapFailure> linuxcnc_kinematics(const LengthMap& map,
                                                                 const LinuxcncNames& names) {
  const auto table = length_table(map);
  if (!table) return tl::unexpected(table.error());
  return LinuxcncKinematics{linuxcnc_source(*table, names),
                            table->columns,
                            table->rows,
                            table->spacing_mm(),
                            table->largest_error_mm};
}

}  // namespace chaintrue::grid::files
