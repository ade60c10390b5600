// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <array>
#include <cmath>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/findings.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

std::string_view name(BudgetLine::What what) {
  return word_of(what, {"settings", "cause", "unexplained", "noise", "inseparable"});
}

std::string_view name(BudgetLine::ChangesWith changes) {
  return word_of(changes, {"nothing", "place", "order", "direction"});
}

namespace {

constexpr double kPartMm = 100.0;

using Shifts = std::vector<Vector2d>;

BudgetLine::ChangesWith changes_with(const Effect& effect) {
  if (effect.by_direction) return BudgetLine::ChangesWith::direction;
  if (effect.station == Station::reading) return BudgetLine::ChangesWith::order;
  return BudgetLine::ChangesWith::place;
}

/// A corner of the marked area, and the points a part's length from it towards the middle, in
/// either direction.
std::array<MarkPoint, 3> corner(const interp::Rectangle& area, bool right, bool top) {
  const double x = right ? area.x_max : area.x_min;
  const double y = top ? area.y_max : area.y_min;
  return {{{x, y}, {x + (right ? -kPartMm : kPartMm), y}, {x, y + (top ? -kPartMm : kPartMm)}}};
}

/// The corners of the marked area as linear systems, those that the machine reaches.
struct Corner {
  ObservationSet session;
  RegressorSystem system;
};

std::vector<Corner> corners_of(const Analysis& a) {
  std::vector<Corner> result;
  if (!a.session.reads_chains()) return result;
  const interp::Rectangle area = marked_area(a.session);
  for (const bool right : {false, true}) {
    for (const bool top : {false, true}) {
      const auto marks = corner(area, right, top);
      ObservationSet session = session_at(a, {marks.begin(), marks.end()});
      if (session.places.size() != marks.size()) continue;
      auto system = linearise(session, a.state);
      if (system) result.push_back({std::move(session), std::move(*system)});
    }
  }
  return result;
}

/// The largest change over a part's length from a corner, with `at` giving the rows of a corner.
template <class At>
std::optional<double> over_a_part(const std::vector<Corner>& corners, const At& at) {
  std::optional<double> most;
  for (const Corner& there : corners) {
    const auto whitened = at(there);
    if (!whitened) continue;
    const Vector2d first = error_of_unit(there.system, *whitened, 0);
    for (const std::size_t u : {std::size_t{1}, std::size_t{2}}) {
      const double change = (error_of_unit(there.system, *whitened, u) - first).norm();
      most = std::max(most.value_or(0.0), change);
    }
  }
  return most;
}

std::optional<double> part_of_cause(const Analysis& a, const std::vector<Corner>& corners,
                                    const Regressor& own, double size) {
  return over_a_part(corners, [&](const Corner& there) {
    auto g = signature(there.session, a.state, there.system, own);
    if (g) *g *= size;
    return g;
  });
}

std::optional<double> part_of_settings(const Analysis& a, const std::vector<Corner>& corners) {
  const Index shared = a.system.setting.size() - a.system.nuisances;
  const VectorXd change =
      (a.system.setting + a.estimate.setting_change - a.session.stated_value).head(shared);
  return over_a_part(corners, [&](const Corner& there) {
    return std::optional<VectorXd>(there.system.by_setting.leftCols(shared) * change);
  });
}

std::optional<double> part_of_pattern(const Analysis& a, const std::vector<Corner>& corners) {
  return over_a_part(corners, [&](const Corner& there) {
    return std::optional(pattern_at(a, a.estimate, there.system));
  });
}

Shifts without(Shifts all, const Shifts& part) {
  for (const auto i : each_index(part)) all[i] -= part[i];
  return all;
}

/// Shares, the common part, and the order.
void finish(ErrorBudget& budget) {
  const double whole = budget.uncalibrated_mm * budget.uncalibrated_mm;
  double sum = 0.0;
  for (const BudgetLine& line : budget.lines) sum += line.mean_square_mm2;
  stable_sort(budget.lines, descending(&BudgetLine::mean_square_mm2));
  budget.lines.push_back({.what = BudgetLine::What::inseparable,
                          .mean_square_mm2 = whole - sum,
                          .changes_with = BudgetLine::ChangesWith::nothing});
  for (BudgetLine& line : budget.lines)
    line.share = whole > 0.0 ? line.mean_square_mm2 / whole : 0.0;
}

}  // namespace

Indices units_of_error(const Analysis& a) {
  const Flags& outliers = marginalised_system(a).outliers;
  const bool of_tool = a.session.reads_chains();
  Indices units = numbers_below(outliers.size());
  std::erase_if(units, [&](std::size_t u) {
    return outliers[u] || a.system.units[u].reads_chains != of_tool;
  });
  return units;
}

ErrorBudget error_budget(const Analysis& a) {
  const Indices units = units_of_error(a);
  const auto stated = linearise(a.session, stated_state(a.session));
  if (!stated || units.empty()) return {};
  const Shifts as_delivered = errors_of_units(*stated, stated->e, units);
  ErrorBudget budget{rms_length(as_delivered), {}};
  // Each part is the reduction of the error without it; together they are the error.
  Shifts rest = as_delivered;
  const auto add = [&](BudgetLine line, const Shifts& part) {
    line.mean_square_mm2 = std::pow(rms_length(part), 2);
    line.without_mm = rms_length(without(as_delivered, part));
    budget.lines.push_back(line);
  };
  const auto take = [&](const BudgetLine& line, const VectorXd& whitened) {
    const Shifts part = errors_of_units(a.system, whitened, units);
    rest = without(rest, part);
    add(line, part);
  };
  const std::vector<Corner> corners = corners_of(a);
  for (const auto k : each_index(a.decision.regressors)) {
    const Regressor& own = regressor(a, a.decision.regressors[k]);
    const double size = a.estimate.coefficient(as_index(k));
    BudgetLine line{.what = BudgetLine::What::cause, .cause = own.cause};
    line.changes_with = changes_with(*own.cause.effect);
    if (line.changes_with == BudgetLine::ChangesWith::place)
      line.part_mm = part_of_cause(a, corners, own, size);
    take(line, a.system.g.col(a.decision.regressors[k]) * size);
  }
  const VectorXd& left = a.estimate.left_given_discrepancy;
  if (a.decision.discrepancy_left) {
    take({.what = BudgetLine::What::unexplained, .part_mm = part_of_pattern(a, corners)},
         a.estimate.left - left);
  }
  take({.what = BudgetLine::What::noise, .changes_with = BudgetLine::ChangesWith::nothing},
       left_of_machine(a.system, a.estimate, left));
  add({.what = BudgetLine::What::settings, .part_mm = part_of_settings(a, corners)}, rest);
  finish(budget);
  return budget;
}

}  // namespace chaintrue::grid::diagnosis
