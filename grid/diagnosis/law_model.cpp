// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/law_model.hpp"

#include <cmath>

#include "grid/plane_vectors.hpp"

namespace chaintrue::grid::diagnosis {

std::vector<LawResidual> residuals_about(const Analysis& a, const WeighedLaw& weighed,
                                         const Law& law) {
  const RegressorSystem& system = a.system;
  const MarginalisedSystem& marginalised = marginalised_system(a, weighed);
  const LawModel::Left left = LawModel(a, marginalised, weighed.with).left_of(weighed.rows(system));
  VectorXd unexplained = VectorXd::Zero(system.e.size());
  unexplained(marginalised.kept.rows()) = left.unexplained;
  std::vector<LawResidual> points;
  const bool of_belts = system.is_of_lengths();
  for (const KeptRows::Unit& kept : marginalised.kept.units()) {
    const SystemUnit& unit = system.units[kept.unit];
    if (kept.across || (!of_belts && !unit.reads_chains)) continue;
    LawResidual point;
    point.index = a.session.units[kept.unit].index;
    if (!of_belts) {
      const Vector2d left_mm = error_of_unit(system, unexplained, kept.unit);
      point.left_x_mm = left_mm.x();
      point.left_y_mm = left_mm.y();
    }
    for (const LawRows& own : law_rows(system, kept.unit, *weighed.curve)) {
      // Readings that cannot show the law are omitted.
      if (!(own.rows.squaredNorm() > 0.0)) continue;
      point.at = own.v;
      point.residual_mm =
          value_of(law, own.v) +
          own.rows.dot(left.noise.segment(kept.at, kept.rows)) / own.rows.squaredNorm();
      points.push_back(point);
    }
  }
  stable_sort(points, ascending(&LawResidual::index));
  return points;
}

void take_laws(std::vector<Law> laws, Diagnosis& d) {
  double some_law = 0.0;
  for (const Law& law : laws) some_law += law.probability;
  d.unexplained->laws = std::move(laws);
  if (some_law <= 0.0) return;
  some_law = std::min(some_law, 1.0);
  // If a law acts, the residual is neither zero nor only noise.
  for (Hypothesis& one : d.hypotheses) {
    if (one.effect == "nothing" || one.effect == "noise" || one.effect == "bad_points")
      one.probability *= 1.0 - some_law;
  }
  d.hypotheses.push_back({"law", "", some_law});
  stable_sort(d.hypotheses, descending(&Hypothesis::probability));
  if (claimed_law(d) != nullptr && d.causes.empty()) d.verdict = Verdict::model_discrepancy;
}

const Law* claimed_law(const Diagnosis& d) {
  if (!d.unexplained || d.unexplained->laws.empty()) return nullptr;
  const Law& first = d.unexplained->laws.front();
  return first.probability >= kLawClaimed ? &first : nullptr;
}

namespace {

constexpr std::size_t kFolds = 4;
/// Number of values of a place or period that a part may choose from.
constexpr std::size_t kMostValues = 5;

/// Distances between holes.
bool joins_places(const RegressorSystem& system) {
  return any_of(system.units, [](const SystemUnit& unit) { return unit.places.size() > 1; });
}

/// Whether a unit was read at some place of which this holds.
template <class Holds>
bool is_at(const SystemUnit& unit, const Holds& holds) {
  return any_of(unit.places, [&](const auto& own) { return holds(own.place); });
}

/// Every fourth place.
std::vector<Indices> folds(const RegressorSystem& system, const KeptRows& kept) {
  std::vector<Indices> result(kFolds);
  for (const std::size_t fold : each_below(kFolds)) {
    const auto is_of_fold = [&](std::size_t number) { return number % kFolds == fold; };
    for (const auto k : each_index(kept.units())) {
      const std::size_t unit = kept.units()[k].unit;
      if (joins_places(system) ? is_at(system.units[unit], is_of_fold) : is_of_fold(k))
        result[fold].push_back(unit);
    }
  }
  return result;
}

/// A quarter of the places, those farthest towards a direction.
Indices quarter_of_places(const RegressorSystem& system, const KeptRows& kept, double towards_rad) {
  const Vector2d towards(std::cos(towards_rad), std::sin(towards_rad));
  Indices order = numbers_below(system.places.size());
  stable_sort(order, descending([&](std::size_t place) {
                return towards.dot(vector_of(system.places[place].mark));
              }));
  order.resize(order.size() / 4);
  Indices units;
  for (const KeptRows::Unit& unit : kept.units()) {
    if (is_at(system.units[unit.unit], [&](std::size_t place) { return contains(order, place); }))
      units.push_back(unit.unit);
  }
  return units;
}

class Predictor {
 public:
  Predictor(const Analysis& a, const WeighedLaw& law, const LawPoints& of_curve)
      : system_(a.system),
        kept_(marginalised_system(a, law).kept),
        without_(model_without(a, law)) {
    for (const WeighedLaw* own : of_curve) {
      if (with_.size() == kMostValues) break;
      WeighedLaw other = *own;
      other.with = law.with;
      with_.emplace_back(model_with(a, other));
    }
  }

  /// Root mean square over all parts.
  LawHeldOut::Errors errors(const std::vector<Indices>& parts) const {
    double without = 0.0;
    double with = 0.0;
    double count = 0.0;
    for (const Indices& left_out : parts) {
      const Rows out = kept_.positions(left_out);
      // No prediction for a part that was rejected, or that is everything.
      if (out.empty() || std::ssize(out) == kept_.size()) continue;
      without += square_mm2(without_.without(out).left, out, left_out);
      with += square_mm2(likeliest(out).left, out, left_out);
      count += 1.0;
    }
    if (!(count > 0.0)) return {};
    return {std::sqrt(without / count), std::sqrt(with / count)};
  }

 private:
  /// The prediction of the model with the law that is likeliest by the other rows.
  LawModel::Downdated::Without likeliest(const Rows& out) const {
    const auto all =
        mapped(with_, [&](const LawModel::Downdated& model) { return model.without(out); });
    return *max_element(all, ascending(&LawModel::Downdated::Without::log_density));
  }

  double square_mm2(const VectorXd& wrong, const Rows& out, const Indices& units) const {
    VectorXd rows = VectorXd::Zero(system_.e.size());
    for (const Index k : each_below(wrong.size()))
      rows(kept_.rows()[as_size(out[as_size(k)])]) = wrong(k);
    return std::pow(rms_of_units_mm(system_, kept_, rows, units), 2);
  }

  const RegressorSystem& system_;
  const KeptRows& kept_;
  LawModel::Downdated without_;
  std::vector<LawModel::Downdated> with_;
};

}  // namespace

std::optional<LawHeldOut> held_out_with(const Analysis& a, const WeighedLaw& law,
                                        const LawPoints& of_curve) {
  const std::vector<BedPart> quarters = bed_parts(a.system, a.session.fewest_units);
  if (quarters.empty()) return std::nullopt;
  const Predictor predictor(a, law, of_curve);
  const KeptRows& kept = marginalised_system(a, law).kept;
  const auto parts = mapped(quarters, [&](const BedPart& quarter) {
    return joins_places(a.system) ? quarter_of_places(a.system, kept, quarter.towards_rad)
                                  : quarter.units;
  });
  return LawHeldOut{predictor.errors(folds(a.system, kept)), predictor.errors(parts)};
}

double averaged_over_parts(const Analysis& a, const WeighedLaw& law, double probability) {
  const KeptRows& kept = marginalised_system(a, law).kept;
  const std::vector<BedPart> parts = bed_parts(a.system, a.session.fewest_units);
  if (parts.empty()) return probability;
  const LawModel::Downdated with(model_with(a, law));
  const LawModel::Downdated without(model_without(a, law));
  const auto log_ratio = [&](const Rows& out) {
    return with.without(out).log_density - without.without(out).log_density;
  };
  const double of_all = log_ratio({});
  // Keeps the odds finite.
  const double sure = std::min(probability, 1.0 - 1e-15);
  const double log_odds = std::log(sure) - std::log1p(-sure);
  double sum = 0.0;
  for (const BedPart& part : parts) {
    const auto out = kept.positions(part.units);
    const double counts = as_double(kept.size()) / as_double(kept.size() - std::ssize(out));
    const double own = log_odds + counts * log_ratio(out) - of_all;
    sum += 1.0 / (1.0 + std::exp(-own));
  }
  return std::min(probability, sum / as_double(parts.size()));
}

}  // namespace chaintrue::grid::diagnosis
