// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A run of Find Anchors that did not finish: at which waypoint, what the machine read there, the
/// possible causes, and what to do. Private to grid/files.
///
/// Source: MaslowCNC/Maslow_4, firmware/FluidNC/src/Maslow/Calibration.cpp, for what is printed: a
/// belt's four readings at a waypoint, repeated up to nine times until they agree to 2.5 mm; the
/// guards of the fit; threads 427, 547, 924, 961, 968 and 1010 for runs that stopped.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/belts/measured_belts.hpp"

namespace chaintrue::grid::files {

enum class StopKind {
  readings_disagree,  ///< of one place, tried again
  gave_up_reading,    ///< they never agreed
  imbalance,          ///< the machine's guard: one belt's misfit is twice another's
  not_converged,      ///< the machine's solver
  low_fitness,        ///< the readings contradict each other, in the machine's view
  centre_off,         ///< the first place is not where the settings put it
  went_back,          ///< to "Belts Extended", without an error
  other_error,
  log_ends,  ///< before the last waypoint that was announced, without an error
};

struct RunStopped {
  StopKind kind{};
  std::size_t line = 0;
  std::string said{};  ///< the machine's message; empty: none
  int last_measured = -1;
  int last_announced = -1;
  /// Single readings of the last attempt at the waypoint where it stopped.
  model::PerBelt<std::vector<double>> readings_mm{};
};

/// A setting, or a whole file of settings, that the controller rejected: it uses others.
struct SettingsRefused {
  std::size_t line = 0;
  std::string said;
};
[[nodiscard]] bool is_setting_refused(std::string_view line);
[[nodiscard]] std::string words_of(const SettingsRefused& refused);

/// Empty for a line that does not indicate a failure.
[[nodiscard]] std::optional<StopKind> stop_of(std::string_view line);

/// The answer. `belts` are the places that were rebuilt, with the settings in force where these are
/// known.
[[nodiscard]] std::string words_of(const RunStopped& stopped, const MeasuredBelts& belts);

}  // namespace chaintrue::grid::files
