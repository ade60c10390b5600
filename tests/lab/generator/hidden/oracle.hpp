// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The best possible result: a least-squares fit of the settings and of the true effects (sizes,
/// phases and knees free, whole links and visits given), started at the truth, with the stated
/// settings as data and gross errors left out. Without effects it is the plain calibration.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "generator/hidden/draw.hpp"

namespace chaintrue::generator {

/// The written data, and how many of them are used.
struct Record {
  std::vector<HiddenMachine::Note> notes;  ///< rising numbers
  NoiseLevel noise;
  StatedSigmas sigmas;
  std::vector<std::size_t> left_out;
};

/// A machine on the drum with its effects, ready to predict.
struct Fitted {
  TrueMachine machine;
  std::vector<Hidden> effects;
  /// Readings at marks as written, in order of visit.
  std::optional<std::vector<Lengths>> predict(std::span<const Vec2> marks,
                                              std::span<const int> numbers) const;
};

std::optional<Fitted> fit_given(const HiddenMachine& machine, std::span<const Hidden> given,
                                const Record& record);

}  // namespace chaintrue::generator
