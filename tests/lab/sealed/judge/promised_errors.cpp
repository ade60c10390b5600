// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/promised_errors.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "generator/hidden/draw.hpp"
#include "grid/belts/belts_error.hpp"
#include "grid/containers.hpp"
#include "grid/diagnosis/anchors_with_causes.hpp"
#include "grid/diagnosis/causes_fit.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/map/controller_error.hpp"
#include "grid/map/map_for_settings.hpp"
#include "grid/map/settings_to_type.hpp"
#include "grid/plotter/plotter_map.hpp"
#include "interp/measured_region.hpp"
#include "sealed/judge/belts_trial.hpp"
#include "sealed/judge/map_errors.hpp"
#include "sealed/judge/plotter_sets.hpp"
#include "tools/gcode/expected_error.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Lengths;
using generator::TrueMachine;
using generator::Vec2;
using model::ControllerSettings;

constexpr double kBedWidthMm = 2438.4;
constexpr double kBedHeightMm = 1219.2;

/// An owner's settings for the machine as known; the sag for its weights.
ControllerSettings settings_of(const TrueMachine& stated) {
  ControllerSettings s;
  s.bed_width_mm = kBedWidthMm;
  s.bed_height_mm = kBedHeightMm;
  s.motor_spacing_mm = stated.axis[1].x - stated.axis[0].x;
  s.motor_offset_y_mm = 0.5 * (stated.axis[0].y + stated.axis[1].y) - 0.5 * kBedHeightMm;
  s.rotation_radius_mm = stated.ring_radius_mm;
  s.chain_sag_correction = 6.07;
  s.left_chain_tolerance_percent = s.right_chain_tolerance_percent = 0.0;
  s.chain_pitch_mm = stated.pitch_mm;
  s.gear_teeth = stated.teeth;
  s.chain_over_sprocket_top = stated.over_top;
  return s;
}

/// MaslowCNC/Firmware, Kinematics.cpp, triangularInverse, chains over the top.
Lengths firmware(const ControllerSettings& s, Vec2 command) {
  const double radius = *s.chain_pitch_mm * *s.gear_teeth / (2.0 * std::numbers::pi);
  const double down = 0.5 * *s.bed_height_mm + *s.motor_offset_y_mm - command.y;
  std::array<double, 2> angle{}, straight{};
  for (const std::size_t i : {0, 1}) {
    const double across = command.x + (i == 0 ? 0.5 : -0.5) * *s.motor_spacing_mm;
    const double apart = std::hypot(across, down);
    angle[i] = std::asin(down / apart) + std::asin(radius / apart);
    straight[i] = std::sqrt(apart * apart - radius * radius);
  }
  Lengths lengths{};
  for (const std::size_t i : {0, 1}) {
    const double c = std::cos(angle[i]);
    const double pull = std::tan(angle[1 - i]) * c + std::sin(angle[i]);
    const double sag = 1e-12 * *s.chain_sag_correction * std::pow(c * straight[i] * pull, 2);
    const double tolerance =
        i == 0 ? *s.left_chain_tolerance_percent : *s.right_chain_tolerance_percent;
    lengths[i] = radius * angle[i] + straight[i] * (1.0 + sag) / (1.0 + tolerance / 100.0) -
                 *s.rotation_radius_mm;
  }
  return lengths;
}

const std::string kBelts = "belts:places";
const std::string kPlotters = "plotters";

generator::Recipe recipe_of(const Outcome& outcome) {
  generator::Recipe recipe;
  if (outcome.way() == "start")
    recipe = recipe_of_start();
  else
    recipe.points = number_of<int>(outcome.way());
  const std::string machine = outcome.group();
  if (machine == "worn_chain") {
    recipe.exactly = {{generator::Cause::chain_pitch_error, generator::Where::right, 0.0015, 0.0}};
  } else if (machine == "bending_beam") {
    const generator::CauseCard& beam = generator::card(generator::Cause::beam_flex);
    recipe.exactly = {{beam.cause, generator::Where::nowhere, beam.usual, 0.0}};
  } else {
    recipe.kind = generator::Mix::nothing;
    recipe.settings_off = 3.0;
  }
  return recipe;
}

void add(const std::string& promise, const grid::ErrorSummary& stated,
         const grid::ErrorSummary& truth, Outcome& outcome) {
  outcome.numbers[promise + "_stated_mm"] = stated.rms_mm;
  outcome.numbers[promise + "_true_mm"] = truth.rms_mm;
  outcome.numbers[promise + "_worst_stated_mm"] = stated.maximum_mm;
  outcome.numbers[promise + "_worst_true_mm"] = truth.maximum_mm;
  outcome.numbers[promise + "_exceeded"] = truth.maximum_mm > stated.maximum_mm ? 1.0 : 0.0;
}

/// A place of the measured area.
struct Place {
  Vec2 at;
  Lengths needed{};  ///< for the tool to be there
  Eigen::Matrix2d to_tool;
  bool is_on_edge = false;
};

/// With what the hidden machine needs to be there.
std::vector<Place> places_at(const std::vector<Vec2>& within, const std::vector<Vec2>& edge,
                             const generator::SealedSet& set, const grid::CompensationMap& map) {
  std::vector<Place> places;
  std::vector<generator::Visit> visits;
  const auto add = [&](Vec2 at, bool is_on_edge) {
    const auto here = map.lengths({at.x, at.y});
    if (!here) throw std::runtime_error("a map without lengths within its points");
    visits.push_back({at, static_cast<int>(visits.size())});
    places.push_back({at, {}, here->mark_jacobian.inverse(), is_on_edge});
  };
  for (const Vec2 at : within) add(at, false);
  for (const Vec2 at : edge) add(at, true);
  const auto exact = set.machine.exact(visits);
  if (!exact) throw std::runtime_error("a hidden machine that does not reach its bed");
  for (std::size_t i = 0; i < places.size(); ++i) places[i].needed = (*exact)[i];
  return places;
}

/// What the marks span: squares of 75 mm, and its edge every 50 mm.
std::vector<Place> measured_area(const generator::SealedSet& set,
                                 const grid::CompensationMap& map) {
  std::vector<interp::PlanePoint> marks;
  for (const model::MarkPoint corner : map.contents().hull)
    marks.push_back({corner.x_mm, corner.y_mm});
  const interp::ConvexHull hull(marks);
  std::vector<Vec2> within, edge;
  constexpr double kSquareMm = 75.0, kEdgeMm = 50.0;
  for (double x = -0.5 * kBedWidthMm; x <= 0.5 * kBedWidthMm; x += kSquareMm) {
    for (double y = -0.5 * kBedHeightMm; y <= 0.5 * kBedHeightMm; y += kSquareMm)
      if (hull.contains(x, y)) within.push_back({x, y});
  }
  const auto& corners = hull.corners();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const interp::PlanePoint from = corners[i], to = corners[(i + 1) % corners.size()];
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    for (double at = 0.0; at < length; at += kEdgeMm)
      edge.push_back(
          {from.x + (to.x - from.x) * at / length, from.y + (to.y - from.y) * at / length});
  }
  return places_at(within, edge, set, map);
}

/// A circle of 50 to 300 mm in chords, where all of it was measured.
std::vector<Vec2> circle_within(const grid::LengthMap& map, std::uint64_t seed) {
  constexpr double kLeastMm = 50.0, kMostMm = 300.0;
  constexpr int kAttempts = 1000, kChords = 72;
  generator::Dice dice(seed, "a circle to cut");
  const interp::Rectangle& area = map.domain();
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const double radius = dice.log_uniform(kLeastMm, kMostMm);
    const Vec2 middle{dice.uniform(area.x_min, area.x_max), dice.uniform(area.y_min, area.y_max)};
    std::vector<Vec2> corners;
    for (int k = 0; k <= kChords; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kChords;
      corners.push_back({middle.x + radius * std::cos(angle), middle.y + radius * std::sin(angle)});
      if (map.status({corners.back().x, corners.back().y}) != grid::MapStatus::inside) break;
    }
    if (corners.size() == kChords + 1 &&
        map.status({corners.back().x, corners.back().y}) == grid::MapStatus::inside)
      return corners;
  }
  throw std::runtime_error("no circle fits into what was measured");
}

/// Of a program that cuts along these.
grid::ErrorSummary expected_along(const std::vector<Vec2>& corners, const grid::LengthMap& map) {
  gcode::CutPlaces cuts;
  for (std::size_t i = 1; i < corners.size(); ++i)
    cuts.add(i, {corners[i - 1].x, corners[i - 1].y, 0.0}, {corners[i].x, corners[i].y, 0.0});
  const auto expected = cuts.expected(map);
  if (!expected) throw std::runtime_error("a map that does not know its error");
  return {expected->measured.rms_mm, expected->measured.largest_mm};
}

grid::ErrorSummary true_error(const std::vector<Place>& places,
                              const std::function<Lengths(Vec2)>& paid_out) {
  grid::ErrorSummary error;
  double squares_mm2 = 0.0;
  int within = 0;
  for (const Place& place : places) {
    const Lengths lengths = paid_out(place.at);
    const double mm = (place.to_tool *
                       Eigen::Vector2d(lengths[0] - place.needed[0], lengths[1] - place.needed[1]))
                          .norm();
    error.maximum_mm = std::max(error.maximum_mm, mm);
    if (place.is_on_edge) continue;
    squares_mm2 += mm * mm;
    ++within;
  }
  error.rms_mm = std::sqrt(squares_mm2 / within);
  return error;
}

std::function<Lengths(Vec2)> by_map(const grid::CompensationMap& map) {
  return [&map](Vec2 at) {
    const auto answer = map.lengths({at.x, at.y}).value();
    return Lengths{answer.lengths.left_mm, answer.lengths.right_mm};
  };
}

/// Squared distances of tools, laid on the sheet, from their commands.
Eigen::RowVectorXd squares_when_laid(const Eigen::Matrix2Xd& tools,
                                     const Eigen::Matrix2Xd& commands,
                                     const Eigen::Matrix3d& laid) {
  return (laid * tools.colwise().homogeneous() - commands.colwise().homogeneous())
      .colwise()
      .squaredNorm();
}

using FrameAnchors = std::array<std::array<double, 3>, 4>;

/// Where the sled of a true frame comes to rest when its upper belts are paid out for `command` by other
/// anchors.
Eigen::Vector2d rest_for(const generator::BeltFrame& frame, const FrameAnchors& anchors,
                         Eigen::Vector2d command) {
  generator::FourLengths held{}, pulls{};
  for (const std::size_t i : {0, 1}) {
    const double level = std::hypot(command.x() - anchors[i][0], command.y() - anchors[i][1]);
    held[i] = std::hypot(level - frame.reach_mm, anchors[i][2]);
  }
  pulls[2] = pulls[3] = frame.pull_n;
  const auto rest = generator::rest_on_belts(frame, {false, false, true, true}, held, pulls,
                                             command.x(), command.y());
  return {rest.x_mm, rest.y_mm};
}

/// Over the hull of the places; with the best placement of the sheet and scale of the belts.
grid::ErrorSummary true_error_of_belts(const generator::BeltFrame& frame,
                                       const FrameAnchors& anchors, const grid::BeltsFit& fit) {
  std::vector<interp::PlanePoint> measured;
  for (const grid::FittedPlace& place : fit.places)
    measured.push_back({place.at.x_mm, place.at.y_mm});
  const interp::ConvexHull hull(measured);
  std::vector<Eigen::Vector2d> within;
  for (double x = 0.0; x <= 5000.0; x += 80.0) {
    for (double y = 0.0; y <= 5000.0; y += 80.0)
      if (hull.contains(x, y)) within.emplace_back(x, y);
  }
  const std::size_t inner = within.size();
  for (const interp::PlanePoint& corner : hull.corners()) within.emplace_back(corner.x, corner.y);
  Eigen::Matrix2Xd commands(2, std::ssize(within)), tools(2, std::ssize(within));
  for (std::size_t i = 0; i < within.size(); ++i) {
    commands.col(static_cast<Eigen::Index>(i)) = within[i];
    tools.col(static_cast<Eigen::Index>(i)) = rest_for(frame, anchors, within[i]);
  }
  const Eigen::RowVectorXd squares =
      squares_when_laid(tools, commands, Eigen::umeyama(tools, commands, true));
  return {std::sqrt(squares.head(static_cast<Eigen::Index>(inner)).mean()),
          std::sqrt(squares.maxCoeff())};
}

void promised_by_belts(Outcome& outcome) {
  const std::uint64_t seed = outcome.seed;
  generator::BeltRecipe recipe;
  recipe.nothing = true;
  const generator::BeltDraw draw = generator::draw_belts(recipe, seed);
  // To the accuracy of a tape along the frame.
  constexpr double kStatedSigmaMm = 6.0;
  generator::Dice dice(seed, "stated anchors");
  FrameAnchors stated = draw.frame.anchors;
  for (double* one : {&stated[0][0], &stated[0][1], &stated[1][0], &stated[1][1], &stated[3][0]})
    *one += kStatedSigmaMm * dice.normal();
  grid::MeasuredBelts belts = measured_belts_of(draw);
  belts.machine.anchors_known = true;
  for (std::size_t i = 0; i < stated.size(); ++i)
    belts.machine.anchors[model::kBelts[i]] = {stated[i][0], stated[i][1], stated[i][2]};
  const auto fit = grid::diagnosis::fit_with_causes(belts);
  const auto error = fit ? grid::error_of_belts(*fit) : std::nullopt;
  if (!error || !error->today) return outcome.fail();
  FrameAnchors typed = stated;
  for (std::size_t i = 0; i < typed.size(); ++i) {
    const model::Anchor& anchor = fit->machine.anchors[model::kBelts[i]];
    typed[i] = {anchor.x_mm, anchor.y_mm, anchor.z_mm};
  }
  add("today", *error->today, true_error_of_belts(draw.frame, stated, *fit), outcome);
  add("typed", error->expected, true_error_of_belts(draw.frame, typed, *fit), outcome);
}

/// The page is laid as its crosses are drawn with the map: a drawing does not say where it hangs.
void promised_by_plotter(Outcome& outcome) {
  const PlotterKind* kind =
      grid::find_where(kPlotterKinds, [&](PlotterKind one) { return name(one) == outcome.way(); });
  const PlotterSet set = plotter_set(*kind, {}, 0.0, 0.0, outcome.seed);
  const auto fit = grid::fit_drawing(set.drawing);
  if (!fit) return outcome.fail();
  const grid::MechanismMap map = grid::plotter_map({set.drawing, grid::found_by(*fit)});
  const auto pens_of = [&](const Eigen::Matrix2Xd& commands) {
    Eigen::Matrix2Xd pens(2, commands.cols());
    for (Eigen::Index i = 0; i < commands.cols(); ++i)
      pens.col(i) = set.pen(map.lengths({commands(0, i), commands(1, i)}).value());
    return pens;
  };
  Eigen::Matrix2Xd crosses(2, std::ssize(set.drawing.crosses));
  for (Eigen::Index i = 0; i < crosses.cols(); ++i) {
    const model::BedPoint at = set.drawing.crosses[static_cast<std::size_t>(i)].commanded;
    crosses.col(i) << at.x_mm + set.drawing.pins_middle.x_mm,
        at.y_mm + set.drawing.pins_middle.y_mm;
  }
  const Eigen::Matrix3d laid = Eigen::umeyama(pens_of(crosses), crosses, false);
  const std::vector<Vec2> circle = circle_within(map, outcome.seed);
  Eigen::Matrix2Xd commands(2, std::ssize(circle));
  for (std::size_t i = 0; i < circle.size(); ++i)
    commands.col(static_cast<Eigen::Index>(i)) << circle[i].x, circle[i].y;
  const Eigen::RowVectorXd squares = squares_when_laid(pens_of(commands), commands, laid);
  add("cuts", expected_along(circle, map),
      {std::sqrt(squares.mean()), std::sqrt(squares.maxCoeff())}, outcome);
}

void promised_by_chains(Outcome& outcome) {
  const generator::SealedSet set = generator::draw_set(recipe_of(outcome), outcome.seed);
  const ControllerSettings in_force = settings_of(set.machine.stated());
  grid::MeasuredGrid measured = grid::files::parse_grid(set.grid_text, "sealed.json").grid;
  measured.machine->controller = {model::ControllerKind::maslow_classic, in_force};
  const auto fit = grid::diagnosis::fit_with_causes(measured);
  if (!fit) return outcome.fail();
  const grid::CompensationMap& map = fit->fit.map;
  const auto today = grid::error_in_use(map);
  const auto typed = grid::settings_to_type(map);
  if (!today || !typed) return outcome.fail();
  const grid::CompensationMap after =
      grid::map_for_settings(map, {model::ControllerKind::maslow_classic, typed->settings}, "");

  const std::vector<Place> places = measured_area(set, map);
  const grid::MapInFrame in_frame(map);
  const std::vector<Vec2> circle = circle_within(in_frame, outcome.seed);
  const auto by_settings = [&places](const ControllerSettings& settings) {
    return true_error(places, [&settings](Vec2 at) { return firmware(settings, at); });
  };
  const auto expected_of = [](const grid::CompensationMap& one) {
    return one.contents().accuracy.expected_tool;
  };
  add("today", *today, by_settings(in_force), outcome);
  add("map", expected_of(map), true_error(places, by_map(map)), outcome);
  add("typed", typed->typed, by_settings(typed->settings), outcome);
  add("map_after", expected_of(after), true_error(places, by_map(after)), outcome);
  add("cuts", expected_along(circle, in_frame),
      true_error(places_at(circle, {}, set, map), by_map(map)), outcome);
}

}  // namespace

std::vector<std::string> promised_kinds() {
  std::vector<std::string> kinds;
  for (const char* machine : {"worn_chain", "bending_beam", "wrong_settings"}) {
    for (const char* way : {"28", "60", "117", "start"})
      kinds.push_back(fmt::format("{}:{}", machine, way));
  }
  kinds.push_back(kBelts);
  for (const PlotterKind kind : kPlotterKinds)
    kinds.push_back(fmt::format("{}:{}", kPlotters, name(kind)));
  return kinds;
}

Outcome promised_outcome(const std::string& kind, std::uint64_t seed) {
  Outcome outcome{.kind = kind, .seed = seed};
  if (kind == kBelts)
    promised_by_belts(outcome);
  else if (outcome.group() == kPlotters)
    promised_by_plotter(outcome);
  else
    promised_by_chains(outcome);
  return outcome;
}

}  // namespace chaintrue::sealed
