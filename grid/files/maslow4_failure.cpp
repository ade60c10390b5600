// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/maslow4_scan.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include "grid/belts/commands_check.hpp"
#include "grid/containers.hpp"
#include "grid/files/problems.hpp"

namespace chaintrue::grid::files {
namespace {

/// The firmware's own limit for four readings of a belt.
constexpr double kReadingsAgreeMm = 2.5;
/// Tolerance of a whole number of turns of the encoder: a belt's scatter.
constexpr double kWholeTurnMm = 3.0;
/// The tolerance against commanded places: anchors in force are off by a centimetre, and holding
/// belts stretch.
constexpr double kWholeTurnOfCommandsMm = 10.0;

double spread(const std::vector<double>& readings_mm) {
  if (readings_mm.size() < 2) return 0.0;
  const auto [least, most] = minmax_element(readings_mm);
  return *most - *least;
}

/// Whole turns by which a length is off; 0 if none.
int whole_turns(double excess_mm, double turn_mm, double within_mm = kWholeTurnMm) {
  const double turns = std::round(std::abs(excess_mm) / turn_mm);
  const bool is_whole = std::abs(std::abs(excess_mm) - turns * turn_mm) < within_mm;
  return is_whole ? static_cast<int>(turns) : 0;
}

std::string turns_in_words(int turns) {
  return turns == 1 ? "a whole turn of its encoder" : fmt::format("{} turns of its encoder", turns);
}

std::string where(const RunStopped& stopped) {
  const std::string reached =
      stopped.last_measured < 0
          ? "before the first waypoint was measured"
          : fmt::format("after waypoint {}{}, as the machine counts from 0", stopped.last_measured,
                        stopped.last_announced > stopped.last_measured
                            ? fmt::format(" of 0 to {}", stopped.last_announced)
                            : "");
  return fmt::format("This run did not finish: {} {}",
                     stopped.said.empty() ? "the log ends" : "it stopped", reached);
}

/// The evidence of the single readings and its cause; empty if there are none.
std::string shown_by_readings(const RunStopped& stopped, double turn_mm) {
  const auto spread_of = [&](Belt belt) { return spread(stopped.readings_mm[belt]); };
  const Belt worst = *max_element(kBelts, ascending(spread_of));
  const double most_mm = spread_of(worst);
  if (most_mm <= 0.0) return "";
  const std::string text =
      fmt::format(" At waypoint {} the readings of the {} belt are {:.1f} mm apart",
                  stopped.last_measured + 1, words(worst), most_mm);
  if (const int turns = whole_turns(most_mm, turn_mm)) {
    return fmt::format(
        "{}, {}. Probable cause: an encoder that lost turns. Check its magnet and its cable, "
        "retract that belt, extend it again and measure again.",
        text, turns_in_words(turns));
  }
  const std::size_t apart =
      count_where(kBelts, [&](Belt belt) { return spread_of(belt) > kReadingsAgreeMm; });
  if (apart > 1) {
    return fmt::format(
        "{}, and {} belts have inconsistent readings. Possible causes: a sled that still swings, a "
        "frame that yields, or too weak a pull. Brace the frame, and raise "
        "Maslow_Calibration_Current_Threshold slightly.",
        text, apart);
  }
  return fmt::format(
      "{}, the others agree. Probable cause: a slack belt, or one that catches at the arm or on "
      "the spool. Free it, make sure that it is taut at this place, and measure again.",
      text);
}

/// Comparison of the places read with the commanded ones.
std::string shown_by_commands(const MeasuredBelts& belts) {
  // Anchors in force are off by less; a belt with a wrong zero is off by more.
  constexpr double kFarMm = 20.0;
  const auto found = against_commands(belts);
  if (!found) return "";
  if (found->swapped) {
    return fmt::format(
        " The lengths look like {}. Probable cause: belts at the wrong anchors, or plugged in in "
        "the wrong order. Correct this and measure again.",
        grid::words_of(*found->swapped));
  }
  const auto off = [&](Belt belt) { return std::abs(found->median_mm[belt]); };
  const Belt worst = *max_element(kBelts, ascending(off));
  const std::size_t far = count_where(kBelts, [&](Belt belt) { return off(belt) > kFarMm; });
  if (far != 1) return "";
  const double excess_mm = found->median_mm[worst];
  const int turns = whole_turns(excess_mm, belts.machine.belt_turn_mm, kWholeTurnOfCommandsMm);
  return fmt::format(
      " The {} belt reads {:.0f} mm {} than the settings predict for the commanded place, the "
      "others "
      "agree. Probable cause: {}. Retract it, extend it again and measure again.",
      words(worst), std::abs(excess_mm), excess_mm > 0.0 ? "longer" : "shorter",
      turns > 0 ? fmt::format("{}, lost or gained,", turns_in_words(turns))
      : excess_mm > 0.0
          ? "a slack belt, or an anchor nearer than in the settings,"
          : "an anchor that is farther than in the settings, or an arm that catches,");
}

constexpr std::string_view kReadingsDisagree =
    " The readings at one place did not agree. Possible causes: a slack belt, a belt that "
    "catches, or an encoder that loses turns. Watch the four belts at that place: each "
    "must be taut, and its spool must not turn while it is read.";

/// What happened and what to do, for each kind in their order.
constexpr std::string_view kByKind[] = {
    kReadingsDisagree,
    kReadingsDisagree,
    " The machine gives up if one belt's misfit is twice another's, which good readings "
    "at six places can produce by chance. The belts may be fine: start it again, or use "
    "the readings so far.",
    " The machine's solver stalled, which shows little about the readings. Possible "
    "causes: a frame far from the set size, belts at the wrong anchors, or chance. Tape "
    "the frame, enter its size in the settings and start again.",
    " By the machine's criterion the readings contradict each other. Possible causes: "
    "belts at the wrong anchors, a slack belt at some place, an encoder that lost turns, "
    "or arms that are swapped. Make sure that each belt goes to its own anchor (tl, tr, "
    "bl, br) and that all are taut.",
    " The first place is not where the settings put it. Possible causes: settings of "
    "another frame, belts at the wrong anchors, or belts that were not retracted before "
    "they were extended. Retract all, extend all, tape the frame and enter its size.",
    " The machine went back to \"Belts Extended\" without a message: it was stopped, "
    "its power failed for a moment, or it lost the connection. Start again.",
    " Read the machine's message there, and start again.",
    " Either the run was stopped there or the text was cut off when it was copied: paste "
    "it again from beginning to end, or continue measuring."};
static_assert(std::size(kByKind) == as_size(StopKind::log_ends) + 1);

}  // namespace

std::optional<StopKind> stop_of(std::string_view line) {
  constexpr std::pair<std::string_view, StopKind> kSigns[] = {
      {"Critical error, measurements are not within", StopKind::gave_up_reading},
      {"measurements are not within", StopKind::readings_disagree},
      {"per-anchor RMS imbalance", StopKind::imbalance},
      {"did not converge", StopKind::not_converged},
      {"Find Anchors fit failed", StopKind::low_fitness},
      {"recompute failed", StopKind::low_fitness},
      {"stopped due to low fitness", StopKind::low_fitness},
      {"Center point deviation", StopKind::centre_off}};
  for (const auto& [word, kind] : kSigns) {
    if (has(line, word)) return kind;
  }
  if (has(line, "state change from Find") && has(line, "to Belts Extended"))
    return StopKind::went_back;
  return has(line, "[MSG:ERR") ? std::optional(StopKind::other_error) : std::nullopt;
}

bool is_setting_refused(std::string_view line) {
  constexpr std::array<std::string_view, 5> kSigns = {
      "Invalid setting", "Configuration parse error", "Using default configuration",
      "Configuration validation error", "Cannot open configuration file"};
  return any_of(kSigns, [&](std::string_view sign) { return has(line, sign); });
}

std::string words_of(const SettingsRefused& refused) {
  return fmt::format(
      "the controller rejected its settings ({}), so the typed or found ones are not in force. "
      "Firmware before July 2025 accepts lines such as $/Maslow_trX=, later firmware "
      "$/kinematics/MaslowKinematics/trX=. Send the lines in the layout of the machine's "
      "maslow.yaml (export maslow4 does so if import maslow4 read that file with --settings), "
      "restart the machine and check that it prints no error",
      shortened(refused.said));
}

std::string words_of(const RunStopped& stopped, const MeasuredBelts& belts) {
  std::string text = where(stopped);
  if (!stopped.said.empty()) text += fmt::format("; it printed {}", shortened(stopped.said));
  text += ".";
  const std::string found =
      shown_by_readings(stopped, belts.machine.belt_turn_mm) + shown_by_commands(belts);
  text += found.empty() ? std::string(kByKind[as_size(stopped.kind)]) : found;
  const std::size_t count = belts.points.size();
  if (count >= kFewestBeltPoints) {
    text +=
        fmt::format(" {} places were read before that; chaintrue diagnose can use them.", count);
  } else {
    text += fmt::format(" {} were read before that; a fit needs {}.",
                        count == 0   ? "No places"
                        : count == 1 ? "One place"
                                     : fmt::format("{} places", count),
                        kFewestBeltPoints);
  }
  return text;
}

}  // namespace chaintrue::grid::files
