// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/input_checks/whole_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "grid/input_checks/number_checks.hpp"

namespace chaintrue::grid::input_checks {
namespace {

using model::BedPoint;
using model::MarkPoint;

constexpr double kMmPerCm = 10.0;
constexpr double kMmPerM = 1000.0;

void scale_mark(MeasuredPoint& point, double factor) {
  point.mark = {factor * point.mark.x_mm, factor * point.mark.y_mm};
}

void scale_reading(MeasuredPoint& point, double factor) {
  if (point.lengths)
    point.lengths = {factor * point.lengths->left_mm, factor * point.lengths->right_mm};
  if (point.commanded)
    point.commanded = BedPoint{factor * point.commanded->x_mm, factor * point.commanded->y_mm};
}

class List {
 public:
  void mark(ProblemKind kind,
            std::string sentence,
            std::function<MarkPoint(MarkPoint, BedPoint)> meant) {
    slips_.push_back({kind, std::move(sentence), [meant](MeasuredPoint& point, BedPoint place) {
                        point.mark = meant(point.mark, place);
                      }});
  }
  void shift(double x_mm, double y_mm, std::string sentence, bool is_doubtful = false) {
    mark(ProblemKind::constant_offset, std::move(sentence), [=](MarkPoint m, BedPoint) {
      return MarkPoint{m.x_mm + x_mm, m.y_mm + y_mm};
    });
    slips_.back().is_doubtful = is_doubtful;
  }
  void reading(ProblemKind kind,
               std::string sentence,
               std::function<void(MeasuredPoint&)> meant) {
    slips_.push_back({kind,
                      std::move(sentence),
                      [meant](MeasuredPoint& point, BedPoint) { meant(point); },
                      true});
  }
  [[nodiscard]] std::vector<WholeError> take() { return std::move(slips_); }

 private:
  std::vector<WholeError> slips_;
};

void add_axes(List& list) {
  list.mark(ProblemKind::axes,
            "the sign of x_mm looks turned round: x_mm counts to the right of the bed's middle",
            [](MarkPoint m, BedPoint) {
              return MarkPoint{-m.x_mm, m.y_mm};
            });
  list.mark(ProblemKind::axes,
            "y_mm looks counted downwards: it counts up the sheet", [](MarkPoint m, BedPoint) {
    return MarkPoint{m.x_mm, -m.y_mm};
  });
  list.mark(
      ProblemKind::axes,
      "the signs of x_mm and y_mm both look turned round: they count to the right and up the sheet",
      [](MarkPoint m, BedPoint) {
        return MarkPoint{-m.x_mm, -m.y_mm};
      });
  list.mark(ProblemKind::axes,
            "the two columns look swapped: x_mm counts to the right, y_mm up the sheet",
            [](MarkPoint m, BedPoint) {
              return MarkPoint{m.y_mm, m.x_mm};
            });
  list.mark(ProblemKind::axes,
            "the axes look turned by a quarter: x_mm counts to the right, y_mm up the sheet",
            [](MarkPoint m, BedPoint) {
              return MarkPoint{m.y_mm, -m.x_mm};
            });
  list.mark(ProblemKind::axes,
            "the axes look turned by a quarter: x_mm counts to the right, y_mm up the sheet",
            [](MarkPoint m, BedPoint) {
              return MarkPoint{-m.y_mm, m.x_mm};
            });
}

/// A minus in every row that needs one, where a column has none.
void add_signs(List& list, const MeasuredGrid& grid) {
  const auto has_minus = [&](double MarkPoint::*axis) {
    return std::any_of(grid.points.begin(), grid.points.end(), [axis](const MeasuredPoint& point) {
      return point.mark.*axis < 0.0;
    });
  };
  const bool x = !has_minus(&MarkPoint::x_mm);
  const bool y = !has_minus(&MarkPoint::y_mm);
  const auto left_of = [](double written, double place) { return std::copysign(written, place); };
  if (x) {
    list.mark(ProblemKind::minus_signs,
              "all the minus signs of x_mm look left out: places left of the bed's middle need one",
              [=](MarkPoint m, BedPoint p) {
                return MarkPoint{left_of(m.x_mm, p.x_mm), m.y_mm};
              });
  }
  if (y) {
    list.mark(ProblemKind::minus_signs,
              "all the minus signs of y_mm look left out: places below the bed's middle need one",
              [=](MarkPoint m, BedPoint p) {
                return MarkPoint{m.x_mm, left_of(m.y_mm, p.y_mm)};
              });
  }
  if (x && y) {
    list.mark(
        ProblemKind::minus_signs,
        "all the minus signs look left out: places left of the bed's middle and below it need them",
        [=](MarkPoint m, BedPoint p) {
          return MarkPoint{left_of(m.x_mm, p.x_mm), left_of(m.y_mm, p.y_mm)};
        });
  }
}

/// --inches is of marks and lengths together, and leaves commands as they are.
void add_units(List& list, bool reads_lengths, Written written) {
  const std::string_view readings = reads_lengths ? "lengths" : "commands";
  const std::string_view for_marks = reads_lengths ? "" : or_say_inches(written);
  const std::string_view for_all = reads_lengths ? or_say_inches(written) : "";
  const auto marks_in = [&](std::string_view unit, double factor) {
    list.mark(
        ProblemKind::other_unit,
        fmt::format("x_mm and y_mm look like {}, the {} like mm: multiply x_mm and y_mm by {:g}{}",
                    unit,
                    readings,
                    factor,
                    factor == kMmPerInch ? for_marks : ""),
        [factor](MarkPoint m, BedPoint) {
          return MarkPoint{factor * m.x_mm, factor * m.y_mm};
        });
  };
  marks_in("inches", kMmPerInch);
  marks_in("centimetres", kMmPerCm);
  marks_in("metres", kMmPerM);
  const auto readings_in = [&](std::string_view unit, double factor) {
    list.reading(
        ProblemKind::other_unit,
        fmt::format("the {0} look like {1}, x_mm and y_mm like mm: multiply the {0} by {2:g}",
                    readings,
                    unit,
                    factor),
        [factor](MeasuredPoint& point) { scale_reading(point, factor); });
    list.reading(ProblemKind::other_unit,
                 fmt::format("these look like {}: multiply all of them by {:g}{}",
                             unit,
                             factor,
                             factor == kMmPerInch ? for_all : ""),
                 [factor](MeasuredPoint& point) {
                   scale_reading(point, factor);
                   scale_mark(point, factor);
                 });
  };
  readings_in("inches", kMmPerInch);
  readings_in("centimetres", kMmPerCm);
  readings_in("metres", kMmPerM);
}

/// Each a little off, all equally: only the machine's prior shows that this is an error.
void add_shifts(List& list, const model::Bed& bed, bool reads_lengths) {
  for (const auto& slip : {std::pair(kTapeMarkMm, "the tape held at its 100 mm mark"),
                           std::pair(kMmPerFoot, "a foot miscounted")}) {
    const double by_mm = slip.first;
    const char* why = slip.second;
    for (const double sign : {1.0, -1.0}) {
      const char* too = sign > 0.0 ? "small" : "large";
      const auto words = [&](const char* what) {
        return fmt::format(
            "all {} look {:g} mm too {}: was {}, or are the machine's measures off by that?",
            what,
            by_mm,
            too,
            why);
      };
      list.shift(sign * by_mm, 0.0, words("x_mm"), reads_lengths);
      list.shift(0.0, sign * by_mm, words("y_mm"), reads_lengths);
      list.shift(sign * by_mm, sign * by_mm, words("x_mm and y_mm"), reads_lengths);
    }
  }
  const double half_width = 0.5 * bed.width_mm;
  const double half_height = 0.5 * bed.height_mm;
  for (const auto& [x, y, corner] : {std::tuple(1.0, 1.0, "lower left"),
                                     std::tuple(-1.0, 1.0, "lower right"),
                                     std::tuple(1.0, -1.0, "upper left"),
                                     std::tuple(-1.0, -1.0, "upper right")}) {
    const auto words = fmt::format(
        "x_mm and y_mm look counted from the bed's {} corner: they count from its middle", corner);
    list.shift(-x * half_width, -y * half_height, words);
    if (x < 0.0 || y < 0.0) {
      list.mark(ProblemKind::constant_offset,
                words, [=, x = x, y = y](MarkPoint m, BedPoint) {
        return MarkPoint{x * (m.x_mm - half_width), y * (m.y_mm - half_height)};
      });
    }
  }
}

void add_lengths(List& list) {
  list.reading(ProblemKind::sides_swapped,
               "the columns left_mm and right_mm look swapped", [](MeasuredPoint& point) {
    if (point.lengths) std::swap(point.lengths->left_mm, point.lengths->right_mm);
  });
  const auto longer = [&](double left_mm, double right_mm, std::string_view what, double by_mm) {
    for (const double sign : {1.0, -1.0}) {
      list.reading(
          ProblemKind::constant_offset,
          fmt::format("{} look {:g} mm too {}: they count from the sprocket's 12 o'clock; was the "
                      "tape held at another mark?",
                      what,
                      by_mm,
                      sign > 0.0 ? "small" : "large"),
          [=](MeasuredPoint& point) {
            if (!point.lengths) return;
            point.lengths->left_mm += sign * left_mm;
            point.lengths->right_mm += sign * right_mm;
          });
    }
  };
  for (const double by_mm : {kTapeMarkMm, kMmPerFoot}) {
    longer(by_mm, by_mm, "all lengths", by_mm);
    longer(by_mm, 0.0, "all left lengths", by_mm);
    longer(0.0, by_mm, "all right lengths", by_mm);
  }
}

}  // namespace

std::vector<WholeError> whole_errors(const MeasuredGrid& grid, Written written) {
  const bool reads_lengths =
      std::any_of(grid.points.begin(), grid.points.end(), [](const MeasuredPoint& point) {
        return point.lengths.has_value();
      });
  List list;
  add_signs(list, grid);
  add_axes(list);
  if (reads_lengths) add_lengths(list);
  add_units(list, reads_lengths, written);
  if (grid.machine) add_shifts(list, grid.machine->bed, reads_lengths);
  return list.take();
}

}  // namespace chaintrue::grid::input_checks
