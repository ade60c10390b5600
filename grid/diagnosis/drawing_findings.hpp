// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a diagnosis of a V-plotter's test drawing has of its own: the settings with the causes at work,
/// and each measure.
#pragma once

#include <string>
#include <vector>

namespace chaintrue::grid::diagnosis {

/// A parameter of the plotter's mechanism, in its own unit.
struct DrawnSetting {
  std::string name;  ///< "zero_left_mm"
  double set = 0.0;
  double found = 0.0;  ///< with the causes of the verdict at work
  double sigma = 0.0;
  bool off = false;  ///< further away than its own sigma and chance allow
};

/// A length or a bow, mm.
struct DrawnValue {
  std::string name;  ///< "the bow of A-B at E"
  double measured_mm = 0.0;
  double explained_mm = 0.0;  ///< by the settings found and the causes of the verdict
  bool rejected = false;
};

struct DrawingFindings {
  std::string plotter;  ///< its name
  std::vector<DrawnSetting> settings;
  /// In the order of the drawing's measures.
  std::vector<DrawnValue> measures;
};

}  // namespace chaintrue::grid::diagnosis
