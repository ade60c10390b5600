// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Slips in the measurements of a test drawing, detected by comparison with the drawing
/// predicted for the machine as set or as found. Private to grid/plotter.
#pragma once

#include <optional>

#include "grid/containers.hpp"
#include "grid/plotter/drawing_fit.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {

/// Slips of the measures as a whole, compared with what the stated `machine` would have drawn, with
/// its derivatives: another unit, bows of the opposite sign or a scaled page, for all measures or
/// some; and a bow that was measured along its line.
[[nodiscard]] std::optional<DrawingFailure> slip_of_drawing(const TestDrawing& drawing,
                                                            const VectorXd& as_set,
                                                            const MatrixXd& by_parameter,
                                                            const Mechanism& machine);

/// Two rejected measures that fit `found` once exchanged.
[[nodiscard]] std::optional<DrawingFailure> exchanged_rows(const TestDrawing& drawing,
                                                           const VectorXd& found,
                                                           const Flags& rejected);

}  // namespace chaintrue::grid
