// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The marks of a session and the order in which they are visited, repeats included.
#pragma once

#include <string_view>
#include <vector>

#include "generator/hidden/effects.hpp"
#include "generator/hidden/random.hpp"

namespace chaintrue::generator {

enum class Order { rows, columns, serpentine_rows, serpentine_columns, random };
inline constexpr std::size_t kOrders = 5;
std::string_view word(Order order);

struct Layout {
  int columns = 7;
  int rows = 4;
  double half_width_mm = 1200.0;
  double half_height_mm = 600.0;
  int repeats = 6;
};
/// 28, 60, 117, 200 or 465 marks. \throws std::invalid_argument for another number.
Layout layout_of(int points);

/// Marks in visiting order, numbered from 0; the repeats are earlier marks, spread evenly over the
/// session. `mark` is the index of the repeated mark.
struct PlannedVisit {
  Vec2 place;
  std::size_t mark = 0;
  bool repeat = false;
};
std::vector<PlannedVisit> plan_visits(const Layout& layout, Order order, Dice& dice);
/// The list that `chaintrue start` prints for a bed of 8 by 4 feet: 28 marks row by row, one way and back,
/// the second mark of each row but the last once more at its end, and the first mark last.
std::vector<PlannedVisit> list_of_start();

}  // namespace chaintrue::generator
