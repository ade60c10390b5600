// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The observability of an effect: its signature over a session, the part of it that the
/// calibration of the settings does not absorb, and the size from which such points can identify
/// it.
///
/// Notation
///   r_i    residual of a visit that the effect causes, reading less that of the stated machine
///          at the mark as written: dL - J dw; for the two chains [mm]
///   C_i    J S_xy J' + diag(s_L^2): covariance of that residual, from position and length noise
///   g      all r_i, whitened by C_i
///   J_s    the settings' sensitivities, whitened by C_i, their stated sigmas as further rows
///   M      projection orthogonal to J_s
///   delta  |M g|: the signal-to-noise ratio
///   rho    |cos| of the angle between M g of two effects: their collinearity
///
/// An effect is detected at delta 4.8 (1 in 100 false alarms over the catalogue, 9 in 10 found) and
/// distinguished from a rival in 95 of 100 cases at 1.645 sqrt(2 / (1 - rho)): the rival fits
/// better with probability Phi(-delta sqrt((1 - rho) / 2)). Beyond kInseparable no number of such
/// points is sufficient. Signatures are secants at the usual size, so delta is proportional to the
/// size as far as the effect is.
///
/// \code
///   const StrengthTable table(machine, regular_session(machine, 10, 6), StatedNoise{});
///   const EffectStrength s = table.strength(*find_effect("chain_stretch"), EffectSide::none);
///   fmt::print("{} {}\n", s.named_size, s.nearest_rival->id);
/// \endcode
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "grid/containers.hpp"
#include "grid/observation/measured_grid.hpp"
#include "grid/precondition.hpp"
#include "interp/linear_algebra.hpp"
#include "model/calibration/setting.hpp"
#include "model/effects/catalogue.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid::synthetic {

inline constexpr double kDetectableSignalToNoise = 4.8;
inline constexpr double kInseparable = 0.9995;

/// Marks of a regular grid, visited row by row.
[[nodiscard]] std::vector<model::Visit> regular_session(const model::Machine& machine,
                                                        int columns,
                                                        int rows);

/// The changes of a session's readings by effects.
struct SessionSignature {
  std::vector<Eigen::Vector2d> residual_mm;   ///< r_i
  std::vector<Eigen::Matrix2d> length_by_xy;  ///< J_i of the stated machine
  /// To first order: actual position of the tool less that of the stated machine, -J^-1 r.
  [[nodiscard]] std::vector<Eigen::Vector2d> tool_shift_mm() const;
};

/// \throws std::invalid_argument if a visit cannot be reached.
[[nodiscard]] SessionSignature signature(const model::Machine& stated,
                                         const std::vector<model::AppliedEffect>& effects,
                                         const std::vector<model::Visit>& visits);

struct Rival {
  const model::effects::Effect* effect = nullptr;
  model::effects::EffectSide side = model::effects::EffectSide::none;
  double collinearity = 0.0;
};

struct EffectStrength {
  /// At the usual size.
  double signal_to_noise = 0.0;
  /// Share of the signature that remains after calibration.
  double share_left = 0.0;
  /// Size of the effect's first parameter at kDetectableSignalToNoise.
  double detectable_size = 0.0;
  /// The rival with the most collinear signature, apart from the effect's own class.
  std::optional<Rival> nearest;
  /// Size from which it is also distinguished from the nearest rival; absent if that is out of the
  /// parameter's range.
  std::optional<double> named_size;
  /// Effects that no points of this kind distinguish from this one.
  std::vector<Rival> inseparable;
};

/// The signatures of the whole catalogue over one session.
class StrengthTable {
 public:
  using Effect = model::effects::Effect;
  using EffectParameter = model::effects::EffectParameter;
  using EffectSide = model::effects::EffectSide;

  /// \throws std::invalid_argument if a visit cannot be reached or a noise is not above 0.
  StrengthTable(const model::Machine& stated,
                std::vector<model::Visit> visits,
                const StatedNoise& noise)
      : stated_(stated), visits_(std::move(visits)) {
    if (!(noise.length_mm > 0.0 && noise.position_mm >= 0.0)) {
      throw precondition("strength: noise of {} mm in length, {} mm in position",
                         noise.length_mm,
                         noise.position_mm);
    }
    const auto count = std::ssize(visits_);
    const auto settings = std::ssize(model::kMachineSettings);
    Eigen::MatrixXd by_setting = Eigen::MatrixXd::Zero(2 * count + settings, settings);
    const model::ReadingModel model(stated);
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto reading = model.at(visits_[as_size(i)].position);
      if (!reading) throw precondition("strength: visit {}: {}", i, reading.error().sentence());
      const Eigen::Matrix2d& j = reading->position_jacobian;
      const Eigen::Matrix2d covariance =
          j * j.transpose() * (noise.position_mm * noise.position_mm) +
          Eigen::Matrix2d::Identity() * (noise.length_mm * noise.length_mm);
      length_by_xy_.push_back(j);
      const Eigen::Matrix2d lower = Eigen::LLT<Eigen::Matrix2d>(covariance).matrixL();
      whitening_.emplace_back(lower.inverse());
      for (Eigen::Index k = 0; k < settings; ++k) {
        by_setting.block<2, 1>(2 * i, k) =
            whitening_.back() * model.sensitivity(*reading, model::kMachineSettings[as_size(k)]);
      }
    }
    for (Eigen::Index k = 0; k < settings; ++k) {
      by_setting(2 * count + k, k) =
          1.0 /
          std::max(kKnownSigma, model::stated_sigma(stated, model::kMachineSettings[as_size(k)]));
    }
    settings_basis_ = linear::orthonormal_columns(by_setting);
    for (const Effect* effect : model::effects::effects_of(stated_)) {
      for (const EffectSide side : effect->sides) add_entries(*effect, side);
    }
  }

  [[nodiscard]] EffectStrength strength(const Effect& effect, EffectSide side) const {
    const Entry& own = usual(effect, side);
    EffectStrength result;
    result.signal_to_noise = own.left.norm();
    result.share_left = own.norm > 0.0 ? result.signal_to_noise / own.norm : 0.0;
    const EffectParameter& size = effect.parameters.front();
    const double per_size = result.signal_to_noise / std::abs(size.nominal);
    result.detectable_size = kDetectableSignalToNoise / per_size;
    // The most collinear place of each rival.
    std::vector<Rival> rivals;
    for (const Entry& other : entries_) {
      if (other.effect == &effect && other.side == side) continue;
      const double length = other.left.norm();
      if (!(length > 0.0 && result.signal_to_noise > 0.0)) continue;
      const double collinearity =
          std::min(1.0, std::abs(own.left.dot(other.left)) / (length * result.signal_to_noise));
      auto* same = find_where(
          rivals, [&](const Rival& r) { return r.effect == other.effect && r.side == other.side; });
      if (same == nullptr) {
        rivals.push_back({other.effect, other.side, collinearity});
      } else {
        same->collinearity = std::max(same->collinearity, collinearity);
      }
    }
    stable_sort(rivals, descending(&Rival::collinearity));
    double needed = kDetectableSignalToNoise;
    for (const Rival& rival : rivals) {
      if (rival.collinearity >= kInseparable) {
        result.inseparable.push_back(rival);
      } else {
        result.nearest = rival;
        needed = std::max(needed, 1.645 * std::sqrt(2.0 / (1.0 - rival.collinearity)));
        break;
      }
    }
    const double named = needed / per_size;
    if (named <= size.upper) result.named_size = named;
    return result;
  }

  /// The change of the tool's position at each visit by an effect, after calibration of the
  /// settings on these visits.
  [[nodiscard]] std::vector<Eigen::Vector2d> calibrated_shift_mm(
      const model::AppliedEffect& applied) const {
    const Eigen::VectorXd left = entry(applied).left;
    std::vector<Eigen::Vector2d> shift;
    for (std::size_t i = 0; i < visits_.size(); ++i) {
      const Eigen::Vector2d pair = left.segment<2>(2 * as_index(i));
      shift.emplace_back(-length_by_xy_[i].inverse() * (whitening_[i].inverse() * pair));
    }
    return shift;
  }

 private:
  /// Sigma of what is stated exactly, in mm: below every other number here.
  static constexpr double kKnownSigma = 1e-7;

  struct Entry {
    const Effect* effect;
    EffectSide side;
    bool usual = false;    ///< at its nominal places
    double norm = 0.0;     ///< of g
    Eigen::VectorXd left;  ///< M g, measurement rows and prior rows
  };
  /// Candidate places at which a rival may set in: evenly over the range of the session.
  static std::vector<std::vector<double>> place_choices(const Effect& effect, std::size_t visits) {
    constexpr int kSteps = 12;
    std::vector<std::vector<double>> choices = {model::effects::nominal_values(effect)};
    for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
      const EffectParameter& parameter = effect.parameters[i];
      if (parameter.role != model::effects::ParameterRole::place) continue;
      const bool counts_visits = parameter.integer;
      const bool declared = effect.law != nullptr;
      const double from = counts_visits ? 1.0
                          : declared    ? parameter.lower
                                        : std::max(parameter.lower, 0.0);
      const double to = counts_visits ? as_double(visits) - 1.0
                        : declared    ? parameter.upper
                                      : std::min(parameter.upper, std::numbers::pi);
      std::vector<std::vector<double>> more;
      for (const auto& choice : choices) {
        for (int k = 0; k < kSteps; ++k) {
          std::vector<double> other = choice;
          const double place = from + (to - from) * (k + 0.5) / kSteps;
          other[i] = counts_visits ? std::floor(place) : place;
          more.push_back(other);
        }
      }
      append_all(choices, more);
    }
    return choices;
  }

  void add_entries(const Effect& effect, EffectSide side) {
    bool usual = true;
    for (const auto& values : place_choices(effect, visits_.size())) {
      model::Machine with = stated_;
      with.effects.push_back(model::effects::applied(effect, side, values));
      if (!model::effects::problems_of_effects(with).empty()) return;  // cannot act on such a machine
      entries_.push_back(entry(with.effects.back()));
      entries_.back().effect = &effect;
      entries_.back().side = side;
      entries_.back().usual = usual;
      usual = false;
    }
  }

  [[nodiscard]] Entry entry(const model::AppliedEffect& applied) const {
    Entry result{};
    const std::vector<Eigen::Vector2d> residual_mm =
        signature(stated_, {applied}, visits_).residual_mm;
    Eigen::VectorXd g = Eigen::VectorXd::Zero(settings_basis_.rows());
    for (std::size_t i = 0; i < visits_.size(); ++i)
      g.segment<2>(2 * as_index(i)) = whitening_[i] * residual_mm[i];
    result.norm = g.norm();
    result.left = g - settings_basis_ * (settings_basis_.transpose() * g);
    return result;
  }

  [[nodiscard]] const Entry& usual(const Effect& effect, EffectSide side) const {
    auto* found = find_where(
        entries_, [&](const Entry& e) { return e.usual && e.effect == &effect && e.side == side; });
    if (found == nullptr) {
      throw precondition("strength: {} cannot act on this machine", effect.id);
    }
    return *found;
  }

  model::Machine stated_;
  std::vector<model::Visit> visits_;
  std::vector<Eigen::Matrix2d> whitening_;  ///< inverse Cholesky factors of C_i
  std::vector<Eigen::Matrix2d> length_by_xy_;
  Eigen::MatrixXd settings_basis_;  ///< orthonormal columns that span J_s
  std::vector<Entry> entries_;
};

}  // namespace chaintrue::grid::synthetic
