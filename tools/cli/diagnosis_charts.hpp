// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The pictures of a diagnosis' page. Residuals are measured less predicted; vermilion is before,
/// blue is with the causes named.
/// The places on the bed are drawn in diagnosis_charts.cpp, what the residuals follow in
/// diagnosis_scatter_charts.cpp and diagnosis_law_charts.cpp, bars and the matrix in
/// diagnosis_bar_charts.cpp; the sections of pictures are assembled in diagnosis_pictures.cpp.
#pragma once

#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/report/bed_chart.hpp"

namespace chaintrue::cli {

/// The bed of the machine as found, about its middle.
[[nodiscard]] report::Outline bed_of(const grid::diagnosis::Diagnosis& found);
/// A point's error of the tool, with one sigma of its noise.
[[nodiscard]] report::Arrow arrow_of(const grid::diagnosis::PointPicture& point,
                                     const Eigen::Vector2d& shift_mm);
/// Of the causes named, and of the first one's rival, which it must have. Precondition: a cause is named.
[[nodiscard]] std::string title_of_causes(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] std::string title_of_rival(const grid::diagnosis::Diagnosis& found);

/// The tool, or the distances, before and with the causes. Precondition of this and the next two:
/// readings.
[[nodiscard]] report::Section arrows_section(const grid::diagnosis::Diagnosis& found);
/// The measured residuals, and those that the cause and its rival predict. Precondition: a cause is
/// named.
[[nodiscard]] report::Section signature_section(const grid::diagnosis::Diagnosis& found);
/// Residuals against lengths, angles and visits.
[[nodiscard]] report::Section residuals_section(const grid::diagnosis::Diagnosis& found);

/// Arrows of the tool before and after, at one scale, and after again if it is much smaller.
[[nodiscard]] std::vector<report::ChartRow> arrow_charts(const grid::diagnosis::Diagnosis& found);
/// Measured, best cause, rival, remainder: one chart a chain. Empty where no cause is named.
[[nodiscard]] std::vector<report::Chart> strip_charts(const grid::diagnosis::Diagnosis& found);
/// The likeliest law's curve among the points' partial residuals, and its best rival's. Precondition of this
/// and the next: the law has points.
[[nodiscard]] report::ChartRow law_charts(const grid::diagnosis::Diagnosis& found);
/// The tool's residual error without the likeliest law, and with it.
[[nodiscard]] std::vector<report::ChartRow> law_rest_charts(const grid::diagnosis::Diagnosis& found);
/// Against the chain's length, and alongside the same folded at one turn of the sprocket; a row a
/// chain.
[[nodiscard]] std::vector<report::ChartRow> length_charts(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] report::ChartRow angle_charts(const grid::diagnosis::Diagnosis& found);
/// Coloured by which way the chain moved; only where the points have an order (has_order).
[[nodiscard]] report::ChartRow order_charts(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] bool has_order(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] report::Chart probability_chart(const grid::diagnosis::Diagnosis& found);
/// Precondition: the diagnosis has a gain.
[[nodiscard]] report::Chart improvement_chart(const grid::diagnosis::Diagnosis& found);
/// The follow-up's places on the bed.
[[nodiscard]] report::Chart next_points_chart(const grid::diagnosis::Diagnosis& found);

}  // namespace chaintrue::cli
