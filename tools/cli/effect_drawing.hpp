// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The picture of an effect as a drawing (SVG): arrows over the bed before and after calibration,
/// and the two squares as cut, both with their scale printed.
#pragma once

#include <string>

#include "grid/synthetic/effect_picture.hpp"
#include "model/machine.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

/// Same picture, same bytes.
[[nodiscard]] std::string draw_effect(const Machine& machine,
                                      const synthetic::EffectPicture& picture);

/// `3`, `0.17`, `6e-06`: three digits, without trailing zeros.
[[nodiscard]] std::string short_number(double value);

}  // namespace chaintrue::cli
