// SPDX-License-Identifier: GPL-3.0-or-later
/// Laws of every kind of observation: a line in kinds.def without a simulation here fails.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "grid/files/machine_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/observation/belt_lengths.hpp"
#include "grid/observation/chain_lengths.hpp"
#include "grid/observation/drawn_measures.hpp"
#include "grid/observation/single_readings.hpp"
#include "grid/observation/tape_distances.hpp"
#include "grid/random.hpp"
#include "grid/synthetic/generator.hpp"
#include "grid/synthetic/holes.hpp"
#include "model/belts/belt_mechanism.hpp"
#include "model/plotter/plotter_mechanism.hpp"
#include "model/reading_model.hpp"
#include "tests/support/belt_frame.hpp"

namespace chaintrue::grid::observation {
namespace {

const model::Machine& classic() {
  static const model::Machine machine =
      files::read(files::parse_machine, std::string(CHAINTRUE_FIXTURES) + "/machines/classic.json")
          .machine;
  return machine;
}

/// Simulated readings of `classic`, which is exactly as stated. `slip` adds an error of many sigmas
/// to one of them; `turn` changes the order in the file.
struct Wanted {
  std::uint64_t seed = 1;
  bool exact = false;  ///< without noise; the kind's derivatives are then those of exact readings
  bool slip = false;
  bool turn = false;
};
using Simulate = std::function<std::shared_ptr<const Observation>(const Wanted&)>;

constexpr std::size_t kSpoilt = 5;

template <class T>
void turn_over(std::vector<T>& items, const Wanted& wanted) {
  if (wanted.turn) std::reverse(items.begin(), items.end());
}

std::shared_ptr<const Observation> marks(const Wanted& wanted) {
  synthetic::SyntheticSpec spec;
  spec.noise = {.length_mm = 0.2, .position_mm = 0.3};
  spec.seed = wanted.seed;
  const auto session = synthetic::generate(classic(), spec);
  std::vector<Place> places;
  for (std::size_t i = 0; i < session->grid.points.size(); ++i) {
    const MeasuredPoint& point = session->grid.points[i];
    places.push_back({i, std::to_string(i + 1), point.mark, *point.lengths, *point.order});
  }
  if (wanted.slip) places[kSpoilt].mark.x_mm += 20.0;
  turn_over(places, wanted);
  for (std::size_t i = 0; i < places.size(); ++i) places[i].index = i;
  return std::make_shared<ChainLengthReadings>(std::move(places), true, PointNoise{0.2, 0.3}, 15.0,
                                               SheetPrior{20.0, 0.01});
}

MeasuredHoles holes_design() {
  MeasuredHoles set;
  set.machine = classic();
  set.tape.tape_zero_offset_sigma_mm = 0.4;
  const double x[] = {-900, 0, 900};
  const double y[] = {-450, 0, 450};
  for (const double at_y : y) {
    for (const double at_x : x) {
      set.holes.push_back(
          {std::string(1, static_cast<char>('A' + set.holes.size())), {at_x, at_y}});
    }
  }
  for (std::size_t i = 0; i < set.holes.size(); ++i) {
    for (std::size_t j = i + 1; j < set.holes.size(); j += 2) {
      set.distances.push_back({.from = i, .to = j});
    }
  }
  set.distances.push_back({.from = 0, .edge = SheetEdge::left});
  set.distances.push_back({.from = 6, .edge = SheetEdge::left});
  set.distances.push_back({.from = 8, .edge = SheetEdge::top});
  return set;
}

std::shared_ptr<const Observation> holes(const Wanted& wanted) {
  MeasuredHoles design = holes_design();
  auto made = synthetic::simulate_holes(design, {.seed = wanted.seed});
  Random random(wanted.seed, 77);
  MeasuredHoles set = made->set;
  const double tape_zero = 0.4 * random.normal();
  const double wider[] = {random.normal(), random.normal()};
  for (HoleDistance& distance : set.distances) {
    distance.distance_mm += tape_zero;
    if (distance.edge)
      distance.distance_mm += 0.5 * wider[*distance.edge == SheetEdge::top ? 1 : 0];
  }
  if (wanted.slip) set.distances[kSpoilt].distance_mm += 20.0;
  if (wanted.turn) {
    const std::size_t last = set.holes.size() - 1;
    std::reverse(set.holes.begin(), set.holes.end());
    for (HoleDistance& distance : set.distances) {
      distance.from = last - distance.from;
      if (!distance.edge) distance.to = last - distance.to;
    }
  }
  turn_over(set.distances, wanted);
  return std::make_shared<TapeDistances>(*TapeDistances::of(set));
}

std::shared_ptr<const Observation> parts(const Wanted& wanted) {
  Random random(wanted.seed, 78);
  std::vector<ExtraReading> readings = {
      {ReadingOf::motor_spacing, "", 0.0, 1.0}, {ReadingOf::beam_rise, "", 0.0, 0.5},
      {ReadingOf::ring_radius, "", 0.0, 0.5},   {ReadingOf::link_pitch, "left", 0.0, 0.001},
      {ReadingOf::chain_mass, "", 0.0, 0.002},  {ReadingOf::tape_error, "x", 0.0, 0.2}};
  for (ExtraReading& reading : readings) {
    reading.value = predicted_reading(classic(), reading) + reading.sigma * random.normal();
  }
  turn_over(readings, wanted);
  return std::make_shared<SingleReadings>(std::move(readings));
}

const std::shared_ptr<const model::Mechanism>& four_belts() {
  static const std::shared_ptr<const model::Mechanism> mechanism =
      model::make_belt_mechanism(testing_support::stated());
  return mechanism;
}

/// Unknown positions, one of them with a reading that does not count; two known ones.
std::shared_ptr<const Observation> belts_at_places(const Wanted& wanted) {
  constexpr BeltNoise kNoise{.length_mm = 0.5, .position_mm = 0.3};
  Random random(wanted.seed, 79);
  const auto normal = [&] { return wanted.exact ? 0.0 : random.normal(); };
  std::vector<LengthsAtPlace> places;
  for (const double y : {700.0, 1050.0, 1400.0}) {
    for (const double x : {800.0, 1300.0, 1700.0, 2200.0}) {
      const std::size_t i = places.size();
      const model::ToolPosition at{x + random.uniform(-5.0, 5.0), y + random.uniform(-5.0, 5.0)};
      LengthsAtPlace place{
          i, std::to_string(i + 1), four_belts()->predict(at, {})->lengths_mm, {}, {}};
      for (double& length : place.lengths_mm) length += kNoise.length_mm * normal();
      place.visit.order = static_cast<int>(i);
      if (i == 7) place.counting = {true, true, false, true};
      if (i == 2 || i == 9) {
        place.known = {at.x_mm + kNoise.position_mm * normal(),
                       at.y_mm + kNoise.position_mm * normal()};
      }
      places.push_back(std::move(place));
    }
  }
  if (wanted.slip) places[kSpoilt].lengths_mm[2] += 20.0;
  turn_over(places, wanted);
  for (std::size_t i = 0; i < places.size(); ++i) places[i].index = i;
  return std::make_shared<BeltLengthReadings>(std::move(places), true, kNoise, 15.0);
}

const std::shared_ptr<const model::Mechanism>& plotter() {
  static const std::shared_ptr<const model::Mechanism> mechanism =
      model::make_plotter_mechanism(model::mural(1500.0));
  return mechanism;
}

/// Nine crosses that a plotter drew, lengths between all of them and the bows of their rows.
std::shared_ptr<const Observation> drawing(const Wanted& wanted) {
  std::vector<DrawnPoint> points;
  for (const double y : {-400.0, -800.0, -1300.0}) {
    for (const double x : {-420.0, 20.0, 400.0}) {
      const auto at = plotter()->predict({x, y}, {});
      points.push_back({std::string(1, static_cast<char>('A' + points.size())),
                        {x, y},
                        {at->lengths_mm[0], at->lengths_mm[1]}});
    }
  }
  std::vector<DrawnMeasure> measures;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); j += 2)
      measures.push_back({DrawnMeasure::Kind::length, i, j, 0, 0.0, 0.5});
  }
  for (const std::size_t row : {0U, 3U, 6U})
    measures.push_back({DrawnMeasure::Kind::bow, row, row + 2, row + 1, 0.0, 0.3});
  const DrawnMeasures exact(points, measures, 15.0);
  const Eigen::VectorXd rows = *exact.predicted(View(plotter()));
  Random random(wanted.seed, 80);
  for (const Unit& unit : exact.units())
    measures[unit.index].value_mm =
        rows[unit.first_row] + measures[unit.index].sigma_mm * random.normal();
  if (wanted.slip) measures[kSpoilt].value_mm += 20.0;
  turn_over(measures, wanted);
  return std::make_shared<DrawnMeasures>(std::move(points), std::move(measures), 15.0);
}

const std::map<std::string_view, Simulate>& simulations() {
  static const std::map<std::string_view, Simulate> kSimulations = {
      {"chain_lengths", marks},
      {"tape_distances", holes},
      {"single_readings", parts},
      {"belt_lengths", belts_at_places},
      {"drawn_measures", drawing}};
  return kSimulations;
}

class EveryObservation : public testing::TestWithParam<const Kind*> {
 protected:
  std::shared_ptr<const Observation> simulated(const Wanted& wanted = {}) const {
    const auto found = simulations().find(GetParam()->id);
    if (found == simulations().end()) {
      throw std::logic_error("no simulation of " + std::string(GetParam()->id));
    }
    return found->second(wanted);
  }
  static std::shared_ptr<const model::Mechanism> mechanism() {
    if (GetParam()->id == "belt_lengths") return four_belts();
    if (GetParam()->id == "drawn_measures") return plotter();
    return model::make_chain_mechanism(classic());
  }
  static View as_stated() { return View(mechanism()); }
};

constexpr Columns kAllColumns{.parameters = true, .sheet = true};

TEST_P(EveryObservation, UnitsCoverTheRowsAndHaveDescriptions) {
  const auto observation = simulated();
  EXPECT_EQ(&observation->kind(), GetParam());
  EXPECT_EQ(observation->measured().size(), observation->rows());
  Eigen::Index row = 0;
  for (std::size_t u = 0; u < observation->units().size(); ++u) {
    EXPECT_EQ(observation->units()[u].first_row, row);
    row += observation->units()[u].rows;
    EXPECT_FALSE(observation->name_of(u).empty());
  }
  EXPECT_EQ(row, observation->rows());
  EXPECT_GT(observation->noise_dof(), 0.0);
  const auto line = observation->linearise(as_stated(), kAllColumns);
  ASSERT_TRUE(line);
  EXPECT_EQ(line->units.size(), observation->units().size());
  EXPECT_EQ(line->places.size(), line->places.empty() ? 0 : observation->places().size());
  EXPECT_EQ(line->by_nuisance.cols(), observation->nuisance_sigma().size());
  EXPECT_EQ(GetParam()->place.empty(), observation->places().empty());
}

TEST_P(EveryObservation, DerivativesBySettingAreDifferences) {
  const auto observation = simulated({.exact = true});
  const model::SheetPlacement sheet{3.0, -2.0, 0.004};
  const auto line = observation->linearise({mechanism(), sheet}, kAllColumns);
  ASSERT_TRUE(line);
  const Eigen::Index parameters = mechanism()->values().size();
  ASSERT_EQ(line->by_setting.cols(), parameters + 3);
  for (Eigen::Index s = 0; s < line->by_setting.cols(); ++s) {
    SCOPED_TRACE(s < parameters
                     ? std::string(mechanism()->parameters()[static_cast<std::size_t>(s)].name)
                     : "of the sheet: " + std::to_string(s - parameters));
    const bool turn = s == parameters + 2;
    const double step = turn ? 1e-5 : 1e-2;
    const auto predicted_at = [&](double change) -> Eigen::VectorXd {
      View view(mechanism(), sheet);
      if (s < parameters) {
        view.mechanism = mechanism()->with_values(mechanism()->values() +
                                                  change * Eigen::VectorXd::Unit(parameters, s));
      } else {
        double* const value[] = {&view.sheet.x_mm, &view.sheet.y_mm, &view.sheet.rotation_rad};
        *value[s - parameters] += change;
      }
      return *observation->predicted(view);
    };
    const Eigen::VectorXd by_difference = (predicted_at(step) - predicted_at(-step)) / (2.0 * step);
    // The error of a central difference is step^2 / 6 times the third derivative, some 1e-6 per
    // mm^2, plus rounding, 1e-9 mm over the step.
    EXPECT_LT((line->by_setting.col(s) - by_difference).cwiseAbs().maxCoeff(), turn ? 2e-3 : 1e-6);
  }
}

/// Adds c to the chains in the neighbourhood of one position.
class AtOnePlace final : public LengthCorrection {
 public:
  AtOnePlace(model::MarkPoint centre, model::ChainLengths c) : centre_(centre), c_(c) {}
  At at(model::MarkPoint mark, model::ChainLengths lengths,
        const Eigen::Matrix2d& by_mark) const override {
    const bool near = std::hypot(mark.x_mm - centre_.x_mm, mark.y_mm - centre_.y_mm) < 50.0;
    if (near) lengths = {lengths.left_mm + c_.left_mm, lengths.right_mm + c_.right_mm};
    return {lengths, by_mark};
  }

 private:
  model::MarkPoint centre_;
  model::ChainLengths c_;
};

TEST_P(EveryObservation, CommandedLengthsMoveAUnitAsItsColumns) {
  const auto observation = simulated();
  const auto line = observation->linearise(as_stated(), {});
  ASSERT_TRUE(line);
  for (std::size_t i = 0; i < line->places.size(); ++i) {
    for (const Eigen::Vector2d& c : {Eigen::Vector2d(1e-2, 0.0), Eigen::Vector2d(0.0, 1e-2)}) {
      View with = as_stated();
      const AtOnePlace plus(line->places[i].mark, {c.x(), c.y()});
      const AtOnePlace minus(line->places[i].mark, {-c.x(), -c.y()});
      with.correction = &plus;
      Eigen::VectorXd change = *observation->predicted(with);
      with.correction = &minus;
      change = 0.5 * (change - *observation->predicted(with));
      for (std::size_t u = 0; u < line->units.size(); ++u) {
        const Unit& unit = observation->units()[u];
        Eigen::VectorXd expected = Eigen::VectorXd::Zero(unit.rows);
        for (const PlaceColumns& columns : line->units[u].places) {
          if (columns.place == i) expected += columns.by_chain * c;
        }
        // As for the settings: third derivatives, and poses to 1e-9 mm.
        EXPECT_LT((change.segment(unit.first_row, unit.rows) - expected).cwiseAbs().maxCoeff(),
                  2e-8)
            << observation->name_of(u);
      }
    }
  }
}

TEST_P(EveryObservation, WhitenedResidualsOfGeneratedDataHaveUnitVariance) {
  constexpr std::uint64_t kSessions = 150;
  double square = 0.0;
  double count = 0.0;
  for (std::uint64_t seed = 1; seed <= kSessions; ++seed) {
    const auto observation = simulated({.seed = seed});
    const auto line = observation->linearise(as_stated(), {});
    ASSERT_TRUE(line);
    const Eigen::VectorXd residual = observation->measured() - line->predicted;
    square += residual.dot(
        marginal_covariance(*line, observation->nuisance_sigma()).llt().solve(residual));
    count += static_cast<double>(residual.size());
  }
  // Chi-square of `count` degrees of freedom; four of its standard deviations, 1 in 16 000.
  EXPECT_NEAR(square / count, 1.0, 4.0 * std::sqrt(2.0 / count)) << "seeds 1 to " << kSessions;
}

TEST_P(EveryObservation, TheOrderOfTheFileChangesNothing) {
  const auto one = simulated();
  const auto other = simulated({.turn = true});
  const auto a = one->linearise(as_stated(), kAllColumns);
  const auto b = other->linearise(as_stated(), kAllColumns);
  ASSERT_TRUE(a && b);
  // To the last bit.
  EXPECT_EQ(one->measured(), other->measured());
  EXPECT_EQ(a->predicted, b->predicted);
  EXPECT_EQ(a->by_setting, b->by_setting);
  EXPECT_EQ(a->by_nuisance, b->by_nuisance);
  EXPECT_EQ(*one->predicted(as_stated()), *other->predicted(as_stated()));
  const std::size_t last = one->units().size() - 1;
  for (std::size_t u = 0; u <= last; ++u) {
    EXPECT_EQ(one->name_of(u), other->name_of(u));
    if (GetParam()->id != "single_readings") {
      EXPECT_EQ(one->units()[u].index, last - other->units()[u].index);
    }
  }
}

TEST_P(EveryObservation, ABadUnitIsFound) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto observation = simulated({.seed = seed, .slip = true});
    if (!observation->may_be_outlier()) return;
    const auto line = observation->linearise(as_stated(), {});
    ASSERT_TRUE(line);
    const Eigen::MatrixXd precision =
        marginal_covariance(*line, observation->nuisance_sigma())
            .llt()
            .solve(Eigen::MatrixXd::Identity(observation->rows(), observation->rows()));
    const Eigen::VectorXd pulled = precision * (observation->measured() - line->predicted);
    double worst = -1.0;
    std::size_t found = 0;
    for (const Unit& unit : observation->units()) {
      const auto own = pulled.segment(unit.first_row, unit.rows);
      const Eigen::MatrixXd block =
          precision.block(unit.first_row, unit.first_row, unit.rows, unit.rows);
      const double distance = own.dot(block.llt().solve(Eigen::VectorXd(own)));
      if (distance <= worst) continue;
      worst = distance;
      found = unit.index;
    }
    EXPECT_EQ(found, kSpoilt) << "seed " << seed;
  }
}

TEST_P(EveryObservation, EveryEffectIsShownOrRefusedWithASentence) {
  const auto observation = simulated();
  for (const Kind* kind : kinds()) EXPECT_FALSE(kind->units.empty());
  model::effects::Effect nothing;
  nothing.needs = model::effects::DataNeed::order;
  if (!observation->ordered()) {
    EXPECT_FALSE(observation->untestable(nothing, model::effects::EffectSide::none).empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryObservation, testing::ValuesIn(kinds()),
                         [](const auto& kind) { return std::string(kind.param->id); });

}  // namespace
}  // namespace chaintrue::grid::observation
