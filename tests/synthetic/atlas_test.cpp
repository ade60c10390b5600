// SPDX-License-Identifier: GPL-3.0-or-later
// Every picture of the atlas: where a line is drawn, the machine with the cause reads what the
// controller paid out for the command.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/synthetic/atlas.hpp"
#include "grid/synthetic/simulated_belts.hpp"
#include "model/belts/belt_mechanism.hpp"
#include "model/effects/catalogue.hpp"
#include "model/plotter/plotter_mechanism.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid::synthetic::atlas_tests {
namespace {

using model::Mechanism;
using model::MechanismVisit;
using model::ToolPosition;
using MechanismPointer = std::shared_ptr<const Mechanism>;

MechanismPointer classic() {
  return model::make_chain_mechanism(
      files::read(files::parse_machine, std::string(CHAINTRUE_FIXTURES) + "/machines/classic.json")
          .machine);
}

/// A pen on two cords from spools, so that effects of pulleys act too; heavy elastic cords, so that
/// forces move the pen.
MechanismPointer point_plotter() {
  model::PlotterMachine machine;
  machine.pulley_radius_mm = 10.0;
  machine.cord = {.mass_kg_per_m = 0.01, .compliance_per_n = 1e-4};
  return model::make_plotter_mechanism(machine);
}

MechanismPointer mural() { return model::make_plotter_mechanism(model::mural(1500.0)); }

model::BeltMachine belt_frame() {
  model::BeltMachine machine;
  machine.anchors.tl = {-20.0, 2150.0, 100.0};
  machine.anchors.tr = {3010.0, 2140.0, 56.0};
  machine.anchors.br = {2990.0, 0.0, 78.0};
  machine.anchors_known = true;
  return machine;
}

const Atlas& atlas_of_kind(const std::string& kind) {
  static std::map<std::string, Atlas> made;
  if (!made.contains(kind)) {
    made[kind] = kind == "chains"  ? atlas_of(*classic())
                 : kind == "point" ? atlas_of(*point_plotter())
                 : kind == "mural" ? atlas_of(*mural())
                                   : atlas_of(belt_frame());
  }
  return made[kind];
}

MechanismPointer mechanism_of_kind(const std::string& kind) {
  if (kind == "chains") return classic();
  if (kind == "point") return point_plotter();
  return kind == "mural" ? mural() : model::make_belt_mechanism(belt_frame());
}

model::AppliedEffect effect_of(const AtlasPicture& picture, double size) {
  std::vector<double> values = nominal_values(*picture.effect);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (picture.effect->parameters[i].name == picture.parameter) values[i] = size;
  }
  return model::effects::applied(*picture.effect, picture.side, values);
}

MechanismPointer with_cause(const Mechanism& mechanism, const AtlasPicture& picture, double size) {
  if (picture.effect != nullptr) return mechanism.with_effects({effect_of(picture, size)});
  Eigen::VectorXd values = mechanism.values();
  for (std::size_t k = 0; k < mechanism.parameters().size(); ++k) {
    if (mechanism.parameters()[k].name == picture.parameter)
      values[static_cast<Eigen::Index>(k)] += size;
  }
  return mechanism.with_values(values);
}

std::string name_of(const AtlasPicture& picture) {
  const std::string_view id = picture.effect == nullptr ? picture.parameter : picture.effect->id;
  return std::string(id) + " " + std::string(name(picture.side));
}

/// For each kind of machine; an atlas is made once a process.
class EveryPicture : public ::testing::TestWithParam<const char*> {};

/// The planar distance of an anchor, the length that a Maslow 4 prints.
double span(const model::Anchor& anchor, double x, double y) {
  return std::hypot(x - anchor.x_mm, y - anchor.y_mm);
}

/// The belts controller's anchors while it draws: those set, or those that it found.
model::BeltMachine believed(const AtlasPicture& picture, double size) {
  if (picture.effect == nullptr) return belt_frame();
  BeltsSpec spec;
  spec.columns = spec.rows = 6;
  spec.noise_mm = 0.0;
  spec.hidden = {effect_of(picture, size)};
  const MeasuredBelts session = simulate_belts(belt_frame(), belt_frame(), spec).value();
  const belts::Counting all(session.points.size(), belts::kAllBelts);
  const auto found =
      belts::fit_anchors_from(session, {belts::anchors_of(belt_frame()), 0.0, {}}, all);
  return belts::with_anchors(belt_frame(), found.value().state.anchors);
}

/// The direction of each length along a line; its first point is reached in the line's direction.
std::vector<double> ways(const Mechanism& set, const AtlasLine& line, std::size_t i) {
  const std::size_t to = std::max<std::size_t>(i, 1);
  const auto from = set.predict(line.points[to - 1], {});
  const auto at = set.predict(line.points[to], {});
  return {at->lengths_mm[0] < from->lengths_mm[0] ? -1.0 : 1.0,
          at->lengths_mm[1] < from->lengths_mm[1] ? -1.0 : 1.0};
}

/// The largest difference of what is read where a frame was drawn to what was paid out, mm.
double worst_of_two(const Mechanism& set, const Mechanism& actual, const Atlas& atlas,
                    const AtlasFrame& frame) {
  double worst = 0.0;
  for (std::size_t k = 0; k < atlas.lines.size(); ++k) {
    for (std::size_t i = 0; i < atlas.lines[k].points.size(); ++i) {
      if (!frame.lines[k][i]) continue;
      const MechanismVisit visit{.order = static_cast<int>(k),
                                 .direction = ways(set, atlas.lines[k], i)};
      const auto paid_out = set.predict(atlas.lines[k].points[i], {});
      const auto read = actual.predict(actual.place_of_mark(*frame.lines[k][i]), visit);
      worst = std::max(worst, (read->lengths_mm - paid_out->lengths_mm).cwiseAbs().maxCoeff());
    }
  }
  return worst;
}

double worst_of_belts(const model::BeltMachine& set, const model::BeltMechanism& actual,
                      const Atlas& atlas, const AtlasFrame& frame) {
  const auto set_centre = model::centre_of(set);
  const auto centre = model::centre_of(actual.machine());
  double worst = 0.0;
  for (std::size_t k = 0; k < atlas.lines.size(); ++k) {
    for (std::size_t i = 0; i < atlas.lines[k].points.size(); ++i) {
      if (!frame.lines[k][i]) continue;
      const ToolPosition& command = atlas.lines[k].points[i];
      const double x = set_centre.x_mm + command.x_mm, y = set_centre.y_mm + command.y_mm;
      const ToolPosition drawn{centre.x_mm + frame.lines[k][i]->x_mm,
                               centre.y_mm + frame.lines[k][i]->y_mm};
      const auto read = actual.predict(drawn, {.order = kAtlasPlaces + static_cast<int>(k)});
      worst = std::max({worst, std::abs(read->lengths_mm[0] - span(set.anchors.tl, x, y)),
                        std::abs(read->lengths_mm[1] - span(set.anchors.tr, x, y))});
    }
  }
  return worst;
}

double share_drawn(const AtlasFrame& frame) {
  double drawn = 0.0, all = 0.0;
  for (const auto& line : frame.lines) {
    all += static_cast<double>(line.size());
    for (const auto& point : line) drawn += point ? 1.0 : 0.0;
  }
  return drawn / all;
}

TEST_P(EveryPicture, MatchesTheMachineWithTheCause) {
  const Atlas& atlas = atlas_of_kind(GetParam());
  const MechanismPointer set = mechanism_of_kind(GetParam());
  for (const AtlasPicture& picture : atlas.pictures) {
    SCOPED_TRACE(name_of(picture));
    ASSERT_FALSE(picture.frames.empty());
    // The first frame and the usual one show the sign and the size.
    for (const std::size_t at : {std::size_t{0}, picture.usual}) {
      const AtlasFrame& frame = picture.frames[at];
      SCOPED_TRACE(frame.size);
      ASSERT_EQ(frame.lines.size(), atlas.lines.size());
      // Lines end where the machine cannot hold the tool: a tenth of them at most.
      EXPECT_GT(share_drawn(frame), 0.9);
      const MechanismPointer actual = with_cause(*set, picture, frame.size);
      if (std::string(GetParam()) != "belts") {
        // Newton's method ends at 1e-9 mm; numbers on the paper are inverted to as much.
        EXPECT_LT(worst_of_two(*set, *actual, atlas, frame), 1e-6);
      } else {
        // Anchors of the estimator are within 1e-6 of their sigmas, of some millimetres here.
        EXPECT_LT(worst_of_belts(believed(picture, frame.size),
                                 dynamic_cast<const model::BeltMechanism&>(*actual), atlas, frame),
                  1e-3);
      }
    }
  }
}

TEST_P(EveryPicture, ShowsTheUsualSizeAndMovesSomeLine) {
  for (const AtlasPicture& picture : atlas_of_kind(GetParam()).pictures) {
    SCOPED_TRACE(name_of(picture));
    ASSERT_LT(picture.usual, picture.frames.size());
    for (std::size_t i = 1; i < picture.frames.size(); ++i)
      EXPECT_LT(picture.frames[i - 1].size, picture.frames[i].size);
    // A pen's line is half a millimetre wide; shifts below a hundredth of it are not drawn.
    EXPECT_GT(picture.largest_shift_mm, 0.01);
    if (picture.effect == nullptr) continue;
    for (const auto& parameter : picture.effect->parameters) {
      if (parameter.name != picture.parameter) continue;
      EXPECT_EQ(picture.frames[picture.usual].size, parameter.nominal);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Atlas, EveryPicture,
                         ::testing::Values("chains", "point", "mural", "belts"),
                         [](const auto& tested) { return std::string(tested.param); });

/// Every effect of the catalogue that can act has a picture of each of its sides.
TEST(AtlasOf, EachMechanismHasItsSettingsAndItsCatalogue) {
  for (const char* kind : {"chains", "point", "mural", "belts"}) {
    SCOPED_TRACE(kind);
    const MechanismPointer mechanism = mechanism_of_kind(kind);
    std::size_t expected = mechanism->parameters().size();
    for (const model::effects::Effect* effect : mechanism->effects()) {
      for (const auto side : effect->sides) {
        const auto applied = model::effects::applied(*effect, side, nominal_values(*effect));
        expected += mechanism->problems_of_effects({applied}).empty() ? 1 : 0;
      }
    }
    EXPECT_EQ(atlas_of_kind(kind).pictures.size(), expected);
    EXPECT_TRUE(atlas_of_kind(kind).not_drawn.empty());
  }
}

TEST(AtlasOf, RefusesUnknownAnchors) {
  EXPECT_THROW((void)atlas_of(model::BeltMachine{}), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::grid::synthetic::atlas_tests
