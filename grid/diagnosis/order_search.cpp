// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/order_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "grid/diagnosis/workshop_units.hpp"
#include "grid/observation/length_points.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Models below this share of the weight cannot change p(o) by 1 %.
constexpr double kLeastModelShare = 0.01;
constexpr std::size_t kMostModels = 5;

/// The first file, if it is a grid and no grid has an order.
const MeasuredGrid* grid_without_order(const Measured& measured) {
  if (measured.files().empty()) return nullptr;
  for (const MeasuredGrid* grid : measured.grids()) {
    const bool numbered = any_of(grid->points, &MeasuredPoint::order);
    if (numbered) return nullptr;
  }
  return measured.files().front().grid();
}

/// That grid without the other files, if its marks form lines.
std::optional<Measured> grid_alone(const Measured& measured) {
  const MeasuredGrid* grid = grid_without_order(measured);
  if (grid == nullptr) return std::nullopt;
  Measured alone;
  alone.add({measured.files().front().name, *grid});
  const std::vector<VisitingOrder> orders = line_by_line_orders();
  const bool has_lines = any_of(
      orders, [&](const VisitingOrder& order) { return visited_in(alone, order).has_value(); });
  if (!has_lines) return std::nullopt;
  return alone;
}

/// The points by place, so that the order of the file's rows does not matter.
Indices by_place(const std::vector<MeasuredPoint>& points) {
  auto result = numbers_below(points.size());
  const auto key = [&](std::size_t i) {
    const MeasuredPoint& point = points[i];
    const ChainLengths lengths = point.lengths.value_or(ChainLengths{});
    return std::tuple(point.mark.y_mm, point.mark.x_mm, lengths.left_mm, lengths.right_mm);
  };
  stable_sort(result, ascending(key));
  return result;
}

/// Whether a point's mark was measured more than once: which visit was first is unknown.
Flags measured_again(const std::vector<MeasuredPoint>& points) {
  Flags again(points.size(), false);
  for (const auto i : each_index(points)) {
    again[i] = any_of(points, [own = &points[i]](const MeasuredPoint& other) {
      return &other != own && distance_mm(other.mark, own->mark) <= kRepeatDistanceMm;
    });
  }
  return again;
}

/// One compared model, with its parameters marginalised.
struct GivenModel {
  double log_weight = 0.0;
  double log_odds = 0.0;  ///< for one more cause
  MarginalisedSystem marginalised;
  LowRankNoise noise;  ///< in its rows: the model's causes and discrepancy
  VectorXd e;          ///< half-solved by it
};

GivenModel given(const Analysis& a, const CandidateModel& model, const Flags& again) {
  const RegressorSystem& system = a.system;
  const MarginalisedSystem& compared = a.comparison.marginalised_systems[model.marginalised];
  Flags left_out = compared.outliers;
  for (const auto u : each_index(a.session.units)) {
    const NumberedUnit& unit = a.session.units[u];
    if (a.session.parts[unit.part].reads_chains() && again[unit.index]) left_out[u] = true;
  }
  MarginalisedSystem own = marginalise(system, left_out);
  own.discrepancy_trace = compared.discrepancy_trace;  // the discrepancy keeps its strength
  const MatrixXd pattern = discrepancy_columns(system, own, model.discrepancy);
  MatrixXd columns(own.kept.size(), pattern.cols() + std::ssize(model.regressors));
  columns.leftCols(pattern.cols()) = reduced(own, pattern);
  Index free = pattern.cols();
  for (const int k : model.regressors) {
    const VectorXd column = reduced(own, system.g.col(k));
    if (system.regressor(k).fixed) {
      own.e -= column;
    } else {
      columns.col(free++) = column * wide_coefficient_sigma(system, compared, k);
    }
  }
  GivenModel result{model.log_weight,
                    log_odds_of_another(system, model.regressors, model.discrepancy >= 0),
                    std::move(own),
                    LowRankNoise(columns.leftCols(free)),
                    {}};
  result.e = result.noise.half_solve(result.marginalised.e);
  return result;
}

std::vector<GivenModel> leading_models(const Analysis& a, const Flags& again) {
  std::vector<GivenModel> result;
  for (const CandidateModel& model : a.comparison.models) {
    if (result.size() == kMostModels || a.comparison.probability(model) < kLeastModelShare) break;
    result.push_back(given(a, model, again));
  }
  return result;
}

/// Causes that depend on the order and have only a size.
struct OrderColumns {
  std::vector<Regressor> regressors;
  MatrixXd columns;  ///< in the rows of the analysis
};

OrderColumns order_columns(const Analysis& a, const Measured& ordered) {
  OrderColumns result;
  auto set = observations_of(ordered);
  if (!set) return result;
  auto system = linearise(*set, a.state);
  if (!system) return result;
  std::vector<CauseId> causes;
  for (const CauseId& cause : candidates(*set).testable) {
    const bool at_a_visit =
        any_of(cause.effect->parameters, having(&EffectParameter::role, ParameterRole::place));
    if (cause.effect->needs == DataNeed::order && !at_a_visit) causes.push_back(cause);
  }
  add_regressors(*set, a.state, causes, {}, *system);
  const MatrixXd columns = system->g.dense(numbers_below<int>(system->g.cols()));
  result.columns.setZero(a.session.rows, columns.cols());
  for (const NumberedUnit& unit : a.session.units) {
    const NumberedUnit& own = *find_where(set->units, [&](const NumberedUnit& other) {
      return other.part == unit.part && other.index == unit.index;
    });
    result.columns.middleRows(unit.first_row, unit.rows) =
        columns.middleRows(own.first_row, own.rows);
  }
  result.regressors = std::move(system->regressors);
  return result;
}

/// log sum_c odds_M B(c | M, o)
double log_order_factor(const OrderColumns& order, const GivenModel& model, double noise_dof) {
  const MatrixXd g = model.noise.half_solve(reduced(model.marginalised, order.columns));
  double sum = kMinusInfinity;
  for (const CauseScore& own : single_scores(
           order.regressors, linear::inner(g, model.e), g.colwise().squaredNorm(),
           model.e.squaredNorm(), NoiseDensity(noise_dof, model.marginalised.kept.size())))
    sum = log_sum(sum, own.log_factor);
  return sum + model.log_odds;
}

/// p(o) of each of line_by_line_orders(); 0 for those that the marks do not have. \pre one file.
std::vector<double> order_probabilities(const Measured& measured, const Analysis& a) {
  const std::vector<VisitingOrder> orders = line_by_line_orders();
  const MeasuredGrid* grid = grid_without_order(measured);
  if (grid == nullptr) return std::vector<double>(orders.size(), 0.0);
  const std::vector<GivenModel> models = leading_models(a, measured_again(grid->points));
  std::vector<double> result(orders.size(), kMinusInfinity);
  double tried = 0.0;
  for (const auto k : each_index(orders)) {
    const auto ordered = visited_in(measured, orders[k]);
    if (!ordered) continue;
    const OrderColumns columns = order_columns(a, *ordered);
    if (columns.regressors.empty()) continue;
    result[k] = log_sum(mapped(models, [&](const GivenModel& model) {
      return model.log_weight + log_order_factor(columns, model, a.system.noise_dof);
    }));
    tried += 1.0;
  }
  std::vector<double> all = {a.comparison.log_total};
  for (double& own : result) all.push_back(own += std::log(kOrderPrior / std::max(1.0, tried)));
  const double total = log_sum(all);
  for (double& own : result) own = std::exp(own - total);
  return result;
}

}  // namespace

std::string in_words(const VisitingOrderFound& found, const std::string& session) {
  const std::string order =
      found.corner_known
          ? grid::in_words(found.order)
          : fmt::format("{} in {}", found.order.serpentine ? "there and back" : "one way",
                        found.order.rows ? "rows" : "columns");
  return fmt::format(
      "The order in which the marks{} were visited was not recorded. The readings show that it "
      "was: {} ({}). If that is wrong, record the order, or give it with --assume-order.",
      session.empty() ? "" : " of " + session, order, percent(found.probability));
}

std::optional<VisitingOrderFound> find_order_of_first(const Measured& measured,
                                                      const DiagnosisOptions& options) {
  const auto first = grid_alone(measured);
  if (!first) return std::nullopt;
  auto session = observations_of(*first);
  if (!session) return std::nullopt;
  const auto own = analyse(*std::move(session), options);
  return own ? find_visiting_order(*first, *own) : std::nullopt;
}

std::optional<VisitingOrderFound> find_visiting_order(const Measured& measured,
                                                      const Analysis& analysis) {
  const std::vector<double> probabilities = order_probabilities(measured, analysis);
  const std::vector<VisitingOrder> orders = line_by_line_orders();
  const auto best = as_size(max_element(probabilities) - probabilities.begin());
  VisitingOrderFound found{orders[best], probabilities[best], true};
  if (found.probability < kLeastModelShare) return std::nullopt;
  // Starting corners differ only in the few steps between lines, which repeated marks would change.
  const Flags again = measured_again(grid_without_order(measured)->points);
  const bool tells_corners = !contains(again, true);
  if (tells_corners && found.probability >= kOrderFound) return found;
  double from_any_corner = 0.0;
  for (const auto k : each_index(orders)) {
    if (orders[k].rows == found.order.rows && orders[k].serpentine == found.order.serpentine)
      from_any_corner += probabilities[k];
  }
  if (from_any_corner < kOrderFound) return std::nullopt;
  return VisitingOrderFound{found.order, from_any_corner, false};
}

std::optional<Measured> visited_in(const Measured& measured, const VisitingOrder& order) {
  const MeasuredGrid* grid = grid_without_order(measured);
  if (grid == nullptr) return std::nullopt;
  const Indices places = by_place(grid->points);
  const auto points = mapped(places, [&](std::size_t i) { return grid->points[i]; });
  const auto numbers = visit_numbers(points, order);
  if (!numbers) return std::nullopt;
  MeasuredGrid numbered = *grid;
  for (const auto k : each_index(places)) numbered.points[places[k]].order = (*numbers)[k];
  Measured result;
  result.add({measured.files().front().name, std::move(numbered)});
  for (std::size_t k = 1; k < measured.files().size(); ++k) result.add(measured.files()[k]);
  return result;
}

}  // namespace chaintrue::grid::diagnosis
