// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/input_checks/row_checks.hpp"

#include <fmt/format.h>

#include <utility>

#include "grid/input_checks/number_checks.hpp"

namespace chaintrue::grid::input_checks {
namespace {

/// Some ten kinds of errors in a whole row.
constexpr double kOfRow = 2.3;
/// Commands are printed on the sheet, lengths and marks are written by hand.
constexpr double kPrinted = 2.0;

template <class Number>
void add_number(std::vector<RowError>& slips,
                const MeasuredPoint& written,
                const char* name,
                bool is_signed,
                bool is_reading,
                double penalty,
                Number number) {
  MeasuredPoint copy = written;
  const double value = number(copy);
  for (NumberError& slip : number_errors(value, is_signed)) {
    RowError row{written,
                fmt::format("{} {}", name, digits_of(value)),
                std::move(slip.question),
                slip.penalty + penalty,
                is_reading};
    number(row.meant) = slip.value;
    slips.push_back(std::move(row));
  }
}

}  // namespace

std::vector<RowError> row_errors(const MeasuredPoint& written) {
  std::vector<RowError> slips;
  const auto mark = [&](double x_mm, double y_mm, const char* question) {
    RowError slip{written, "", question, kOfRow, false};
    slip.meant.mark = {x_mm, y_mm};
    slips.push_back(std::move(slip));
  };
  const auto [x_mm, y_mm] = written.mark;
  mark(y_mm, x_mm, "are x and y swapped?");
  mark(-x_mm, -y_mm, "are the minus signs of x_mm and y_mm wrong?");
  if (written.lengths) {
    RowError slip{written, "", "are left_mm and right_mm exchanged?", kOfRow, true};
    std::swap(slip.meant.lengths->left_mm, slip.meant.lengths->right_mm);
    slips.push_back(std::move(slip));
  }
  add_number(slips, written, "x_mm", true, false, 0.0, [](MeasuredPoint& p) -> double& {
    return p.mark.x_mm;
  });
  add_number(slips, written, "y_mm", true, false, 0.0, [](MeasuredPoint& p) -> double& {
    return p.mark.y_mm;
  });
  if (written.lengths) {
    add_number(slips, written, "left_mm", false, true, 0.0, [](MeasuredPoint& p) -> double& {
      return p.lengths->left_mm;
    });
    add_number(slips, written, "right_mm", false, true, 0.0, [](MeasuredPoint& p) -> double& {
      return p.lengths->right_mm;
    });
  } else if (written.commanded) {
    add_number(
        slips, written, "commanded_x_mm", true, true, kPrinted, [](MeasuredPoint& p) -> double& {
          return p.commanded->x_mm;
        });
    add_number(
        slips, written, "commanded_y_mm", true, true, kPrinted, [](MeasuredPoint& p) -> double& {
          return p.commanded->y_mm;
        });
  }
  mark(25.4 * x_mm, 25.4 * y_mm, "are x_mm and y_mm in inches?");
  mark(10.0 * x_mm, 10.0 * y_mm, "are x_mm and y_mm in centimetres?");
  return slips;
}

}  // namespace chaintrue::grid::input_checks
