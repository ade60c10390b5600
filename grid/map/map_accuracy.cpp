// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/map_accuracy.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "grid/containers.hpp"

namespace chaintrue::grid {
HeldOutError summarise(const std::vector<HeldOutResidual>& residuals) {
  std::vector<double> chain, tool, x, y;
  for (const HeldOutResidual& residual : residuals) {
    append_all(chain, residual.chain_mm);
    const Vector2d at_tool = residual.mark_jacobian.inverse() * residual.chain_mm;
    tool.push_back(at_tool.norm());
    x.push_back(at_tool.x());
    y.push_back(at_tool.y());
  }
  return {summary_of(chain), summary_of(tool), rms(x), rms(y)};
}

double noise_at_tool_mm(const CompensationMap& map) {
  const MapNoise& noise = map.contents().noise;
  double variance_mm2 = 0.0;
  std::size_t count = 0;
  for (const MapPoint& point : map.contents().points) {
    const auto lengths = map.lengths(point.mark);
    if (point.bad || !lengths) continue;
    const Matrix2d to_tool = lengths->mark_jacobian.inverse();
    // Stated noise is kept; unstated noise is known only through the estimated factor.
    const double factor = noise.source == NoiseSource::stated ? 1.0 : noise.factor_found;
    variance_mm2 += factor * factor *
                    (to_tool.squaredNorm() * noise.length_mm * noise.length_mm +
                     2.0 * noise.position_mm * noise.position_mm);
    ++count;
  }
  return count > 0 ? std::sqrt(variance_mm2 / as_double(count)) : 0.0;
}

MirrorTest test_mirror(const CompensationMap& map) {
  MirrorTest test;
  std::vector<double> differences;
  double sum = 0.0;
  // Without a machine the middle is that of the points' grid.
  const interp::Rectangle& domain = map.contents().domain;
  const double middle_mm = map.machine() == nullptr ? 0.5 * (domain.x_min + domain.x_max) : 0.0;
  for (const MapPoint& point : map.contents().points) {
    const BedPoint bed = map.to_bed(point.mark);
    const MarkPoint mirrored = map.to_mark({2.0 * middle_mm - bed.x_mm, bed.y_mm});
    const MapStatus status = map.status(mirrored);
    if (point.bad || (status != MapStatus::inside && status != MapStatus::edge)) continue;
    const auto here = map.query(point.mark);
    const auto there = map.query(mirrored);
    if (!here || !there) continue;
    const double difference = point.lengths.right_mm - there->lengths.left_mm;
    const MapNoise& noise = map.contents().noise;
    const double scale = noise.factor_found;
    const double variance =
        std::pow(scale * noise.length_mm, 2) +
        std::pow(scale * noise.position_mm, 2) * here->mark_jacobian.row(1).squaredNorm() +
        there->sigma.left_mm * there->sigma.left_mm;
    constexpr double kBeyondChance = 4.5;
    test.holds = test.holds && std::abs(difference) <= kBeyondChance * std::sqrt(variance);
    // Of places that differ by rounding alone the first is kept.
    constexpr double kRoundingMm = 1e-9;
    if (differences.empty() ||
        std::abs(difference) > std::abs(test.worst_signed_mm) + kRoundingMm) {
      test.worst_signed_mm = difference;
      test.worst_at = point.mark;
    }
    differences.push_back(difference);
    sum += difference;
  }
  test.points = differences.size();
  if (test.points == 0) {
    test.sentence =
        "No point's mirror image lies on the measured part of the bed, so the chains were not "
        "compared.";
    return test;
  }
  test.difference = summary_of(differences);
  test.mean_mm = sum / as_double(test.points);
  const auto than = [](double value) { return value >= 0.0 ? "longer" : "shorter"; };
  if (test.holds) {
    test.sentence = fmt::format(
        "The right chain mirrors the left one within the noise: the largest difference at {} "
        "points is {:.2f} mm.",
        test.points, std::abs(test.worst_signed_mm));
  } else {
    test.sentence = fmt::format(
        "The right chain does not mirror the left one: at ({:.0f}, {:.0f}) it is {:.2f} mm {} than "
        "the left chain at the mirrored place, {:.2f} mm rms over {} points (mean {:+.2f} mm). One "
        "surface for both chains would put that error into every part.",
        test.worst_at.x_mm, test.worst_at.y_mm, std::abs(test.worst_signed_mm),
        than(test.worst_signed_mm), test.difference.rms_mm, test.points, test.mean_mm);
  }
  return test;
}

}  // namespace chaintrue::grid
