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

/// Whether something rotates there, or consists of equal parts.
bool may_repeat(const LawTerm& term) {
  if (term.of == Coordinate::x || term.of == Coordinate::y) return true;
  if (unit_of(term.of) != "mm") return false;
  if (const auto belt = belt_of(term.of)) return belt_of(term.enters) == belt;
  return chain_of(term.of) && chain_of(term.of) == chain_of(term.enters);
}

/// The shortest period: shorter ones are implausible, or no marks show them.
double shortest_wave(const LawCurve& curve) {
  if (curve.of == Coordinate::x || curve.of == Coordinate::y) return 100.0;
  if (curve.of == Coordinate::across) return 400.0;
  const bool of_length = (chain_of(curve.of) || belt_of(curve.of)) && unit_of(curve.of) == "mm";
  if (!of_length) return curve.span() / 6.0;
  return may_repeat(curve) ? 25.0 : 200.0;
}

/// Equally likely places.
StepPlaces evenly(std::vector<double> at) {
  std::vector<double> mass(at.size(), 1.0 / as_double(at.size()));
  return {std::move(at), std::move(mass)};
}

class CurveList {
 public:
  explicit CurveList(const RegressorSystem& system) : system_(system) {}

  void add_all(Coordinate of, double direction_deg, double weight) {
    start_ = {};
    start_.of = of;
    start_.direction_deg = direction_deg;
    values_.clear();
    for (const SystemPlace& place : system_.places) {
      if (of != Coordinate::visit || place.ordered)
        values_.push_back(value_at(place, of, start_.direction_rad()));
    }
    constexpr std::size_t kFewest = 8;  // fewer places show no shape
    if (values_.size() < kFewest) return;
    sort(values_);
    if (!(values_.back() - values_.front() > 1e-6)) return;
    start_.from = values_.front();
    start_.to = values_.back();
    for (const LawEntrance& entrance : law_entrances(system_, of)) {
      start_.enters = entrance.enters;
      most_waves_ = most_resolvable_waves(start_.span() / shortest_wave(start_));
      add_shapes(weight * entrance.weight);
    }
  }

  std::vector<LawCurve> take() { return std::move(curves_); }

 private:
  /// Half the weight for each additional parameter.
  void add_shapes(double weight) {
    const bool of_border = start_.of == Coordinate::border;
    const bool of_visit = start_.of == Coordinate::visit;
    const bool outwards = start_.enters == Enters::outwards;
    // Drift and a moving zero are in the catalogue.
    if (!of_border && !of_visit) {
      add(LawShape::linear, 0, weight, evenly({0.0}));
      add(LawShape::square, 0, 0.5 * weight, evenly({0.0}));
    }
    if (!of_visit && !outwards)
      add(LawShape::step, 0, 0.5 * weight, step_places(values_, start_.from, start_.to));
    for (const int towards : {-1, 1}) {
      // A drop at the border starts there.
      if (of_border && towards > 0) continue;
      const double own = of_border ? 0.5 * weight : 0.25 * weight;
      if (!outwards) add(LawShape::kink, towards, own, kink_places());
      add(LawShape::exponential, towards, own, scales());
    }
    if (!of_border) add(LawShape::wave, 0, 0.25 * weight, waves(most_waves_, kWaveStep));
    // Two parameters more than a wave.
    if (may_repeat(start_))
      add(LawShape::harmonics, 0, 0.0625 * weight, waves(most_waves_ / 2.0, kHarmonicsStep));
  }

  void add(LawShape shape, int towards, double weight, StepPlaces grid) {
    if (grid.at.empty()) return;
    LawCurve& curve = curves_.emplace_back(start_);
    curve.shape = shape;
    curve.towards = towards;
    curve.share = weight;
    curve.grid = std::move(grid.at);
    curve.mass = std::move(grid.mass);
  }

  StepPlaces kink_places() const {
    return evenly(mapped(each_below(kKinkPlaces), [&](int k) {
      return start_.from + (k + 0.5) / kKinkPlaces * start_.span();
    }));
  }

  StepPlaces scales() const {
    return evenly(mapped(each_below(kScales), [&](int k) {
      return kShortestScale * std::pow(kScaleFactor, k) * start_.span();
    }));
  }

  static StepPlaces waves(double most, double step) {
    StepPlaces grid;
    double sum = 0.0;
    for (double waves = kFewestWaves; waves <= most; waves += step) {
      grid.at.push_back(waves);
      grid.mass.push_back(1.0 / waves);
      sum += 1.0 / waves;
    }
    for (double& own : grid.mass) own /= sum;
    return grid;
  }

  /// Waves over the span beyond which evenly spaced values mistake one for a longer one: half of the
  /// first number of waves that all of them see nearly in the same phase (the sampling theorem).
  /// Returns no more than `most`.
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
      for (const auto k : each_index(phases)) {
        sum += phases[k];
        phases[k] *= steps[k];
      }
      if (std::abs(sum) > kSamePhase * as_double(values_.size())) return 0.5 * waves;
    }
    return most;
  }

  const RegressorSystem& system_;
  std::vector<double> values_;
  double most_waves_ = 0.0;
  LawCurve start_;
  std::vector<LawCurve> curves_;
};

std::vector<LawEntrance> entrances_of_chains(Coordinate of) {
  using enum Enters;
  if (const auto chain = chain_of(of)) {
    const bool is_left = *chain == Side::left;
    return {{left, is_left ? 0.55 : 0.15}, {right, is_left ? 0.15 : 0.55}, {x, 0.15}, {y, 0.15}};
  }
  switch (of) {
    case Coordinate::x:
    case Coordinate::y:
      return {{left, 0.25}, {right, 0.25}, {x, 0.25}, {y, 0.25}};
    case Coordinate::across:
      return {{left, 0.2}, {right, 0.2}, {x, 0.2}, {y, 0.2}, {along, 0.2}};
    case Coordinate::border:
      return {{outwards, 0.4}, {left, 0.15}, {right, 0.15}, {x, 0.15}, {y, 0.15}};
    default:
      break;
  }
  return {{left, 0.35}, {right, 0.35}, {equal, 0.3}};
}

std::vector<LawEntrance> entrances_of_belts(Coordinate of) {
  const auto own = belt_of(of);
  std::vector<LawEntrance> entrances;
  for (const Enters enters : {Enters::tl, Enters::tr, Enters::bl, Enters::br})
    entrances.push_back({enters, !own ? 0.25 : belt_of(enters) == own ? 0.7 : 0.1});
  return entrances;
}

/// The effect of one millimetre of a law on the chains at a place, with the law's argument.
std::vector<std::pair<double, Vector2d>> chains_at(const SystemPlace& place, const LawTerm& term) {
  if (term.of == Coordinate::visit && !place.ordered) return {};
  const Matrix2d& by_mark = place.state.by_mark;
  if (term.enters == Enters::outwards) {
    const auto& [x_mm, y_mm] = place.mark;
    return {
        {0.5 * place.bed.width_mm - std::abs(x_mm), by_mark.col(0) * std::copysign(1.0, x_mm)},
        {0.5 * place.bed.height_mm - std::abs(y_mm), by_mark.col(1) * std::copysign(1.0, y_mm)}};
  }
  const Vector2d along(std::cos(term.direction_rad()), std::sin(term.direction_rad()));
  const Vector2d chains_mm = term.enters == Enters::left    ? Vector2d(1.0, 0.0)
                             : term.enters == Enters::right ? Vector2d(0.0, 1.0)
                             : term.enters == Enters::equal ? Vector2d(1.0, 1.0)
                             : term.enters == Enters::x     ? Vector2d(by_mark.col(0))
                             : term.enters == Enters::y     ? Vector2d(by_mark.col(1))
                                                            : Vector2d(by_mark * along);
  return {{value_at(place, term.of, term.direction_rad()), chains_mm}};
}

}  // namespace

StepPlaces step_places(const std::vector<double>& values, double from, double to) {
  const auto place = [&](int k) { return from + (k + 0.5) / kStepPlaces * (to - from); };
  StepPlaces places;
  std::ptrdiff_t last = -1;
  int first = 0;  // of those between the same two values
  for (const int k : each_below(kStepPlaces)) {
    const auto below = std::lower_bound(values.begin(), values.end(), place(k)) - values.begin();
    if (below != last) {
      places.at.emplace_back();
      places.mass.emplace_back();
      first = k;
    }
    places.at.back() = 0.5 * (place(first) + place(k));
    places.mass.back() = (k - first + 1.0) / kStepPlaces;
    last = below;
  }
  return places;
}

Index columns_of(LawShape shape) {
  if (shape == LawShape::harmonics) return 4;
  return shape == LawShape::square || shape == LawShape::wave ? 2 : 1;
}

bool is_continuous(LawShape shape) {
  return shape == LawShape::kink || shape == LawShape::exponential || is_periodic(shape);
}

double basis_at(const LawForm& law, double at, Index column, double v) {
  const double u = (v - law.middle()) / law.span();
  switch (law.shape) {
    case LawShape::linear:
      return u;
    case LawShape::square:
      return column == 0 ? 4.0 * u * u : 2.0 * u;
    case LawShape::step:
      return v >= at ? 1.0 : 0.0;
    case LawShape::kink:
      return std::max(0.0, law.towards * (v - at)) / law.span();
    case LawShape::exponential:
      return std::exp(-(law.towards > 0 ? law.to - v : v - law.from) / at);
    case LawShape::wave:
    case LawShape::harmonics:
      break;
  }
  const double harmonic = column < 2 ? 1.0 : 2.0;
  const double turn = 2.0 * std::numbers::pi * harmonic * at * u;
  return column % 2 == 0 ? std::cos(turn) : std::sin(turn);
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
    list.add_all(Coordinate::across, 180.0 * k / kLawDirections, 0.5 / (kLawDirections - 2));
  }
  std::vector<LawCurve> curves = list.take();
  share_out(curves);
  return curves;
}

void share_out(std::vector<LawCurve>& curves) {
  double sum = 0.0;
  for (const LawCurve& curve : curves) sum += curve.share;
  for (LawCurve& curve : curves) curve.share /= sum;
}

namespace {

/// Values of every amplitude at each of some points of the grid.
RowVectorXd values_at(const LawCurve& curve, const std::vector<double>& at, double v) {
  const Index each = columns_of(curve.shape);
  RowVectorXd values(each * std::ssize(at));
  for (const Index k : each_below(values.size()))
    values(k) = basis_at(curve, at[as_size(k / each)], k % each, v);
  return values;
}

}  // namespace

MatrixXd law_columns(const RegressorSystem& system, const LawCurve& curve,
                     const std::vector<double>& at) {
  const Index count = columns_of(curve.shape) * std::ssize(at);
  MatrixXd columns = MatrixXd::Zero(system.e.size(), count);
  for (const auto u : each_index(system.units)) {
    const SystemUnit& unit = system.units[u];
    for (const LawRows& own : law_rows(system, u, curve))
      columns.middleRows(unit.first_row, unit.rows) += own.rows * values_at(curve, at, own.v);
  }
  return columns;
}

std::vector<Coordinate> law_variables(const RegressorSystem& system) {
  using enum Coordinate;
  if (system.is_of_lengths()) {
    return {x,        y,        length_tl, length_tr, length_bl, length_br,
            angle_tl, angle_tr, angle_bl,  angle_br,  visit};
  }
  return {x,          y,           border,       length_left,   length_right,
          angle_left, angle_right, tension_left, tension_right, visit};
}

std::vector<LawEntrance> law_entrances(const RegressorSystem& system, Coordinate of) {
  return system.is_of_lengths() ? entrances_of_belts(of) : entrances_of_chains(of);
}

std::vector<LawRows> law_rows(const RegressorSystem& system, std::size_t unit,
                              const LawTerm& term) {
  std::vector<LawRows> all;
  for (const PlaceColumns& own : system.units[unit].places) {
    const SystemPlace& place = system.places[own.place];
    if (const auto belt = belt_of(term.enters)) {
      all.push_back({value_at(place, term.of, term.direction_rad()),
                     system.units[unit].by_reading.col(as_index(*belt))});
      continue;
    }
    for (const auto& [v, chains_mm] : chains_at(place, term))
      all.push_back({v, own.by_chain * chains_mm});
  }
  return all;
}

}  // namespace chaintrue::grid::diagnosis
