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

#include "grid/diagnosis/causes_fit.hpp"
#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/optical_file.hpp"
#include "grid/files/whole_file.hpp"
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

bool is_fitted(const Scan& scan, model::MarkPoint mark) {
  return on(scan.fitted_ix, mark.x_mm) && on(scan.fitted_iy, mark.y_mm);
}

grid::MeasuredGrid whole_of(const Scan& scan) {
  const std::filesystem::path data = CHAINTRUE_SHARED_DATA;
  files::OpticalOptions options;
  options.machine =
      // The settings in force were not recorded, so the tolerances' purpose is unknown.
      files::read(files::parse_groundcontrol, data / "holey" / "groundcontrol_2018-09-01b.ini",
                  files::Tolerances::unexplained)
          .machine;
  options.pitch_mm = kPitchMm;
  return files::read(files::parse_optical, data / "optical_grid" / scan.file, options);
}

grid::MeasuredGrid few_of(const Scan& scan, grid::MeasuredGrid whole) {
  std::erase_if(whole.points,
                [&](const grid::MeasuredPoint& point) { return !is_fitted(scan, point.mark); });
  return whole;
}

/// Errors of the tool at the marks that were not fitted, in x and y.
Eigen::Vector2d rms_at_others(const Scan& scan, const grid::MeasuredGrid& whole,
                              const grid::CompensationMap& map) {
  const auto truth = grid::length_points(whole);
  EXPECT_TRUE(truth);
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  std::size_t held_out = 0;
  for (const grid::LengthPoint& point : *truth) {
    if (is_fitted(scan, point.mark)) continue;
    const auto answer = map.query(point.mark);
    EXPECT_TRUE(answer);
    const Eigen::Vector2d missing(point.lengths.left_mm - answer->lengths.left_mm,
                                  point.lengths.right_mm - answer->lengths.right_mm);
    squares += (answer->mark_jacobian.inverse() * missing).cwiseAbs2();
    ++held_out;
  }
  return (squares / static_cast<double>(held_out)).cwiseSqrt();
}

class RealScans : public testing::TestWithParam<Scan> {
 protected:
  void SetUp() override {
    const std::filesystem::path data = CHAINTRUE_SHARED_DATA;
    if (!std::filesystem::exists(data / "optical_grid" / GetParam().file))
      GTEST_SKIP() << "the scans are shared data, not part of a checkout; they are not in "
                   << data / "optical_grid";
  }
};

TEST_P(RealScans, AFewMarksPredictAllOthers) {
  const grid::MeasuredGrid whole = whole_of(GetParam());
  const grid::MeasuredGrid few = few_of(GetParam(), whole);
  ASSERT_EQ(few.points.size(), GetParam().fitted_points);
  const auto map = grid::fit(few);
  ASSERT_TRUE(map) << map.error().sentence();
  const Eigen::Vector2d rms = rms_at_others(GetParam(), whole, *map);
  fmt::print("{}: fitted at {} marks, the others: {:.3f} mm rms in X, {:.3f} mm in Y\n",
             GetParam().name, few.points.size(), rms.x(), rms.y());
  // The machine with a length scale for each chain alone reaches 0.21 / 0.40 (D) and 0.43 / 0.62
  // (C).
  EXPECT_LE(rms.x(), GetParam().most_x_rms_mm);
  EXPECT_LE(rms.y(), GetParam().most_y_rms_mm);
}

// With stated noise causes are compared; the scan states none, so no cause is.
TEST_P(RealScans, CausesMakeNoMapWorse) {
  const grid::MeasuredGrid whole = whole_of(GetParam());
  grid::MeasuredGrid few = few_of(GetParam(), whole);
  for (const bool is_stated : {false, true}) {
    if (is_stated) few.noise = grid::StatedNoise{0.1, 0.3, 12.0};
    const auto plain = grid::joint_fit(few);
    const auto own = grid::diagnosis::fit_with_causes(few);
    ASSERT_TRUE(plain && own);
    const double plain_mm = rms_at_others(GetParam(), whole, plain->map).norm();
    const double own_mm = rms_at_others(GetParam(), whole, own->fit.map).norm();
    fmt::print("{}, noise {}stated: plain {:.3f} mm, with causes {:.3f} mm\n", GetParam().name,
               is_stated ? "" : "not ", plain_mm, own_mm);
    // The figures of docs/accuracy.md are to three digits.
    EXPECT_LE(own_mm, plain_mm + 5e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(Optical, RealScans,
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
