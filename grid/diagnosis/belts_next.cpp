// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/belts_next.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/diagnosis/belts_pattern.hpp"
#include "grid/diagnosis/next_measurements.hpp"
#include "model/belts/belt_kinematics.hpp"

namespace chaintrue::grid::diagnosis {

using model::Belt;
using model::kBelts;

namespace {

/// Further places lie on a raster over the frame; a coarser one where each is reached in four ways.
struct Raster {
  int columns;
  int rows;
};
constexpr Raster kUpright{9, 7};
constexpr Raster kFlat{5, 4};
/// Of the frame's width and height that the raster leaves out on each side: nearer to an anchor its
/// arm is in the way.
constexpr double kMargin = 0.14;
/// A place beside one of the raster says the same; people type whole tens.
constexpr double kRasterMm = 10.0;
/// Places of the session that may be visited once more, spread over it.
constexpr std::size_t kRevisits = 5;
/// All places once more are foretold for so many at most: a second.
constexpr std::size_t kMostOnceMore = 200;

/// Places to come, with what the state makes of their readings.
struct NextPlaces {
  MeasuredBelts belts;
  belts::FrameState state;
  std::vector<Eigen::Matrix<double, 4, 2>> checks;
  Eigen::MatrixXd by_anchor;  ///< of their checks, in units of noise
};

/// Belts that are pulled on the way to a place, and that way in words.
struct Approach {
  const char* words;
  std::vector<Belt> pulled;
};
const std::vector<Approach>& approaches(model::Orientation orientation) {
  static const std::vector<Approach> upright = {{"", {}}};
  static const std::vector<Approach> flat = {{", coming from the left", {Belt::tl, Belt::bl}},
                                             {", coming from the right", {Belt::tr, Belt::br}},
                                             {", coming from above", {Belt::tl, Belt::tr}},
                                             {", coming from below", {Belt::bl, Belt::br}}};
  return orientation == model::Orientation::flat ? flat : upright;
}

class Gathering {
 public:
  explicit Gathering(const BeltsAnalysis& a)
      : a_(a), machine_(belts::with_anchors(a.belts.machine, a.state.frame.state.anchors)) {
    next_.belts.machine = a.belts.machine;
    next_.state.anchors = a.state.frame.state.anchors;
    for (const BeltPoint& point : a.belts.points) {
      if (point.order) next_visit_ = std::max(next_visit_.value_or(0), *point.order + 1);
    }
  }

  /// True where the machine reaches it.
  bool add(model::FramePoint at, const std::optional<std::vector<Belt>>& pulled) {
    const auto lengths = model::lengths_at(machine_, at);
    if (!lengths) return false;
    BeltPoint point;
    point.lengths_mm = *lengths;
    point.pulled = pulled;
    point.order = next_visit_;
    next_.belts.points.push_back(std::move(point));
    next_.state.places.push_back(at);
    return true;
  }
  void count_visits() {
    for (BeltPoint& point : next_.belts.points) {
      if (next_visit_) point.order = (*next_visit_)++;
    }
  }
  [[nodiscard]] bool has_order() const { return next_visit_.has_value(); }
  [[nodiscard]] const model::BeltMachine& machine() const { return machine_; }

  [[nodiscard]] NextPlaces take() {
    const std::size_t count = next_.belts.points.size();
    const belts::Counting all(count, model::PerBelt<bool>{true, true, true, true});
    const belts::AnchorAdjustment solver(next_.belts, all, a_.sigma_mm);
    const belts::FrameEquations at = solver.equations(next_.state);
    Eigen::MatrixXd by_anchor(4 * static_cast<Eigen::Index>(count), belts::kAnchorUnknowns);
    for (std::size_t k = 0; k < count; ++k) {
      for (const Belt belt : kBelts) {
        by_anchor.row(belts::row_of(k, belt)) =
            solver.frame_row(at, k, belt).head<belts::kAnchorUnknowns>();
      }
      next_.checks.emplace_back(checks_of(at, k, all[k]));
    }
    next_.by_anchor = checked(next_.checks, by_anchor) / a_.sigma_mm;
    return std::move(next_);
  }

 private:
  const BeltsAnalysis& a_;
  model::BeltMachine machine_;
  NextPlaces next_;
  std::optional<int> next_visit_;
};

Candidate candidate_of(MeasurementKind kind,
                       std::string what,
                       model::BedPoint command,
                       const std::vector<Belt>& pulled,
                       std::size_t place) {
  Candidate candidate{{kind, std::move(what), "", model::identity_placement(command), 0.0}, {}, 2};
  candidate.measurement.pulled = pulled;
  const auto row = 2 * static_cast<Eigen::Index>(place);
  candidate.rows = {row, row + 1};
  return candidate;
}

void add_places(const BeltsAnalysis& a, Gathering& gathering, std::vector<Candidate>& all) {
  const model::BeltMachine& machine = gathering.machine();
  const model::FramePoint centre = model::centre_of(machine);
  const auto& anchors = machine.anchors;
  const auto between = [](double low, double high, int i, int n) {
    return low + (high - low) * (kMargin + (1.0 - 2.0 * kMargin) * i / (n - 1));
  };
  const bool flat = machine.orientation == model::Orientation::flat;
  const Raster raster = flat ? kFlat : kUpright;
  for (int j = 0; j < raster.rows; ++j) {
    for (int i = 0; i < raster.columns; ++i) {
      const double x = between(0.5 * (anchors.tl.x_mm + anchors.bl.x_mm),
                               0.5 * (anchors.tr.x_mm + anchors.br.x_mm),
                               i,
                               raster.columns);
      const double y = between(0.0, 0.5 * (anchors.tl.y_mm + anchors.tr.y_mm), j, raster.rows);
      const auto whole = [](double mm) { return kRasterMm * std::round(mm / kRasterMm) + 0.0; };
      const model::BedPoint command{whole(x - centre.x_mm), whole(y - centre.y_mm)};
      for (const Approach& way : approaches(a.belts.machine.orientation)) {
        const auto pulled = way.pulled.empty() ? std::nullopt : std::optional(way.pulled);
        const bool reached =
            gathering.add({centre.x_mm + command.x_mm, centre.y_mm + command.y_mm}, pulled);
        if (!reached) continue;
        all.push_back(candidate_of(MeasurementKind::point,
                                   fmt::format("a further place{}", way.words),
                                   command,
                                   way.pulled,
                                   all.size()));
      }
    }
  }
}

void add_revisits(const BeltsAnalysis& a, Gathering& gathering, std::vector<Candidate>& all) {
  if (!gathering.has_order()) return;
  const model::FramePoint centre = model::centre_of(gathering.machine());
  const std::size_t count = a.belts.points.size();
  for (std::size_t i = 0; i < kRevisits; ++i) {
    const std::size_t k = i * (count - 1) / (kRevisits - 1);
    const model::FramePoint at = a.state.frame.state.places[k];
    const BeltPoint& point = a.belts.points[k];
    if (!gathering.add(at, point.pulled)) continue;
    all.push_back(candidate_of(
        MeasurementKind::revisit,
        fmt::format("point {} once more", k + 1),
        point.commanded.value_or(model::BedPoint{std::round(at.x_mm - centre.x_mm) + 0.0,
                                                 std::round(at.y_mm - centre.y_mm) + 0.0}),
        point.pulled.value_or(std::vector<Belt>{}),
        all.size()));
  }
}

std::vector<PatternRow> pattern_rows_of(const NextPlaces& next, double sigma_mm) {
  std::vector<PatternRow> rows;
  for (std::size_t k = 0; k < next.checks.size(); ++k) {
    for (int i = 0; i < 2; ++i) {
      rows.push_back(
          {next.state.places[k], next.belts.points[k].order, next.checks[k].col(i) / sigma_mm});
    }
  }
  return rows;
}

/// What alternatives expect of places to come.
class Foretelling {
 public:
  Foretelling(const BeltsAnalysis& a, const NextPlaces& next)
      : a_(a),
        next_(next),
        space_(marginalise(
            a.linear.system,
            a.analysis.comparison.marginalised_systems[a.analysis.decision.marginalised].outliers,
            a.analysis.options.steps)),
        measured_(pattern_rows(a, space_.kept)),
        to_come_(pattern_rows_of(next, a.sigma_mm)) {}

  void foretell(Alternative& h) const {
    const RegressorSystem& system = a_.linear.system;
    Eigen::VectorXd e = system.e(space_.kept);
    h.mean = Eigen::VectorXd::Zero(next_.by_anchor.rows());
    std::vector<Eigen::Index> free;
    Eigen::MatrixXd x = system.by_setting(space_.kept, Eigen::all);
    Eigen::MatrixXd design = next_.by_anchor;
    Eigen::VectorXd precision = system.sigma.cwiseAbs2().cwiseInverse();
    for (const int k : h.regressors) {
      const Regressor& own = system.regressors[static_cast<std::size_t>(k)];
      const Eigen::VectorXd there = column_of(own);
      if (own.fixed) {
        e -= system.g.column(space_.kept, k);
        h.mean += there;
        continue;
      }
      append(system.g.column(space_.kept, k), x);
      append(there, design);
      precision.conservativeResize(precision.size() + 1);
      precision(precision.size() - 1) =
          space_.g.col(k).squaredNorm() / (kWideSignalToNoise * kWideSignalToNoise);
    }
    h.spread.resize(design.rows(), 0);
    if (h.discrepancy < 0) {
      settle(e, x, precision, {}, design, h);
    } else {
      beside_a_pattern(e, x, precision, design, h);
    }
    // In units of the noise as found.
    h.mean /= std::sqrt(a_.analysis.estimate.noise_square);
  }

 private:
  static void append(const Eigen::VectorXd& column, Eigen::MatrixXd& matrix) {
    matrix.conservativeResize(Eigen::NoChange, matrix.cols() + 1);
    matrix.col(matrix.cols() - 1) = column;
  }

  [[nodiscard]] Eigen::VectorXd column_of(const Regressor& own) const {
    return checked(next_.checks, added_by(next_.belts, {{own.cause, own.values}}, next_.state)) /
           a_.sigma_mm;
  }

  /// (1) with C = 1 in whitened rows, and (2) but for the pattern itself; `weights` is K C^-1 L of
  /// these rows, or empty.
  static void settle(const Eigen::VectorXd& e,
                     const Eigen::MatrixXd& x,
                     const Eigen::VectorXd& precision,
                     const Eigen::MatrixXd& weights,
                     Eigen::MatrixXd design,
                     Alternative& h) {
    Eigen::MatrixXd normal = x.transpose() * x;
    normal.diagonal() += precision;
    const Eigen::LLT<Eigen::MatrixXd> llt(normal);
    const Eigen::VectorXd b = llt.solve(x.transpose() * e);
    h.mean += design * b;
    if (weights.size() > 0) {
      h.mean += weights * (e - x * b);
      design -= weights * x;
    }
    // normal = L L': the covariance's root is L'^-1.
    const Eigen::MatrixXd root =
        llt.matrixU().solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
    const Eigen::MatrixXd of_pattern = h.spread;
    h.spread.resize(design.rows(), design.cols() + of_pattern.cols());
    h.spread << design * root, of_pattern;
  }

  void beside_a_pattern(Eigen::VectorXd e,
                        Eigen::MatrixXd x,
                        const Eigen::VectorXd& precision,
                        const Eigen::MatrixXd& design,
                        Alternative& h) const {
    const std::size_t kernel = pattern_kernel_of(h.discrepancy);
    const Eigen::MatrixXd covariance = pattern_covariance(measured_, measured_, kernel);
    const double square = pattern_square(covariance, space_.root, h.discrepancy);
    const PatternNoise noise = beside_pattern(covariance, space_.root, h.discrepancy);
    // L^-1 K': what is whitened once serves (1) and (2).
    Eigen::MatrixXd across = square * pattern_covariance(measured_, to_come_, kernel);
    noise.root.matrixL().solveInPlace(across);
    noise.root.matrixL().solveInPlace(e);
    noise.root.matrixL().solveInPlace(x);
    const Eigen::MatrixXd own = square * pattern_covariance(to_come_, to_come_, kernel);
    h.spread = square_root(own - across.transpose() * across);
    settle(e, x, precision, across.transpose(), design, h);
  }

  const BeltsAnalysis& a_;
  const NextPlaces& next_;
  MarginalisedSystem space_;
  std::vector<PatternRow> measured_;
  std::vector<PatternRow> to_come_;
};

std::vector<Alternative> foretold(const BeltsAnalysis& a,
                                  const NextPlaces& next,
                                  std::vector<Alternative> alternatives) {
  const Foretelling foretelling(a, next);
  for (Alternative& one : alternatives) foretelling.foretell(one);
  return alternatives;
}

/// Every place once more, the last one first.
std::optional<double> all_once_more(const BeltsAnalysis& a,
                                    const std::vector<Alternative>& alternatives) {
  if (a.belts.points.size() > kMostOnceMore) return std::nullopt;
  Gathering gathering(a);
  for (std::size_t k = a.belts.points.size(); k-- > 0;)
    gathering.add(a.state.frame.state.places[k], a.belts.points[k].pulled);
  gathering.count_visits();
  const NextPlaces next = gathering.take();
  std::vector<Eigen::Index> rows;
  for (Eigen::Index row = 0; row < next.by_anchor.rows(); ++row) rows.push_back(row);
  return expected_discrimination(foretold(a, next, alternatives), rows).named_alone;
}

}  // namespace

BeltsNext next_measurements(const BeltsAnalysis& a) {
  BeltsNext result;
  const std::vector<Alternative> alternatives = leading_alternatives(a.analysis);
  if (is_left_alone(a.analysis, alternatives) || alternatives.back().group == 0 ||
      a.analysis.decision.verdict == Verdict::named) {
    return result;
  }
  result.is_open = true;
  Gathering gathering(a);
  std::vector<Candidate> candidates;
  add_places(a, gathering, candidates);
  add_revisits(a, gathering, candidates);
  const NextPlaces next = gathering.take();
  result.measurements =
      most_telling(a.analysis, foretold(a, next, alternatives), std::move(candidates));
  result.all_once_more = all_once_more(a, alternatives);
  return result;
}

}  // namespace chaintrue::grid::diagnosis
