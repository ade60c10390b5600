// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Several runs of a Maslow 4's calibration as one session: the same machine, each run with its own
/// pull. Visits are numbered on from run to run.
///
/// How hard belts were pulled comes from `--pulls`, or, where a log prints it,
/// from Maslow_Calibration_Current_Threshold, mA (MaslowCNC/Maslow_4, firmware/FluidNC/src/Maslow).
///
/// \code
///   std::vector<Maslow4Import> runs = {parse_maslow4(one, "1.log"), parse_maslow4(two, "2.log")};
///   const Maslow4Import session = one_session(std::move(runs), pulls_of("1,1.6", "--pulls"));
/// \endcode
#pragma once

#include <string>
#include <vector>

#include "grid/files/maslow4_log.hpp"

namespace chaintrue::grid::files {

/// "1,1.6" relative, "1300mA,1900mA" or "150N,240N"; one unit. \throws InputError otherwise.
[[nodiscard]] std::vector<BeltPull> pulls_of(const std::string& text, const std::string& option);

/// `pulls`: one for each run; empty: as in the logs. A single run is returned itself, with its
/// pull.
/// \throws InputError if runs have different frames, or if the pull of each is unknown.
/// \throws std::logic_error without runs.
[[nodiscard]] Maslow4Import one_session(std::vector<Maslow4Import> runs,
                                        const std::vector<BeltPull>& pulls);

}  // namespace chaintrue::grid::files
