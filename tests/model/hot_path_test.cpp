// SPDX-License-Identifier: GPL-3.0-or-later
// Poses, derivatives and failures without a single allocation.
#include <gmock/gmock.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <vector>

#include "model/kinematics.hpp"

namespace {

std::atomic<long> allocations{0};

}  // namespace

// Counts every allocation of this test program.
void* operator new(std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return std::malloc(size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace chaintrue::model {
namespace {

TEST(HotPath, AllocatesNothing) {
  for (const Attachment& attachment : {Attachment{Ring{}}, Attachment{Brackets{}}}) {
    Machine machine;
    machine.attachment = attachment;
    for (const Model model : {Model::straight, Model::wrap, Model::firmware, Model::one_shot,
                              Model::inextensible, Model::elastic, Model::elastic_3d}) {
      if (model == Model::one_shot && std::holds_alternative<Brackets>(attachment)) continue;
      const auto kinematics = make_kinematics(equilibrium_parameters(machine), model);
      double sum = 0.0;
      const long before = allocations.load();
      const Pose pose = *kinematics->inverse({-700.0, 300.0});
      sum += kinematics->forward(pose.lengths)->position.x_mm + kinematics->jacobian(pose).sum() +
             kinematics->by_parameter(pose, Parameter::chain_weight_n_per_mm).left.length_mm.d[0];
      // Named failures, a cold start at the edge of the domain that needs continuation, and chains
      // that do not meet.
      sum += kinematics->inverse({0.0, 2000.0}).has_value() +
             kinematics->inverse({-1470.0, -3000.0}).has_value() +
             kinematics->forward({10.0, 20.0}).has_value();
      EXPECT_EQ(allocations.load() - before, 0)
          << "model " << static_cast<int>(model) << ", sum " << sum;
    }
  }
}

// Shows that the counter works: otherwise the test above could not fail.
TEST(HotPath, CounterSeesAnAllocation) {
  const long before = allocations.load();
  const std::vector<double> numbers(1000, 1.0);
  EXPECT_GT(allocations.load() - before, 0) << numbers.size();
}

}  // namespace
}  // namespace chaintrue::model
