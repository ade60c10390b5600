// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/synthetic/generator.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "grid/files/answer_file.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/machine_file.hpp"

namespace chaintrue::grid::synthetic {
namespace {

using model::AppliedEffect;
using model::BedPoint;
using model::Machine;
using model::MarkPoint;
using ::testing::HasSubstr;
using ::testing::SizeIs;

SyntheticSession session_of(const SyntheticSpec& spec, const Machine& machine = {}) {
  auto session = generate(machine, spec);
  EXPECT_TRUE(session.has_value());
  return session ? *session : SyntheticSession{};
}

double distance(const auto& a, const auto& b) {
  return std::hypot(a.x_mm - b.x_mm, a.y_mm - b.y_mm);
}

std::vector<Mark> marks_of(const Design& design) {
  Random random(1, 0);
  return marks(model::Bed{}, design, random);
}

TEST(Design, RegularGridHasRoundCoordinates) {
  const auto pattern = marks_of({});
  ASSERT_THAT(pattern, SizeIs(28));
  EXPECT_EQ(pattern.front().place.x_mm, -1200.0);
  EXPECT_EQ(pattern.front().place.y_mm, -600.0);
  EXPECT_NEAR(pattern[8].place.x_mm, -800.0, 1e-12);  // one rounding of 1200 * (2/3)
  EXPECT_NEAR(pattern[8].place.y_mm, -200.0, 1e-12);
  EXPECT_EQ(pattern.back().place.x_mm, 1200.0);
}

TEST(Design, ChebyshevSpacingIsDenserAtTheEdges) {
  Design design;
  design.kind = DesignKind::chebyshev;
  design.margin_mm = 19.2;
  const auto pattern = marks_of(design);
  ASSERT_THAT(pattern, SizeIs(28));
  for (int i = 0; i < 7; ++i) {
    // Chebyshev-Lobatto nodes -cos(pi i / 6), closed forms: 1, sqrt(3)/2, 1/2, 0.
    const double nodes[] = {-1.0, -std::sqrt(0.75), -0.5, 0.0, 0.5, std::sqrt(0.75), 1.0};
    EXPECT_NEAR(pattern[static_cast<std::size_t>(i)].place.x_mm, 1200.0 * nodes[i],
                1e-10);  // rounding
  }
}

TEST(Design, LeavesOutCornersAndHalves) {
  Design design;
  design.without_corners = true;
  EXPECT_THAT(marks_of(design), SizeIs(24));
  design.without_corners = false;
  design.region = Region::left;
  const auto left = marks_of(design);
  EXPECT_THAT(left, SizeIs(16));
  for (const Mark& mark : left) EXPECT_LE(mark.place.x_mm, 0.0);
}

TEST(Design, RandomMarksStayWithinTheBed) {
  Design design;
  design.kind = DesignKind::random;
  design.points = 500;
  design.region = Region::top;
  design.without_corners = true;
  for (const Mark& mark : marks_of(design)) {
    EXPECT_LE(std::abs(mark.place.x_mm), 1200.0);
    EXPECT_GE(mark.place.y_mm, 0.0);
    EXPECT_LE(mark.place.y_mm, 600.0);
    EXPECT_FALSE(std::abs(mark.place.x_mm) > 960.0 && mark.place.y_mm > 480.0);
  }
}

TEST(Design, RefusesInvalidDesigns) {
  Design design;
  design.columns = 1;
  EXPECT_THROW(static_cast<void>(marks_of(design)), std::invalid_argument);
  design.columns = 7;
  design.margin_mm = 700.0;
  EXPECT_THROW(static_cast<void>(marks_of(design)), std::invalid_argument);
}

/// Column and row of each mark.
std::string cells_of(VisitingOrder order) {
  Random random(4, 0);
  Design design;
  design.columns = 3;
  design.rows = 2;
  auto pattern = marks(model::Bed{}, design, random);
  put_in_order(pattern, order, random);
  std::string cells;
  for (const Mark& mark : pattern) cells += fmt::format("{}{} ", mark.column, mark.row);
  return cells;
}

TEST(VisitingOrder, GoesAlongRowsAndColumnsAndTurns) {
  EXPECT_EQ(cells_of(VisitingOrder::rows), "00 10 20 01 11 21 ");
  EXPECT_EQ(cells_of(VisitingOrder::serpentine_rows), "00 10 20 21 11 01 ");
  EXPECT_EQ(cells_of(VisitingOrder::columns), "00 01 10 11 20 21 ");
  EXPECT_EQ(cells_of(VisitingOrder::serpentine_columns), "00 01 11 10 20 21 ");
  const std::string any = cells_of(VisitingOrder::random);
  for (const char* cell : {"00 ", "10 ", "20 ", "01 ", "11 ", "21 "})
    EXPECT_THAT(any, HasSubstr(cell));
  EXPECT_EQ(any.size(), 18U);
}

TEST(Generator, EqualsTheReadingModelWithoutNoise) {
  SyntheticSpec spec;
  spec.hidden = {{"chain_pitch_error", "left", {{"elongation", 0.0012}}}};
  const SyntheticSession session = session_of(spec);
  Machine machine;
  machine.effects = spec.hidden;
  const model::ReadingModel model(machine);
  ASSERT_THAT(session.grid.points, SizeIs(28));
  for (const MeasuredPoint& point : session.grid.points) {
    const auto reading = model.at(model::identity_placement(point.mark));
    ASSERT_TRUE(reading);
    EXPECT_EQ(point.lengths->left_mm, reading->lengths.left_mm);
    EXPECT_EQ(point.lengths->right_mm, reading->lengths.right_mm);
  }
  EXPECT_FALSE(session.grid.noise.has_value());
}

TEST(Generator, WritesOnlyStatedNumbersToTheGrid) {
  SyntheticSpec spec;
  spec.hidden = {{"drift", "both", {{"rate_mm_per_visit", 0.03}}}};
  spec.offsets = {{model::Setting::motor_left_x_mm, 2.5}};
  Machine machine;
  machine.effects = {{"chain_sag", "", {{"relative_weight", 0.1}}}};
  const SyntheticSession session = session_of(spec, machine);
  EXPECT_EQ(files::write_machine(*session.grid.machine), files::write_machine(machine));
  EXPECT_THAT(session.answer.machine.effects, SizeIs(2));
  EXPECT_EQ(session.answer.machine.motors.left.x_mm, machine.motors.left.x_mm + 2.5);
}

SyntheticSpec busy_spec() {
  SyntheticSpec spec;
  spec.order = VisitingOrder::serpentine_columns;
  spec.repeats = 6;
  spec.jitter_mm = 8.0;
  spec.noise = {.length_mm = 0.2, .position_mm = 0.3, .heavy_tails = true};
  spec.bad = {.count = 2, .size_mm = 12.0};
  spec.hidden = {{"direction_hysteresis", "both", {{"half_width_mm", 0.3}}},
                 {"link_miscount", "right", {{"links", 1.0}, {"visit", 5.0}}}};
  spec.draw_settings = true;
  spec.sheet = SheetUncertainty{5.0, 2.0};
  return spec;
}

// Each kind of random number has its own stream.
TEST(Generator, ChangingOneChanceLeavesTheOthersAndAnotherSeedNone) {
  SyntheticSpec quiet = busy_spec();
  quiet.noise.length_mm = 0.0;
  const SyntheticSession a = session_of(busy_spec());
  const SyntheticSession b = session_of(quiet);
  for (std::size_t i = 0; i < a.grid.points.size(); ++i) {
    EXPECT_EQ(a.grid.points[i].mark.x_mm, b.grid.points[i].mark.x_mm);
    EXPECT_EQ(a.answer.lengths[i].left_mm, b.answer.lengths[i].left_mm);
  }
  EXPECT_EQ(a.answer.bad_points, b.answer.bad_points);
  quiet.seed = 2;
  EXPECT_NE(session_of(quiet).grid.points[0].mark.x_mm, b.grid.points[0].mark.x_mm);
}

TEST(Generator, RepeatsMeasuredMarksThroughoutTheSession) {
  SyntheticSpec spec;
  spec.repeats = 6;
  spec.jitter_mm = 8.0;
  const SyntheticSession session = session_of(spec);
  const auto& points = session.grid.points;
  ASSERT_THAT(points, SizeIs(34));
  std::vector<std::size_t> repeats;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i].order, static_cast<int>(i));
    for (std::size_t k = 0; k < i; ++k) {
      // Two visits of one mark are at most twice the jitter apart, two marks 400 mm less that.
      if (distance(points[i].mark, points[k].mark) <= 16.0) repeats.push_back(i);
    }
  }
  ASSERT_THAT(repeats, SizeIs(6));
  EXPECT_LT(repeats.front(), 8U);
  EXPECT_EQ(repeats.back(), 33U);
}

TEST(Generator, PutsTheSledDownBesideTheMark) {
  SyntheticSpec spec;
  spec.jitter_mm = 8.0;
  const SyntheticSession session = session_of(spec);
  const auto pattern = marks_of(spec.design);
  double farthest = 0.0;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    EXPECT_LE(distance(session.answer.places[i], pattern[i].place), 8.0);
    farthest = std::max(farthest, distance(session.answer.places[i], pattern[i].place));
    // Without noise the mark is at the tool's true position.
    EXPECT_EQ(distance(session.grid.points[i].mark, session.answer.places[i]), 0.0);
  }
  EXPECT_GT(farthest, 6.0);
}

TEST(Generator, NoiseHasTheStatedSize) {
  SyntheticSpec spec;
  spec.design.columns = 50;
  spec.design.rows = 40;
  spec.noise = {.length_mm = 0.2, .position_mm = 0.3};
  const SyntheticSession session = session_of(spec);
  double position = 0.0, length = 0.0;
  const auto& points = session.grid.points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const BedPoint place = session.answer.places[i];
    position += std::pow(points[i].mark.x_mm - place.x_mm, 2) +
                std::pow(points[i].mark.y_mm - place.y_mm, 2);
    length += std::pow(points[i].lengths->left_mm - session.answer.lengths[i].left_mm, 2) +
              std::pow(points[i].lengths->right_mm - session.answer.lengths[i].right_mm, 2);
  }
  const double count = 2.0 * static_cast<double>(points.size());
  const double four_errors = 4.0 / std::sqrt(2.0 * count);
  EXPECT_NEAR(std::sqrt(position / count), 0.3, 0.3 * four_errors);
  EXPECT_NEAR(std::sqrt(length / count), 0.2, 0.2 * four_errors);
  ASSERT_TRUE(session.grid.noise.has_value());
  EXPECT_EQ(session.grid.noise->length_mm, 0.2);
  EXPECT_EQ(session.grid.noise->position_mm, 0.3);
}

TEST(Generator, RoundsToTheTape) {
  SyntheticSpec spec;
  spec.jitter_mm = 8.0;
  spec.noise = {
      .length_mm = 0.2, .position_mm = 0.3, .length_rounding_mm = 0.1, .position_rounding_mm = 0.5};
  for (const MeasuredPoint& point : session_of(spec).grid.points) {
    EXPECT_EQ(point.mark.x_mm * 2.0, std::round(point.mark.x_mm * 2.0));
    EXPECT_EQ(point.mark.y_mm * 2.0, std::round(point.mark.y_mm * 2.0));
    EXPECT_EQ(point.lengths->left_mm, std::round(point.lengths->left_mm * 10.0) / 10.0);
  }
}

TEST(Generator, StatesWrongNoiseWhereAsked) {
  SyntheticSpec spec;
  spec.noise = {.length_mm = 0.2, .position_mm = 0.3};
  spec.stated = StatedNoise{0.1, 0.15, 30.0};
  const SyntheticSession session = session_of(spec);
  EXPECT_EQ(session.grid.noise->length_mm, 0.1);
  EXPECT_EQ(session.grid.noise->dof, 30.0);
}

TEST(Generator, ListsSlipsAndMiscountedLinks) {
  SyntheticSpec spec = busy_spec();
  const SyntheticSession session = session_of(spec);
  std::set<std::size_t> bad(session.answer.bad_points.begin(), session.answer.bad_points.end());
  EXPECT_EQ(bad.count(5), 1U);
  EXPECT_THAT(session.answer.bad_points, SizeIs(::testing::AnyOf(2, 3)));
  spec.noise = {};
  spec.hidden.clear();
  spec.sheet.reset();
  const SyntheticSession slips = session_of(spec);
  ASSERT_THAT(slips.answer.bad_points, SizeIs(2));
  for (std::size_t i = 0; i < slips.grid.points.size(); ++i) {
    const bool is_bad = slips.answer.bad_points[0] == i || slips.answer.bad_points[1] == i;
    EXPECT_NEAR(distance(slips.grid.points[i].mark, slips.answer.places[i]), is_bad ? 12.0 : 0.0,
                1e-9);  // rounding
  }
}

TEST(Generator, WritesThePaperInTheSheetsFrame) {
  SyntheticSpec spec;
  spec.hidden = {{"tape_scale", "x", {{"scale", 0.001}}}};
  spec.offsets = {{model::Setting::sheet_x_mm, 12.0},
                  {model::Setting::sheet_y_mm, -7.0},
                  {model::Setting::sheet_rotation_rad, 0.005}};
  const SyntheticSession session = session_of(spec);
  for (std::size_t i = 0; i < session.grid.points.size(); ++i) {
    const MarkPoint mark = session.grid.points[i].mark;
    const double x = mark.x_mm / 1.001;
    // bed = shift + R sheet, rounding of numbers of 1200
    EXPECT_NEAR(session.answer.places[i].x_mm,
                12.0 + std::cos(0.005) * x - std::sin(0.005) * mark.y_mm, 1e-11);
    EXPECT_NEAR(session.answer.places[i].y_mm,
                -7.0 + std::sin(0.005) * x + std::cos(0.005) * mark.y_mm, 1e-11);
  }
}

TEST(Generator, AddsAnUnmodelledDisturbance) {
  SyntheticSpec spec;
  const SyntheticSession plain = session_of(spec);
  spec.unmodelled_mm = 0.8;
  const SyntheticSession disturbed = session_of(spec);
  double largest = 0.0;
  for (std::size_t i = 0; i < plain.grid.points.size(); ++i) {
    const double added =
        disturbed.grid.points[i].lengths->left_mm - plain.grid.points[i].lengths->left_mm;
    // Rounding of lengths of 3000 mm.
    EXPECT_NEAR(added, 0.8 * unmodelled(plain.answer.places[i]).left_mm, 1e-12);
    largest = std::max(largest, std::abs(added));
  }
  EXPECT_GT(largest, 0.4);
  EXPECT_LE(largest, 0.8);
}

TEST(Generator, NamesTheMarkThatCannotBeReached) {
  SyntheticSpec spec;
  spec.design.kind = DesignKind::given;
  spec.design.given = {{0.0, 0.0}, {0.0, 1500.0}};
  const auto session = generate(Machine{}, spec);
  ASSERT_FALSE(session);
  EXPECT_EQ(session.error().place.y_mm, 1500.0);
  EXPECT_EQ(session.error().reason, model::PoseReason::above_sprockets);
}

TEST(ReadPlaces, SkipsUnreachablePlacesAndNumbersVisits) {
  const std::vector<AppliedEffect> drift = {{"drift", "left", {{"rate_mm_per_visit", 1.0}}}};
  const std::vector<model::Visit> visits = {{{0.0, 0.0}, 0}, {{0.0, 1500.0}, 1}, {{0.0, 0.0}, 2}};
  const PlacesRead read = read_places(Machine{}, drift, visits);
  ASSERT_THAT(read.unreachable, SizeIs(1));
  EXPECT_EQ(read.unreachable[0].first, 1U);
  ASSERT_THAT(read.grid.points, SizeIs(2));
  EXPECT_EQ(read.grid.points[1].order, 2);
  EXPECT_EQ(read.grid.points[1].lengths->left_mm - read.grid.points[0].lengths->left_mm, 2.0);
}

}  // namespace
}  // namespace chaintrue::grid::synthetic
