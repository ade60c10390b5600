// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/input_checks/distance_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "grid/containers.hpp"
#include "grid/input_checks/number_checks.hpp"
#include "grid/input_checks/transformation_search.hpp"
#include "grid/plane_vectors.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::input_checks {
namespace {

/// Sheet right and up, its turn, three strains, the tape's zero offset.
constexpr Index kDistanceBasis = 7;
/// One sigma of each: a sheet laid by hand; machines err by 3 mm a metre before they are calibrated.
constexpr double kSheetMm = 10.0;
constexpr double kPerMetreMm = 5.0;
constexpr double kTapeZeroMm = 3.0;
constexpr double kMetreMm = 1000.0;
/// Chi-square of seven coefficients: one set in a thousand.
constexpr double kOddDistances = 25.0;
/// Half of the distances are this far off, without an explanation.
constexpr double kStrangeDistancesMm = 60.0;

RowVectorXd basis_of(const MeasuredHoles& set, const HoleDistance& distance) {
  const BedPoint from = set.holes[distance.from].commanded;
  RowVectorXd basis = RowVectorXd::Zero(kDistanceBasis);
  basis[6] = 1.0;
  if (!distance.edge) {
    const BedPoint to = set.holes[distance.to].commanded;
    const Vector2d way = difference(to, from);
    const double length = std::max(1.0, way.norm());
    basis.segment<3>(3) << way.x() * way.x(), way.y() * way.y(), way.x() * way.y();
    basis.segment<3>(3) /= length * kMetreMm;
    return basis;
  }
  const Vector2d at = vector_of(from) / kMetreMm;
  const EdgeLine line = edge_line(set, *distance.edge);
  basis[line.axis] = line.sign;
  basis[2] = line.sign * (line.axis == 0 ? -at.y() : at.x());
  basis[3 + line.axis] = line.sign * at[line.axis];
  return basis;
}

VectorXd distance_sigmas(const MeasuredHoles& set) {
  VectorXd sigma(kDistanceBasis);
  const double tape_zero_mm =
      std::hypot(kTapeZeroMm, set.tape.tape_zero_offset_sigma_mm.value_or(0.0));
  sigma << kSheetMm, kSheetMm, kSheetMm, kPerMetreMm, kPerMetreMm, kPerMetreMm, tape_zero_mm;
  return sigma;
}

TrendRows distance_rows(const MeasuredHoles& set) {
  const auto n = as_index(set.distances.size());
  TrendRows rows{MatrixXd(n, kDistanceBasis), MatrixXd(n, 1)};
  for (const Index i : each_below(n)) {
    const HoleDistance& distance = set.distances[as_size(i)];
    rows.basis.row(i) = basis_of(set, distance);
    rows.off_mm(i, 0) = length_of(set, distance) - commanded_mm(set, distance);
  }
  return rows;
}

using HoleTransformations = Transformations<MeasuredHoles>;

/// For the holes, which all distances share.
Transformation& add_of_holes(HoleTransformations& list, ProblemKind kind, std::string sentence,
                             const std::function<void(MeasuredHoles&)>& mend) {
  Transformation& own =
      list.add(kind, std::move(sentence), [mend](MeasuredHoles& meant, std::size_t row) {
        if (row == 0) mend(meant);
      });
  own.of = Transformation::Of::all;
  return own;
}

void add_of_commands(HoleTransformations& list, ProblemKind kind, std::string sentence,
                     const Affine& meant) {
  add_of_holes(list, kind, std::move(sentence), [meant](MeasuredHoles& set) {
    for (Hole& hole : set.holes) hole.commanded = meant.of(hole.commanded);
  });
}

void add_units(HoleTransformations& list, Written written) {
  for (const WrittenUnit& unit : kWrittenUnits) {
    const double factor = unit.mm;
    list.add(
        ProblemKind::other_unit,
        fmt::format("the distances look like {}, the holes' x_mm and y_mm like mm: multiply the "
                    "distances by {:g}{}",
                    unit.word, factor, factor == kMmPerInch ? or_say_inches(written) : ""),
        [=](MeasuredHoles& meant, std::size_t row) { meant.distances[row].distance_mm *= factor; });
    add_of_commands(
        list, ProblemKind::other_unit,
        fmt::format("the holes' x_mm and y_mm look like {}, the distances like mm: multiply the "
                    "holes by {:g}",
                    unit.word, factor),
        times(factor, factor));
  }
}

void add_axes(HoleTransformations& list) {
  const std::pair<const char*, Affine> axes[] = {
      {"the sign of the holes' x_mm looks reversed, or the left and right edges exchanged: x_mm "
       "counts to the right",
       times(-1, 1)},
      {"the sign of the holes' y_mm looks reversed, or the top and bottom edges exchanged: y_mm "
       "counts up the sheet",
       times(1, -1)},
      {"the signs of the holes' x_mm and y_mm look reversed, or opposite edges exchanged: they "
       "count to the right and up the sheet",
       times(-1, -1)},
      {"the holes' two columns look swapped: x_mm counts to the right, y_mm up the sheet",
       swapped()}};
  for (const auto& [sentence, meant] : axes)
    add_of_commands(list, ProblemKind::axes, sentence, meant);
}

/// A hole that was misnamed or written down wrongly makes every distance from it wrong.
void add_holes(const MeasuredHoles& set, const Flags& is_gross, HoleTransformations& list) {
  for (const auto h : each_index(set.holes)) {
    std::size_t of_it = 0;
    for (const auto i : each_index(set.distances)) {
      const HoleDistance& distance = set.distances[i];
      const bool ends = distance.from == h || (!distance.edge && distance.to == h);
      of_it += is_gross[i] && ends ? 1 : 0;
    }
    if (of_it < 2) continue;
    const std::string& name = set.holes[h].name;
    const auto number = [&](const char* axis, double BedPoint::*of) {
      const double written = set.holes[h].commanded.*of;
      for (const NumberError& slip : number_errors(written, true)) {
        add_of_holes(list, ProblemKind::doubtful_row,
                     fmt::format("the {1} at which hole {0} was cut is {2}: {3}", name, axis,
                                 digits_of(written), slip.question),
                     [=](MeasuredHoles& meant) { meant.holes[h].commanded.*of = slip.value; })
            .penalty = slip.penalty;
      }
    };
    number("x_mm", &BedPoint::x_mm);
    number("y_mm", &BedPoint::y_mm);
    add_of_holes(list, ProblemKind::doubtful_row,
                 fmt::format("are x_mm and y_mm of hole {} swapped?", name),
                 [=](MeasuredHoles& meant) {
                   std::swap(meant.holes[h].commanded.x_mm, meant.holes[h].commanded.y_mm);
                 });
    for (const std::size_t other : each_below(h)) {
      add_of_holes(list, ProblemKind::other_order,
                   fmt::format("holes {} and {} look exchanged", set.holes[other].name, name),
                   [=](MeasuredHoles& meant) {
                     std::swap(meant.holes[h].commanded, meant.holes[other].commanded);
                   });
    }
  }
}

/// Each distance was written one line too low or too high.
void add_slips(const MeasuredHoles& set, HoleTransformations& list) {
  const auto count = static_cast<std::ptrdiff_t>(set.distances.size());
  for (const std::ptrdiff_t by : {-1, 1}) {
    list.add(ProblemKind::row_slip,
             fmt::format("the distances fit the two holes of the line {}: is one left out or "
                         "written twice?",
                         by < 0 ? "before" : "after"),
             [&set, by, count](MeasuredHoles& meant, std::size_t row) {
               const std::ptrdiff_t of = static_cast<std::ptrdiff_t>(row) + by;
               if (of < 0 || of >= count) return;  // one row stays off
               HoleDistance& to = meant.distances[row];
               const double read_mm = to.distance_mm;
               to = set.distances[as_size(of)];
               to.distance_mm = read_mm;
             })
        .of = Transformation::Of::tail;
  }
}

struct DistanceRows {
  const MeasuredHoles& set;
  const RobustTrend& trend;

  double residual_mm(std::size_t row) const { return trend.residual_mm[as_index(row)]; }
  bool is_gross(std::size_t row) const {
    return residual_mm(row) > std::max(kGrossMm, kGrossScales * trend.scale_mm);
  }
  double off_of(const HoleDistance& meant) const {
    return std::abs(length_of(set, meant) - commanded_mm(set, meant) -
                    (basis_of(set, meant) * trend.coefficients)(0, 0));
  }

  std::string question_of(std::size_t row) const {
    const HoleDistance& written = set.distances[row];
    std::string best;
    double most = log_density_of(residual_mm(row), trend.scale_mm, 1) + kThreeTimes;
    const auto weigh = [&](const HoleDistance& meant, std::string question, double penalty) {
      const double likely = log_density_of(off_of(meant), trend.scale_mm, 1) - penalty;
      if (likely <= most) return;
      most = likely;
      best = std::move(question);
    };
    const auto value = [&](double distance_mm, std::string question, double penalty) {
      HoleDistance meant = written;
      meant.distance_mm = distance_mm;
      weigh(meant, std::move(question), penalty);
    };
    // One number here; a row of points has four.
    constexpr double kFewer = 1.4;
    constexpr double kTwice = 0.7;
    const double d = written.distance_mm;
    value(0.5 * d, fmt::format("is it double the true {:.10g} mm?", 0.5 * d), kTwice);
    value(2.0 * d, fmt::format("is it half of the true {:.10g} mm?", 2.0 * d), kTwice);
    for (const NumberError& slip : number_errors(d, false))
      value(slip.value, slip.question, slip.penalty - kFewer);
    others(written, weigh);
    return best;
  }

  template <class Weigh>
  void others(const HoleDistance& written, const Weigh& weigh) const {
    const double each = std::log(2.0 * as_double(set.holes.size()));
    if (written.edge) {
      for (const SheetEdge edge : kSheetEdges) {
        HoleDistance meant = written;
        meant.edge = edge;
        if (edge != *written.edge)
          weigh(meant, fmt::format("is it to the {} edge?", name(edge)), each);
      }
      return;
    }
    for (const auto h : each_index(set.holes)) {
      if (h == written.from || h == written.to) continue;
      for (const auto& [from, to] : {std::pair(written.from, h), std::pair(h, written.to)}) {
        HoleDistance meant = written;
        meant.from = from;
        meant.to = to;
        weigh(meant, fmt::format("is it {}?", words_of(set, meant)), each);
      }
    }
  }

  std::vector<RowFinding> findings() const {
    std::vector<RowFinding> found;
    for (const auto row : each_index(set.distances)) {
      if (!is_gross(row)) continue;
      const std::string question = question_of(row);
      if (question.empty()) continue;
      found.push_back({row, fmt::format("{} is {} off the prediction by the others: {}",
                                        words_of(set, set.distances[row]),
                                        length_in_words(residual_mm(row)), question)});
    }
    return found;
  }
};

}  // namespace

Findings check_distances(const MeasuredHoles& set, Written written) {
  if (set.distances.empty()) return {};
  const TrendRows written_rows = distance_rows(set);
  const VectorXd sigma_mm = distance_sigmas(set);
  const RobustTrend trend = robust_trend(written_rows, sigma_mm);
  const DistanceRows rows{set, trend};
  Flags is_gross;
  for (const auto i : each_index(set.distances)) is_gross.push_back(rows.is_gross(i));
  const double median_mm = trend.median_residual_mm();
  const bool is_odd =
      trend.prior_chi_square > kOddDistances || median_mm > kSoundMm || contains(is_gross, true);
  if (!is_odd) return {};
  HoleTransformations list(set, distance_rows);
  add_units(list, written);
  add_axes(list);
  add_holes(set, is_gross, list);
  add_slips(set, list);
  std::vector<Candidate> candidates =
      searched(sigma_mm, written_rows, list.take(),
               [](std::size_t row) { return fmt::format("{}", row + 1); });
  const Account plain = account_of(trend);
  Findings findings;
  findings.whole =
      whole_finding(std::move(candidates), plain, 2 * set.distances.size(), kOddDistances,
                    fmt::format("half of the distances differ by more than {} from the commanded "
                                "ones",
                                length_in_words(median_mm)));
  if (findings.whole) return findings;
  findings.rows = rows.findings();
  constexpr std::size_t kFewestForStrangers = 6;
  if (set.distances.size() >= kFewestForStrangers && median_mm > kStrangeDistancesMm &&
      !suspected_tape_zero_offset_mm(set)) {
    findings.whole = WholeFinding{
        std::nullopt,
        "the distances do not belong to these holes: are they from another sheet, or between other "
        "holes?",
        fmt::format("half of them differ by more than {} from the commanded ones",
                    length_in_words(median_mm)),
        false};
  }
  return findings;
}

}  // namespace chaintrue::grid::input_checks
