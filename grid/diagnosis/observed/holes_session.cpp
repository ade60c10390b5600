// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>

#include "grid/diagnosis/session.hpp"
#include "grid/holes/holes_fit.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using Reason = DiagnosisFailure::Reason;

tl::unexpected<DiagnosisFailure> failure(Reason reason, std::string sentence) {
  return tl::unexpected(DiagnosisFailure{reason, std::move(sentence)});
}

/// What is stated without any doubt is taken as known this well, mm.
constexpr double kKnownSigmaMm = 1e-6;

/// Pairs of holes between which nothing was measured, the farthest apart first.
std::vector<std::string> unmeasured(const MeasuredHoles& set, std::size_t most) {
  std::set<std::pair<std::size_t, std::size_t>> done;
  for (const HoleDistance& d : set.distances) {
    if (!d.edge) done.insert(std::minmax(d.from, d.to));
  }
  std::vector<HoleDistance> left;
  for (std::size_t i = 0; i < set.holes.size(); ++i) {
    for (std::size_t j = i + 1; j < set.holes.size(); ++j) {
      if (done.count({i, j}) == 0) left.push_back({.from = i, .to = j});
    }
  }
  std::stable_sort(left.begin(), left.end(), [&](const HoleDistance& a, const HoleDistance& b) {
    return commanded_mm(set, a) > commanded_mm(set, b);
  });
  std::vector<std::string> words;
  for (const HoleDistance& d : left) {
    if (words.size() < most) words.push_back(words_of(set, d));
  }
  return words;
}

std::string too_few(const MeasuredHoles& set) {
  const std::size_t missing = kFewestDistances - set.distances.size();
  const std::vector<std::string> pairs = unmeasured(set, missing);
  std::string text = fmt::format(
      "{} distances are too few to name a cause: they tell four of the settings, and at least {} "
      "are needed; nine holes and twenty distances are a good start",
      set.distances.size(),
      kFewestDistances);
  if (!pairs.empty()) text += fmt::format(". Measure also {}", fmt::join(pairs, ", "));
  if (pairs.size() < missing) {
    text += fmt::format("{} {}",
                        pairs.empty() ? ". Cut more holes and measure" : ", and from new holes",
                        missing - pairs.size());
  }
  return text;
}

struct Ordered {
  MeasuredHoles set;
  std::vector<std::size_t> hole;      ///< into the given set's
  std::vector<std::size_t> distance;  ///< into the given set's
};

/// Holes by place and distances by their holes: an order that the file's does not change.
Ordered in_order(const MeasuredHoles& set) {
  Ordered result{set, {}, {}};
  result.hole.resize(set.holes.size());
  std::iota(result.hole.begin(), result.hole.end(), std::size_t{0});
  std::sort(result.hole.begin(), result.hole.end(), [&](std::size_t a, std::size_t b) {
    const Hole& x = set.holes[a];
    const Hole& y = set.holes[b];
    return std::tie(x.commanded.x_mm, x.commanded.y_mm, x.name) <
           std::tie(y.commanded.x_mm, y.commanded.y_mm, y.name);
  });
  std::vector<std::size_t> place(set.holes.size());
  for (std::size_t i = 0; i < result.hole.size(); ++i) {
    place[result.hole[i]] = i;
    result.set.holes[i] = set.holes[result.hole[i]];
  }
  const auto key = [&](std::size_t k) {
    const HoleDistance& d = set.distances[k];
    const std::size_t a = place[d.from];
    const std::size_t b = d.edge ? a : place[d.to];
    return std::tuple(
        std::min(a, b), std::max(a, b), d.edge, d.distance_mm, d.session, sigma_of(set, d));
  };
  result.distance.resize(set.distances.size());
  std::iota(result.distance.begin(), result.distance.end(), std::size_t{0});
  std::stable_sort(result.distance.begin(),
                   result.distance.end(),
                   [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  for (std::size_t k = 0; k < result.distance.size(); ++k) {
    HoleDistance own = set.distances[result.distance[k]];
    own.from = place[own.from];
    if (!own.edge) own.to = place[own.to];
    result.set.distances[k] = own;
  }
  return result;
}

/// The machine's settings, where the sheet lies, how large it is, the hook of each session of
/// the tape, and each hole's own error.
void state_unknowns(const MeasuredHoles& set, Session& session) {
  session.settings.assign(model::kMachineSettings.begin(), model::kMachineSettings.end());
  session.settings.insert(
      session.settings.end(), model::kSheetSettings.begin(), model::kSheetSettings.end());
  constexpr auto kOfMachine = static_cast<Eigen::Index>(model::kMachineSettings.size());
  constexpr auto kSettings = kOfMachine + static_cast<Eigen::Index>(model::kSheetSettings.size());
  const Eigen::Index of_holes = 2 * static_cast<Eigen::Index>(set.holes.size());
  const auto hooks = static_cast<Eigen::Index>(session.tape_sessions.size());
  session.stated_value = Eigen::VectorXd::Zero(kSettings + 2 + hooks + of_holes);
  session.stated_sigma.resize(session.stated_value.size());
  for (Eigen::Index k = 0; k < kOfMachine; ++k) {
    const model::Setting setting = session.settings[static_cast<std::size_t>(k)];
    session.stated_value(k) = model::stated_value(session.stated, setting);
    session.stated_sigma(k) =
        std::max(model::stated_sigma(session.stated, setting), kKnownSigmaMm);
  }
  session.stated_sigma.segment<3>(kOfMachine) << kSheetShiftMm, kSheetShiftMm, kSheetTurnRad;
  session.stated_sigma.segment<2>(kSettings).setConstant(
      std::max(set.sheet.size_sigma_mm, kKnownSigmaMm));
  session.stated_sigma.segment(kSettings + 2, hooks)
      .setConstant(std::max(set.tape.hook_sigma_mm.value_or(0.0), kKnownSigmaMm));
  session.stated_sigma.tail(of_holes).setConstant(std::max(set.hole_sigma_mm, kKnownSigmaMm));
}

void take_holes(HoleDistances distances, const std::vector<std::size_t>& index, Session& session) {
  session.distances = std::make_shared<const HoleDistances>(std::move(distances));
  session.points.clear();
  const std::vector<Hole>& holes = session.distances->set().holes;
  for (std::size_t i = 0; i < holes.size(); ++i) {
    session.points.push_back(
        {index[i], holes[i].commanded, session.distances->lengths()[i], static_cast<int>(i)});
  }
  state_unknowns(session.distances->set(), session);
}

}  // namespace

bool Session::knows(model::Setting setting) const {
  if (!distances || setting < model::Setting::sheet_x_mm) return true;
  const SheetMeasured measured = sheet_measured(distances->set());
  return setting == model::Setting::sheet_x_mm   ? measured.x
         : setting == model::Setting::sheet_y_mm ? measured.y
                                                 : measured.rotation;
}

tl::expected<Session, DiagnosisFailure> make_session(const MeasuredHoles& set) {
  if (!set.machine) {
    return failure(Reason::no_machine,
                   "the holes name no machine; what was commanded becomes chain lengths by its "
                   "controller: give --machine M.json");
  }
  if (set.distances.size() < kFewestDistances) return failure(Reason::too_few_points, too_few(set));
  const Ordered ordered = in_order(set);
  auto distances = HoleDistances::of(ordered.set);
  if (!distances) return failure(Reason::point_unreachable, distances.error());
  Session session;
  session.stated = *set.machine;
  session.distance_index = ordered.distance;
  session.noise_dof = set.noise_dof;
  if (set.tape.hook_sigma_mm) {
    std::set<std::size_t> sessions;
    for (const HoleDistance& d : set.distances) sessions.insert(d.session);
    session.tape_sessions.assign(sessions.begin(), sessions.end());
  }
  take_holes(*std::move(distances), ordered.hole, session);
  return session;
}

std::optional<Session> with_holes(const Session& session, MeasuredHoles set) {
  std::vector<std::size_t> index(set.holes.size());
  std::iota(index.begin(), index.end(), std::size_t{0});
  auto distances = HoleDistances::of(std::move(set));
  if (!distances) return std::nullopt;
  Session other = session;
  other.readings.clear();
  other.distance_index.resize(distances->set().distances.size());
  std::iota(other.distance_index.begin(), other.distance_index.end(), std::size_t{0});
  take_holes(*std::move(distances), index, other);
  return other;
}

}  // namespace chaintrue::grid::diagnosis
