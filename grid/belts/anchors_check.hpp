// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Whether fitted anchors still hold, from a few places that the machine has measured since.
///
/// Notation
///   r    two checks Q' (read less what the fitted anchors make of it) of each new place, whose own
///        coordinates nobody measured (frame_solver.hpp)
///   D    Q' d(read)/d(anchors), C their covariance as fitted, s what one belt's reading was off by
///
///   V = s^2 I + D C D' + B,   log p = -1/2 log |V| - (n + nu) / 2 log(1 + r' V^-1 r / nu)       (1)
///
/// B is what may have happened since: nothing; a belt, or all, counts from elsewhere (belts that were
/// drawn in and let out anew count right again); an anchor moved; a reading at one place that is simply
/// wrong; something else. nu: checks that s was found from.
///
/// Source: A. O'Hagan and J. Forster, Bayesian Inference (2004), section 11.3, for (1).
///
/// \code
///   const auto check = check_anchors(fit, new_belts);
///   if (check) say(check->sentence);
/// \endcode
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "grid/belts/belts_fit.hpp"
#include "grid/map/map_check.hpp"

namespace chaintrue::grid {

/// What may have changed: nothing, zero, anchor, bad_point, unknown.
struct AnchorsHypothesis {
  std::string what;
  std::optional<model::Belt> belt{};  ///< of a zero none: all four; of an anchor its own
  std::size_t point = 0;              ///< of a bad one
  CheckVerdict verdict = CheckVerdict::valid;
  double probability = 0.0;
  double size_mm = 0.0;  ///< of a zero: what is read too much; of an anchor: how far it moved
};

/// A new place, as the anchors foretell it.
struct CheckedPlace {
  double rms_mm = 0.0;    ///< of its two checks
  double sigma_mm = 0.0;  ///< what noise and anchors together leave of them
};

struct AnchorsCheck {
  CheckVerdict verdict = CheckVerdict::valid;
  std::array<double, 3> probability{};        ///< by verdict
  bool decided = true;                        ///< the verdict has kDecided at least
  std::vector<AnchorsHypothesis> hypotheses;  ///< most probable first
  std::vector<CheckedPlace> places;
  std::string sentence;
  std::string not_told_apart;  ///< empty where all is clear
  [[nodiscard]] bool is_valid_as_it_is() const { return decided && verdict == CheckVerdict::valid; }
};

/// One sigma of what a belt's zero is off by after it jumped: a turn of the encoder is 44 mm, a tooth 2.
inline constexpr double kBeltZeroShiftMm = 5.0;
/// One sigma of how far an anchor that came loose has moved, in x and in y.
inline constexpr double kAnchorShiftMm = 5.0;

struct AnchorsCheckFailure {
  enum class Reason {
    no_noise,  ///< the anchors were fitted without belts, or left no checks
    nowhere,   ///< lengths that end nowhere together about these anchors
  } reason;
  std::string sentence;
};
/// A place is enough; two or three far from each other tell an anchor from a belt. The anchors are the
/// fit's; what lengths count, arm and heights are those of `belts`. Precondition: it has points.
[[nodiscard]] tl::expected<AnchorsCheck, AnchorsCheckFailure> check_anchors(
    const BeltsFit& fit, const MeasuredBelts& belts);

}  // namespace chaintrue::grid
