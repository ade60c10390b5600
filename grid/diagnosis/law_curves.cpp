// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/law_curves.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "grid/diagnosis/discrepancy.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Directions over half a turn, those of x and y among them: a step or fold bends elsewhere under one
/// next to its own.
constexpr int kLawDirections = 16;
constexpr double kFewestWaves = 0.5;  // over the span; less is a trend
constexpr double kWaveStep = 0.25;
constexpr double kHarmonicsStep = 0.125;  // their second harmonic reaches twice as far
constexpr int kStepPlaces = 48;
constexpr int kKinkPlaces = 16;
constexpr int kScales = 9;
constexpr double kShortestScale = 0.03;  // of the span
constexpr double kScaleFactor = 1.45;

class CurveList {
 public:
  explicit CurveList(const RegressorSystem& system) : system_(system) {}

  void add_all(Coordinate of, double direction_rad, double weight) {
    values_ = values_of_variable(system_, of, direction_rad);
    constexpr std::size_t kFewest = 8;  // fewer places show no shape
    if (values_.size() < kFewest) return;
    const auto [low, high] = minmax_element(values_);
    if (!(*high - *low > 1e-6)) return;
    start_ = {};
    start_.of = of;
    start_.direction_rad = direction_rad;
    start_.from = *low;
    start_.to = *high;
    sort(values_);
    double most = 0.0;
    for (const LawEntrance& entrance : law_entrances(system_, of))
      most = std::max(most, start_.span() / shortest_wave(of, entrance.enters, start_.span()));
    most_resolvable_waves_ = most_resolvable_waves(most);
    for (const LawEntrance& entrance : law_entrances(system_, of)) {
      start_.enters = entrance.enters;
      add_shapes(weight * entrance.weight);
    }
  }

  std::vector<LawCurve> take() { return std::move(curves_); }

 private:
  /// Half the weight for each additional parameter.
  void add_shapes(double weight) {
    const bool of_border = start_.of == Coordinate::border;
    const bool of_visit = start_.of == Coordinate::visit;
    // Drift and a moving zero are in the catalogue.
    if (!of_border && !of_visit) {
      add(LawShape::linear, 0, weight, {0.0});
      add(LawShape::square, 0, 0.5 * weight, {0.0});
    }
    if (!of_visit && start_.enters != Enters::outwards) add_steps(0.5 * weight);
    for (const int towards : {-1, 1}) {
      // A drop at the border starts there.
      if (of_border && towards > 0) continue;
      const double own = of_border ? 0.5 * weight : 0.25 * weight;
      if (start_.enters != Enters::outwards) add(LawShape::kink, towards, own, kink_places());
      add(LawShape::exponential, towards, own, scales());
    }
    if (!of_border) add_waves(LawShape::wave, kWaveStep, 0.25 * weight);
    // Two parameters more than a wave.
    if (may_repeat(start_.of, start_.enters))
      add_waves(LawShape::harmonics, kHarmonicsStep, 0.0625 * weight);
  }

  void add(LawShape shape, int towards, double weight, std::vector<double> grid) {
    LawCurve curve = start_;
    curve.shape = shape;
    curve.towards = towards;
    curve.weight = weight;
    curve.mass.assign(grid.size(), 1.0 / as_double(grid.size()));
    curve.grid = std::move(grid);
    curves_.push_back(std::move(curve));
  }

  void add_steps(double weight) {
    StepPlaces places = step_places(values_, start_.from, start_.to);
    add(LawShape::step, 0, weight, std::move(places.at));
    curves_.back().mass = std::move(places.mass);
  }

  std::vector<double> kink_places() const {
    std::vector<double> grid;
    for (int k = 0; k < kKinkPlaces; ++k)
      grid.push_back(start_.from + (k + 0.5) / kKinkPlaces * start_.span());
    return grid;
  }

  std::vector<double> scales() const {
    std::vector<double> grid;
    for (int k = 0; k < kScales; ++k)
      grid.push_back(kShortestScale * std::pow(kScaleFactor, k) * start_.span());
    return grid;
  }

  /// Waves over the span beyond which evenly spaced values mistake one for a longer one: half of the
  /// first number of waves that all of them see nearly in the same phase (the sampling theorem).
  double most_resolvable_waves(double most) const {
    // 0.97: a strength of 12 separates two such waves by less than three sigmas, 12 sqrt(1 -
    // 0.97^2).
    constexpr double kSamePhase = 0.97;
    constexpr double kFirst = 1.5;  // fewer waves than one are nearly in phase everywhere
    constexpr double kStep = 0.05;
    std::vector<std::complex<double>> phases;
    std::vector<std::complex<double>> steps;
    for (const double v : values_) {
      const double turn = 2.0 * std::numbers::pi * (v - start_.from) / start_.span();
      phases.push_back(std::polar(1.0, kFirst * turn));
      steps.push_back(std::polar(1.0, kStep * turn));
    }
    for (double waves = kFirst; waves < 2.0 * most; waves += kStep) {
      std::complex<double> sum = 0.0;
      for (std::size_t k = 0; k < phases.size(); ++k) {
        sum += phases[k];
        phases[k] *= steps[k];
      }
      if (std::abs(sum) > kSamePhase * as_double(values_.size())) return 0.5 * waves;
    }
    return most;
  }

  void add_waves(LawShape shape, double step, double weight) {
    const double harmonic = shape == LawShape::harmonics ? 2.0 : 1.0;
    const double most =
        std::min(start_.span() / shortest_wave(start_.of, start_.enters, start_.span()),
                 most_resolvable_waves_) /
        harmonic;
    std::vector<double> grid;
    std::vector<double> mass;
    double sum = 0.0;
    for (double waves = kFewestWaves; waves <= most; waves += step) {
      grid.push_back(waves);
      mass.push_back(1.0 / waves);
      sum += 1.0 / waves;
    }
    if (grid.empty()) return;
    for (double& own : mass) own /= sum;
    add(shape, 0, weight, std::move(grid));
    curves_.back().mass = std::move(mass);
  }

  const RegressorSystem& system_;
  std::vector<double> values_;
  double most_resolvable_waves_ = 0.0;
  LawCurve start_;
  std::vector<LawCurve> curves_;
};

/// The factor of one amplitude of a law at one value.
double basis(const LawCurve& curve, double at, Index column, double v) {
  const double u = (v - curve.middle()) / curve.span();
  switch (curve.shape) {
    case LawShape::linear:
      return u;
    case LawShape::square:
      return column == 0 ? 4.0 * u * u : 2.0 * u;
    case LawShape::step:
      return v >= at ? 1.0 : 0.0;
    case LawShape::kink:
      return std::max(0.0, curve.towards * (v - at)) / curve.span();
    case LawShape::exponential:
      return std::exp(-(curve.towards > 0 ? curve.to - v : v - curve.from) / at);
    case LawShape::wave:
    case LawShape::harmonics:
      break;
  }
  const double harmonic = column < 2 ? 1.0 : 2.0;
  const double turn = 2.0 * std::numbers::pi * harmonic * at * u;
  return column % 2 == 0 ? std::cos(turn) : std::sin(turn);
}

std::vector<LawEntrance> entrances_of_chains(Coordinate of) {
  if (const auto chain = chain_of(of)) {
    const bool is_left = *chain == model::Side::left;
    return {{Enters::left, is_left ? 0.55 : 0.15},
            {Enters::right, is_left ? 0.15 : 0.55},
            {Enters::x, 0.15},
            {Enters::y, 0.15}};
  }
  switch (of) {
    case Coordinate::x:
    case Coordinate::y:
      return {{Enters::left, 0.25}, {Enters::right, 0.25}, {Enters::x, 0.25}, {Enters::y, 0.25}};
    case Coordinate::across:
      return {{Enters::left, 0.2},
              {Enters::right, 0.2},
              {Enters::x, 0.2},
              {Enters::y, 0.2},
              {Enters::along, 0.2}};
    case Coordinate::border:
      return {{Enters::outwards, 0.4},
              {Enters::left, 0.15},
              {Enters::right, 0.15},
              {Enters::x, 0.15},
              {Enters::y, 0.15}};
    default:
      break;
  }
  return {{Enters::left, 0.35}, {Enters::right, 0.35}, {Enters::equal, 0.3}};
}

std::vector<LawEntrance> entrances_of_belts(Coordinate of) {
  const auto own = belt_of(of);
  std::vector<LawEntrance> entrances;
  for (const Enters enters : {Enters::tl, Enters::tr, Enters::bl, Enters::br})
    entrances.push_back({enters, !own ? 0.25 : belt_of(enters) == own ? 0.7 : 0.1});
  return entrances;
}

/// Distance from the border that a component crosses.
double from_border(const SystemPlace& place, bool along_x) {
  return along_x ? 0.5 * place.bed.width_mm - std::abs(place.mark.x_mm)
                 : 0.5 * place.bed.height_mm - std::abs(place.mark.y_mm);
}

/// The effect of one millimetre of a law on the chains at a place, with the law's argument.
std::vector<std::pair<double, Vector2d>> chains_at(const SystemPlace& place, const LawTerm& term) {
  if (term.of == Coordinate::visit && !place.ordered) return {};
  const Matrix2d& by_mark = place.state.by_mark;
  const auto at = [&](const Vector2d& chains_mm) {
    return std::vector{std::pair(value_at(place, term.of, term.direction_rad), chains_mm)};
  };
  switch (term.enters) {
    case Enters::left:
      return at({1.0, 0.0});
    case Enters::right:
      return at({0.0, 1.0});
    case Enters::equal:
      return at({1.0, 1.0});
    case Enters::opposite:
      return at({1.0, -1.0});
    case Enters::x:
      return at(by_mark.col(0));
    case Enters::y:
      return at(by_mark.col(1));
    case Enters::along:
      return at(by_mark * Vector2d(std::cos(term.direction_rad), std::sin(term.direction_rad)));
    case Enters::outwards:
      return {{from_border(place, true), by_mark.col(0) * std::copysign(1.0, place.mark.x_mm)},
              {from_border(place, false), by_mark.col(1) * std::copysign(1.0, place.mark.y_mm)}};
    default:
      break;
  }
  return {};
}

}  // namespace

StepPlaces step_places(const std::vector<double>& values, double from, double to) {
  StepPlaces places;
  std::ptrdiff_t last = 0;
  std::vector<double> same;
  const auto close = [&] {
    if (same.empty()) return;
    places.at.push_back(0.5 * (same.front() + same.back()));
    places.mass.push_back(as_double(same.size()) / kStepPlaces);
    same.clear();
  };
  for (int k = 0; k < kStepPlaces; ++k) {
    const double at = from + (k + 0.5) / kStepPlaces * (to - from);
    const auto below = std::lower_bound(values.begin(), values.end(), at) - values.begin();
    if (below != last) close();
    last = below;
    same.push_back(at);
  }
  close();
  return places;
}

Index columns_of(LawShape shape) {
  if (shape == LawShape::harmonics) return 4;
  return shape == LawShape::square || shape == LawShape::wave ? 2 : 1;
}

bool is_continuous(LawShape shape) {
  return shape == LawShape::kink || shape == LawShape::exponential || is_periodic(shape);
}

double density_at(const LawCurve& curve, double at) {
  // Scales are even in their logarithm, as periods are.
  return is_periodic(curve.shape) || curve.shape == LawShape::exponential ? 1.0 / at : 1.0;
}

std::vector<LawCurve> law_curves(const RegressorSystem& system) {
  CurveList list(system);
  for (const Coordinate of : law_variables(system)) list.add_all(of, 0.0, 1.0);
  for (int k = 1; k < kLawDirections; ++k) {
    if (2 * k == kLawDirections) continue;
    // A direction is one more parameter.
    list.add_all(Coordinate::across, std::numbers::pi * k / kLawDirections,
                 0.5 / (kLawDirections - 2));
  }
  std::vector<LawCurve> curves = list.take();
  share_out(curves);
  return curves;
}

void share_out(std::vector<LawCurve>& curves) {
  double sum = 0.0;
  for (const LawCurve& curve : curves) sum += curve.weight;
  for (LawCurve& curve : curves) curve.share = curve.weight / sum;
}

namespace {

/// Values of every amplitude at each of some points of the grid.
RowVectorXd values_at(const LawCurve& curve, const std::vector<double>& at, double v) {
  const Index each = columns_of(curve.shape);
  RowVectorXd values(each * std::ssize(at));
  for (Index k = 0; k < values.size(); ++k)
    values(k) = basis(curve, at[as_size(k / each)], k % each, v);
  return values;
}

}  // namespace

MatrixXd law_columns(const RegressorSystem& system, const LawCurve& curve,
                     const std::vector<double>& at) {
  const Index count = columns_of(curve.shape) * std::ssize(at);
  MatrixXd columns = MatrixXd::Zero(system.e.size(), count);
  for (std::size_t u = 0; u < system.units.size(); ++u) {
    const SystemUnit& unit = system.units[u];
    for (const LawRows& own : law_rows(system, u, curve))
      columns.middleRows(unit.first_row, unit.rows) += own.rows * values_at(curve, at, own.v);
  }
  return columns;
}

std::vector<Coordinate> law_variables(const RegressorSystem& system) {
  if (system.is_of_lengths()) {
    return {Coordinate::x,         Coordinate::y,         Coordinate::length_tl,
            Coordinate::length_tr, Coordinate::length_bl, Coordinate::length_br,
            Coordinate::angle_tl,  Coordinate::angle_tr,  Coordinate::angle_bl,
            Coordinate::angle_br,  Coordinate::visit};
  }
  return {Coordinate::x,
          Coordinate::y,
          Coordinate::border,
          Coordinate::length_left,
          Coordinate::length_right,
          Coordinate::angle_left,
          Coordinate::angle_right,
          Coordinate::tension_left,
          Coordinate::tension_right,
          Coordinate::visit};
}

std::vector<LawEntrance> law_entrances(const RegressorSystem& system, Coordinate of) {
  return system.is_of_lengths() ? entrances_of_belts(of) : entrances_of_chains(of);
}

double shortest_wave(Coordinate of, Enters enters, double span) {
  if (of == Coordinate::x || of == Coordinate::y) return 100.0;
  if (of == Coordinate::across) return 400.0;
  const bool of_length = (chain_of(of) || belt_of(of)) && unit_of(of) == "mm";
  if (!of_length) return span / 6.0;
  return may_repeat(of, enters) ? 25.0 : 200.0;
}

bool may_repeat(Coordinate of, Enters enters) {
  if (of == Coordinate::x || of == Coordinate::y) return true;
  if (unit_of(of) != "mm") return false;
  if (const auto belt = belt_of(of)) return belt_of(enters) == belt;
  const auto chain = chain_of(of);
  return chain && enters == (*chain == model::Side::left ? Enters::left : Enters::right);
}

std::vector<double> values_of_variable(const RegressorSystem& system, Coordinate of,
                                       double direction_rad) {
  std::vector<double> values;
  for (const SystemPlace& place : system.places) {
    if (of != Coordinate::visit || place.ordered)
      values.push_back(value_at(place, of, direction_rad));
  }
  return values;
}

std::vector<LawRows> law_rows(const RegressorSystem& system, std::size_t unit,
                              const LawTerm& term) {
  std::vector<LawRows> all;
  for (const observation::PlaceColumns& own : system.units[unit].places) {
    const SystemPlace& place = system.places[own.place];
    if (const auto belt = belt_of(term.enters)) {
      all.push_back({value_at(place, term.of, term.direction_rad),
                     system.units[unit].by_reading.col(static_cast<Index>(*belt))});
      continue;
    }
    for (const auto& [v, chains_mm] : chains_at(place, term))
      all.push_back({v, own.by_chain * chains_mm});
  }
  return all;
}

}  // namespace chaintrue::grid::diagnosis
