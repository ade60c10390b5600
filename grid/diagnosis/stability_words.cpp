// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "grid/diagnosis/stability.hpp"
#include "grid/diagnosis/workshop_units.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Up to this many points are listed; for more, their count and the first ones.
constexpr std::size_t kMostNumbers = 5;
constexpr double kBeyondDoubt = 0.995;

struct Kind {
  Removal::What what;
  std::string_view one;
  std::string_view many;
};
constexpr std::array kKinds = {Kind{Removal::What::point, "point", "points"},
                               Kind{Removal::What::column, "column of marks", "columns of marks"},
                               Kind{Removal::What::row, "row of marks", "rows of marks"},
                               Kind{Removal::What::distance, "distance", "distances"},
                               Kind{Removal::What::hole, "hole", "holes"}};

std::vector<const Removal*> of_kind(const Stability& stability, Removal::What what, bool changing) {
  std::vector<const Removal*> found;
  for (const Removal& removal : stability.removals) {
    if (removal.what == what && !(changing && removal.stands)) found.push_back(&removal);
  }
  return found;
}

std::string place(const Diagnosis& diagnosis, const Removal& removal) {
  switch (removal.what) {
    case Removal::What::column:
      return fmt::format("x = {} mm", std::lround(removal.at_mm));
    case Removal::What::row:
      return fmt::format("y = {} mm", std::lround(removal.at_mm));
    case Removal::What::distance:
      return words_of_ends(diagnosis.distances.at(removal.index));
    case Removal::What::hole:
      return diagnosis.holes.at(removal.index).name;
    case Removal::What::point:
      break;
  }
  return fmt::format("{}", removal.index + 1);
}

/// "point 17", "points 3, 9 and 17", "the column of marks at x = 1200 mm".
std::string named_places(const Diagnosis& diagnosis, const Kind& kind,
                         const std::vector<const Removal*>& removals) {
  std::vector<std::string> places;
  for (const Removal* one : removals) {
    if (places.size() < kMostNumbers) places.push_back(place(diagnosis, *one));
  }
  if (removals.size() > kMostNumbers) places.emplace_back("others");
  const bool single = removals.size() == 1;
  const std::string where = joined(places, "and", ", ");
  const std::string_view noun = single ? kind.one : kind.many;
  const bool line = kind.what == Removal::What::column || kind.what == Removal::What::row;
  return line ? fmt::format("the {} at {}", noun, where) : fmt::format("{} {}", noun, where);
}

std::string fate(const Removal& removal) {
  if (removal.causes.empty()) return "nothing would be named";
  std::vector<std::string> names;
  for (const CauseId& cause : removal.causes) {
    const std::string_view side = model::effects::name(cause.side);
    names.push_back(fmt::format("{}{}{}", cause.effect->id, side.empty() ? "" : " ", side));
    std::replace(names.back().begin(), names.back().end(), '_', ' ');
  }
  return fmt::format("the verdict would be {}",
                     joined(names, removal.verdict == Verdict::named_set ? "or" : "and", ", "));
}

/// Whether a column or row that was left out holds the point.
bool lies_on(const Diagnosis& diagnosis, const Removal& line, std::size_t point) {
  auto* found =
      find_where(diagnosis.points, [&](const PointPicture& p) { return p.index == point; });
  const bool is_line = line.what == Removal::What::column || line.what == Removal::What::row;
  if (!is_line || found == nullptr) return false;
  const double at_mm = line.what == Removal::What::column ? found->mark.x_mm : found->mark.y_mm;
  return std::abs(at_mm - line.at_mm) < kLineGapMm;
}

}  // namespace

Indices influential_points(const Diagnosis& diagnosis) {
  Indices points;
  if (!diagnosis.stability) return points;
  for (const Removal* removal : of_kind(*diagnosis.stability, Removal::What::point, true)) {
    points.push_back(removal->index);
  }
  return points;
}

std::string stability_in_words(const Diagnosis& diagnosis) {
  const Stability& stability = *diagnosis.stability;
  std::vector<std::string> tried;
  std::size_t changes = 0;
  for (const Kind& kind : kKinds) {
    const auto all = of_kind(stability, kind.what, false);
    if (all.empty()) continue;
    changes += of_kind(stability, kind.what, true).size();
    tried.push_back(fmt::format("{} {}", all.size(), all.size() == 1 ? kind.one : kind.many));
  }
  const auto weakest = min_element(stability.removals, ascending(&Removal::probability));
  const Kind& kind = kKinds[static_cast<std::size_t>(weakest->what)];
  const std::string which = joined(tried, "and", ", ");
  const std::string text =
      changes == 0 ? fmt::format("Leaving out any of {} does not change the answer.", which)
                   : fmt::format("Of {}, each left out in turn, {} would change the answer.", which,
                                 changes);
  if (weakest->probability > kBeyondDoubt) return text;
  return text + fmt::format(" It is least certain without {}: then {}, with all {} {}.",
                            named_places(diagnosis, kind, {&*weakest}),
                            percent(weakest->probability),
                            diagnosis.observations == Observations::points ? "points" : "readings",
                            percent(stability.probability));
}

std::string influence_in_words(const Diagnosis& diagnosis) {
  if (!diagnosis.stability) return "";
  std::string text;
  const auto points = influential_points(diagnosis);
  for (const Kind& kind : kKinds) {
    auto changes = of_kind(*diagnosis.stability, kind.what, true);
    // A line is mentioned only if not a single point of it is responsible.
    std::erase_if(changes, [&](const Removal* removal) {
      return any_of(points, [&](std::size_t point) { return lies_on(diagnosis, *removal, point); });
    });
    if (changes.empty()) continue;
    text +=
        fmt::format(" {} rests on {}{}: without {} {}.",
                    diagnosis.causes.size() == 1 ? "The name" : "What is named",
                    changes.size() == 1 ? "" : "each of ", named_places(diagnosis, kind, changes),
                    changes.size() == 1 ? "it" : "the first of these", fate(*changes.front()));
  }
  return text;
}

}  // namespace chaintrue::grid::diagnosis
