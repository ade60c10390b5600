// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A router on four elastic belts, by the balance of forces. Shares no code with the product.
///
/// Each belt is a spring that only pulls. Two of them hold: their unstretched lengths are set, and
/// they stretch under tension. Two are pulled by their motors to a tension; their unstretched lengths
/// follow from the sled's equilibrium. On an upright frame the sled's weight pulls down.
///
///   F(x, y) = sum_i T_i b_i / d_i u_i + W = 0                                               (1)
///
///   u_i  horizontal direction to anchor i          d_i  slanting length, b_i its level part
///   T_i  of a belt that holds: EA max(0, d_i / l_i - 1), l_i set; of one that is pulled: given
///
/// The readings are the unstretched lengths l_i.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace chaintrue::generator {

/// tl, tr, bl, br.
using FourLengths = std::array<double, 4>;

struct BeltFrame {
  std::array<std::array<double, 3>, 4> anchors{};  ///< x, y, z in mm
  double reach_mm = 153.4;                         ///< arm and the belt's end
  double stiffness_n = 40000.0;                    ///< EA; infinity: rigid belts
  double pull_n = 150.0;                           ///< of a motor
  double weight_n = 110.0;                         ///< along the sheet; 0: the frame lies flat
};

struct SledAtRest {
  double x_mm = 0.0;
  double y_mm = 0.0;
  FourLengths tension_n{};
  FourLengths length_mm{};   ///< unstretched
  double left_over_n = 0.0;  ///< residual of (1)
};

/// `held_mm` are unstretched lengths of the two that hold (the others are ignored), `pulls_n` of the
/// two that are pulled. Starts from a nearby position. \throws std::runtime_error if it does not
/// converge.
SledAtRest rest_on_belts(const BeltFrame& frame, const std::array<bool, 4>& is_pulled,
                         const FourLengths& held_mm, const FourLengths& pulls_n, double near_x_mm,
                         double near_y_mm);

/// A session: the upper two hold, the lower two are pulled, with a relative variation `pull_noise`
/// of the pull and noise `noise_mm` of each reading.
struct BeltSession {
  BeltFrame frame;
  std::vector<std::array<double, 2>> commands;  ///< positions that rigid belts would give the sled
  double pull_noise = 0.03;
  double noise_mm = 0.2;
  std::uint64_t seed = 1;
};
std::vector<FourLengths> read_session(const BeltSession& session);

}  // namespace chaintrue::generator
