// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/session.hpp"

#include <algorithm>

namespace chaintrue::grid::diagnosis {

Eigen::Index Session::sheet_column(std::size_t sheet) {
  return static_cast<Eigen::Index>(model::kMachineSettings.size() + 3 * sheet);
}

bool Session::reads_chains() const {
  return std::any_of(
      parts.begin(), parts.end(), [](const SessionPart& part) { return part.reads_chains(); });
}

bool Session::has_distances() const {
  return !parts_of<observation::TapeDistances>(*this).empty();
}

bool Session::ordered() const {
  return std::any_of(parts.begin(), parts.end(), [](const SessionPart& part) {
    return part.reads_chains() && part.observation->ordered();
  });
}

const std::vector<ExtraReading>& Session::readings() const {
  static const std::vector<ExtraReading> kNone;
  const auto own = parts_of<observation::SingleReadings>(*this);
  return own.empty() ? kNone : own.front().second->readings();
}

bool Session::knows(std::size_t column) const {
  if (column >= settings.size() || !model::is_of_sheet(settings[column])) return true;
  return std::any_of(parts.begin(), parts.end(), [&](const SessionPart& part) {
    return part.sheet && (column - model::kMachineSettings.size()) / 3 == *part.sheet &&
           part.observation->sheet()->knows(settings[column]);
  });
}

std::string_view Session::units_word() const {
  std::string_view word;
  for (const SessionPart& part : parts) {
    if (!part.observation->may_slip()) continue;
    const std::string_view own = part.observation->kind().units;
    word = word.empty() || word == own ? own : "readings";
  }
  return word;
}

State stated_state(const Session& session) {
  return {session.stated, std::vector<model::SheetPlacement>(session.sheets)};
}

Eigen::VectorXd setting_values(const Session& session, const State& state) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(session.stated_value.size());
  for (std::size_t k = 0; k < model::kMachineSettings.size(); ++k) {
    values(static_cast<Eigen::Index>(k)) =
        model::stated_value(state.machine, session.settings[k]);
  }
  for (std::size_t i = 0; i < session.sheets; ++i) {
    const model::SheetPlacement& sheet = state.sheets[i];
    values.segment<3>(Session::sheet_column(i)) << sheet.x_mm, sheet.y_mm, sheet.rotation_rad;
  }
  return values;
}

State with_settings(const Session& session, State state, const Eigen::VectorXd& values) {
  for (std::size_t k = 0; k < model::kMachineSettings.size(); ++k) {
    state.machine = model::with_setting(
        std::move(state.machine), session.settings[k], values(static_cast<Eigen::Index>(k)));
  }
  for (std::size_t i = 0; i < session.sheets; ++i) {
    const Eigen::Index at = Session::sheet_column(i);
    state.sheets[i] = {values(at), values(at + 1), values(at + 2)};
  }
  return state;
}

std::string name_of(const Session& session, std::size_t unit) {
  const SessionPart& part = session.parts[session.units[unit].part];
  return part.observation->name_of(unit - part.first_unit);
}

}  // namespace chaintrue::grid::diagnosis
