// SPDX-License-Identifier: GPL-3.0-or-later
// Poses over the classic bed, cold, in a random order; pose/wrap_only is the weightless straight
// tangent in the same run, the unit of the ratios in model/README.md.
#include <vector>

#include "grid/random.hpp"
#include "model/chain_formulas.hpp"
#include "model/kinematics.hpp"
#include "tools/bench/work.hpp"

namespace chaintrue::model {
namespace {

constexpr std::size_t kPoints = 4096;

/// Points of the bed, the same on every run.
std::vector<BedPoint> bench_points() {
  grid::Random random(1);
  std::vector<BedPoint> points(kPoints);
  for (BedPoint& p : points) p = {random.uniform(-1219.2, 1219.2), random.uniform(-609.6, 609.6)};
  return points;
}

EquilibriumParameters classic(const Attachment& attachment) {
  Machine machine;
  machine.attachment = attachment;
  return equilibrium_parameters(machine);
}

/// `prepare(kinematics)` returns the items, `work(kinematics, item)` is what is measured.
template <class Prepare, class Work>
const benchmark::internal::Benchmark* add(const char* name, Model model,
                                          const Attachment& attachment, Prepare prepare,
                                          Work work) {
  const auto prepared = [=](const benchmark::State&) {
    std::shared_ptr<const Kinematics> kinematics = make_kinematics(classic(attachment), model);
    return [kinematics, work, items = prepare(*kinematics)] {
      for (const auto& item : items) benchmark::DoNotOptimize(work(*kinematics, item));
      return items.data();
    };
  };
  return bench::add(name, prepared, benchmark::kNanosecond, kPoints);
}

const auto points = [](const Kinematics&) { return bench_points(); };
const auto poses = [](const Kinematics& kinematics) {
  std::vector<Pose> all;
  for (const BedPoint& p : bench_points()) all.push_back(*kinematics.inverse(p));
  return all;
};
const auto lengths = [](const Kinematics& kinematics) {
  std::vector<ChainLengths> all;
  for (const Pose& pose : poses(kinematics)) all.push_back(pose.lengths);
  return all;
};

const auto wrap_only = [m = classic(Ring{})](const Kinematics&, const BedPoint& p) {
  const double r = m.sprocket_radius_mm, y_mm = m.motors.left.y_mm - p.y_mm;
  benchmark::DoNotOptimize(straight_chain(p.x_mm - m.motors.left.x_mm, y_mm, r, 1.0));
  return straight_chain(m.motors.right.x_mm - p.x_mm, m.motors.right.y_mm - p.y_mm, r, 1.0);
};
const auto inverse = [](const Kinematics& k, const BedPoint& p) { return k.inverse(p); };
const auto forward = [](const Kinematics& k, const ChainLengths& l) { return k.forward(l); };
const auto jacobian = [](const Kinematics& k, const Pose& pose) { return k.jacobian(pose); };

const benchmark::internal::Benchmark* const of_poses[] = {
    add("pose/wrap_only", Model::elastic, Ring{}, points, wrap_only),
    add("pose/inverse", Model::elastic, Ring{}, points, inverse),
    add("pose/forward", Model::elastic, Ring{}, lengths, forward),
    add("pose/jacobian", Model::elastic, Ring{}, poses, jacobian),
    add("pose/inverse/brackets", Model::elastic, Brackets{}, points, inverse),
    add("pose/forward/brackets", Model::elastic, Brackets{}, lengths, forward),
    add("pose/inverse/elastic_3d", Model::elastic_3d, Ring{}, points, inverse),
    add("pose/inverse/wrap", Model::wrap, Ring{}, points, inverse)};

}  // namespace
}  // namespace chaintrue::model
