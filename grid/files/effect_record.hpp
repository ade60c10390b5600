// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The table of a chaintrue_effect, for the formats that contain declared effects. Private to
/// grid/files.
#pragma once

#include <string_view>
#include <vector>

#include "grid/files/json_reader.hpp"
#include "model/effects/declared_effect.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::files {

/// Without the checks of model::effects::problems_of.
[[nodiscard]] const Record<model::effects::Declaration>& declaration_record();

/// A machine's "declared_effects": each is read, checked and declared.
void read_declared(const Cursor& at, std::vector<const model::effects::Effect*>& declared);
[[nodiscard]] Json write_declared(const std::vector<const model::effects::Effect*>& declared);
[[nodiscard]] Expected declared_expected();
/// Whether a machine's declared effects are finite on its bed and 0 at null.
void check_declared_on_bed(const Cursor& at, const model::Machine& machine);

/// The effect of this name that the document's own machine declares, for a record that is read
/// before or without that machine; null if there is none.
[[nodiscard]] const model::effects::Effect* declared_in_document(const Cursor& at,
                                                                 std::string_view id);

}  // namespace chaintrue::grid::files
