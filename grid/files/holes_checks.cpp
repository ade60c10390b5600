// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/holes_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "grid/containers.hpp"
#include "grid/files/number_text.hpp"
#include "grid/input_checks/distance_checks.hpp"
#include "grid/input_checks/number_checks.hpp"

namespace chaintrue::grid::files {
namespace {

std::optional<std::size_t> hole_of(const std::string& word, const std::vector<Hole>& holes) {
  for (const auto i : each_index(holes)) {
    if (holes[i].name == word) return i;
  }
  // A number is the index of a hole if no hole has it as its name.
  const auto number = whole_number_of(word, 0, as_int(holes.size()) - 1);
  return number ? std::optional(as_size(*number)) : std::nullopt;
}

std::string names_of(const std::vector<Hole>& holes) { return joined(mapped(holes, &Hole::name)); }

using Pair = std::pair<std::size_t, std::size_t>;

Pair pair_of(const HoleDistance& distance) { return std::minmax(distance.from, distance.to); }

/// The longest pairs that were not measured: what to measure next.
std::string missing_pairs(const MeasuredHoles& set, std::size_t count) {
  std::set<Pair> measured;
  for (const HoleDistance& distance : set.distances) {
    if (!distance.edge) measured.insert(pair_of(distance));
  }
  std::vector<HoleDistance> others;
  for (const auto a : each_index(set.holes)) {
    for (std::size_t b = a + 1; b < set.holes.size(); ++b) {
      if (measured.count({a, b}) == 0) others.push_back({.from = a, .to = b});
    }
  }
  stable_sort(others, descending([&](const HoleDistance& own) { return commanded_mm(set, own); }));
  others.resize(std::min(others.size(), count));
  return joined(mapped(others, [&](const HoleDistance& own) { return words_of(set, own); }));
}

/// Reports to `problems`.
struct HolesChecks {
  const MeasuredHoles& set;
  const HolesPlaces& places;
  Problems& problems;

  /// Reports distances and holes that are both in inches or centimetres: they fit each other, and only
  /// the bed shows it. True if found.
  bool check_other_unit() const {
    double farthest_mm = 0.0;
    for (const Hole& hole : set.holes) {
      farthest_mm =
          std::max({farthest_mm, std::abs(hole.commanded.x_mm), std::abs(hole.commanded.y_mm)});
    }
    // Holes of a set go out to half of the bed's half width and more, which is 1 / 51 to 1 / 25 of it
    // in inches, 1 / 20 to 1 / 10 in centimetres. A set in mm within an eighth of it is inconclusive.
    constexpr double kOfInches = 0.045;
    constexpr double kOfCentimetres = 0.125;
    const double half_width_mm = 0.5 * (set.machine ? set.machine->bed : Bed{}).width_mm;
    const double share = farthest_mm / half_width_mm;
    if (set.holes.size() < 3 || share >= kOfCentimetres) return false;
    problems.explain(
        places.holes, ProblemKind::other_unit,
        fmt::format("these and their distances look like {} (no hole is farther than {:.4g} "
                    "from the middle).",
                    share < kOfInches ? "inches: multiply them by 25.4"
                                      : "centimetres: multiply them by 10",
                    farthest_mm));
    return true;
  }

  /// Reports an error of the whole file; returns the questions about single distances.
  std::vector<input_checks::RowFinding> check_entries() const {
    input_checks::Findings found = input_checks::check_distances(set, places.written);
    if (found.whole) {
      problems.explain(found.whole->from_row
                           ? places.distance(*found.whole->from_row, "distance_mm")
                           : places.distances,
                       found.whole->kind, found.whole->sentence());
    }
    return std::move(found.rows);
  }

  /// Reports two holes so near that the direction from one to the other is undetermined.
  void check_apart() const {
    constexpr double kLeastMm = 20.0;
    for (const auto i : each_index(set.distances)) {
      const HoleDistance& distance = set.distances[i];
      if (distance.edge || commanded_mm(set, distance) >= kLeastMm) continue;
      problems.add(places.distance(i, ""),
                   fmt::format("{}, {:.4g} mm apart as commanded", words_of(set, distance),
                               commanded_mm(set, distance)),
                   ProblemKind::out_of_range,
                   "two holes at least {:.0f} mm apart; holes {} and {} are at the same "
                   "spot: is a minus missing at one of them?",
                   kLeastMm, set.holes[distance.from].name, set.holes[distance.to].name);
    }
  }

  /// Checks each triangle with three measured sides: the longest is no longer than the sum of the
  /// others, within the tape's error.
  void check_triangles(const std::vector<input_checks::RowFinding>& asked) const {
    std::map<Pair, const HoleDistance*> first;
    for (const HoleDistance& distance : set.distances) {
      if (!distance.edge) first.emplace(pair_of(distance), &distance);
    }
    for (const auto& [ab, side_ab] : first) {
      for (std::size_t c = ab.second + 1; c < set.holes.size(); ++c) {
        const auto ac = first.find({ab.first, c});
        const auto bc = first.find({ab.second, c});
        if (ac == first.end() || bc == first.end()) continue;
        std::array sides = {side_ab, ac->second, bc->second};
        sort(sides, descending(&HoleDistance::distance_mm));
        const auto& [longest, second, third] = sides;
        const double excess =
            length_of(set, *longest) - length_of(set, *second) - length_of(set, *third);
        const double sigma =
            std::hypot(sigma_of(set, *longest), sigma_of(set, *second), sigma_of(set, *third));
        constexpr double kBeyondChance = 5.0;  // sigmas: one triangle in some million
        if (excess <= kBeyondChance * sigma) continue;
        std::string question;
        for (const input_checks::RowFinding& row : asked) {
          if (contains(sides, &set.distances[row.row])) question += ". " + row.sentence;
        }
        problems.add(places.distance(as_size(longest - set.distances.data()), "distance_mm"),
                     fmt::format("{:g}", longest->distance_mm), ProblemKind::contradiction,
                     "at most {:.1f} mm, because {} cannot be longer than {} ({:g}) plus "
                     "{} ({:g}); one of the three was misread{}",
                     longest->distance_mm - excess, words_of(set, *longest), words_of(set, *second),
                     second->distance_mm, words_of(set, *third), third->distance_mm, question);
      }
    }
  }

  void check_enough(std::size_t fewest) const {
    std::set<Pair> pairs;
    std::set<std::size_t> used;
    for (const HoleDistance& distance : set.distances) {
      if (distance.edge) continue;
      pairs.insert(pair_of(distance));
      used.insert({distance.from, distance.to});
    }
    // The shape of n holes is 2 n - 3 distances; more distances are redundant.
    const std::size_t shape = used.size() < 2 ? 0 : 2 * used.size() - 3;
    const std::size_t independent = std::min(pairs.size(), shape);
    if (independent >= fewest) return;
    const std::size_t lacking = fewest - independent;
    std::string expected = fmt::format("at least {} independent distances between holes", fewest);
    if (fewest == kFewestHoleDistances) {
      expected +=
          ", one for each unknown: the motors' spacing and the zero and scale of each chain";
    }
    const std::string more = missing_pairs(set, lacking);
    const bool holes_suffice =
        set.holes.size() >= 2 && 2 * set.holes.size() - 3 >= fewest && !more.empty();
    expected += holes_suffice ? fmt::format("; {} missing, measure {}", lacking, more)
                              : fmt::format(
                                    "; cut at least {} holes, of which {} distances are "
                                    "independent",
                                    (fewest + 4) / 2, 2 * ((fewest + 4) / 2) - 3);
    problems.add(places.distances,
                 fmt::format("{} independent distance{}", independent, independent == 1 ? "" : "s"),
                 ProblemKind::too_few, expected);
  }

  /// Without the offset the map would be distorted by the same amount.
  void check_tape_zero(bool is_stated) const {
    const auto offset = suspected_tape_zero_offset_mm(set);
    if (!offset) return;
    const std::string found = fmt::format("distances all about {:.1f} mm {} than commanded",
                                          std::abs(*offset), *offset > 0.0 ? "longer" : "shorter");
    double total_mm = set.tape.tape_zero_offset_mm + *offset;
    // Tapes are held at a printed mark; a machine is off by a centimetre at most.
    constexpr double kAtTheMarkMm = 15.0;
    constexpr double kAtZeroMm = 3.0;
    const double mark_mm =
        input_checks::kTapeMarkMm * std::round(total_mm / input_checks::kTapeMarkMm);
    if (std::abs(total_mm - mark_mm) < (mark_mm == 0.0 ? kAtZeroMm : kAtTheMarkMm))
      total_mm = mark_mm;
    const std::string state =
        fmt::format("enter {:.0f} mm (hook_offset_mm of the tape, or --hook-offset-mm)", total_mm);
    if (is_stated) {
      problems.warn(places.distances,
                    "{}, whatever their length. Was the hook's offset subtracted twice? If so, {}.",
                    found, state);
      return;
    }
    problems.add(places.distances, found, ProblemKind::constant_offset,
                 "the tape's hook offset, because short and long ones are off by the "
                 "same amount: {}; 0 if they are right",
                 state);
  }
};

}  // namespace

void warn_of_copies(const MeasuredHoles& set, const HolesPlaces& places, Problems& problems) {
  // A tape read to the millimetre equals the command now and then; read to the hundredth, or on
  // most of the lines, it does not.
  constexpr double kSameMm = 0.005;
  Words exact;
  Words rounded;
  for (const HoleDistance& distance : set.distances) {
    if (distance.edge) continue;
    const double difference_mm = std::abs(distance.distance_mm - commanded_mm(set, distance));
    // A tape is read to half a millimetre.
    const bool by_eye = 2.0 * distance.distance_mm == std::round(2.0 * distance.distance_mm);
    if (difference_mm < kSameMm && !by_eye) exact.push_back(words_of(set, distance));
    if (distance.distance_mm == std::round(commanded_mm(set, distance)) || difference_mm < kSameMm)
      rounded.push_back(words_of(set, distance));
  }
  const bool most = 2 * rounded.size() > set.distances.size();
  const Words& copies = most ? rounded : exact;
  if (copies.empty()) return;
  problems.warn(places.distances,
                "{} read exactly as commanded. Were they measured? If not, leave "
                "distance_mm blank",
                how_many(copies, set.distances.size(), "distances"));
}

void check_names(std::vector<Hole>& holes, const HolesPlaces& places, Problems& problems) {
  std::map<std::string, std::size_t> first;
  for (const auto i : each_index(holes)) {
    if (holes[i].name.empty()) holes[i].name = fmt::format("{}", i);
    const std::string& name = holes[i].name;
    if (edge_of(name)) {
      problems.add(places.hole(i, ""), name, ProblemKind::repeated_value,
                   "a name that is not an edge of the sheet");
    }
    const auto [other, is_new] = first.emplace(name, i);
    if (!is_new) {
      problems.add(places.hole(i, ""), name, ProblemKind::repeated_value,
                   "a different name for each hole; {} has the same",
                   places.hole(other->second, ""));
    }
  }
}

std::vector<HoleDistance> resolved_distances(const std::vector<StatedDistance>& stated,
                                             const std::vector<Hole>& holes,
                                             const HolesPlaces& places, Problems& problems) {
  std::vector<HoleDistance> distances;
  for (const auto i : each_index(stated)) {
    const StatedDistance& from = stated[i];
    HoleDistance distance;
    distance.distance_mm = from.distance_mm.value_or(0.0);
    distance.sigma_mm = from.sigma_mm;
    if (!from.is_spoilt) {
      const auto start = hole_of(from.from, holes);
      const auto end = hole_of(from.to, holes);
      distance.edge = edge_of(from.to);
      if (!start) {
        problems.add(places.distance(i, "from"), from.from, ProblemKind::unknown_word,
                     "a hole that was cut: {}", names_of(holes));
      }
      if (!end && !distance.edge) {
        problems.add(places.distance(i, "to"), from.to, ProblemKind::unknown_word,
                     "a hole that was cut ({}) or an edge of the sheet (left, right, "
                     "top, bottom)",
                     names_of(holes));
      }
      if (start && end && *start == *end) {
        problems.add(places.distance(i, "to"), from.to, ProblemKind::repeated_value,
                     "a hole different from the distance's start");
      }
      distance.from = start.value_or(0);
      distance.to = distance.edge ? distance.from : end.value_or(0);
    }
    distances.push_back(distance);
  }
  return distances;
}

void check_holes_together(const MeasuredHoles& set, std::size_t fewest_distances,
                          bool tape_zero_is_stated, const HolesPlaces& places, Problems& problems) {
  const HolesChecks checks{set, places, problems};
  checks.check_apart();
  if (problems.any()) return;
  const auto asked = checks.check_entries();
  if (problems.any() || checks.check_other_unit()) return;
  checks.check_triangles(asked);
  for (const input_checks::RowFinding& row : asked)
    problems.warn(places.distance(row.row, "distance_mm"), row.sentence, ProblemKind::doubtful_row);
  checks.check_enough(fewest_distances);
  if (!problems.any()) checks.check_tape_zero(tape_zero_is_stated);
}

}  // namespace chaintrue::grid::files
