// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The errors of the machine as it was delivered. Of a place that gives a command they are what was
/// commanded less what was measured, whatever the stated machine makes of the lengths that its
/// controller paid out.
#pragma once

#include <Eigen/Core>

#include "grid/diagnosis/regressor_system.hpp"

namespace chaintrue::grid::diagnosis {

/// As `stated.e`, whitened; `stated` is the session's linearised where everything is as stated.
[[nodiscard]] Eigen::VectorXd uncalibrated(const ObservationSet& session, const RegressorSystem& stated);

}  // namespace chaintrue::grid::diagnosis
