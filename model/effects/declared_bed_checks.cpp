// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Checks a declaration's formulas on a bed: finite everywhere between the bounds, zero at null,
/// and for the paper proportional to x and y.
#include <fmt/format.h>

#include <cmath>

#include "model/effects/declared_law.hpp"

namespace chaintrue::model::effects {
namespace {

using Problems = std::vector<DeclarationProblem>;

/// Below the accuracy of the equilibrium's lengths.
constexpr double kNothingMm = 1e-9;

/// A place or a visit at which formulas are tried.
struct Trial {
  std::string where;
  LengthState state;
};

/// The bed with its edges and corners, in columns and rows.
template <class At>
void over_the_bed(const Bed& bed, At at) {
  constexpr int kColumns = 9;
  constexpr int kRows = 7;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      at(bed.width_mm * (column / (kColumns - 1.0) - 0.5),
         bed.height_mm * (row / (kRows - 1.0) - 0.5));
    }
  }
}

std::vector<Trial> trials_of(const Declaration& own, const Machine& machine) {
  std::vector<Trial> trials;
  if (!own.elongation.empty()) return {Trial{}};
  if (own.acts_on == ActsOn::reading || own.acts_on == ActsOn::visit) {
    for (const int visit : {0, 1, 2, 9, 10, 11, 100, 1000})
      trials.push_back({fmt::format("visit {}", visit),
                        {.tooth_mm = machine.sprocket.pitch_mm, .order = visit}});
    return trials;
  }
  const auto kinematics = make_kinematics(equilibrium_parameters(machine));
  over_the_bed(machine.bed, [&](double x_mm, double y_mm) {
    const std::string where = fmt::format("({:.0f}, {:.0f}) mm", x_mm, y_mm);
    if (own.acts_on == ActsOn::paper) {
      trials.push_back({where, {.x_mm = x_mm, .y_mm = y_mm}});
      return;
    }
    const PoseResult pose = kinematics->inverse({x_mm, y_mm});
    // There is no pose here to add to.
    if (!pose) return;
    for (const Side side : kSides)
      trials.push_back({where, chain_at_rest(*pose, side, machine.sprocket)});
  });
  return trials;
}

/// Each parameter at its bounds and its usual size; places also in between.
std::vector<std::vector<double>> settings_of(const Declaration& own) {
  std::vector<std::vector<double>> all = {{}};
  for (const DeclaredParameter& p : own.parameters) {
    std::vector<double> choices = {p.lower, p.nominal, p.upper};
    if (p.role == ParameterRole::place)
      choices.push_back(p.integer ? std::floor(0.5 * (p.lower + p.upper))
                                  : 0.5 * (p.lower + p.upper));
    std::vector<std::vector<double>> more;
    for (const std::vector<double>& one : all) {
      for (const double choice : choices) {
        more.push_back(one);
        more.back().push_back(choice);
      }
    }
    all = std::move(more);
  }
  return all;
}

std::string words_of(const Declaration& own, const std::vector<double>& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i)
    text += fmt::format("{}{} = {:g}", i == 0 ? "" : ", ", own.parameters[i].name, values[i]);
  return text;
}

std::string at_words(const Trial& trial) { return trial.where.empty() ? "" : " at " + trial.where; }

/// The first problem of one formula over all trials.
class FormulaOnBed {
 public:
  FormulaOnBed(const Declaration& own, std::string place, const Formula& formula,
               const std::vector<Trial>& trials)
      : own_(own), place_(std::move(place)), formula_(formula), trials_(trials) {}

  [[nodiscard]] std::optional<DeclarationProblem> problem() const {
    for (const std::vector<double>& values : settings_of(own_)) {
      if (auto found = not_finite(values)) return found;
      std::vector<double> without = values;
      without.front() = own_.parameters.front().null;
      if (auto found = not_null(without)) return found;
    }
    if (own_.parameters.front().integer) {
      if (auto found = not_in_proportion_to_size()) return found;
    }
    if (own_.acts_on == ActsOn::paper) return not_in_proportion_to_place();
    return std::nullopt;
  }

 private:
  std::vector<Number> values_of(const Trial& trial, Values values) const {
    return values_at(own_.acts_on, trial.state, values);
  }
  double value(const Trial& trial, const std::vector<double>& values) const {
    return formula_.evaluate(std::span<const Number>(values_of(trial, values))).value;
  }
  [[nodiscard]] DeclarationProblem at(std::string value, std::string expected,
                                      std::size_t offset = 0) const {
    return {place_, std::move(value), std::move(expected), offset};
  }

  [[nodiscard]] std::optional<DeclarationProblem> not_finite(
      const std::vector<double>& values) const {
    for (const Trial& trial : trials_) {
      const std::vector<Number> all = values_of(trial, values);
      const std::span<const Number> given(all);
      const bool shortened = !own_.elongation.empty() && value(trial, values) <= -1.0;
      if (is_finite(formula_.evaluate(given)) && !shortened) continue;
      const std::size_t offset = shortened ? 0 : formula_.first_not_finite(given);
      return at(
          shortened ? "a chain without length" : "not finite",
          fmt::format("a formula that is finite, with its slopes, over the bed of the machine "
                      "between the bounds; this one is not{} with {}",
                      at_words(trial), words_of(own_, values)),
          offset);
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<DeclarationProblem> not_null(
      const std::vector<double>& values) const {
    for (const Trial& trial : trials_) {
      const double left = value(trial, values);
      if (std::abs(left) <= kNothingMm) continue;
      return at(fmt::format("{:g}", left),
                fmt::format("a formula that is 0 at null; this one is {:g}{} with {}", left,
                            at_words(trial), words_of(own_, values)));
    }
    return std::nullopt;
  }

  /// The diagnosis uses one column for all whole numbers.
  [[nodiscard]] std::optional<DeclarationProblem> not_in_proportion_to_size() const {
    for (std::vector<double> values : settings_of(own_)) {
      for (const Trial& trial : trials_) {
        values.front() = 1.0;
        const double one = value(trial, values);
        values.front() = 2.0;
        if (std::abs(value(trial, values) - 2.0 * one) <= kNothingMm) continue;
        return at(own_.parameters.front().name,
                  "a formula in proportion to a size in whole numbers");
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<DeclarationProblem> not_in_proportion_to_place() const {
    for (const std::vector<double>& values : settings_of(own_)) {
      const double by_x = value({"", {.x_mm = 1.0}}, values);
      const double by_y = value({"", {.y_mm = 1.0}}, values);
      for (const Trial& trial : trials_) {
        const double line = by_x * trial.state.x_mm.value + by_y * trial.state.y_mm.value;
        // A slope of 0.05 over 1220 mm is rounded to 1e-13; 1e-7 is far above and far below a tape.
        if (std::abs(value(trial, values) - line) <= 1e-7) continue;
        return at(
            fmt::format("not in proportion{}", at_words(trial)),
            "a formula linear in x and y, like a tape's scale or a skew; an effect on a chain may "
            "use x and y in any way");
      }
    }
    return std::nullopt;
  }

  const Declaration& own_;
  std::string place_;
  const Formula& formula_;
  const std::vector<Trial>& trials_;
};

}  // namespace

std::vector<DeclarationProblem> problems_on_bed(const Declaration& declaration,
                                                const Machine& machine) {
  const DeclaredLaw law(declaration);
  const std::vector<Trial> trials = trials_of(declaration, machine);
  Problems problems;
  for (const FormulaRow& row : kFormulas) {
    const std::optional<Formula>& formula = law.formula(row.key);
    if (!formula) continue;
    if (auto found =
            FormulaOnBed(declaration, fmt::format("/{}", row.name), *formula, trials).problem())
      problems.push_back(*std::move(found));
  }
  return problems;
}

}  // namespace chaintrue::model::effects
