// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/measured.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/calibration/setting.hpp"

namespace chaintrue::grid {
namespace {

template <class Kind>
std::vector<const Kind*> of_kind(const std::vector<MeasuredFile>& files) {
  std::vector<const Kind*> result;
  for (const MeasuredFile& file : files) {
    if (const auto* own = std::get_if<Kind>(&file.measured)) result.push_back(own);
  }
  return result;
}

bool same(const MeasuredPoint& a, const MeasuredPoint& b) {
  const auto same_lengths = [&] {
    return a.lengths->left_mm == b.lengths->left_mm && a.lengths->right_mm == b.lengths->right_mm;
  };
  const auto same_command = [&] {
    return a.commanded->x_mm == b.commanded->x_mm && a.commanded->y_mm == b.commanded->y_mm;
  };
  return a.mark.x_mm == b.mark.x_mm && a.mark.y_mm == b.mark.y_mm &&
         a.lengths.has_value() == b.lengths.has_value() && (!a.lengths || same_lengths()) &&
         a.commanded.has_value() == b.commanded.has_value() && (!a.commanded || same_command());
}

bool same(const HoleDistance& a, const HoleDistance& b) {
  return a.from == b.from && (a.edge || a.to == b.to) && a.edge == b.edge &&
         a.distance_mm == b.distance_mm;
}

template <class Reading>
bool all_same(const std::vector<Reading>& a, const std::vector<Reading>& b) {
  return !a.empty() && std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return same(x, y);
  });
}

}  // namespace

bool same_readings(const MeasuredFile& one, const MeasuredFile& other) {
  if (one.grid() != nullptr && other.grid() != nullptr)
    return all_same(one.grid()->points, other.grid()->points);
  if (one.holes() != nullptr && other.holes() != nullptr)
    return all_same(one.holes()->distances, other.holes()->distances);
  return false;
}

const std::optional<model::Machine>& MeasuredFile::machine() const {
  return std::visit(
      [](const auto& own) -> const auto& { return own.machine; }, measured);
}

Measured::Measured(MeasuredGrid grid) { add(std::move(grid)); }
Measured::Measured(MeasuredHoles set) { add(std::move(set)); }

void Measured::add(MeasuredGrid grid) {
  std::string name = grid.name;
  files_.push_back({std::move(name), std::move(grid)});
}

void Measured::add(MeasuredHoles set) {
  std::string name = set.name;
  files_.push_back({std::move(name), std::move(set)});
}

std::vector<const MeasuredGrid*> Measured::grids() const { return of_kind<MeasuredGrid>(files_); }

std::vector<const MeasuredHoles*> Measured::holes() const { return of_kind<MeasuredHoles>(files_); }

MeasuredGrid* Measured::first_grid() {
  for (MeasuredFile& file : files_) {
    if (auto* own = std::get_if<MeasuredGrid>(&file.measured)) return own;
  }
  return nullptr;
}

std::string Measured::name() const {
  if (files_.empty()) return {};
  return std::visit([](const auto& own) { return own.name; }, files_.front().measured);
}

std::optional<model::Machine> Measured::machine() const {
  return files_.empty() ? std::nullopt : files_.front().machine();
}

std::string difference_of_settings(const model::Machine& first, const model::Machine& other) {
  for (const model::Setting setting : model::kMachineSettings) {
    if (model::stated_value(first, setting) == model::stated_value(other, setting)) continue;
    return fmt::format("{} is {} in this file and {} in the first",
                       model::name(setting),
                       model::stated_value(other, setting),
                       model::stated_value(first, setting));
  }
  return {};
}

}  // namespace chaintrue::grid
