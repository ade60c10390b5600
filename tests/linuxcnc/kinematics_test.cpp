// SPDX-License-Identifier: GPL-3.0-or-later
// The module that export linuxcnc writes, compiled as C against a stub of LinuxCNC, loaded and
// called: its lengths compared with the map's, inverse and forward, and outside.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "grid/files/linuxcnc_kinematics.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/map/joint_fit.hpp"
#include "grid/map/map_in_frame.hpp"
#include "grid/random.hpp"
#include "tests/map/synthetic_grid.hpp"
#include "tests/support/files.hpp"

extern "C" {
#include "tests/linuxcnc/stub/kinematics.h"
}

namespace chaintrue::grid::files {
namespace {

using testing_support::sagging_map;

class Module {
 public:
  explicit Module(const std::string& source) {
    const std::string c = folder_ / "chaintrue_kins.c", library = folder_ / "chaintrue_kins.so";
    write_whole_file(c, source);
    std::string line = CHAINTRUE_COMPILER;
    line +=
        " -x c -std=c99 -Wall -Wextra -Werror -pedantic -Wno-unused-function -O1 -shared -fPIC -I";
    line += CHAINTRUE_LINUXCNC_STUB;
    line += " -o ";
    line += library;
    line += " ";
    line += c;
    compiled_ = std::system(line.c_str()) == 0;
    if (compiled_) handle_ = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  }
  ~Module() {
    if (handle_ != nullptr) dlclose(handle_);
  }
  Module(const Module&) = delete;
  Module& operator=(const Module&) = delete;
  bool is_loaded() const { return handle_ != nullptr; }
  int inverse(double x, double y, double z, double joints[3]) const {
    EmcPose pose{};
    pose.tran = {x, y, z};
    return function<decltype(&call_inverse)>("kinematicsInverse")(&pose, joints, nullptr, nullptr);
  }
  int forward(const double joints[3], EmcPose& pose) const {
    return function<decltype(&call_forward)>("kinematicsForward")(joints, &pose, nullptr, nullptr);
  }
  int start() const { return function<int (*)()>("rtapi_app_main")(); }

 private:
  static int call_inverse(const EmcPose*, double*, const KINEMATICS_INVERSE_FLAGS*,
                          KINEMATICS_FORWARD_FLAGS*);
  static int call_forward(const double*, EmcPose*, const KINEMATICS_FORWARD_FLAGS*,
                          KINEMATICS_INVERSE_FLAGS*);
  template <class Function>
  Function function(const char* name) const {
    return reinterpret_cast<Function>(dlsym(handle_, name));
  }

  testing_support::TemporaryFolder folder_;
  bool compiled_ = false;
  void* handle_ = nullptr;
};

TEST(LinuxcncKinematics, CompiledItsLengthsAreTheMapsThereAndBack) {
  const MapInFrame map(sagging_map());
  const auto written = linuxcnc_kinematics(map, {"chaintrue_kins", "a map */ int x; /*"});
  ASSERT_TRUE(written) << written.error().sentence();
  EXPECT_LE(written->largest_error_mm, kTableErrorMm);
  const Module module(written->source);
  ASSERT_TRUE(module.is_loaded());
  EXPECT_EQ(module.start(), 0);
  constexpr std::uint64_t kSeed = 17;
  Random random(kSeed, 1);
  const interp::Rectangle& area = map.domain();
  double worst = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const double x = area.x_min + random.uniform() * (area.x_max - area.x_min);
    const double y = area.y_min + random.uniform() * (area.y_max - area.y_min);
    double joints[3] = {};
    ASSERT_EQ(module.inverse(x, y, -3.5, joints), 0) << x << " " << y;
    const auto lengths = map.lengths({x, y});
    ASSERT_TRUE(lengths);
    worst = std::max(
        {worst, std::abs(joints[0] - lengths->left_mm), std::abs(joints[1] - lengths->right_mm)});
    EXPECT_EQ(joints[2], -3.5);
    EmcPose pose{};
    ASSERT_EQ(module.forward(joints, pose), 0) << x << " " << y;
    // Newton ends at 1e-7 mm of both lengths; a lever of three at the corners.
    EXPECT_NEAR(pose.tran.x, x, 1e-6);
    EXPECT_NEAR(pose.tran.y, y, 1e-6);
    EXPECT_EQ(pose.tran.z, -3.5);
  }
  // Twice the error in the middles of cells, where an error of the third order is largest but for
  // the edges' cells.
  EXPECT_LT(worst, 2.0 * kTableErrorMm) << "seed " << kSeed;
}

TEST(LinuxcncKinematics, OutsideTheTableBothDirectionsFail) {
  const MapInFrame map(sagging_map());
  const Module module(linuxcnc_kinematics(map, {"chaintrue_kins", "map.json"})->source);
  ASSERT_TRUE(module.is_loaded());
  double joints[3] = {};
  EXPECT_EQ(module.inverse(map.domain().x_max + 1.0, 0.0, 0.0, joints), -1);
  EXPECT_EQ(module.inverse(std::nan(""), 0.0, 0.0, joints), -1);
  EmcPose pose{};
  const double nowhere[3] = {10.0, 10.0, 0.0};
  EXPECT_EQ(module.forward(nowhere, pose), -1);
}

}  // namespace
}  // namespace chaintrue::grid::files
