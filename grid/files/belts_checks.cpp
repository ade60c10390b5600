// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/belts_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "grid/belts/belt_checks.hpp"
#include "grid/belts/belts_fit.hpp"
#include "grid/belts/commands_check.hpp"
#include "grid/belts/two_frames.hpp"

namespace chaintrue::grid::files {

std::string lengths_in_words(const BeltPoint& point) {
  const auto& l = point.lengths_mm;
  return fmt::format("tl {}, tr {}, bl {}, br {}", l.tl, l.tr, l.bl, l.br);
}

bool holds_repeats(const MeasuredBelts& belts) {
  constexpr double kSamePlaceMm = 2.0;
  for (std::size_t i = 1; i < belts.points.size(); ++i) {
    double farthest_mm = 0.0;
    for (const Belt belt : kBelts) {
      farthest_mm = std::max(farthest_mm, std::abs(belts.points[i].lengths_mm[belt] -
                                                   belts.points[i - 1].lengths_mm[belt]));
    }
    if (farthest_mm > 0.0 && farthest_mm < kSamePlaceMm) return true;
  }
  return false;
}

std::vector<BeltCopy> copies_of(const std::vector<BeltPoint>& points) {
  std::map<std::array<double, 4>, std::size_t> known;
  std::vector<BeltCopy> copies;
  for (const auto i : each_index(points)) {
    const auto& l = points[i].lengths_mm;
    const auto [first, is_new] = known.emplace(std::array{l.tl, l.tr, l.bl, l.br}, i);
    if (!is_new) copies.push_back({i, first->second});
  }
  return copies;
}

namespace {

/// Reports to `problems`.
struct BeltsChecks {
  const MeasuredBelts& belts;
  const BeltPlaces& places;
  Problems& problems;

  void check_unit() const {
    const auto unit = suspected_unit(belts);
    if (!unit) return;
    problems.explain(
        places.points, ProblemKind::other_unit,
        fmt::format("these lengths look like {}: multiply them by {:g} (they are about "
                    "{:.3g}; the machine prints mm).",
                    unit->word, unit->factor, unit->found));
  }

  void check_twice() const {
    const bool has_repeats = holds_repeats(belts);
    for (const auto& [i, first] : copies_of(belts.points)) {
      const std::string same = places.point(first, "");
      if (has_repeats) {
        problems.warn(places.point(i, ""),
                      "the same four lengths as {} to the last digit; treated as a repeat, like "
                      "others here. If it is a copy, leave one of the two out",
                      same);
        continue;
      }
      problems.add(places.point(i, ""), lengths_in_words(belts.points[i]),
                   ProblemKind::repeated_value,
                   "a separate reading: {} has the same four lengths to the last digit; leave one "
                   "of the two out",
                   same);
    }
  }

  void check_pulled() const {
    if (belts.machine.orientation == Orientation::flat) return;
    for (const auto i : each_index(belts.points)) {
      if (!belts.points[i].pulled) continue;
      for (const Belt belt : *belts.points[i].pulled) {
        if (!is_upper(belt)) continue;
        problems.add(places.point(i, "pulled"), std::string(name(belt)), ProblemKind::contradiction,
                     "bl and br only: on an upright frame tl and tr hold the sled and are never "
                     "pulled; if the frame lies flat, use \"orientation\": \"flat\"");
      }
    }
  }

  void check_pulls() const {
    const std::optional<BeltPull>& first = belts.points.front().pull;
    for (std::size_t i = 1; i < belts.points.size(); ++i) {
      const std::optional<BeltPull>& own = belts.points[i].pull;
      if (own.has_value() == first.has_value() && (!own || own->unit == first->unit)) continue;
      problems.add(places.point(i, "pull"), own ? words_of(*own) : "no pull",
                   ProblemKind::contradiction,
                   "a pull like that of point 1 ({}): either all points have a pull, in "
                   "one unit (pull_n, pull_ma or pull), or none has",
                   first ? words_of(*first) : "none");
      return;
    }
  }

  void check_swap() const {
    const auto swap = suspected_swap(belts);
    if (!swap) return;
    const auto pair = [](BeltPair p) {
      return fmt::format("{} and {}", name(p.first), name(p.second));
    };
    std::string found = words_of(swap->belts);
    if (swap->or_else) found += fmt::format(", or {}", pair(*swap->or_else));
    // Mirrored frames agree as well as true ones; the misfit of other permutations can be of any
    // size.
    constexpr double kMirroredMm = 15.0;
    constexpr double kMostReported = 1000.0;
    problems.add(
        places.points, found, ProblemKind::sides_swapped,
        "each belt's lengths under its own name: exchanged, they agree to {:.1f} mm; as they "
        "are, they {}",
        swap->swapped_mm,
        swap->as_stated_mm < kMirroredMm
            ? std::string("form a mirror image of the frame")
            : fmt::format("contradict each other by {}{:.0f} mm",
                          swap->as_stated_mm > kMostReported ? "more than " : "",
                          std::min(swap->as_stated_mm, kMostReported)));
  }

  void check_settings(const belts::AnchorFit& frame) const {
    const auto other = suspected_other_frame(belts, frame);
    if (!other) return;
    problems.add(
        fmt::format("{}/anchors", places.machine),
        fmt::format("{} of {:.0f} mm", other->coordinate, other->stated_mm),
        ProblemKind::contradiction,
        "anchors of the measured frame, whose {} is {:.0f} mm according to the lengths{}; these "
        "settings are from another frame, or belts are at the wrong anchors. Use the settings of "
        "this machine, or none (leave out x_mm and y_mm, or --settings)",
        other->coordinate, other->fitted_mm,
        other->upper_mm > 0.0
            ? fmt::format(", and at the commanded places the upper belts read {:.0f} mm off "
                          "these anchors",
                          other->upper_mm)
            : "");
  }

  void check_readings(const belts::AnchorFit& frame) const {
    for (const BeltQuestion& asked : suspected_readings(belts, frame))
      problems.warn(places.point(asked.point, fmt::format("{}_mm", name(asked.belt))),
                    asked.sentence);
    for (const DistanceQuestion& asked : suspected_distances(belts, frame)) {
      problems.add(fmt::format("/distances/{}/distance_mm", asked.distance),
                   fmt::format("{:.10g}", belts.distances[asked.distance].distance_mm),
                   ProblemKind::contradiction,
                   "about {:.0f}, according to the lengths of the belts; {}", asked.by_belts_mm,
                   asked.question);
    }
  }

  void check_nowhere(const belts::AnchorFit& frame) const {
    for (const NowherePoint& nowhere : points_nowhere(belts, frame)) {
      problems.add(places.point(nowhere.point, ""), lengths_in_words(belts.points[nowhere.point]),
                   ProblemKind::contradiction,
                   "four lengths that meet at one place; with the anchors from the other "
                   "points, the best place is off by {:.0f} mm: is a digit missing, or "
                   "is it from another frame? Correct it or leave the point out",
                   nowhere.residual_mm);
    }
  }
};

}  // namespace

void check_belt_points(const MeasuredBelts& belts, const BeltPlaces& places, Problems& problems) {
  const BeltsChecks checks{belts, places, problems};
  checks.check_unit();
  std::vector<StatedOrder> orders;
  for (const BeltPoint& point : belts.points) orders.push_back({point.order});
  check_orders(orders, places.point, problems);
  checks.check_twice();
  checks.check_pulled();
  checks.check_pulls();
}

void check_belt_distances(const MeasuredBelts& belts, Problems& problems) {
  for (const auto i : each_index(belts.distances)) {
    const BeltDistance& distance = belts.distances[i];
    const auto place = [&](std::string_view end) {
      return fmt::format("/distances/{}/{}", i, end);
    };
    const auto check = [&](const BeltEnd& end, std::string_view key) {
      const auto* index = std::get_if<std::size_t>(&end);
      if (index != nullptr && *index >= belts.points.size()) {
        problems.add(place(key), fmt::format("{}", *index), ProblemKind::out_of_range,
                     "a point of this file, counted from 0: 0 to {}", belts.points.size() - 1);
      }
      if (std::holds_alternative<CutHole>(end) && !belts.machine.anchors_known) {
        problems.add(
            place(key), words_of(end), ProblemKind::unknown_word,
            "a point or an anchor; the position of a hole follows from the anchors in force when "
            "it was cut, and the machine has no x_mm and y_mm for them");
      }
    };
    check(distance.from, "from");
    check(distance.to, "to");
    if (words_of(distance.from) == words_of(distance.to)) {
      problems.add(place("to"), words_of(distance.to), ProblemKind::repeated_value,
                   "an end different from its start");
    }
  }
}

bool check_belts_together(const MeasuredBelts& belts, const BeltPlaces& places, BeltsUse use,
                          Problems& problems) {
  // No fit takes more, so readers reject them at once.
  if (belts.points.size() > kMostBeltPoints) return false;
  const bool is_enough = belts.points.size() >= kFewestBeltPoints;
  if (is_enough) {
    const BeltsChecks checks{belts, places, problems};
    checks.check_swap();
    if (problems.any()) return false;
    if (const auto other = second_frame_begins(belts)) {
      problems.explain(
          places.point(*other, ""), ProblemKind::other_sheet,
          "from here on the places are from a different frame: each part is consistent, but no "
          "frame fits both. Possible causes: a belt that was hooked in again, an anchor that was "
          "moved, or two files joined into one. Make each part a separate file");
      return false;
    }
    if (const auto frame = frame_of_lengths(belts)) {
      checks.check_settings(*frame);
      checks.check_nowhere(*frame);
      checks.check_readings(*frame);
    }
    if (problems.any()) return false;
  }
  MeasuredBelts untaped = belts;
  untaped.distances.clear();
  const auto fit = fit_belts(untaped);
  if (fit) return true;
  using Reason = BeltsFitFailure::Reason;
  const Reason reason = fit.error().reason;
  const bool only_said = use == BeltsUse::import && reason != Reason::no_frame;
  if (only_said) {
    problems.warn(places.points, "not enough for a fit of the anchors yet: {}",
                  fit.error().sentence());
    return false;
  }
  const std::string found = fmt::format("{} places", belts.points.size());
  if (reason == Reason::too_few_points) {
    problems.add(places.points, found, ProblemKind::too_few,
                 "at least {}, which leave {} checks of the anchors", kFewestBeltPoints,
                 2 * kFewestBeltPoints - 5);
  } else if (reason == Reason::not_determined) {
    problems.add(
        places.points, found + " on a line", ProblemKind::on_a_line,
        "places spread over the sheet's width and height; on a line or in one spot they do not "
        "determine the anchors");
  } else {
    problems.add(places.points, found + " that fit no frame", ProblemKind::contradiction,
                 "lengths of one frame; {}", fit.error().sentence());
  }
  return false;
}

}  // namespace chaintrue::grid::files
