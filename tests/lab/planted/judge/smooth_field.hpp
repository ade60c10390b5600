// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The strength of a cause on a real machine: the norm of its signature after projection on
/// settings, sheet, noise and one smooth field.
///
/// Notation, besides that of generator/hidden/strength.hpp
///   X    derivatives by the settings (with their stated sigmas as further rows), by shift and turn of
///        the sheet
///   F    covariance of the field: chain a at place p with chain b at q
///        s_a s_b c_ab exp(-|p - q|^2 / (2 l^2)), whitened; c_ab = 1 for a = b
///   V    k^2 I + F; k is the noise as a multiple of the stated one
///   g    a signature; the part of it in the span of X has no influence
///   strength = sqrt(g' (V^-1 - V^-1 X (X' V^-1 X)^-1 X' V^-1) g)
///
/// Without a field and with k = 1 this is delta with the sheet among the settings.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "generator/hidden/strength.hpp"

namespace chaintrue::planted {

/// A session on the generator's machine, settings and sheet calibrated to its readings by least squares.
struct CalibratedSession {
  generator::TrueMachine machine;
  /// For the marks' frame in the bed's: turned, then shifted.
  generator::Vec2 sheet_shift;
  double sheet_turn_rad = 0.0;
  generator::Yardstick yardstick;
  Eigen::MatrixXd free;      ///< X
  Eigen::VectorXd residual;  ///< readings less the machine's, in rows of X

  generator::Vec2 on_bed(generator::Vec2 mark) const;
};
struct ReadMark {
  generator::Vec2 mark;
  generator::Lengths lengths{};
};
/// Visits are the marks in their order. \throws std::runtime_error if the machine cannot reach a mark.
CalibratedSession calibrate(const generator::TrueMachine& stated,
                            const std::vector<ReadMark>& marks, generator::NoiseLevel noise);

struct SmoothField {
  double length_mm = 0.0;
  double left_mm = 0.0;  ///< one sigma at the left chain
  double right_mm = 0.0;
  double correlation = 0.0;   ///< of the two chains
  double noise_factor = 1.0;  ///< k
};
/// By restricted maximum likelihood among six lengths of 100 to 900 mm.
SmoothField likeliest_field(const CalibratedSession& session);
/// `signature` in rows of X.
double strength_given(const SmoothField& field, const CalibratedSession& session,
                      const generator::Signature& signature);

}  // namespace chaintrue::planted
