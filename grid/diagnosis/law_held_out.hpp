// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How well readings that are left out are predicted with a law, and by the settings, the causes and the best
/// smooth pattern without one.
///
///   e_i^ = C_ik C_kk^-1 e_k,   C as in law_model.hpp, k the rows that are kept, i those left out
///
/// Inside: every fourth of the places, four times, so that neighbours stay. Outside: the quarters of the bed on
/// one side of a line (bed_parts.hpp), of which nothing stays. Of distances every one that ends at such a place
/// is left out: others would tell where its hole is. Sizes are estimated anew each time, and the place
/// or period is chosen anew among the leading values of its grid; shape and entry stay.
///
/// Source: C. Rasmussen and C. Williams, Gaussian Processes for Machine Learning (2006), equation 2.25.
#pragma once

#include <optional>

#include "grid/diagnosis/law_evidence.hpp"

namespace chaintrue::grid::diagnosis {

/// Of the law at the heaviest point of its curve; absent where no parts of the bed can be left out.
[[nodiscard]] std::optional<LawHeldOut> held_out_with(const Analysis& analysis,
                                                      const LawEvidence& evidence,
                                                      const WeighedLaw& law);

/// Rows of the kept units in mm, root mean square: of the tool where chains were read, of distances, of one belt.
/// `units` empty: of all.
[[nodiscard]] double rms_of_units_mm(const RegressorSystem& system,
                                     const KeptRows& kept,
                                     const Eigen::VectorXd& rows,
                                     const std::vector<std::size_t>& units = {});

}  // namespace chaintrue::grid::diagnosis
