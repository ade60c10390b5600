// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What could be known at best: a least-squares fit of the settings and of the effects that truly
/// are there (sizes, phases and knees free, whole links and visits told), begun at the truth, with
/// the stated settings as data and slips of the pen left out. With no effect told it is the plain
/// calibration.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "generator/hidden/draw.hpp"

namespace chaintrue::generator {

/// What a person wrote down, and how much of it counts.
struct Record {
  std::vector<HiddenMachine::Note> notes;  ///< rising numbers
  NoiseLevel noise;
  StatedSigmas sigmas;
  std::vector<std::size_t> left_out;
};

/// A machine on the drum with what acts on it, ready to predict.
struct Fitted {
  TrueMachine machine;
  std::vector<Hidden> effects;
  /// Readings at marks as written, in order of visit.
  [[nodiscard]] std::optional<std::vector<Lengths>> predict(std::span<const Vec2> marks,
                                                            std::span<const int> numbers) const;
};

[[nodiscard]] std::optional<Fitted> fit_told(const HiddenMachine& machine,
                                             std::span<const Hidden> told,
                                             const Record& record);

}  // namespace chaintrue::generator
