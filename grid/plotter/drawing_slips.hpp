// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Slips in what was measured on a test drawing, by what the machine as set, or as found, would have
/// drawn. Private to grid/plotter.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "grid/plotter/drawing_fit.hpp"

namespace chaintrue::grid {

/// Of the file alone, against `as_set`: what the machine as stated would have drawn, in the order of
/// the drawing's measures.
[[nodiscard]] std::optional<DrawingFailure> slip_before_fit(const TestDrawing& drawing,
                                                            const Eigen::VectorXd& as_set);

/// A page that was scaled by a few percent, which settings take for pins and cords of that share.
[[nodiscard]] std::optional<DrawingFailure> scaled_page_of(const model::PlotterMachine& stated,
                                                           const model::PlotterMachine& found);

/// Two measures that fit once they are exchanged, against `found`, of which each is rejected.
[[nodiscard]] std::optional<DrawingFailure> exchanged_rows(const TestDrawing& drawing,
                                                           const Eigen::VectorXd& found,
                                                           const std::vector<bool>& rejected);

}  // namespace chaintrue::grid
