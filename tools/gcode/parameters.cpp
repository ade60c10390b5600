// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Storage of parameters.
#include "tools/gcode/parameters.hpp"

#include <algorithm>

namespace chaintrue::gcode {

Parameters::Parameters() : values_(parameter::kCount, 0.0), frames_(1) {
  values_[parameter::kSystem] = 1.0;
}

void Parameters::follow(StateByNumber by_number, StateByName by_name) {
  state_by_number_ = std::move(by_number);
  state_by_name_ = std::move(by_name);
}

double Parameters::get(int index) const {
  if (index >= parameter::kPosition && state_by_number_) {
    if (const auto value = state_by_number_(index)) return *value;
  }
  return stored(index);
}

void Parameters::set(int index, double value) { values_[static_cast<std::size_t>(index)] = value; }

bool Parameters::writable(int index) const {
  // 5400 to 5428 are the tool and the position.
  return exists(index) && (index < 5400 || index > 5428);
}

std::optional<double> Parameters::get(std::string_view name) const {
  if (state_by_name_) {
    if (const auto value = state_by_name_(name)) return value;
  }
  const Names& names = name.starts_with('_') ? global_ : frames_.back().names;
  const auto found = names.find(name);
  if (found == names.end()) return std::nullopt;
  return found->second;
}

bool Parameters::set(std::string_view name, double value) {
  if (state_by_name_ && state_by_name_(name)) return false;
  Names& names = name.starts_with('_') ? global_ : frames_.back().names;
  names.insert_or_assign(std::string(name), value);
  return true;
}

void Parameters::enter(const std::vector<double>& arguments) {
  Frame frame;
  std::copy_n(values_.begin() + 1, kArguments, frame.saved.begin());
  std::fill_n(values_.begin() + 1, kArguments, 0.0);
  std::copy_n(arguments.begin(), std::min(arguments.size(), kArguments), values_.begin() + 1);
  frames_.push_back(std::move(frame));
}

void Parameters::leave() {
  std::copy(frames_.back().saved.begin(), frames_.back().saved.end(), values_.begin() + 1);
  frames_.pop_back();
}

}  // namespace chaintrue::gcode
