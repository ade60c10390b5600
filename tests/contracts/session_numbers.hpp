// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A session of the classic machine as a row of numbers, for comparing two machines.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/reading_model.hpp"

namespace chaintrue::model::effects {

/// A session over the whole bed of the classic machine, corners included; a serpentine, so that
/// chains are paid out and taken in, with the first point repeated at the end.
inline std::vector<Visit> session() {
  std::vector<Visit> visits;
  int order = 0;
  for (int row = 0; row < 5; ++row) {
    for (int k = 0; k < 7; ++k) {
      const int column = row % 2 == 0 ? k : 6 - k;
      visits.push_back({{-1219.2 + column * 406.4, -609.6 + row * 304.8}, order++});
    }
  }
  visits.push_back({visits.front().position, order});
  return visits;
}

/// Everything observable in a session: the written coordinates of each mark and the reading there,
/// one after the other.
inline std::vector<double> found(const Machine& machine, const std::vector<Visit>& visits) {
  const auto lengths = readings(ReadingModel(machine), visits);
  EXPECT_TRUE(lengths.has_value()) << "visit " << (lengths ? 0 : lengths.error().place);
  const MarkFrame mark_frame(machine);
  std::vector<double> numbers;
  for (std::size_t i = 0; lengths && i < visits.size(); ++i) {
    const MarkPoint mark = mark_frame.written(identity_placement(visits[i].position));
    numbers.insert(numbers.end(),
                   {mark.x_mm, mark.y_mm, (*lengths)[i].left_mm, (*lengths)[i].right_mm});
  }
  return numbers;
}

inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = a.size() == b.size() ? 0.0 : INFINITY;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    largest = std::max(largest, std::abs(a[i] - b[i]));
  }
  return largest;
}

}  // namespace chaintrue::model::effects
