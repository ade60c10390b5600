// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A law as a cause of the user's own (model/effects/declared_effect.hpp), so that later
/// diagnoses can name it and a user can edit it.
///
/// A place and a phase are the effect's place; a period, a scale and the range are numbers in the formula,
/// to be edited there. A movement of the tool is written as its effect on either chain: side
/// cos(phi) of it along x, -sin(phi) along y. A chain's formula cannot express a law that moves the
/// tool outwards over every border, or one that depends on the other chain: both are refused.
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "grid/diagnosis/law.hpp"
#include "model/effects/declared_effect.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::diagnosis {

/// Or a sentence with the reason.
[[nodiscard]] tl::expected<model::effects::Declaration, std::string> declaration_of(
    const Law& law, const model::Bed& bed);
/// For the likeliest law of a list, which must be at least kLawClaimed.
[[nodiscard]] tl::expected<model::effects::Declaration, std::string> declaration_of(
    const std::vector<Law>& laws, const model::Bed& bed);

}  // namespace chaintrue::grid::diagnosis
