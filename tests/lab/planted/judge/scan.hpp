// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Real readings with a known cause added: marks of a scan drawn at random, as read, and with the
/// change that the cause makes on the generator's machine, calibrated to the scan.
///
/// The order of visits was not recorded. Causes that act by the visit are added, and diagnosed, in
/// an order drawn at random, which nothing else on the scan follows; all others are diagnosed
/// without one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "planted/judge/claims.hpp"
#include "planted/judge/smooth_field.hpp"

namespace chaintrue::planted {

struct Scan {
  std::string name;
  generator::TrueMachine machine;  ///< as stated
  grid::MeasuredGrid grid;         ///< lengths, without an order
};
/// A scan of the optical calibration (grid/files/optical_file.hpp), on the machine of a
/// groundcontrol.ini; the noise stated as 0.1 and 0.3 mm. \throws InputError as the readers do.
Scan read_scan(const std::filesystem::path& scan, const std::filesystem::path& groundcontrol_ini);

/// All of a scan.
Reference make_reference(const Scan& scan);

struct Draw {
  grid::MeasuredGrid plain;
  grid::MeasuredGrid planted;
  generator::Hidden hidden;
  bool with_order = false;
  double strength = 0.0;  ///< given the reference's field (smooth_field.hpp)
};
/// 60 marks, and a strength of 8 to 20 against the stated noise alone. The same seed has the same cause on every scan: seven in turn, stretch, flex, eccentricity, kink, a zero
/// that moves, drift, a tape that is long along y. \throws std::runtime_error if no size of it fits.
Draw draw_planted(const Scan& scan, const std::vector<Reference>& references, std::uint64_t seed);

grid::diagnosis::Diagnosis diagnosed(const grid::MeasuredGrid& grid);

}  // namespace chaintrue::planted
