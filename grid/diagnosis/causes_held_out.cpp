// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/causes_held_out.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "grid/containers.hpp"
#include "grid/estimation/spatial_blocks.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

double square_at_tool(const FittedPoint& point) {
  return (point.mark_jacobian.inverse() * point.blocked_residual_mm).squaredNorm();
}

/// Keys of points in both fits: the file's number and their own.
using PointKey = std::pair<std::size_t, std::size_t>;

}  // namespace

std::vector<HeldOutSquare> held_out_squares(const JointFit& plain, const JointFit& with_causes) {
  std::vector<HeldOutSquare> squares;
  std::map<PointKey, const FittedPoint*> own;
  std::map<std::size_t, std::vector<LengthPoint>> by_file;
  for (const FittedPoint& point : with_causes.points) {
    own[{point.file, point.point.index}] = &point;
    by_file[point.file].push_back(point.point);
  }
  std::map<PointKey, std::size_t> block_of;
  std::size_t blocks = 0;
  for (const auto& [file, points] : by_file) {
    for (const std::vector<std::size_t>& block : spatial_blocks(points)) {
      for (const std::size_t k : block) block_of[{file, points[k].index}] = blocks;
      ++blocks;
    }
  }
  for (const FittedPoint& point : plain.points) {
    const PointKey key{point.file, point.point.index};
    const FittedPoint& other = *own.at(key);
    if (!other.bad)
      squares.push_back({square_at_tool(point), square_at_tool(other), block_of[key]});
  }
  if (!squares.empty()) return squares;
  for (std::size_t f = 0; f < plain.distances.size(); ++f) {
    const auto& before = plain.distances[f].distances;
    const auto& after = with_causes.distances[f].distances;
    for (std::size_t k = 0; k < before.size(); ++k) {
      if (after[k].rejected) continue;
      squares.push_back({before[k].left_out_mm * before[k].left_out_mm,
                         after[k].left_out_mm * after[k].left_out_mm,
                         squares.size()});
    }
  }
  return squares;
}

HeldOutBlocksError error_of(const std::vector<HeldOutSquare>& squares) {
  HeldOutBlocksError sum;
  for (const HeldOutSquare& one : squares) {
    sum.plain_mm += one.plain_mm2;
    sum.with_causes_mm += one.with_causes_mm2;
  }
  const auto count = as_double(std::max<std::size_t>(squares.size(), 1));
  return {std::sqrt(sum.plain_mm / count), std::sqrt(sum.with_causes_mm / count)};
}

bool falls_beyond_its_error(const std::vector<HeldOutSquare>& squares) {
  std::map<std::size_t, std::pair<double, double>> blocks;  // d_b and n_b
  double total = 0.0;
  for (const HeldOutSquare& one : squares) {
    auto& [difference, count] = blocks[one.block];
    difference += one.plain_mm2 - one.with_causes_mm2;
    count += 1.0;
    total += one.plain_mm2 - one.with_causes_mm2;
  }
  const auto b = as_double(blocks.size());
  if (b < 2.0) return false;
  const auto n = as_double(squares.size());
  const double mean = total / n;
  double sum = 0.0;
  for (const auto& [block, of] : blocks) sum += std::pow(of.first - of.second * mean, 2);
  return mean > std::sqrt(b / (b - 1.0) * sum) / n;
}

}  // namespace chaintrue::grid::diagnosis
