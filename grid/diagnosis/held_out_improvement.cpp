// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/held_out_improvement.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "grid/diagnosis/best_model.hpp"
#include "grid/diagnosis/held_out_fold.hpp"
#include "grid/parallel.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/random.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

bool names_agree(const Fold& fold, const Analysis& a) {
  return fold.named.empty() ? a.decision.listed.empty()
                            : contains(a.decision.leaders(), fold.named.front());
}

/// Sets the errors of the machine as delivered, and with only the sheets' placement fitted.
void measure_before_calibration(const Analysis& a, const Indices& units, const Indices& number,
                                HeldOutImprovement& improvement) {
  const ObservationSet& session = a.session;
  const auto stated = linearise(session, stated_state(session));
  if (!stated) return;
  const auto summary = [&](const VectorXd& rows) {
    return summarise(errors_of_units(*stated, rows, units), number, a.options.seed);
  };
  const VectorXd as_stated = uncalibrated(session, *stated);
  improvement.uncalibrated = summary(as_stated);
  constexpr auto kOfMachine = std::ssize(model::kMachineSettings);
  const auto sheet = std::ssize(session.settings) - kOfMachine;
  const auto moves = [&](Index k) {
    return session.settings[as_size(k)] != model::Setting::sheet_rotation_rad &&
           session.knows(as_size(k));
  };
  if (none_of(numbers_below<Index>(sheet), [&](Index k) { return moves(kOfMachine + k); })) return;
  improvement.placed =
      summary(left_by(marginalised_system(a).kept, stated->by_setting.middleCols(kOfMachine, sheet),
                      stated->sigma.segment(kOfMachine, sheet), as_stated));
}

/// The errors that judge the extension, which must help at points that it was not fitted to; else those
/// of the calibration.
const ErrorsWith& extension_of(const Analysis& a, const Errors& errors) {
  // If these points leave two names without a block, the wrong one first, that says little against
  // the name that all points give.
  for (const CausesOfFold causes : {kExtended, kFixedNaming}) {
    if (!a.decision.listed.empty() &&
        rms_length(errors[causes].machine) < rms_length(errors[kCalibrated].machine))
      return errors[causes];
  }
  return errors[kCalibrated];
}

/// The held-out errors of every fold.
struct AllFolds {
  Indices units;
  Indices number;  ///< of the block of each
  Errors errors;
  int agree = 0;
};

AllFolds hold_out_each(const Analysis& a, const HeldOutBlocks& blocks) {
  AllFolds all;
  tell(a.options.progress, {"what a name gains", 3, 4});
  const Downdating downdating(a.system, a.comparison);
  std::vector<Fold> folds(blocks.units.size());
  for_each_index(folds.size(),
                 [&](std::size_t b) { folds[b] = fold_without(a, downdating, blocks.units[b]); });
  for (std::size_t b = 0; b < folds.size(); ++b) {
    const Fold& fold = folds[b];
    all.agree += names_agree(fold, a) ? 1 : 0;
    append_all(all.units, fold.units);
    all.number.insert(all.number.end(), fold.units.size(), b);
    for (std::size_t k = 0; k < all.errors.size(); ++k) {
      append_all(all.errors[k].machine, fold.errors[k].machine);
      append_all(all.errors[k].and_surface, fold.errors[k].and_surface);
    }
  }
  return all;
}

std::string scheme_of(const ObservationSet& session, const HeldOutBlocks& blocks,
                      bool naming_repeated) {
  return fmt::format(
      "{}, each left out in turn, {}",
      blocks.of_the_bed ? fmt::format("{} blocks of the bed", blocks.units.size())
                        : fmt::format("all the distances of each of {} holes", blocks.units.size()),
      naming_repeated ? "the rest diagnosed without it"
                      : fmt::format("with the causes from all {} fitted without it, because "
                                    "leaving some out changes the answer",
                                    session.units_word()));
}

}  // namespace

HeldOut summarise(const std::vector<Vector2d>& tool_mm, const Indices& block, std::uint64_t seed) {
  HeldOut result;
  result.rms_mm = rms_length(tool_mm);
  std::vector<double> sorted;
  for (const Vector2d& e : tool_mm) sorted.push_back(e.norm());
  sort(sorted);
  const auto at = static_cast<std::size_t>(std::ceil(0.95 * as_double(sorted.size())));
  result.percentile_95_mm = sorted[at - 1];
  const std::size_t blocks = 1 + *max_element(block);
  std::vector<double> sum(blocks, 0.0);
  std::vector<double> count(blocks, 0.0);
  for (std::size_t i = 0; i < tool_mm.size(); ++i) {
    sum[block[i]] += tool_mm[i].squaredNorm();
    count[block[i]] += 1.0;
  }
  constexpr int kDraws = 400;  // the 5th and 95th percentile to a tenth of the interval
  constexpr std::uint64_t kStream = 62;
  Random random(seed, kStream);
  std::vector<double> drawn;
  for (int draw = 0; draw < kDraws; ++draw) {
    double s = 0.0;
    double n = 0.0;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::size_t k = random.below(blocks);
      s += sum[k];
      n += count[k];
    }
    drawn.push_back(n > 0.0 ? std::sqrt(s / n) : 0.0);
  }
  sort(drawn);
  result.low_mm = drawn[kDraws / 20];
  result.high_mm = drawn[kDraws - 1 - kDraws / 20];
  return result;
}

std::optional<HeldOutImprovement> measure_improvement(const Analysis& a) {
  const HeldOutBlocks blocks = held_out_blocks(a.session);
  const AllFolds folds = hold_out_each(a, blocks);
  const auto& [units, number, all, agree] = folds;
  if (units.empty()) return std::nullopt;
  HeldOutImprovement improvement;
  improvement.folds = static_cast<int>(blocks.units.size());
  improvement.folds_agree = agree;
  const std::uint64_t seed = a.options.seed;
  measure_before_calibration(a, units, number, improvement);
  improvement.calibrated = summarise(all[kCalibrated].machine, number, seed);
  improvement.surface_only = summarise(all[kCalibrated].and_surface, number, seed);
  const ErrorsWith& extension = extension_of(a, all);
  improvement.scheme = scheme_of(a.session, blocks, &extension != &all[kFixedNaming]);
  improvement.extended = summarise(extension.machine, number, seed);
  improvement.extended_and_surface = summarise(extension.and_surface, number, seed);
  improvement.noise_floor_mm =
      std::sqrt(a.estimate.noise_square) * noise_of_units_mm(a.system, units);
  if (&extension != &all[kCalibrated]) {
    const ExpectedImprovement expected = expected_improvement(a);
    improvement.drop_mm2 = expected.drop_mm2;
    improvement.drop_share = expected.share;
  }
  return improvement;
}

bool naming_improves_the_map(const Analysis& a) {
  const Errors errors = hold_out_each(a, held_out_blocks(a.session)).errors;
  return rms_length(extension_of(a, errors).and_surface) <
         rms_length(errors[kCalibrated].and_surface);
}

bool naming_improves_the_map(const std::optional<HeldOutImprovement>& improvement) {
  return improvement && improvement->extended_and_surface.rms_mm < improvement->surface_only.rms_mm;
}

VectorXd uncalibrated(const ObservationSet& session, const RegressorSystem& stated) {
  VectorXd e = stated.e;
  for (const SystemUnit& unit : stated.units) {
    if (!unit.reads_chains) continue;
    const std::size_t number = unit.places.front().place;
    const ObservationPart& part = session.parts[session.places[number].part];
    const observation::Place& place = part.observation->places()[number - part.first_place];
    if (!place.commanded) continue;
    e.segment<2>(unit.first_row) = unit.whitening * (stated.places[number].state.by_mark *
                                                     difference(*place.commanded, place.mark));
  }
  return e;
}

}  // namespace chaintrue::grid::diagnosis
