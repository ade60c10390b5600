// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The measurements for a diagnosis: points and distances of one machine, in any mix, as one set of
/// observations.
#pragma once

#include <tl/expected.hpp>

#include "grid/diagnosis/options.hpp"
#include "grid/estimation/observation_set.hpp"
#include "grid/observation/measured.hpp"

namespace chaintrue::grid::diagnosis {

using estimation::FollowUp;
using estimation::NumberedPlace;
using estimation::NumberedUnit;
using estimation::ObservationPart;
using estimation::ObservationSet;
using State = estimation::MachineState;

/// With fewer points no residual remains after fitting the settings.
inline constexpr std::size_t kFewestPoints = 8;
/// Distances determine four of the six settings; two more are needed for a cause, and two to check
/// it.
inline constexpr std::size_t kFewestDistances = 8;
/// This many must remain after rejection.
inline constexpr std::size_t kFewestGoodDistances = 6;

/// Whether the distance between these holes, or to this edge, was measured.
bool is_measured(const MeasuredHoles& set, const HoleDistance& wanted);

/// The machine is that of the first file; observations in the order of the files, points first, the
/// readings of the machine itself last. Fails with a sentence if there is no machine, too little
/// was measured, or a command is out of reach.
[[nodiscard]] tl::expected<ObservationSet, DiagnosisFailure> observations_of(
    const Measured& measured);

}  // namespace chaintrue::grid::diagnosis
