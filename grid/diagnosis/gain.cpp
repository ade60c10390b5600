// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/gain.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "grid/diagnosis/expected_gain.hpp"
#include "grid/map/spatial_blocks.hpp"
#include "grid/synthetic/random.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr double kBorderShare = 0.9;  // of the half width of the points: beyond is the border

/// Tool errors for every way of modelling.
struct Errors {
  std::vector<Eigen::Vector2d> calibrated, surface_only;
  /// With the causes that the fold itself names.
  std::vector<Eigen::Vector2d> extended, extended_and_surface;
  /// With the causes that all points name, their sizes fitted without the fold.
  std::vector<Eigen::Vector2d> fixed_naming, fixed_naming_and_surface;
};

/// Held-out points of one fold.
struct Fold {
  std::vector<std::size_t> points;
  Errors errors;
  std::vector<CauseClass> named;
};

class Folds {
 public:
  Folds(const Session& session, const Analysis& analysis, const DiagnosisOptions& options)
      : session_(session), a_(analysis), options_(options) {}

  [[nodiscard]] Fold hold_out(const std::vector<std::size_t>& points) const {
    std::vector<bool> excluded(session_.units(), false);
    for (const std::size_t i : points) excluded[i] = true;
    const ComparisonOptions compared{options_.steps, true, options_.told};
    const ModelComparison comparison = compare_models(session_, a_.system, excluded, compared);
    // The same gate as for all points: the strongest score against what noise does.
    const MarginalisedSystem& first =
        comparison.marginalised_systems[comparison.best().marginalised];
    const SingleScore score(a_.system, first, session_.noise_dof);
    const bool seen = options_.told.has_value() ||
                      a_.null.p_value(score.by_cause(first.e).maxCoeff()) < kFalseAlarm;
    const Decision decision =
        decide_beside_discrepancy(session_, a_.system, comparison, excluded, seen);
    const MarginalisedSystem& marginalised = comparison.marginalised_systems[decision.marginalised];
    Fold fold;
    for (const std::size_t i : points) {
      if (!outlier_in_all(i)) fold.points.push_back(i);
    }
    for (const std::size_t index : decision.listed) fold.named.push_back(decision.classes[index]);
    const MarginalisedSystem plain =
        without_slips(session_, a_.system, marginalised, a_.decision.regressors, options_.steps);
    fold.errors.calibrated = errors(fit(plain, {}), fold.points);
    fold.errors.surface_only =
        beside_discrepancy(comparison, decision.marginalised, {}, fold.points);
    fold.errors.extended = errors(fit(marginalised, decision.regressors), fold.points);
    fold.errors.extended_and_surface =
        beside_discrepancy(comparison, decision.marginalised, decision.regressors, fold.points);
    const std::vector<int>& all = a_.decision.regressors;
    fold.errors.fixed_naming = errors(fit(marginalised, all), fold.points);
    fold.errors.fixed_naming_and_surface =
        beside_discrepancy(comparison, decision.marginalised, all, fold.points);
    return fold;
  }

 private:
  [[nodiscard]] bool outlier_in_all(std::size_t point) const {
    if (a_.comparison.marginalised_systems[a_.decision.marginalised].outliers[point]) return true;
    // A reading wrong at its own visit alone says nothing of any other.
    for (const int k : a_.decision.regressors) {
      const Regressor& d = a_.system.regressors[static_cast<std::size_t>(k)];
      if (d.slip && session_.points[point].order == static_cast<int>(d.values.back())) return true;
    }
    return false;
  }

  [[nodiscard]] Estimate fit(const MarginalisedSystem& marginalised,
                             const std::vector<int>& regressors,
                             int discrepancy = -1) const {
    return estimate(session_, a_.system, marginalised, regressors, discrepancy);
  }

  [[nodiscard]] std::vector<Eigen::Vector2d> beside_discrepancy(
      const ModelComparison& comparison,
      std::size_t marginalised,
      const std::vector<int>& regressors,
      const std::vector<std::size_t>& points) const {
    const int discrepancy = preferred_discrepancy(comparison, marginalised, regressors);
    return errors(fit(comparison.marginalised_systems[marginalised], regressors, discrepancy),
                  points);
  }

  /// The discrepancy that the points prefer beside these causes; none where they would rather have
  /// none.
  static int preferred_discrepancy(const ModelComparison& comparison,
                                   std::size_t marginalised,
                                   const std::vector<int>& regressors) {
    for (const CandidateModel& model : comparison.models) {
      if (model.regressors == regressors && model.marginalised == marginalised)
        return model.discrepancy;
    }
    return -1;
  }

  /// What the model leaves, the discrepancy that it may have taken out.
  [[nodiscard]] std::vector<Eigen::Vector2d> errors(const Estimate& model,
                                                    const std::vector<std::size_t>& points) const {
    const Eigen::VectorXd left = left_of_machine(a_.system, model, model.left_beside_discrepancy);
    std::vector<Eigen::Vector2d> result;
    for (const std::size_t i : points) result.push_back(error_of_unit(a_.system, left, i));
    return result;
  }

  const Session& session_;
  const Analysis& a_;
  const DiagnosisOptions& options_;
};

double rms(const std::vector<Eigen::Vector2d>& errors) {
  double sum = 0.0;
  for (const auto& e : errors) sum += e.squaredNorm();
  return errors.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(errors.size()));
}

std::vector<LengthPoint> as_length_points(const Session& session) {
  std::vector<LengthPoint> result;
  for (const SessionPoint& p : session.points) result.push_back({p.index, p.mark, p.lengths});
  return result;
}

/// Blocks of the bed; or each hole with all distances that end there.
std::vector<std::vector<std::size_t>> held_out_blocks(const Session& session) {
  if (!session.distances) return spatial_blocks(as_length_points(session));
  const MeasuredHoles& set = session.distances->set();
  std::vector<std::vector<std::size_t>> blocks(set.holes.size());
  for (std::size_t k = 0; k < set.distances.size(); ++k) {
    blocks[set.distances[k].from].push_back(k);
    if (!set.distances[k].edge) blocks[set.distances[k].to].push_back(k);
  }
  std::erase_if(blocks, [](const auto& block) { return block.empty(); });
  return blocks;
}

/// Three blocks, and twice the fewest points; of distances the fewest without any of the blocks.
bool are_enough(const Session& session, const std::vector<std::vector<std::size_t>>& blocks) {
  if (blocks.size() < 3) return false;
  if (!session.distances) return session.points.size() >= 2 * kFewestPoints;
  return std::all_of(blocks.begin(), blocks.end(), [&](const auto& block) {
    return session.units() - block.size() >= kFewestDistances;
  });
}

/// Points beyond kBorderShare of the measured half width or half height.
std::vector<std::size_t> border(const Session& session) {
  double low_x = session.points.front().mark.x_mm;
  double high_x = low_x;
  double low_y = session.points.front().mark.y_mm;
  double high_y = low_y;
  for (const SessionPoint& p : session.points) {
    low_x = std::min(low_x, p.mark.x_mm);
    high_x = std::max(high_x, p.mark.x_mm);
    low_y = std::min(low_y, p.mark.y_mm);
    high_y = std::max(high_y, p.mark.y_mm);
  }
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < session.points.size(); ++i) {
    const model::BedPoint& m = session.points[i].mark;
    const double x =
        std::abs(m.x_mm - 0.5 * (low_x + high_x)) / std::max(0.5 * (high_x - low_x), 1.0);
    const double y =
        std::abs(m.y_mm - 0.5 * (low_y + high_y)) / std::max(0.5 * (high_y - low_y), 1.0);
    if (std::max(x, y) > kBorderShare) result.push_back(i);
  }
  return result;
}

bool names_agree(const Fold& fold, const Analysis& a) {
  const auto leader = [](const std::vector<CauseClass>& named) {
    std::vector<CauseId> ids;
    for (const CauseClass& one : named) ids.push_back(one.front());
    return ids;
  };
  std::vector<CauseId> whole;
  for (const std::size_t index : a.decision.listed)
    whole.push_back(a.decision.classes[index].front());
  const std::vector<CauseId> here = leader(fold.named);
  if (whole.empty() || here.empty()) return whole.empty() && here.empty();
  return std::find(whole.begin(), whole.end(), here.front()) != whole.end();
}

/// Root mean square of what noise alone does to a reading, seen at the tool.
double noise_floor(const Session& session,
                   const Analysis& a,
                   const std::vector<std::size_t>& points) {
  double sum = 0.0;
  for (const std::size_t i : points) {
    sum += noise_of_unit_mm2(session, a.system, i);
  }
  return std::sqrt(a.estimate.noise_square * sum / static_cast<double>(points.size()));
}

/// Tool errors with the settings as stated, and with the sheet alone moved to where it fits.
struct Delivered {
  std::vector<Eigen::Vector2d> as_stated, placed;
};

Delivered delivered(const Session& session,
                    const Analysis& a,
                    const std::vector<std::size_t>& points) {
  Delivered result;
  const auto stated = linearise(session, stated_state(session), {});
  if (!stated) return result;
  constexpr auto kOfMachine = static_cast<Eigen::Index>(model::kMachineSettings.size());
  const auto sheet = static_cast<Eigen::Index>(session.settings.size()) - kOfMachine;
  Eigen::VectorXd placed = stated->e;
  const Eigen::MatrixXd by_sheet = stated->by_setting.middleCols(kOfMachine, sheet);
  const bool moves = sheet > 0 && (session.knows(model::Setting::sheet_x_mm) ||
                                   session.knows(model::Setting::sheet_y_mm));
  if (moves) {
    const auto& kept = a.comparison.marginalised_systems[a.decision.marginalised].kept;
    const Eigen::VectorXd sigma = stated->sigma.segment(kOfMachine, sheet);
    const Eigen::MatrixXd scaled = by_sheet(kept, Eigen::all) * sigma.asDiagonal();
    Eigen::MatrixXd normal = scaled.transpose() * scaled;
    normal.diagonal().array() += 1.0;
    const Eigen::VectorXd x =
        normal.llt().solve(scaled.transpose() * Eigen::VectorXd(stated->e(kept)));
    placed -= by_sheet * sigma.cwiseProduct(x);
  }
  for (const std::size_t i : points) {
    result.as_stated.push_back(error_of_unit(*stated, stated->e, i));
    if (moves) result.placed.push_back(error_of_unit(*stated, placed, i));
  }
  return result;
}

void append(const Errors& fold, Errors& all) {
  const auto join = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  join(all.calibrated, fold.calibrated);
  join(all.surface_only, fold.surface_only);
  join(all.extended, fold.extended);
  join(all.extended_and_surface, fold.extended_and_surface);
  join(all.fixed_naming, fold.fixed_naming);
  join(all.fixed_naming_and_surface, fold.fixed_naming_and_surface);
}

/// Which errors speak of the extension: an extension that does not help on points it has not seen
/// is not made.
struct Extension {
  const std::vector<Eigen::Vector2d>* machine = nullptr;
  const std::vector<Eigen::Vector2d>* and_surface = nullptr;
  bool helps = false;
  bool naming_repeated = true;
};

Extension extension_of(const Analysis& a, const Errors& errors) {
  if (!a.decision.listed.empty() && rms(errors.extended) < rms(errors.calibrated)) {
    return {&errors.extended, &errors.extended_and_surface, true, true};
  }
  // A block without which these points leave two names, the wrong one first, says little against
  // the name that all points give.
  if (!a.decision.listed.empty() && rms(errors.fixed_naming) < rms(errors.calibrated)) {
    return {&errors.fixed_naming, &errors.fixed_naming_and_surface, true, false};
  }
  return {&errors.calibrated, &errors.surface_only, false, true};
}

std::string scheme_of(const Session& session, std::size_t blocks, bool naming_repeated) {
  return fmt::format(
      "{}, each held out in turn, {}",
      session.distances ? fmt::format("all the distances of each of {} holes", blocks)
                        : fmt::format("{} blocks of the bed", blocks),
      naming_repeated ? "the naming repeated without it"
                      : fmt::format("the causes that all {} name fitted without it, since not "
                                    "every block left out leaves the same name",
                                    session.distances ? "distances" : "points"));
}

}  // namespace

HeldOut summarise(const std::vector<Eigen::Vector2d>& tool_mm,
                  const std::vector<std::size_t>& block,
                  std::uint64_t seed) {
  HeldOut result;
  if (tool_mm.empty()) return result;
  std::vector<double> size;
  for (const auto& e : tool_mm) size.push_back(e.norm());
  result.rms_mm = rms(tool_mm);
  std::vector<double> sorted = size;
  std::sort(sorted.begin(), sorted.end());
  const auto at = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(sorted.size())));
  result.percentile_95_mm = sorted[std::max<std::size_t>(at, 1) - 1];
  const std::size_t blocks = 1 + *std::max_element(block.begin(), block.end());
  std::vector<double> sum(blocks, 0.0);
  std::vector<double> count(blocks, 0.0);
  for (std::size_t i = 0; i < size.size(); ++i) {
    sum[block[i]] += size[i] * size[i];
    count[block[i]] += 1.0;
  }
  constexpr int kDraws = 400;  // the 5th and 95th percentile to a tenth of the interval
  constexpr std::uint64_t kStream = 62;
  synthetic::Random random(seed, kStream);
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
  std::sort(drawn.begin(), drawn.end());
  result.low_mm = drawn[kDraws / 20];
  result.high_mm = drawn[kDraws - 1 - kDraws / 20];
  return result;
}

std::optional<Gain> measure_gain(const Session& session,
                                 const Analysis& a,
                                 const DiagnosisOptions& options) {
  const auto blocks = held_out_blocks(session);
  if (!are_enough(session, blocks)) return std::nullopt;
  const Folds folds(session, a, options);
  Gain gain;
  std::vector<std::size_t> points;
  std::vector<std::size_t> number;
  Errors all;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Fold fold = folds.hold_out(blocks[b]);
    gain.folds += 1;
    gain.folds_agree += names_agree(fold, a) ? 1 : 0;
    points.insert(points.end(), fold.points.begin(), fold.points.end());
    number.insert(number.end(), fold.points.size(), b);
    append(fold.errors, all);
  }
  if (points.empty()) return std::nullopt;
  const Delivered before = delivered(session, a, points);
  gain.as_delivered = summarise(before.as_stated, number, options.seed);
  if (!before.placed.empty()) gain.placed = summarise(before.placed, number, options.seed);
  gain.calibrated = summarise(all.calibrated, number, options.seed);
  gain.surface_only = summarise(all.surface_only, number, options.seed);
  const Extension extension = extension_of(a, all);
  gain.scheme = scheme_of(session, blocks.size(), extension.naming_repeated);
  gain.extended = summarise(*extension.machine, number, options.seed);
  gain.extended_and_surface = summarise(*extension.and_surface, number, options.seed);
  gain.noise_floor_mm = noise_floor(session, a, points);
  if (extension.helps) {
    const ExpectedGain expected = expected_gain(session, a, options.steps);
    gain.drop_mm2 = expected.drop_mm2;
    gain.drop_share = expected.share;
  }
  // Nearly all distances reach the border.
  if (session.distances) return gain;
  const auto edge = border(session);
  if (session.points.size() - edge.size() >= kFewestPoints) {
    const Errors outer = folds.hold_out(edge).errors;
    gain.border = {rms(outer.calibrated),
                   rms(outer.extended),
                   rms(outer.extended_and_surface),
                   rms(outer.surface_only)};
  }
  return gain;
}

}  // namespace chaintrue::grid::diagnosis
