// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Ranges of a machine's numbers: how they are checked, and as a list for reference pages and editors.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

#include "model/machine.hpp"

namespace chaintrue::model {

/// Range of a number of a machine, by its JSON pointer; both ends are allowed.
struct MachineRange {
  std::string place;
  double least = 0.0;
  double most = 0.0;
  std::string unit;
};
/// Collects problems of a machine's numbers. The ranges contain every real machine, so that a value
/// outside is a mistake.
class RangeChecks {
 public:
  /// With `ranges`, every range that is checked is appended to it.
  explicit RangeChecks(std::vector<MachineRange>* ranges = nullptr) : ranges_(ranges) {}
  /// `slip` is what may have happened to a value outside.
  void range(std::string_view place, double value, double least, double most,
             std::string_view unit = "", std::string_view slip = "");
  template <class Value>
  void add(std::string_view place, const Value& value, std::string expected) {
    problems_.push_back({std::string(place), fmt::format("{}", value), std::move(expected)});
  }
  bool sound() const { return problems_.empty(); }
  [[nodiscard]] std::vector<MachineProblem> take() { return std::move(problems_); }

 private:
  std::vector<MachineProblem> problems_;
  std::vector<MachineRange>* ranges_;
};

/// The ranges of problems_of for a ring and for brackets, with every setting of a controller.
std::vector<MachineRange> machine_ranges();

}  // namespace chaintrue::model
