// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/input_checks/point_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "grid/input_checks/number_checks.hpp"
#include "grid/input_checks/point_accounts.hpp"
#include "grid/input_checks/whole_checks.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::input_checks {
namespace {

struct RowError {
  MeasuredPoint meant;
  /// The questioned number: "y_mm 536.5"; empty for the whole row.
  std::string number;
  std::string question;
  double penalty = 0.0;  ///< as NumberError
  bool mends_reading = false;
};

/// Some ten kinds of errors in a whole row.
constexpr double kOfRow = 2.3;
/// Commands are printed on the sheet, lengths and marks are written by hand.
constexpr double kPrinted = 2.0;

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
  MeasuredPoint meant = written;
  const auto number = [&](const char* name, bool is_signed, bool is_reading, double penalty,
                          double& of) {
    const double value = of;
    for (NumberError& slip : number_errors(value, is_signed)) {
      of = slip.value;
      slips.push_back({meant, fmt::format("{} {}", name, digits_of(value)),
                       std::move(slip.question), slip.penalty + penalty, is_reading});
    }
    of = value;
  };
  number("x_mm", true, false, 0.0, meant.mark.x_mm);
  number("y_mm", true, false, 0.0, meant.mark.y_mm);
  if (written.lengths) {
    number("left_mm", false, true, 0.0, meant.lengths->left_mm);
    number("right_mm", false, true, 0.0, meant.lengths->right_mm);
  } else if (written.commanded) {
    number("commanded_x_mm", true, true, kPrinted, meant.commanded->x_mm);
    number("commanded_y_mm", true, true, kPrinted, meant.commanded->y_mm);
  }
  mark(25.4 * x_mm, 25.4 * y_mm, "are x_mm and y_mm in inches?");
  mark(10.0 * x_mm, 10.0 * y_mm, "are x_mm and y_mm in centimetres?");
  return slips;
}

/// Chi-square of the trend's twelve coefficients: the 98th percentile.
constexpr double kOddPoints = 25.0;
/// Half of the points are this far off, without an explanation: marks and readings are from two
/// lists.
constexpr double kStrangePointsMm = 60.0;
constexpr std::size_t kFewestStrangePoints = 6;
/// This many rows show an error of the whole file as well as all do.
constexpr std::size_t kMostLookedAt = 200;
constexpr double kRepeatMm = 30.0;

/// A file may have ten thousand points.
Indices looked_at(std::size_t count) {
  const std::size_t few = std::min(count, kMostLookedAt);
  return mapped(each_below(few), [&](std::size_t i) { return i * count / few; });
}

std::string number_of(const MeasuredGrid& grid, std::size_t row) {
  return fmt::format("{}", grid.points[row].order.value_or(as_int(row) + 1));
}

std::optional<WholeFinding> strangers(const Account& plain, std::size_t count) {
  if (count < kFewestStrangePoints || plain.median_mm < kStrangePointsMm) return std::nullopt;
  return WholeFinding{
      std::nullopt,
      "marks and readings do not belong together, and no usual typing error explains it; are they "
      "from another sheet, another list or another machine?",
      std::isfinite(plain.median_mm)
          ? fmt::format(
                "half of the points are more than {:.0f} mm from where the machine puts them",
                plain.median_mm)
          : std::string("no machine can have these readings"),
      false};
}

std::optional<WholeFinding> of_the_file(const PointAccounts& accounts, const MeasuredGrid& grid,
                                        const PlacedPoints& all, const RobustTrend& trend,
                                        Written written) {
  const Indices looked = looked_at(grid.points.size());
  PlacedPoints few;
  for (const std::size_t row : looked) few.push_back(all[row]);
  const VectorXd& sigma_mm = accounts.prior_sigma_mm();
  const TrendRows few_rows = accounts.rows(few);
  const Account plain = account_of(robust_trend(few_rows, sigma_mm));
  std::vector<Candidate> candidates =
      searched(sigma_mm, few_rows, point_transformations(accounts, grid, few, written),
               [&](std::size_t row) { return number_of(grid, looked[row]); });
  for (Candidate& candidate : candidates) {
    if (candidate.from_row) candidate.from_row = looked[*candidate.from_row];
  }
  // These need neighbours in the file and, with all rows, a separate account of the uncorrected
  // file.
  std::vector<Candidate> of_all =
      searched(sigma_mm, accounts.rows(all), slip_transformations(accounts, all),
               [&](std::size_t row) { return number_of(grid, row); });
  const double scale = plain.log_likelihood - trend.log_likelihood;
  for (Candidate& candidate : of_all) {
    candidate.account.log_likelihood += scale;
    candidates.push_back(std::move(candidate));
  }
  auto finding = whole_finding(
      std::move(candidates), plain, 2 * all.size(), kOddPoints,
      std::isfinite(plain.median_mm)
          ? fmt::format("half of the marks are more than {} from where the machine puts them",
                        length_in_words(plain.median_mm))
          : std::string("the machine cannot have these readings"));
  if (finding && finding->from_row.value_or(0) > 0) {
    const VectorXd& residual_mm = trend.residual_mm;
    finding->found = fmt::format(
        "half of the marks from here on are off by more than {}",
        length_in_words(
            median({residual_mm.begin() + as_index(*finding->from_row), residual_mm.end()})));
  }
  if (finding) return finding;
  return strangers(account_of(trend), grid.points.size());
}

/// Marks that are all rotated by one angle, with much less stretch and skew.
std::optional<WholeFinding> turned_sheet(const PointAccounts& accounts, const MeasuredGrid& grid,
                                         const RobustTrend& trend) {
  // Motors known to 3 mm rotate the picture by one or two.
  constexpr double kLeastTurn = 8e-3;
  constexpr double kPure = 4.0;
  if (grid.sheet || grid.points.size() < kFewestStrangePoints) return std::nullopt;
  const Matrix2d slope = accounts.slope(trend);
  const double turn = 0.5 * (slope(1, 0) - slope(0, 1));  // of the marks, to the left
  const double skew = 0.5 * (slope(1, 0) + slope(0, 1));
  const double strain = std::max({std::abs(slope(0, 0)), std::abs(slope(1, 1)), std::abs(skew)});
  if (std::abs(turn) < std::max(kLeastTurn, kPure * strain)) return std::nullopt;
  constexpr double kMmPerMetre = 1000.0;
  return WholeFinding{
      std::nullopt,
      fmt::format("the sheet looks rotated by {:.0f} mm per metre, its right end {}: was it placed "
                  "at an angle, or is the beam with the motors tilted? If it was placed by hand, "
                  "enter how accurately (\"sheet\": {{\"shift_mm\": 10, \"rotation_mrad\": 20}}); "
                  "otherwise measure from the bed's axes",
                  kMmPerMetre * std::abs(turn), turn > 0.0 ? "up" : "down"),
      fmt::format("all marks agree on it to {:.1f} mm", trend.median_residual_mm()),
      true,
      std::nullopt,
      ProblemKind::axes};
}

std::string capitalised(std::string text) {
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

/// Distance between the marks of this row and of the row with the nearest reading.
std::optional<double> apart_from_its_repeat(const PlacedPoints& placed, std::size_t row) {
  const PlacedPoint& own = placed[row];
  std::optional<double> apart;
  for (const PlacedPoint& other : placed) {
    if (&other == &own || !other.place || distance_mm(*own.place, *other.place) > kRepeatMm)
      continue;
    apart = distance_mm(own.mark, other.mark);
  }
  return apart;
}

struct PointRows {
  const PointAccounts& accounts;
  const MeasuredGrid& grid;
  const PlacedPoints& placed;
  const RobustTrend& trend;

  double off_of(const RowError& slip, std::size_t row) const {
    const Place place = slip.mends_reading ? accounts.place_of(slip.meant) : placed[row].place;
    if (!place) return kInfinity;
    return accounts.off(trend, slip.meant.mark, *place).norm();
  }
  double residual_mm(std::size_t row) const { return trend.residual_mm[as_index(row)]; }
  bool is_gross(std::size_t row) const {
    // If the stated machine is off by decimetres the trend is only a first guess.
    constexpr double kGrossOfOddMm = 100.0;
    const double least_mm = trend.prior_chi_square < kOddPoints ? kGrossMm : kGrossOfOddMm;
    return residual_mm(row) > std::max(least_mm, kGrossScales * trend.scale_mm);
  }
  /// The likeliest error of the row, if its correction makes the row three times likelier.
  [[nodiscard]] std::optional<RowError> best_of(std::size_t row) const {
    constexpr double kLostMm = 2000.0;  // a row whose lengths no pose has
    const double as_it_is =
        log_density_of(std::min(residual_mm(row), kLostMm), trend.scale_mm, 2) + kThreeTimes;
    std::optional<RowError> best;
    double most = as_it_is;
    for (RowError& slip : row_errors(placed[row])) {
      const double likely = log_density_of(off_of(slip, row), trend.scale_mm, 2) - slip.penalty;
      if (likely <= most) continue;
      most = likely;
      best = std::move(slip);
    }
    return best;
  }
  /// Another row with a gross error such that the readings of the two fit each other's marks.
  std::optional<std::size_t> exchanged_with(std::size_t row, const Indices& gross) const {
    const auto fits = [&](std::size_t reading, std::size_t mark) {
      const Place& place = placed[reading].place;
      return place && accounts.off(trend, placed[mark].mark, *place).norm() <
                          std::max(kSoundMm, 4.0 * trend.scale_mm);
    };
    for (const std::size_t other : gross) {
      if (other != row && fits(row, other) && fits(other, row)) return other;
    }
    return std::nullopt;
  }

  RowFinding words_of(std::size_t row, const RowError& slip) const {
    const std::string number = number_of(grid, row);
    const MarkPoint mark = placed[row].mark;
    const auto& motors = grid.machine->motors;
    if (!accounts.can_hold(mark)) {
      const bool is_above = mark.y_mm > std::min(motors.left.y_mm, motors.right.y_mm);
      return {row,
              fmt::format("Mark {} is {}: {}", number,
                          is_above ? "above the motors" : "where the machine cannot hold the sled",
                          slip.question),
              true};
    }
    const auto apart = placed[row].place ? apart_from_its_repeat(placed, row) : std::nullopt;
    const std::string what =
        apart && *apart > kGrossMm
            ? fmt::format("was measured twice, {} apart", length_in_words(*apart))
        : !std::isfinite(residual_mm(row))
            ? "has lengths that the machine cannot have"
            : fmt::format("is {} from where the others put it", length_in_words(residual_mm(row)));
    const std::string question = slip.number.empty()
                                     ? capitalised(slip.question)
                                     : fmt::format("{}: {}", slip.number, slip.question);
    return {row, fmt::format("Mark {} {}. {}", number, what, question), false};
  }

  std::vector<RowFinding> findings() const {
    constexpr std::size_t kMostNamed = 200;
    Indices gross;
    for (const auto row : each_index(grid.points)) {
      if (is_gross(row) && gross.size() < kMostNamed) gross.push_back(row);
    }
    std::vector<RowFinding> found;
    for (const std::size_t row : gross) {
      if (const auto other = exchanged_with(row, gross)) {
        found.push_back({row,
                         fmt::format("Marks {} and {} look exchanged: each is where the other "
                                     "one's reading puts it.",
                                     number_of(grid, row), number_of(grid, *other)),
                         false});
        continue;
      }
      if (const auto slip = best_of(row)) found.push_back(words_of(row, *slip));
    }
    return found;
  }
};

}  // namespace

Findings check_points(const MeasuredGrid& grid, Written written) {
  if (!grid.machine || !problems_of(*grid.machine).empty() || grid.points.empty()) return {};
  const PointAccounts accounts(grid);
  const PlacedPoints placed = accounts.placed(grid.points);
  const RobustTrend trend = robust_trend(accounts.rows(placed), accounts.prior_sigma_mm());
  const PointRows rows{accounts, grid, placed, trend};
  bool is_odd = trend.prior_chi_square > kOddPoints || trend.median_residual_mm() > kSoundMm;
  for (const auto row : each_index(grid.points)) is_odd = is_odd || rows.is_gross(row);
  Findings findings;
  if (is_odd) findings.whole = of_the_file(accounts, grid, placed, trend, written);
  if (!findings.whole) findings.whole = turned_sheet(accounts, grid, trend);
  if (!is_odd) return findings;
  if (!findings.whole || findings.whole->is_doubtful) findings.rows = rows.findings();
  return findings;
}

}  // namespace chaintrue::grid::input_checks
