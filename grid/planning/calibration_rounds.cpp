// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/planning/calibration_rounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/linear_algebra.hpp"
#include "grid/observation/length_points.hpp"
#include "grid/observation/measured.hpp"
#include "grid/synthetic/holes.hpp"
#include "model/controllers/payout.hpp"

namespace chaintrue::grid {
namespace {

using model::BedPoint;

/// (1)
Eigen::MatrixXd after_one_more(const Eigen::MatrixXd& before, const Eigen::MatrixXd& after) {
  return linear::inverse(2.0 * linear::inverse(after) - linear::inverse(before));
}

/// Rms of measured less intended distances between the holes.
double as_cut_rms_mm(const MeasuredHoles& set, const std::vector<BedPoint>& wanted) {
  double squares = 0.0;
  int count = 0;
  MeasuredHoles meant = set;
  for (std::size_t i = 0; i < wanted.size(); ++i) meant.holes[i].commanded = wanted[i];
  for (const HoleDistance& distance : set.distances) {
    if (distance.edge) continue;
    const double error = length_of(set, distance) - commanded_mm(meant, distance);
    squares += error * error;
    ++count;
  }
  return count > 0 ? std::sqrt(squares / count) : 0.0;
}

}  // namespace

HolesRounds::HolesRounds(model::Machine stated, double worthwhile_mm)
    : stated_(std::move(stated)),
      worthwhile_mm_(worthwhile_mm),
      prior_(estimation::stated_knowledge(stated_)) {}

tl::expected<HolesPass, FitFailure> HolesRounds::add(const MeasuredHoles& set,
                                                     const std::vector<BedPoint>& wanted) {
  if (!set.machine) {
    return tl::unexpected(FitFailure{FitFailure::Reason::no_machine, "the holes name no machine"});
  }
  if (const std::string difference = difference_of_settings(stated_, *set.machine);
      !difference.empty()) {
    return tl::unexpected(FitFailure{FitFailure::Reason::impossible_readings,
                                     fmt::format("{}: passes share one machine file; only the "
                                                 "controller's settings change from pass to pass",
                                                 difference)});
  }
  MeasuredHoles own = set;
  std::erase_if(own.readings, [this](const ExtraReading& reading) {
    return std::find(counted_.begin(), counted_.end(), reading) != counted_.end();
  });
  auto fit = joint_fit(own, {.knowledge = prior_});
  if (!fit) return tl::unexpected(fit.error());
  HolesPass pass;
  pass.number = ++count_;
  pass.as_cut_rms_mm = as_cut_rms_mm(set, wanted);
  pass.left_out_rms_mm = fit->distances.front().left_out_good.rms_mm;
  for (const FittedDistance& distance : fit->distances.front().distances)
    pass.rejected += distance.rejected ? 1 : 0;
  pass.expected_mm = tool_sigma_mm(stated_, fit->estimate.knowledge.covariance);
  pass.expected_next_mm =
      tool_sigma_mm(stated_, after_one_more(prior_.covariance, fit->estimate.knowledge.covariance));
  pass.next_pays = pass.expected_mm - pass.expected_next_mm > worthwhile_mm_;
  prior_ = fit->estimate.knowledge;
  const auto of_settings = setting_readings(own.readings);
  counted_.insert(counted_.end(), of_settings.begin(), of_settings.end());
  fit_ = *std::move(fit);
  return pass;
}

double true_error_mm(const model::Machine& truth,
                     const model::Machine& stated,
                     const CompensationMap* map) {
  constexpr int kAcross = 13;
  constexpr int kUp = 7;
  const model::ReadingModel model(truth);
  const auto controller = model::make_controller_kinematics(stated);
  std::vector<double> errors;
  std::vector<double> rigid;
  for (int i = 0; i < kAcross * kUp; ++i) {
    const BedPoint wanted{0.9 * stated.bed.width_mm * ((i % kAcross + 0.5) / kAcross - 0.5),
                          0.9 * stated.bed.height_mm * ((i / kAcross + 0.5) / kUp - 0.5)};
    std::optional<model::ChainLengths> lengths;
    if (map != nullptr) {
      if (const auto answer = map->lengths(model::identity_placement(wanted)))
        lengths = answer->lengths;
    } else if (const auto paid_out = controller->lengths(wanted)) {
      lengths = *paid_out;
    }
    if (!lengths) continue;
    const auto reading = model.find(*lengths, wanted);
    if (!reading) continue;
    errors.push_back(reading->pose.position.x_mm - wanted.x_mm);
    errors.push_back(reading->pose.position.y_mm - wanted.y_mm);
    rigid.insert(rigid.end(), {1.0, 0.0, -1e-3 * wanted.y_mm, 0.0, 1.0, 1e-3 * wanted.x_mm});
  }
  const auto count = static_cast<Eigen::Index>(errors.size());
  const Eigen::Map<const Eigen::VectorXd> all(errors.data(), count);
  const Eigen::MatrixXd whole =
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>(
          rigid.data(), count, 3);
  const Eigen::VectorXd left = all - linear::product(whole, linear::least_squares(whole, all));
  return count > 0 ? std::sqrt(2.0 * left.squaredNorm() / static_cast<double>(count)) : 0.0;
}

tl::expected<SimulatedRounds, FitFailure> simulate_rounds(const model::Machine& stated,
                                                          const SimulatedRoundsRequest& request) {
  const auto cannot_be_cut = [](std::string sentence) {
    return tl::unexpected(FitFailure{FitFailure::Reason::point_unreachable, std::move(sentence)});
  };
  const auto plan = plan_holes(stated, request.plan);
  if (!plan) return cannot_be_cut(plan.error().sentence());
  synthetic::HolesSpec spec;
  spec.draw_settings = true;
  spec.scale_sigma = request.elongation_sigma;
  spec.seed = request.seed;
  const model::Machine truth = synthetic::hidden_truth(stated, spec);
  const auto controller = model::make_controller_kinematics(stated);
  std::vector<BedPoint> wanted;
  for (const Hole& hole : plan->set.holes) wanted.push_back(hole.commanded);
  HolesRounds passes(stated, request.worthwhile_mm);
  const double before_mm = true_error_mm(truth, stated, nullptr);
  std::vector<HolesPass> done;
  MeasuredHoles last = plan->set;
  std::optional<CompensationMap> map;
  for (int number = 1; number <= request.most; ++number) {
    tell(request.progress, {"a set of holes, fitted", number, request.most});
    MeasuredHoles design = plan->set;
    for (std::size_t i = 0; map && i < wanted.size(); ++i) {
      const auto lengths = map->lengths(model::identity_placement(wanted[i]));
      const auto command = lengths ? controller->command(lengths->lengths)
                                   : tl::expected<BedPoint, model::PoseFailure>(wanted[i]);
      if (!command) {
        return cannot_be_cut(
            fmt::format("hole {}: {}", design.holes[i].name, command.error().sentence()));
      }
      design.holes[i].commanded = *command;
    }
    // An independent noise stream for each round.
    spec.seed = request.seed + 1000003ULL * static_cast<std::uint64_t>(number);
    auto made = synthetic::simulate_holes(design, spec, truth);
    if (!made) return cannot_be_cut(made.error().sentence());
    auto pass = passes.add(made->set, wanted);
    if (!pass) return tl::unexpected(pass.error());
    last = made->set;
    map.emplace(passes.fit()->map);
    pass->true_mm = true_error_mm(truth, stated, &*map);
    done.push_back(*pass);
    if (!pass->next_pays) break;
  }
  return SimulatedRounds{before_mm, std::move(done), std::move(last), *passes.fit()};
}

}  // namespace chaintrue::grid
