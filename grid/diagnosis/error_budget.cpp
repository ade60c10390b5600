// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <array>
#include <cmath>

#include "grid/diagnosis/best_model.hpp"
#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/other_places.hpp"
#include "grid/statistics.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {

std::string_view name(BudgetLine::What what) {
  constexpr std::string_view kNames[] = {
      "settings", "cause", "unexplained", "noise", "inseparable"};
  return kNames[static_cast<std::size_t>(what)];
}

std::string_view name(BudgetLine::ChangesWith changes) {
  constexpr std::string_view kNames[] = {"nothing", "place", "order", "direction"};
  return kNames[static_cast<std::size_t>(changes)];
}

namespace {

constexpr double kPartMm = 100.0;

using Shifts = std::vector<Eigen::Vector2d>;

BudgetLine::ChangesWith changes_with(const Effect& effect) {
  if (effect.by_direction) return BudgetLine::ChangesWith::direction;
  if (effect.station == Station::reading) return BudgetLine::ChangesWith::order;
  return BudgetLine::ChangesWith::place;
}

/// A corner of the marked area, and the points a part's length from it towards the middle, in
/// either direction.
std::array<model::MarkPoint, 3> corner(const interp::Rectangle& area, bool right, bool top) {
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
    const Eigen::Vector2d first = error_of_unit(there.system, *whitened, 0);
    for (const std::size_t u : {std::size_t{1}, std::size_t{2}}) {
      const double change = (error_of_unit(there.system, *whitened, u) - first).norm();
      most = std::max(most.value_or(0.0), change);
    }
  }
  return most;
}

class Budget {
 public:
  explicit Budget(const Analysis& a) : a_(a), corners_(corners_of(a)) {
    const Flags& outliers = marginalised_system(a).outliers;
    const bool of_tool = a.session.reads_chains();
    for (std::size_t u = 0; u < outliers.size(); ++u) {
      if (!outliers[u] && a.system.units[u].reads_chains == of_tool) units_.push_back(u);
    }
  }

  [[nodiscard]] ErrorBudget measure() {
    const auto stated = linearise(a_.session, stated_state(a_.session));
    if (!stated || units_.empty()) return {};
    as_delivered_ = errors_of_units(*stated, stated->e, units_);
    ErrorBudget budget;
    budget.uncalibrated_mm = rms_length(as_delivered_);
    // Each part is the reduction of the error without it; together they are the error.
    Shifts settings = as_delivered_;
    add_causes(budget, settings);
    const Shifts pattern = shifts_of(a_.estimate.left - a_.estimate.left_given_discrepancy);
    const Shifts noise =
        shifts_of(left_of_machine(a_.system, a_.estimate, a_.estimate.left_given_discrepancy));
    take_away(pattern, settings);
    take_away(noise, settings);
    add({.what = BudgetLine::What::settings, .part_mm = settings_over_a_part()}, settings, budget);
    if (a_.decision.discrepancy_left) {
      add({.what = BudgetLine::What::unexplained, .part_mm = pattern_over_a_part()},
          pattern,
          budget);
    }
    add({.what = BudgetLine::What::noise, .changes_with = BudgetLine::ChangesWith::nothing},
        noise,
        budget);
    finish(budget);
    return budget;
  }

 private:
  [[nodiscard]] Shifts shifts_of(const Eigen::VectorXd& whitened) const {
    return errors_of_units(a_.system, whitened, units_);
  }

  static void take_away(const Shifts& part, Shifts& from) {
    for (std::size_t i = 0; i < part.size(); ++i) from[i] -= part[i];
  }

  void add(BudgetLine line, const Shifts& shifts, ErrorBudget& budget) const {
    line.mean_square_mm2 = std::pow(rms_length(shifts), 2);
    Shifts rest = as_delivered_;
    take_away(shifts, rest);
    line.without_mm = rms_length(rest);
    budget.lines.push_back(line);
  }

  void add_causes(ErrorBudget& budget, Shifts& rest) const {
    for (std::size_t k = 0; k < a_.decision.regressors.size(); ++k) {
      const int column = a_.decision.regressors[k];
      const Regressor& own = regressor(a_, column);
      const double size = a_.estimate.coefficient(as_index(k));
      const Shifts shifts = shifts_of(a_.system.g.col(column) * size);
      take_away(shifts, rest);
      BudgetLine line{.what = BudgetLine::What::cause, .cause = own.cause};
      line.changes_with = changes_with(*own.cause.effect);
      if (line.changes_with == BudgetLine::ChangesWith::place) {
        line.part_mm = over_a_part(corners_, [&](const Corner& there) {
          auto g = signature(there.session, a_.state, there.system, own.cause, own.values);
          if (g) *g *= size;
          return g;
        });
      }
      add(line, shifts, budget);
    }
  }

  [[nodiscard]] std::optional<double> settings_over_a_part() const {
    const Eigen::VectorXd change =
        a_.system.setting + a_.estimate.setting_change - a_.session.stated_value;
    return over_a_part(corners_, [&](const Corner& there) {
      const Eigen::Index shared = a_.system.setting.size() - a_.system.nuisances;
      return std::optional<Eigen::VectorXd>(there.system.by_setting.leftCols(shared) *
                                            change.head(shared));
    });
  }

  [[nodiscard]] std::optional<double> pattern_over_a_part() const {
    return over_a_part(corners_, [&](const Corner& there) {
      Eigen::VectorXd whitened(there.system.e.size());
      whitened.setZero();
      for (const SystemUnit& unit : there.system.units) {
        const SystemPlace& place = there.system.places[unit.places.front().place];
        whitened.segment<2>(unit.first_row) =
            unit.whitening * discrepancy_at(a_.system, marginalised_system(a_), a_.estimate, place);
      }
      return std::optional<Eigen::VectorXd>(std::move(whitened));
    });
  }

  /// Shares, the common part, and the order.
  static void finish(ErrorBudget& budget) {
    const double whole = budget.uncalibrated_mm * budget.uncalibrated_mm;
    double sum = 0.0;
    for (const BudgetLine& line : budget.lines) sum += line.mean_square_mm2;
    stable_sort(budget.lines, descending(&BudgetLine::mean_square_mm2));
    budget.lines.push_back({.what = BudgetLine::What::inseparable,
                            .mean_square_mm2 = whole - sum,
                            .changes_with = BudgetLine::ChangesWith::nothing});
    for (BudgetLine& line : budget.lines) {
      line.share = whole > 0.0 ? line.mean_square_mm2 / whole : 0.0;
    }
  }

  const Analysis& a_;
  std::vector<Corner> corners_;
  Indices units_;
  Shifts as_delivered_;
};

}  // namespace

ErrorBudget error_budget(const Analysis& analysis) { return Budget(analysis).measure(); }

}  // namespace chaintrue::grid::diagnosis
