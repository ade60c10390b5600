// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/input_checks/whole_checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <utility>

#include "grid/input_checks/number_checks.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::input_checks {
namespace {

/// Builds the list of transformations of marks and readings.
class List : public Transformations<PlacedPoints> {
 public:
  List(const PointAccounts& accounts, const PlacedPoints& written)
      : Transformations(written, [&](const PlacedPoints& meant) { return accounts.rows(meant); }),
        accounts_(accounts) {}

  Transformation& mark(ProblemKind kind, std::string sentence, const Affine& meant) {
    return add(kind, std::move(sentence), [meant](PlacedPoints& all, std::size_t row) {
      all[row].mark = meant.of(all[row].mark);
    });
  }
  Transformation& reading(ProblemKind kind, std::string sentence, const Affine& lengths,
                          const Affine& commands = {}, const Affine& marks = {}) {
    return add(
        kind, std::move(sentence),
        [&accounts = accounts_, lengths, commands, marks](PlacedPoints& all, std::size_t row) {
          PlacedPoint& own = all[row];
          own.mark = marks.of(own.mark);
          if (own.lengths) own.lengths = lengths.of(*own.lengths);
          if (own.commanded) own.commanded = commands.of(*own.commanded);
          own.place = accounts.place_of(own);
        });
  }
  /// Each reading with the mark of another line.
  Transformation& order(ProblemKind kind, std::string sentence, const std::vector<Place>& others) {
    Transformation& own =
        add(kind, std::move(sentence),
            [others](PlacedPoints& all, std::size_t row) { all[row].place = others[row]; });
    own.of = Transformation::Of::all;
    return own;
  }

 private:
  const PointAccounts& accounts_;
};

void add_axes(List& list) {
  constexpr const char* kQuarter =
      "the axes look rotated by a quarter turn: x_mm counts to the right, y_mm up the sheet";
  const std::pair<const char*, Affine> axes[] = {
      {"the sign of x_mm looks reversed: x_mm counts to the right of the bed's middle",
       times(-1, 1)},
      {"y_mm looks counted downwards: it counts up the sheet", times(1, -1)},
      {"the signs of x_mm and y_mm both look reversed: they count to the right and up the sheet",
       times(-1, -1)},
      {"the two columns look swapped: x_mm counts to the right, y_mm up the sheet", swapped()},
      {kQuarter, {Matrix2d{{0, 1}, {-1, 0}}}},
      {kQuarter, {Matrix2d{{0, -1}, {1, 0}}}}};
  for (const auto& [sentence, meant] : axes) list.mark(ProblemKind::axes, sentence, meant);
}

/// Adds a minus in every row that needs one, if a column has none.
void add_signs(List& list, const PlacedPoints& written) {
  const auto has_minus = [&](double MarkPoint::*axis) {
    return any_of(written, [axis](const PlacedPoint& point) { return point.mark.*axis < 0.0; });
  };
  const auto add = [&](bool of_x, bool of_y, const char* which, const char* where) {
    list.add(ProblemKind::minus_signs,
             fmt::format("all minus signs{} seem to be missing: places {} need one", which, where),
             [=](PlacedPoints& all, std::size_t row) {
               PlacedPoint& own = all[row];
               if (own.place && of_x) own.mark.x_mm = std::copysign(own.mark.x_mm, own.place->x_mm);
               if (own.place && of_y) own.mark.y_mm = std::copysign(own.mark.y_mm, own.place->y_mm);
             });
  };
  const bool x = !has_minus(&MarkPoint::x_mm), y = !has_minus(&MarkPoint::y_mm);
  if (x) add(true, false, " of x_mm", "left of the bed's middle");
  if (y) add(false, true, " of y_mm", "below the bed's middle");
  if (x && y) add(true, true, "", "left of the bed's middle and below it");
}

/// --inches applies to marks and lengths together, and not to commands.
void add_units(List& list, bool reads_lengths, Written written) {
  const std::string_view readings = reads_lengths ? "lengths" : "commands";
  const std::string_view for_marks = reads_lengths ? "" : or_say_inches(written);
  const std::string_view for_all = reads_lengths ? or_say_inches(written) : "";
  const auto column_in_inches = [&](const char* column, const char* other, double x, double y) {
    list.mark(ProblemKind::other_unit,
              fmt::format("{} looks like inches, {} and the {} like mm: multiply {} by {:g}",
                          column, other, readings, column, kMmPerInch),
              times(x, y));
  };
  column_in_inches("x_mm", "y_mm", kMmPerInch, 1.0);
  column_in_inches("y_mm", "x_mm", 1.0, kMmPerInch);
  for (const auto& [word, mm] : kWrittenUnits) {
    const Affine meant = times(mm, mm);
    list.mark(
        ProblemKind::other_unit,
        fmt::format("x_mm and y_mm look like {}, the {} like mm: multiply x_mm and y_mm by {:g}{}",
                    word, readings, mm, mm == kMmPerInch ? for_marks : ""),
        meant);
    list.reading(
        ProblemKind::other_unit,
        fmt::format("the {0} look like {1}, x_mm and y_mm like mm: multiply the {0} by {2:g}",
                    readings, word, mm),
        meant, meant);
    list.reading(ProblemKind::other_unit,
                 fmt::format("these look like {}: multiply all of them by {:g}{}", word, mm,
                             mm == kMmPerInch ? for_all : ""),
                 meant, meant, meant);
  }
}

/// All rows are slightly off by the same amount: only the machine's prior shows that this is an
/// error. For a part of the rows the others show it.
void add_shifts(List& list, bool reads_lengths) {
  constexpr std::pair<double, const char*> kSlips[] = {
      {kTapeMarkMm, "the tape held at its 100 mm mark"},
      {kMmPerFoot, "a foot miscounted"},
      {kMmPerInch, "the tape held at its first inch"}};
  for (const auto& [by_mm, why] : kSlips) {
    for (const double sign : {1.0, -1.0}) {
      const auto shift = [&, by_mm = by_mm, why = why](double x, double y, const char* what) {
        Transformation& own = list.mark(
            ProblemKind::constant_offset,
            fmt::format("all {} look {:g} mm too {}: was {}, or are the machine's measures off by "
                        "that amount?",
                        what, by_mm, sign > 0.0 ? "small" : "large", why),
            {.plus = sign * by_mm * Vector2d(x, y)});
        own.is_doubtful = reads_lengths;
        if (by_mm == kMmPerInch) own.of = Transformation::Of::part;
      };
      shift(1.0, 0.0, "x_mm");
      shift(0.0, 1.0, "y_mm");
      shift(1.0, 1.0, "x_mm and y_mm");
    }
  }
}

/// The origin and direction of one coordinate.
struct Origin {
  std::string from;  ///< "the left motor"; empty: the bed's middle
  std::string edge;  ///< of the bed: "left"
  double at_mm = 0.0;
  std::string way;  ///< ", to the left" or ", down" where it counts that way
  double sign = 1.0;
};
using Origins = std::vector<Origin>;

/// Each origin in both counting directions; `back` describes the second.
Origins both_ways(const Origins& some, const char* back) {
  Origins all;
  for (const Origin& own : some) {
    all.push_back(own);
    all.push_back({own.from, own.edge, own.at_mm, back, -1.0});
  }
  return all;
}

std::string origin_in_words(const Origin& x, const Origin& y) {
  if (!x.edge.empty() && !y.edge.empty()) {
    return fmt::format("x_mm and y_mm look counted from the bed's {} {} corner{}{}", y.edge, x.edge,
                       x.way, y.way);
  }
  const auto one = [](const char* name, const Origin& own) {
    return own.from.empty() ? std::string()
                            : fmt::format("{} looks counted from {}{}", name, own.from, own.way);
  };
  return one("x_mm", x) + (x.from.empty() || y.from.empty() ? "" : " and ") + one("y_mm", y);
}

/// Edges and corners of the bed, and motors.
void add_origins(List& list, const Machine& machine) {
  const auto add = [&](const Origin& x, const Origin& y) {
    list.mark(ProblemKind::constant_offset,
              origin_in_words(x, y) + ": they count from the bed's middle, to the right and up",
              {times(x.sign, y.sign).by, {x.at_mm, y.at_mm}});
  };
  const auto group = [&](const Origins& left_or_right, const Origins& up_or_down) {
    const Origins xs = both_ways(left_or_right, ", to the left");
    const Origins ys = both_ways(up_or_down, ", down");
    for (const Origin& x : xs) add(x, {});
    for (const Origin& y : ys) add({}, y);
    for (const Origin& x : xs)
      for (const Origin& y : ys) add(x, y);
  };
  const double right = 0.5 * machine.bed.width_mm, top = 0.5 * machine.bed.height_mm;
  group({{"the bed's left edge", "left", -right}, {"the bed's right edge", "right", right}},
        {{"the bed's upper edge", "upper", top}, {"the bed's lower edge", "lower", -top}});
  const auto& [left_motor, right_motor] = machine.motors;
  group({{"the left motor", "", left_motor.x_mm}, {"the right motor", "", right_motor.x_mm}},
        {{"the motors", "", 0.5 * (left_motor.y_mm + right_motor.y_mm)}});
}

void add_lengths(List& list) {
  list.reading(ProblemKind::sides_swapped, "the columns left_mm and right_mm look swapped",
               swapped());
  const auto longer = [&](double left_mm, double right_mm, std::string_view what, double by_mm) {
    for (const double sign : {1.0, -1.0}) {
      list.reading(
          ProblemKind::constant_offset,
          fmt::format("{} look {:g} mm too {}: they count from the sprocket's 12 o'clock; was the "
                      "tape held at another mark?",
                      what, by_mm, sign > 0.0 ? "small" : "large"),
          {.plus = sign * Vector2d(left_mm, right_mm)});
    }
  };
  for (const double by_mm : {kTapeMarkMm, kMmPerFoot}) {
    longer(by_mm, by_mm, "all lengths", by_mm);
    longer(by_mm, 0.0, "all left lengths", by_mm);
    longer(0.0, by_mm, "all right lengths", by_mm);
  }
}

/// "lengths" or "commands".
std::string_view readings_of(const PlacedPoints& written) {
  return written.front().lengths ? "lengths" : "commands";
}

/// Assigns every mark to its nearest place, if this uses each place once.
std::optional<std::vector<Place>> places_nearest(const PlacedPoints& written) {
  std::vector<Place> nearest;
  std::vector<Place> left = mapped(written, &PlacedPoint::place);
  for (const PlacedPoint& point : written) {
    const auto apart = [&](const Place& place) {
      return place ? distance_mm(point.mark, *place) : kInfinity;
    };
    const auto best = min_element(left, ascending(apart));
    if (!*best) return std::nullopt;
    nearest.push_back(*best);
    left.erase(best);
  }
  return nearest;
}

}  // namespace

std::vector<Transformation> point_transformations(const PointAccounts& accounts,
                                                  const MeasuredGrid& grid,
                                                  const PlacedPoints& written, Written as) {
  const bool reads_lengths = any_of(written, &PlacedPoint::lengths);
  List list(accounts, written);
  add_signs(list, written);
  add_axes(list);
  if (reads_lengths) add_lengths(list);
  add_units(list, reads_lengths, as);
  add_shifts(list, reads_lengths);
  add_origins(list, *grid.machine);
  if (const auto nearest = places_nearest(written)) {
    list.order(
            ProblemKind::other_order,
            fmt::format(
                "the {} belong to the marks of other lines: are the two lists sorted differently?",
                readings_of(written)),
            *nearest)
        .penalty = std::lgamma(as_double(written.size()) + 1.0);  // orders
  }
  return list.take();
}

std::vector<Transformation> slip_transformations(const PointAccounts& accounts,
                                                 const PlacedPoints& written) {
  std::vector<Place> places = mapped(written, &PlacedPoint::place);
  const auto n = std::ssize(places);
  List list(accounts, written);
  for (const std::ptrdiff_t by : {-1, 1}) {
    std::vector<Place> slipped;
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      const bool is_there = i + by >= 0 && i + by < n;
      slipped.push_back(is_there ? places[as_size(i + by)] : std::nullopt);
    }
    list.order(ProblemKind::row_slip,
               fmt::format("x_mm and y_mm fit the {} of the line {}: is a line {}?",
                           written.front().lengths ? "lengths" : "command",
                           by < 0 ? "before" : "after",
                           by < 0 ? "written twice, or missing from the other columns"
                                  : "missing, or written twice in the other columns"),
               slipped)
        .of = Transformation::Of::tail;
  }
  list.order(ProblemKind::other_order,
             fmt::format("one of the two lists, marks and {}, seems to be in reverse order",
                         readings_of(written)),
             {places.rbegin(), places.rend()});
  return list.take();
}

}  // namespace chaintrue::grid::input_checks
