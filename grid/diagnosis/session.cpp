// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/session.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "grid/map/length_points.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using Reason = DiagnosisFailure::Reason;
using model::Machine;
using model::Setting;

tl::unexpected<DiagnosisFailure> failure(Reason reason, std::string sentence) {
  return tl::unexpected(DiagnosisFailure{reason, std::move(sentence)});
}

/// The first parameter of an effect, summed over the machine's own that act on the side.
double summed_size(const Machine& machine, std::string_view effect, const std::string& side) {
  double sum = 0.0;
  for (const model::AppliedEffect& applied : machine.effects) {
    if (applied.effect != effect) continue;
    if (!side.empty() && applied.side != "both" && applied.side != side) continue;
    sum += applied.parameters.begin()->second;
  }
  return sum;
}

using Predict = double (*)(const Machine&, const ExtraReading&);

const std::map<std::string, Predict, std::less<>>& predictions() {
  static const std::map<std::string, Predict, std::less<>> kPredictions = {
      {"motor_spacing_mm",
       [](const Machine& m, const ExtraReading&) {
         return m.motors.right.x_mm - m.motors.left.x_mm;
       }},
      {"beam_rise_mm",
       [](const Machine& m, const ExtraReading&) {
         return m.motors.right.y_mm - m.motors.left.y_mm;
       }},
      {"ring_radius_mm",
       [](const Machine& m, const ExtraReading&) {
         const auto* ring = std::get_if<model::Ring>(&m.attachment);
         return (ring != nullptr ? ring->radius_mm : 0.0) + summed_size(m, "ring_radius", "");
       }},
      {"link_pitch_mm",
       [](const Machine& m, const ExtraReading& r) {
         return m.sprocket.pitch_mm * (1.0 + summed_size(m, "chain_pitch_error", r.side));
       }},
      {"chain_mass_kg_per_m",
       [](const Machine& m, const ExtraReading&) {
         return m.chain.mass_kg_per_m * (1.0 + summed_size(m, "chain_sag", ""));
       }},
      {"tape_error_mm_per_m",
       [](const Machine& m, const ExtraReading& r) {
         return 1000.0 * summed_size(m, "tape_scale", r.side);
       }},
  };
  return kPredictions;
}

/// Secants of effects and the calibration's steps are good to some micrometres over a bed: readings
/// that are better are taken to be this good, and the noise that is found says how good they were.
constexpr double kFinestLengthNoise_mm = 0.01;

/// What is stated exactly is known this well, in mm or rad: no division by zero, and below every
/// other number here.
constexpr double kKnownSigma = 1e-7;

bool on_a_ring(const Machine& machine) {
  return std::holds_alternative<model::Ring>(machine.attachment);
}

/// The readings that the machine predicts; the sled's mass is taken as it was read.
std::vector<ExtraReading> predictable(const std::vector<ExtraReading>& readings, Machine& machine) {
  std::vector<ExtraReading> kept;
  std::vector<ExtraReading> masses;
  for (const ExtraReading& reading : readings) {
    if (reading.what == "sled_mass_kg") masses.push_back(reading);
    if (predictions().find(reading.what) == predictions().end()) continue;
    if (reading.what == "ring_radius_mm" && !on_a_ring(machine)) continue;
    kept.push_back(reading);
  }
  machine = with_readings(machine, masses);
  std::sort(kept.begin(), kept.end(), [](const ExtraReading& a, const ExtraReading& b) {
    return std::tie(a.what, a.side, a.value, a.sigma) < std::tie(b.what, b.side, b.value, b.sigma);
  });
  return kept;
}

/// One sigma of what the machine file says of a thing that can also be read.
double sigma_of_statement(const Machine& machine, const std::string& what) {
  if (what == "motor_spacing_mm" || what == "beam_rise_mm")
    return std::sqrt(2.0) * machine.uncertainty.motor_position_mm;
  if (what == "ring_radius_mm") return machine.uncertainty.ring_radius_mm;
  // A chain's pitch may be off by half a percent, its mass by more than that: nothing contradicts.
  if (what == "link_pitch_mm") return 0.005 * machine.sprocket.pitch_mm;
  if (what == "tape_error_mm_per_m") return 5.0;
  return machine.chain.mass_kg_per_m;
}

constexpr double kContradiction = 6.0;  // sigmas: no slip of the tape, a slip of the pen

std::optional<std::string> contradiction(const Session& session) {
  for (std::size_t i = 0; i < session.readings.size(); ++i) {
    const ExtraReading& reading = session.readings[i];
    const double stated = predicted_reading(session.stated, reading);
    const double sigma =
        std::hypot(sigma_of_statement(session.stated, reading.what), reading.sigma);
    if (std::abs(reading.value - stated) > kContradiction * sigma) {
      return fmt::format(
          "the grid's reading of {} is {:.6g}, but the machine states {:.6g}: {:.0f} sigma apart. "
          "Measure it again and correct whichever is wrong",
          reading.what,
          reading.value,
          stated,
          std::abs(reading.value - stated) / sigma);
    }
    for (std::size_t k = 0; k < i; ++k) {
      const ExtraReading& other = session.readings[k];
      if (other.what != reading.what || other.side != reading.side) continue;
      const double both = std::hypot(other.sigma, reading.sigma);
      if (std::abs(reading.value - other.value) > kContradiction * both) {
        return fmt::format(
            "two readings of {} contradict each other: {:.6g} and {:.6g}, {:.0f} sigma apart",
            reading.what,
            other.value,
            reading.value,
            std::abs(reading.value - other.value) / both);
      }
    }
  }
  return std::nullopt;
}

void state_settings(const MeasuredGrid& grid, Session& session) {
  session.settings.assign(model::kMachineSettings.begin(), model::kMachineSettings.end());
  if (grid.sheet) {
    session.settings.insert(
        session.settings.end(), model::kSheetSettings.begin(), model::kSheetSettings.end());
  }
  const auto count = static_cast<Eigen::Index>(session.settings.size());
  session.stated_value = Eigen::VectorXd::Zero(count);
  session.stated_sigma.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Setting setting = session.settings[static_cast<std::size_t>(k)];
    if (k < static_cast<Eigen::Index>(model::kMachineSettings.size())) {
      session.stated_value(k) = model::stated_value(session.stated, setting);
      session.stated_sigma(k) = model::stated_sigma(session.stated, setting);
    } else {
      session.stated_sigma(k) = setting == Setting::sheet_rotation_rad
                                    ? 1e-3 * grid.sheet->rotation_mrad
                                    : grid.sheet->shift_mm;
    }
    session.stated_sigma(k) = std::max(session.stated_sigma(k), kKnownSigma);
  }
}

/// Scatter of the residuals within each group of repeats, as a multiple of the default noise.
std::optional<StatedNoise> noise_of_repeats(const Session& session,
                                            const std::vector<LengthPoint>& points) {
  const model::ReadingModel model(session.stated);
  const StatedNoise usual;
  double sum = 0.0;
  double dof = 0.0;
  for (const auto& group : repeat_groups(points)) {
    std::vector<Eigen::Vector2d> whitened;
    for (const std::size_t i : group) {
      const auto reading = model.at(points[i].mark);
      if (!reading) continue;
      const Eigen::Matrix2d& j = reading->position_jacobian;
      const Eigen::Matrix2d covariance = std::pow(usual.position_mm, 2) * j * j.transpose() +
                                         std::pow(usual.length_mm, 2) * Eigen::Matrix2d::Identity();
      const Eigen::Vector2d residual(points[i].lengths.left_mm - reading->lengths.left_mm,
                                     points[i].lengths.right_mm - reading->lengths.right_mm);
      whitened.emplace_back(covariance.llt().matrixL().solve(residual));
    }
    if (whitened.size() < 2) continue;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const auto& w : whitened) mean += w / static_cast<double>(whitened.size());
    for (const auto& w : whitened) sum += (w - mean).squaredNorm();
    dof += 2.0 * static_cast<double>(whitened.size() - 1);
  }
  if (dof < 4.0 || !(sum > 0.0)) return std::nullopt;
  const double factor = std::sqrt(sum / dof);
  return StatedNoise{factor * usual.length_mm, factor * usual.position_mm, dof};
}

}  // namespace

tl::expected<Session, DiagnosisFailure> make_session(const MeasuredGrid& grid) {
  if (!grid.machine) {
    return failure(Reason::no_machine,
                   "a diagnosis needs the machine as its owner states it: give --machine M.json");
  }
  const auto lengths = length_points(grid);
  if (!lengths) return failure(Reason::no_lengths, lengths.error().sentence);
  if (lengths->size() < kFewestPoints) {
    return failure(Reason::too_few_points,
                   fmt::format("{} points are too few to name a cause: at least {} are needed, 28 "
                               "with six of them measured twice are a good start",
                               lengths->size(),
                               kFewestPoints));
  }
  Session session;
  session.stated = *grid.machine;
  session.readings = predictable(grid.readings, session.stated);
  session.ordered = std::all_of(
      grid.points.begin(), grid.points.end(), [](const MeasuredPoint& p) { return p.order; });
  for (const LengthPoint& point : *lengths) {
    session.points.push_back(
        {point.index, point.mark, point.lengths, grid.points[point.index].order.value_or(0)});
  }
  std::sort(
      session.points.begin(),
      session.points.end(),
      [](const SessionPoint& a, const SessionPoint& b) {
        return std::tie(a.order, a.mark.x_mm, a.mark.y_mm, a.lengths.left_mm, a.lengths.right_mm) <
               std::tie(b.order, b.mark.x_mm, b.mark.y_mm, b.lengths.left_mm, b.lengths.right_mm);
      });
  state_settings(grid, session);
  if (const auto said = contradiction(session)) {
    return failure(Reason::contradictory_settings, *said);
  }
  std::optional<StatedNoise> noise = grid.noise;
  if (!noise) {
    noise = noise_of_repeats(session, *lengths);
    session.noise_from_repeats = noise.has_value();
  }
  if (!noise) {
    return failure(Reason::no_noise,
                   "how well the points were measured is neither stated nor to be seen in repeats. "
                   "State it (\"noise\" in the grid file, or --noise-length-mm, "
                   "--noise-position-mm), or measure at least six points twice");
  }
  session.noise = {std::max(noise->length_mm, kFinestLengthNoise_mm), noise->position_mm};
  session.noise_dof = noise->dof;
  return session;
}

Session with_points(const Session& session, std::vector<SessionPoint> points) {
  Session other = session;
  other.points = std::move(points);
  other.readings.clear();
  return other;
}

std::size_t Session::fewest_units() const {
  return distances ? kFewestGoodDistances : kFewestPoints;
}

State stated_state(const Session& session) { return {session.stated, {}}; }

Eigen::VectorXd setting_values(const Session& session, const State& state) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(session.stated_value.size());
  const Eigen::Vector3d sheet(state.sheet.x_mm, state.sheet.y_mm, state.sheet.rotation_rad);
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(session.settings.size()); ++k) {
    const auto machine_settings = static_cast<Eigen::Index>(model::kMachineSettings.size());
    values(k) =
        k < machine_settings
            ? model::stated_value(state.machine, session.settings[static_cast<std::size_t>(k)])
            : sheet(k - machine_settings);
  }
  return values;
}

State with_settings(const Session& session, State state, const Eigen::VectorXd& values) {
  const auto machine_settings = static_cast<Eigen::Index>(model::kMachineSettings.size());
  for (Eigen::Index k = 0; k < machine_settings; ++k) {
    state.machine = model::with_setting(
        std::move(state.machine), session.settings[static_cast<std::size_t>(k)], values(k));
  }
  if (static_cast<Eigen::Index>(session.settings.size()) > machine_settings) {
    state.sheet = {
        values(machine_settings), values(machine_settings + 1), values(machine_settings + 2)};
  }
  return state;
}

double predicted_reading(const Machine& machine, const ExtraReading& reading) {
  return predictions().at(reading.what)(machine, reading);
}

}  // namespace chaintrue::grid::diagnosis
