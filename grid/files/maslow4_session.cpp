// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/maslow4_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "grid/belts/two_frames.hpp"
#include "grid/containers.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/pattern.hpp"

namespace chaintrue::grid::files {
namespace {

std::optional<BeltPull> pull_of(std::string_view text) {
  constexpr Range kPull{"", 1e-3, 1e6};
  const auto part = match(text, "(.*?)(mA|N)?");
  const auto value = part.empty() ? std::nullopt : number_of(part[1]);
  if (!value || !kPull.holds(*value)) return std::nullopt;
  return BeltPull{*value, part[2] == "mA"  ? BeltPull::Unit::milliampere
                          : part[2] == "N" ? BeltPull::Unit::newton
                                           : BeltPull::Unit::relative};
}

void give_pull(const BeltPull& pull, MeasuredBelts& belts) {
  for (BeltPoint& point : belts.points) point.pull = pull;
}

void check_all_have_pulls(const std::vector<Maslow4Import>& runs, std::size_t given) {
  if (given > 0 && given != runs.size()) {
    refuse("the command line", "--pulls", fmt::format("{}", given),
           fmt::format("a pull for each of the {} runs, in their order", runs.size()));
  }
  if (given > 0 || runs.size() == 1) return;
  for (const Maslow4Import& run : runs) {
    if (!run.belts.points.empty() && run.belts.points.front().pull) continue;
    refuse(run.belts.name, "no Maslow_Calibration_Current_Threshold",
           "how hard belts were pulled in each run: --pulls 1300mA,1900mA (that setting), or "
           "--pulls 1,1.6 if only the ratio is known; --pulls 1,1 if nothing was changed");
  }
}

/// All points belong to one frame, whatever their run.
void check_frame(const MeasuredBelts& session, const std::string& name) {
  if (session.points.size() > kMostBeltPoints) return;
  const auto second = second_frame_begins(session);
  if (!second) return;
  refuse(name, "readings of anchors other than the previous run's",
         "runs of one frame: moved anchors need a new session");
}

}  // namespace

std::vector<BeltPull> pulls_of(const std::string& text, const std::string& option) {
  std::optional<BeltPull::Unit> unit;
  return list_of_option(
      text, option,
      "how hard belts were pulled, one number for each run: a ratio 1,1.6, motor currents "
      "1300mA,1900mA, or forces 150N,240N",
      [&unit](const std::string& part) {
        const auto pull = pull_of(part);
        if (!pull || unit.value_or(pull->unit) != pull->unit) return std::optional<BeltPull>();
        unit = pull->unit;
        return pull;
      });
}

Maslow4Import one_session(std::vector<Maslow4Import> runs, const std::vector<BeltPull>& pulls) {
  if (runs.empty()) throw std::logic_error("a session of no runs");
  check_all_have_pulls(runs, pulls.size());
  for (const auto i : each_index(pulls)) give_pull(pulls[i], runs[i].belts);
  Maslow4Import session = std::move(runs.front());
  const bool has_pull = !session.belts.points.empty() && session.belts.points.front().pull;
  if (runs.size() == 1 && !has_pull && session.settings_pull)
    give_pull(*session.settings_pull, session.belts);
  for (std::size_t i = 1; i < runs.size(); ++i) {
    Maslow4Import& run = runs[i];
    int visit = 0;
    for (const BeltPoint& point : session.belts.points)
      visit = std::max(visit, point.order.value_or(-1) + 1);
    for (BeltPoint& point : run.belts.points) {
      if (point.order) *point.order += visit;
      session.belts.points.push_back(std::move(point));
    }
    check_frame(session.belts, run.belts.name);
    append_all(session.warnings, run.warnings);
    session.is_enough = session.is_enough || run.is_enough;
    if (run.stopped) session.stopped = std::move(run.stopped);
    // The machine's own figures cover one run.
    session.belts.firmware_fit.reset();
  }
  return session;
}

}  // namespace chaintrue::grid::files
