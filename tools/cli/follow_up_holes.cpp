// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/follow_up_holes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace chaintrue::cli {
namespace {

using grid::MeasuredHoles;
using grid::diagnosis::Diagnosis;
using grid::diagnosis::NextMeasurement;

struct Lines {
  std::vector<grid::Hole> holes;
  std::vector<std::pair<std::string, std::string>> distances;
};

/// N1, N2, ... but for those that are taken.
class FreeNames {
 public:
  explicit FreeNames(const MeasuredHoles& set) : set_(set) {}
  std::string next() {
    std::string name;
    do {
      name = fmt::format("N{}", ++number_);
    } while (std::any_of(set_.holes.begin(), set_.holes.end(), [&](const grid::Hole& hole) {
      return hole.name == name;
    }));
    return name;
  }

 private:
  const MeasuredHoles& set_;
  int number_ = 0;
};

Lines lines_of(const Diagnosis& found, const MeasuredHoles& set) {
  Lines lines;
  FreeNames names(set);
  for (const NextMeasurement& next : found.next_measurements) {
    std::string from = next.from;
    if (next.mark) {
      from = names.next();
      lines.holes.push_back({from, *next.mark});
    }
    for (const std::string& to : next.to) lines.distances.emplace_back(from, to);
  }
  return lines;
}

}  // namespace

bool is_of_these(const Diagnosis& found, const MeasuredHoles& set) {
  constexpr double kSamePlaceMm = 1e-3;
  return found.distances.size() == set.distances.size() &&
         std::equal(found.holes.begin(),
                    found.holes.end(),
                    set.holes.begin(),
                    set.holes.end(),
                    [&](const auto& pictured, const grid::Hole& hole) {
                      return pictured.name == hole.name &&
                             std::hypot(pictured.commanded.x_mm - hole.commanded.x_mm,
                                        pictured.commanded.y_mm - hole.commanded.y_mm) <
                                 kSamePlaceMm;
                    });
}

std::string holes_follow_up_json(const Diagnosis& found, const MeasuredHoles& set) {
  const Lines lines = lines_of(found, set);
  std::string text;
  if (!lines.holes.empty()) text += "\"holes\": cut and add\n";
  for (const grid::Hole& hole : lines.holes) {
    fmt::format_to(std::back_inserter(text),
                   "  {{\"name\": \"{}\", \"x_mm\": {:.0f}, \"y_mm\": {:.0f}}},\n",
                   hole.name,
                   hole.commanded.x_mm + 0.0,
                   hole.commanded.y_mm + 0.0);
  }
  if (!lines.distances.empty()) text += "\"distances\": add, each null filled in\n";
  for (const auto& [from, to] : lines.distances) {
    fmt::format_to(std::back_inserter(text),
                   "  {{\"from\": \"{}\", \"to\": \"{}\", \"distance_mm\": null}},\n",
                   from,
                   to);
  }
  return text;
}

std::string holes_follow_up_csv(const Diagnosis& found, const MeasuredHoles& set) {
  const Lines lines = lines_of(found, set);
  std::string text = "hole,x_mm,y_mm\n";
  for (const grid::Hole& hole : lines.holes) {
    fmt::format_to(std::back_inserter(text),
                   "{},{:.0f},{:.0f}\n",
                   hole.name,
                   hole.commanded.x_mm + 0.0,
                   hole.commanded.y_mm + 0.0);
  }
  text += "from,to,distance_mm\n";
  for (const auto& [from, to] : lines.distances) {
    fmt::format_to(std::back_inserter(text), "{},{},\n", from, to);
  }
  return text;
}

}  // namespace chaintrue::cli
