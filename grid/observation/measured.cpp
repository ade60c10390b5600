// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/measured.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grid/plane_vectors.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid {
namespace {

bool same(const MeasuredPoint& a, const MeasuredPoint& b) {
  const auto agree = [](const auto& x, const auto& y) {
    return x.has_value() == y.has_value() && (!x || vector_of(*x) == vector_of(*y));
  };
  return vector_of(a.mark) == vector_of(b.mark) && agree(a.lengths, b.lengths) &&
         agree(a.commanded, b.commanded);
}

bool same(const HoleDistance& a, const HoleDistance& b) {
  return a.from == b.from && (a.edge || a.to == b.to) && a.edge == b.edge &&
         a.distance_mm == b.distance_mm;
}

template <class Reading>
bool all_same(const std::vector<Reading>& a, const std::vector<Reading>& b) {
  return !a.empty() && std::equal(a.begin(), a.end(), b.begin(), b.end(),
                                  [](const auto& x, const auto& y) { return same(x, y); });
}

}  // namespace

bool same_readings(const MeasuredFile& one, const MeasuredFile& other) {
  if (one.grid() != nullptr && other.grid() != nullptr)
    return all_same(one.grid()->points, other.grid()->points);
  if (one.holes() != nullptr && other.holes() != nullptr)
    return all_same(one.holes()->distances, other.holes()->distances);
  return false;
}

std::string difference_of_settings(const Machine& first, const Machine& other) {
  for (const Setting setting : kMachineSettings) {
    if (stated_value(first, setting) == stated_value(other, setting)) continue;
    return fmt::format("{} is {} in this file and {} in the first", name(setting),
                       stated_value(other, setting), stated_value(first, setting));
  }
  return {};
}

}  // namespace chaintrue::grid
