// SPDX-License-Identifier: GPL-3.0-or-later
// Real scans of a real machine: fitted at a few marks, compared with all the others. The scans stay
// in ../shared/data.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/optical_file.hpp"
#include "grid/map/fit.hpp"
#include "grid/observation/length_points.hpp"

namespace chaintrue {
namespace {

namespace files = grid::files;

constexpr double kPitchMm = 76.2;

struct Scan {
  const char* name;
  const char* file;
  std::vector<int> fitted_ix;
  std::vector<int> fitted_iy;
  std::size_t fitted_points;
  double most_x_rms_mm;
  double most_y_rms_mm;
};

/// Prints only the name: GoogleTest would print the bytes.
void PrintTo(const Scan& scan, std::ostream* out) { *out << scan.name; }

bool on(const std::vector<int>& lines, double coordinate_mm) {
  const int line = static_cast<int>(std::lround(coordinate_mm / kPitchMm));
  return std::find(lines.begin(), lines.end(), line) != lines.end();
}

class RealScans : public testing::TestWithParam<Scan> {};

TEST_P(RealScans, AFewMarksPredictAllOthers) {
  const std::filesystem::path data = CHAINTRUE_SHARED_DATA;
  if (!std::filesystem::exists(data / "optical_grid" / GetParam().file)) {
    GTEST_SKIP() << "the scans are not beside this checkout: " << data / "optical_grid";
  }
  files::OpticalOptions options;
  options.machine =
      // The settings in force were not recorded, so the tolerances' purpose is unknown.
      files::read_groundcontrol(data / "holey" / "groundcontrol_2018-09-01b.ini",
                                files::Tolerances::unexplained)
          .machine;
  options.pitch_mm = kPitchMm;
  const grid::MeasuredGrid whole =
      files::read_optical(data / "optical_grid" / GetParam().file, options).grid;

  grid::MeasuredGrid few = whole;
  std::erase_if(few.points, [](const grid::MeasuredPoint& point) {
    return !on(GetParam().fitted_ix, point.mark.x_mm) || !on(GetParam().fitted_iy, point.mark.y_mm);
  });
  ASSERT_EQ(few.points.size(), GetParam().fitted_points);
  const auto map = grid::fit(few);
  ASSERT_TRUE(map) << map.error().sentence;

  const auto truth = grid::length_points(whole);
  ASSERT_TRUE(truth);
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  std::size_t held_out = 0;
  for (const grid::LengthPoint& point : *truth) {
    if (on(GetParam().fitted_ix, point.mark.x_mm) && on(GetParam().fitted_iy, point.mark.y_mm))
      continue;
    const auto answer = map->query(point.mark);
    ASSERT_TRUE(answer);
    const Eigen::Vector2d missing(point.lengths.left_mm - answer->lengths.left_mm,
                                  point.lengths.right_mm - answer->lengths.right_mm);
    squares += (answer->mark_jacobian.inverse() * missing).cwiseAbs2();
    ++held_out;
  }
  const Eigen::Vector2d rms = (squares / static_cast<double>(held_out)).cwiseSqrt();
  fmt::print("{}: fitted at {} marks, {} others: {:.3f} mm rms in X, {:.3f} mm in Y\n",
             GetParam().name,
             few.points.size(),
             held_out,
             rms.x(),
             rms.y());
  // The machine with a length scale for each chain alone reaches 0.21 / 0.40 (D) and 0.43 / 0.62
  // (C).
  EXPECT_LE(rms.x(), GetParam().most_x_rms_mm);
  EXPECT_LE(rms.y(), GetParam().most_y_rms_mm);
}

INSTANTIATE_TEST_SUITE_P(Optical,
                         RealScans,
                         testing::Values(Scan{"D",
                                              "D_2018-10-01_upper_half.csv",
                                              {-15, -9, -3, 3, 9, 15},
                                              {0, 2, 5, 7},
                                              23,
                                              0.18,
                                              0.31},
                                         Scan{"C",
                                              "C_2018-09-30_full.csv",
                                              {-15, -10, -5, 0, 5, 10, 15},
                                              {-7, -4, 0, 4, 7},
                                              35,
                                              0.45,
                                              0.55}),
                         [](const auto& scan) { return std::string(scan.param.name); });

}  // namespace
}  // namespace chaintrue
