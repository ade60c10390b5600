// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/residual_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "grid/map/joint_fit.hpp"
#include "grid/map/lattice_residual.hpp"
#include "grid/map/length_points.hpp"
#include "grid/map/map_accuracy.hpp"
#include "grid/map/noise_from_repeats.hpp"
#include "grid/map/plain_calibration.hpp"
#include "model/calibration/setting.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid {
namespace {

using model::BedPoint;

/// A stated noise of zero means readings with all digits; this much is left so that the weights
/// stay finite.
constexpr double kLeastNoiseMm = 1e-6;

FitFailure translate(const JointFitFailure& failure) {
  switch (failure.reason) {
    case JointFitFailure::Reason::point_unreachable:
      return {FitFailure::Reason::point_unreachable, failure.sentence};
    case JointFitFailure::Reason::rank_deficient:
      return {FitFailure::Reason::rank_deficient, failure.sentence};
    case JointFitFailure::Reason::not_converged:
      break;
  }
  return {FitFailure::Reason::not_converged, failure.sentence};
}

/// The bed, as far as hand-laid marks may lie beside it, and all points.
interp::Rectangle domain_of(const MeasuredGrid& grid, const std::vector<LengthPoint>& points) {
  const model::Bed& bed = grid.machine->bed;
  double beyond = 0.0;
  if (grid.sheet)
    beyond = 2.0 * grid.sheet->shift_mm + 1e-3 * grid.sheet->rotation_mrad * 0.5 * bed.width_mm;
  interp::Rectangle domain{-0.5 * bed.width_mm - beyond,
                           0.5 * bed.width_mm + beyond,
                           -0.5 * bed.height_mm - beyond,
                           0.5 * bed.height_mm + beyond};
  for (const LengthPoint& point : points) {
    domain.x_min = std::min(domain.x_min, point.mark.x_mm);
    domain.x_max = std::max(domain.x_max, point.mark.x_mm);
    domain.y_min = std::min(domain.y_min, point.mark.y_mm);
    domain.y_max = std::max(domain.y_max, point.mark.y_mm);
  }
  return domain;
}

bool states_noise(const MeasuredGrid& grid) {
  return grid.noise && (grid.noise->length_mm > 0.0 || grid.noise->position_mm > 0.0);
}

JointFitInput input_of(const MeasuredGrid& grid, const std::vector<LengthPoint>& points) {
  JointFitInput input;
  input.machine = with_readings(*grid.machine, grid.readings);
  input.points = points;
  // A stated noise of nothing at all states nothing: it is found from the points.
  if (states_noise(grid)) {
    input.noise = {std::max(grid.noise->length_mm, kLeastNoiseMm),
                   std::max(grid.noise->position_mm, kLeastNoiseMm)};
    input.noise_scale = {interp::NoiseKnowledge::kFromRepeats, grid.noise->dof};
  } else {
    input.noise_scale = {interp::NoiseKnowledge::kUnknown, 0.0};
  }
  input.sheet = grid.sheet;
  input.extra = setting_observations(grid.readings);
  input.domain = domain_of(grid, points);
  return input;
}

Eigen::Vector2d to_tool(const Eigen::Matrix2d& mark_jacobian, const Eigen::Vector2d& chain_mm) {
  return mark_jacobian.inverse() * chain_mm;
}

/// Fits the placement of the sheet under the machine as stated, by weighted least squares on its
/// good points.
model::SheetPlacement fit_sheet_placement(const JointFitInput& input,
                                          const JointFit& fit,
                                          const model::ReadingModel& stated) {
  const std::vector<model::Setting> settings(model::kSheetSettings.begin(),
                                             model::kSheetSettings.end());
  model::SheetPlacement sheet;
  constexpr int kSteps = 8;
  for (int step = 0; step < kSteps; ++step) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const FittedPoint& point : fit.points) {
      if (point.bad) continue;
      const model::ChainReading reading(point.point.mark, point.point.lengths, input.noise);
      const auto line = reading.linearise(stated, sheet, settings);
      if (!line) continue;
      const Eigen::Matrix2d weight = line->covariance.inverse();
      normal += line->setting_jacobian.transpose() * weight * line->setting_jacobian;
      right += line->setting_jacobian.transpose() * weight * line->residual;
    }
    const Eigen::Vector3d change = normal.ldlt().solve(right);
    sheet.x_mm += change[0];
    sheet.y_mm += change[1];
    sheet.rotation_rad += change[2];
  }
  return sheet;
}

/// How far the tool was beyond where a machine thinks; zero where that machine has no pose.
Eigen::Vector2d tool_residual(const model::ReadingModel& model,
                              const model::SheetPlacement& sheet,
                              const LengthPoint& point) {
  const auto reading = model.at(sheet.to_bed(point.mark));
  if (!reading) return Eigen::Vector2d::Zero();
  return to_tool(reading->position_jacobian * sheet.rotation(),
                 Eigen::Vector2d(point.lengths.left_mm - reading->lengths.left_mm,
                                 point.lengths.right_mm - reading->lengths.right_mm));
}

std::vector<MapPoint> map_points(const JointFitInput& input,
                                 const JointFit& fit,
                                 const MeasuredGrid& grid) {
  const model::ReadingModel stated(*grid.machine);
  const model::SheetPlacement laid =
      grid.sheet ? fit_sheet_placement(input, fit, stated) : model::SheetPlacement{};
  std::vector<MapPoint> points;
  for (const FittedPoint& fitted : fit.points) {
    MapPoint point;
    point.mark = fitted.point.mark;
    point.lengths = fitted.point.lengths;
    point.bad = fitted.bad;
    point.distance_sigmas = fitted.distance;
    point.as_stated_mm = tool_residual(stated, {}, fitted.point);
    point.sheet_placed_mm = tool_residual(stated, laid, fitted.point);
    point.mapped_mm = to_tool(fitted.mark_jacobian, fitted.residual_mm);
    point.left_out_mm = to_tool(fitted.mark_jacobian, fitted.left_out_residual_mm);
    points.push_back(point);
  }
  return points;
}

std::vector<SettingResult> setting_results(const JointFitInput& input, const JointFit& fit) {
  constexpr double kOffSigmas = 3.0;
  std::vector<SettingResult> results;
  for (std::size_t i = 0; i < fit.settings.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    SettingResult result{fit.settings[i], 0.0, 0.0, std::sqrt(fit.covariance(at, at)), false};
    if (i < model::kMachineSettings.size()) {
      result.stated = model::stated_value(input.machine, result.setting);
      result.calibrated = model::stated_value(fit.machine, result.setting);
      const double sigma = model::stated_sigma(input.machine, result.setting);
      result.off = std::abs(result.calibrated - result.stated) > kOffSigmas * sigma;
    } else {
      const double placed[] = {fit.sheet.x_mm, fit.sheet.y_mm, fit.sheet.rotation_rad};
      const std::size_t which = i - model::kMachineSettings.size();
      result.calibrated = placed[which];
      const double sigma = which < 2 ? input.sheet->shift_mm : 1e-3 * input.sheet->rotation_mrad;
      result.off = std::abs(result.calibrated) > kOffSigmas * sigma;
    }
    results.push_back(result);
  }
  return results;
}

MapAccuracy held_out_accuracy(const JointFit& fit) {
  std::vector<HeldOutResidual> one;
  std::vector<HeldOutResidual> blocks;
  for (std::size_t i = 0; i < fit.points.size(); ++i) {
    if (fit.points[i].bad) continue;
    one.push_back({fit.points[i].left_out_residual_mm, fit.points[i].mark_jacobian});
    blocks.push_back({fit.blocked_residual_mm[i], fit.points[i].mark_jacobian});
  }
  MapAccuracy accuracy;
  accuracy.leave_one_out = summarise(one);
  accuracy.blocked = summarise(blocks);
  return accuracy;
}

/// A noise that the residuals contradict by this much, one way or the other, is worth a sentence.
constexpr double kNoiseDisagreement = 1.5;

std::vector<std::string> notes_of(const MapContents& map) {
  std::vector<std::string> notes;
  if (map.noise.source == "stated" && map.noise.factor_found > kNoiseDisagreement) {
    notes.push_back(
        fmt::format("The readings scatter {:.1f} times as much as stated: check how the marks and "
                    "the lengths were measured.",
                    map.noise.factor_found));
  }
  if (map.noise.source != "stated") {
    notes.push_back(
        fmt::format("No noise was stated; from the {} it is about {:.2f} mm in a length and {:.2f} "
                    "mm in a position.",
                    map.noise.source == "repeats" ? "repeated points" : "scatter of the points",
                    map.noise.length_mm * map.noise.factor_found,
                    map.noise.position_mm * map.noise.factor_found));
  }
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const MapPoint& point = map.points[i];
    if (!point.bad) continue;
    notes.push_back(
        fmt::format("Point {} at ({:.0f}, {:.0f}) was set aside: it lies {:.1f} mm beside where "
                    "the others put it, {:.0f} times what "
                    "the noise allows. Measure it again.",
                    i + 1,
                    point.mark.x_mm,
                    point.mark.y_mm,
                    point.left_out_mm.norm(),
                    point.distance_sigmas));
  }
  for (const SettingResult& setting : map.settings) {
    if (!setting.off) continue;
    notes.push_back(fmt::format(
        "{} ended {:+.3f} from what was stated, more than three times its stated uncertainty: "
        "measure it again, or something else imitates it.",
        model::name(setting.setting),
        setting.calibrated - setting.stated));
  }
  return notes;
}

/// C = F F'; rounding may leave C not quite semidefinite, so jitter on the diagonal lets it be
/// factorised.
Eigen::MatrixXd lower_factor(const Eigen::MatrixXd& covariance) {
  constexpr double kJitter = 1e-12;
  Eigen::MatrixXd lifted = 0.5 * (covariance + covariance.transpose());
  lifted.diagonal() *= 1.0 + kJitter;
  lifted.diagonal().array() += 1e-18;
  return lifted.llt().matrixL();
}

MapContents contents_of(const MeasuredGrid& grid,
                        const JointFitInput& input,
                        const JointFit& fit,
                        const std::string& noise_source) {
  MapContents map;
  map.name = grid.name;
  map.surface = ModelSurface{fit.machine,
                             fit.sheet,
                             fit.surface,
                             fit.columns,
                             fit.settings,
                             lower_factor(fit.covariance),
                             {}};
  std::vector<BedPoint> good;
  for (const FittedPoint& point : fit.points) {
    if (!point.bad) good.push_back(point.point.mark);
  }
  const MeasuredArea area(good, input.domain);
  map.hull = area.hull();
  map.edge_mm = area.edge_mm();
  map.domain = input.domain;
  map.noise = {input.noise.length_mm, input.noise.position_mm, noise_source, fit.noise_factor};
  map.accuracy = held_out_accuracy(fit);
  map.settings = setting_results(input, fit);
  map.points = map_points(input, fit, grid);
  map.notes = notes_of(map);
  if (!fit.settled) {
    map.notes.push_back(
        "The fit had not quite settled after its last pass: some points hover between good and "
        "bad. "
        "Measure the ones with the largest residuals again.");
  }
  return map;
}

/// Readings with all their digits, as a simulator or a very good measurement gives them, bear a
/// smoother surface than noisy ones. It is taken where it predicts left-out points a fifth better;
/// then `input` says so.
void prefer_smoother(JointFitInput& input, JointFit& joint) {
  constexpr double kClearlyBetter = 0.8;
  JointFitInput smoother = input;
  smoother.bending_order = 3;
  auto fit = fit_jointly(smoother);
  if (!fit) return;
  const double before = held_out_accuracy(joint).leave_one_out.chain.rms_mm;
  if (held_out_accuracy(*fit).leave_one_out.chain.rms_mm > kClearlyBetter * before) return;
  input = std::move(smoother);
  joint = *std::move(fit);
}

/// A surface through every node leaves nothing there, and has left-out residuals of its own.
void tell_residuals(JointFit& joint, const LatticeFit& lattice) {
  for (std::size_t i = 0; i < joint.points.size(); ++i) {
    if (joint.points[i].bad) continue;
    joint.points[i].residual_mm.setZero();
    joint.points[i].left_out_residual_mm = lattice.left_out_residual_mm[i];
  }
}

void append_lattice_notes(std::vector<std::string>& notes, const LatticeResidual& lattice) {
  notes.emplace_back(
      "The readings bear no noise and stand on full rows and columns: the map passes through every "
      "one of them.");
  for (Eigen::Index iy = 0; iy < lattice.doubt_mm.cols(); ++iy) {
    for (Eigen::Index ix = 0; ix < lattice.doubt_mm.rows(); ++ix) {
      if (lattice.doubt_mm(ix, iy) == 0.0) continue;
      notes.push_back(
          fmt::format("No reading at ({:.0f}, {:.0f}) was used: what stands there is foretold by "
                      "the row or column through it, to "
                      "about {:.2g} mm.",
                      lattice.x_nodes_mm[static_cast<std::size_t>(ix)],
                      lattice.y_nodes_mm[static_cast<std::size_t>(iy)],
                      lattice.doubt_mm(ix, iy)));
    }
  }
}

/// Readings can put a machine where no machine is.
tl::expected<void, FitFailure> check_readings(const MeasuredGrid& grid) {
  const model::Machine machine = with_readings(*grid.machine, grid.readings);
  std::string problems;
  for (const model::MachineProblem& problem : model::problems_of(machine)) {
    problems += fmt::format(
        " {} would be {}, expected {};", problem.parameter, problem.value, problem.expected);
  }
  for (const auto& problem : model::effects::problems_of_effects(machine)) {
    problems += fmt::format(
        " {} would be {}, expected {};", problem.parameter, problem.value, problem.expected);
  }
  if (problems.empty()) return {};
  problems.back() = '.';
  return tl::unexpected(FitFailure{FitFailure::Reason::impossible_readings,
                                   "with the grid's readings put in," + problems});
}

/// A map that keeps less than two thirds of its points is not the map of those points.
tl::expected<void, FitFailure> check_enough_good(const JointFit& joint) {
  const auto good = std::count_if(joint.points.begin(),
                                  joint.points.end(),
                                  [](const FittedPoint& point) { return !point.bad; });
  const auto all = static_cast<std::ptrdiff_t>(joint.points.size());
  if (3 * good >= 2 * all && good >= 6) return {};
  return tl::unexpected(FitFailure{
      FitFailure::Reason::rank_deficient,
      fmt::format("{} of {} points contradict the others or the machine as stated; check the "
                  "machine's measures, the order of the columns and the units",
                  all - good,
                  all)});
}

}  // namespace

tl::expected<CompensationMap, FitFailure> fit_residual(const MeasuredGrid& grid) {
  if (!grid.machine) {
    return tl::unexpected(FitFailure{
        FitFailure::Reason::no_machine,
        "the grid names no machine; a residual surface stands on one: give --machine, or "
        "ask for --surface direct"});
  }
  const auto points = length_points(grid);
  if (!points) return tl::unexpected(points.error());
  if (auto possible = check_readings(grid); !possible) return tl::unexpected(possible.error());
  JointFitInput input = input_of(grid, *points);
  auto joint = fit_jointly(input);
  if (!joint) return tl::unexpected(translate(joint.error()));
  if (!states_noise(grid)) prefer_smoother(input, *joint);
  std::string source = states_noise(grid) ? "stated" : "fit";
  if (!states_noise(grid)) {
    if (const auto repeats = noise_from_repeats(*joint, input.noise)) {
      input.noise.length_mm *= repeats->factor;
      input.noise.position_mm *= repeats->factor;
      input.noise_scale = {interp::NoiseKnowledge::kFromRepeats, repeats->dof};
      source = "repeats";
      joint = fit_jointly(input);
      if (!joint) return tl::unexpected(translate(joint.error()));
    }
  }
  std::optional<LatticeFit> lattice;
  if (source == "fit") {
    JointFit plain = with_plain_calibration(input, *joint);
    lattice = fit_lattice(plain);
    if (lattice) joint = std::move(plain);
  }
  if (lattice) tell_residuals(*joint, *lattice);
  if (auto sound = check_enough_good(*joint); !sound) return tl::unexpected(sound.error());
  MapContents contents = contents_of(grid, input, *joint, source);
  if (lattice) {
    std::get<ModelSurface>(contents.surface).lattice = lattice->residual;
    append_lattice_notes(contents.notes, lattice->residual);
  }
  const CompensationMap first(contents);
  measure_expected_error(first, contents.accuracy);
  contents.mirror = test_mirror(first);
  return CompensationMap(std::move(contents));
}

}  // namespace chaintrue::grid
