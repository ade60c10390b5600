// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Anchors of four belts as the machine's own firmware finds them, to be compared with: level spans,
/// every reading with the weight one, places eliminated, none left out and nothing besides the
/// anchors. Made from its description; shares no code with the product or the firmware.
///
///   r_ij = |s_i - A_j| - m_ij                                                              (1)
///   minimise the sum of r^2 over the places s_i and tl, tr and the x of br
///
/// by Eigen's Levenberg and Marquardt, each place by its own four readings.
///
/// Source of the description: MaslowCNC/Maslow_4, firmware/FluidNC/src/Maslow/Calibration.cpp.
#pragma once

#include <array>
#include <vector>

namespace chaintrue::sealed {

/// tl, tr, bl, br: level spans from the anchor to the tool, mm.
using Spans = std::array<double, 4>;

struct FirmwareAnchors {
  std::array<std::array<double, 2>, 4> anchors{};  ///< bl is the origin, br on the x axis
  double rms_mm = 0.0;                             ///< over all readings
  bool converged = false;
};

/// \throws std::invalid_argument for fewer than five places.
FirmwareAnchors firmware_anchors(const std::vector<Spans>& spans);

/// Lower spans minus their values where the upper two put the tool: bl and br of each place.
std::vector<double> lower_off_mm(const FirmwareAnchors& found, const std::vector<Spans>& spans);

}  // namespace chaintrue::sealed
