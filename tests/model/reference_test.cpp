// SPDX-License-Identifier: GPL-3.0-or-later
// Every model compared with the 40-digit tables (independent truth: computed in 60-digit arithmetic
// from the plain asinh forms).
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "tests/model/reference_tables.hpp"

namespace chaintrue::model {
namespace {

constexpr double kBedTolerance = 1e-10;  // mm: required over the bed; rounding leaves about 1e-11
constexpr double kEdgeTolerance =
    1e-9;  // mm: down to 23 mm below the beam and 19 mm from a vertical
constexpr double kJacobianTolerance = 1e-12;  // relative to the larger entry of its row

struct Case {
  std::string table;
  Model model;
  std::string key;  // of the pair [L, R]
};

std::vector<Case> ring_cases() {
  std::vector<Case> cases;
  for (const char* table :
       {"table_over_top.json", "table_off_bottom.json", "table_over_top_rho0.json"}) {
    cases.push_back({table, Model::straight, "a_straight"});
    cases.push_back({table, Model::wrap, "b_wrap"});
    cases.push_back({table, Model::inextensible, "c_inextensible"});
    cases.push_back({table, Model::elastic, "d_elastic"});
    cases.push_back({table, Model::firmware, "f_firmware"});
    cases.push_back({table, Model::one_shot, "g_holey_oneshot"});
  }
  return cases;
}

class ReferenceTable : public testing::TestWithParam<Case> {};

void PrintTo(const Case& c, std::ostream* out) { *out << c.table << " " << c.key; }

void expect_round_trip(const Kinematics& kinematics, const nlohmann::json& record,
                       ChainLengths expected, double tolerance) {
  const BedPoint p = point_of(record);
  SCOPED_TRACE(testing::Message() << "at (" << p.x_mm << ", " << p.y_mm << ")");
  const PoseResult pose = kinematics.inverse(p);
  ASSERT_TRUE(pose) << pose.error().sentence();
  EXPECT_NEAR(pose->lengths.left_mm, expected.left_mm, tolerance);
  EXPECT_NEAR(pose->lengths.right_mm, expected.right_mm, tolerance);
  const PoseResult back = kinematics.forward(expected);
  ASSERT_TRUE(back) << back.error().sentence();
  // At the edge of the bed a millimetre of chain moves the sled by up to ten.
  const double amplification = tolerance > kBedTolerance ? 10.0 : 1.0;
  EXPECT_NEAR(back->position.x_mm, p.x_mm, amplification * tolerance);
  EXPECT_NEAR(back->position.y_mm, p.y_mm, amplification * tolerance);
}

TEST_P(ReferenceTable, InverseAndForwardAgree) {
  const nlohmann::json table = reference_table(GetParam().table);
  const auto kinematics = make_kinematics(parameters_of(table["params"]), GetParam().model);
  const auto lengths = [&](const nlohmann::json& r) {
    return ChainLengths{number(r[GetParam().key][0]), number(r[GetParam().key][1])};
  };
  for (const auto& r : table["bed"]) expect_round_trip(*kinematics, r, lengths(r), kBedTolerance);
  for (const auto& r : table["edge"]) expect_round_trip(*kinematics, r, lengths(r), kEdgeTolerance);
}

INSTANTIATE_TEST_SUITE_P(Ring, ReferenceTable, testing::ValuesIn(ring_cases()));

void expect_jacobian(const Eigen::Matrix2d& j, const nlohmann::json& expected) {
  Eigen::Matrix2d e;
  e << number(expected["dLdx"]), number(expected["dLdy"]), number(expected["dRdx"]),
      number(expected["dRdy"]);
  EXPECT_LE((j - e).cwiseAbs().maxCoeff(), kJacobianTolerance * e.cwiseAbs().maxCoeff());
}

TEST(Reference, JacobianStateAndForces) {
  for (const char* name :
       {"table_over_top.json", "table_off_bottom.json", "table_over_top_rho0.json"}) {
    const nlohmann::json table = reference_table(name);
    const auto kinematics = make_kinematics(parameters_of(table["params"]));
    for (const auto& r : table["bed"]) {
      const BedPoint p = point_of(r);
      SCOPED_TRACE(testing::Message() << name << " at (" << p.x_mm << ", " << p.y_mm << ")");
      const PoseResult pose = kinematics->inverse(p);
      ASSERT_TRUE(pose);
      expect_jacobian(kinematics->jacobian(*pose), r["d_jac"]);
      const auto& state = r["d_state"];
      const double h = number(state["H"]);
      EXPECT_NEAR(pose->chains.left.horizontal_n, h, 1e-12 * h);  // rounding of a few sums
      EXPECT_NEAR(pose->chains.left.vertical_at_sled_n, number(state["VL"]),
                  1e-12 * 110);  // of the sled's weight
      EXPECT_NEAR(pose->chains.right.tension_at_sprocket_n, number(state["TbR"]), 1e-12 * 110);
      EXPECT_NEAR(pose->chains.right.angle_rad, number(state["phiR"]), 1e-13);
      EXPECT_NEAR(pose->chains.left.free_length_mm, number(state["SL"]), kBedTolerance);
      EXPECT_LE(pose->iterations, 4);
    }
  }
}

TEST(Reference, Brackets) {
  for (const char* name : {"table_over_top.json", "table_off_bottom.json"}) {
    const nlohmann::json table = reference_table(name);
    EquilibriumParameters parameters = parameters_of(table["params"]);
    parameters.attachment = brackets_of(table["params"]);
    for (const auto& [model, key] : {std::pair{Model::wrap, "e_quad_weightless"},
                                     std::pair{Model::firmware, "e_quad_weightless"},
                                     std::pair{Model::elastic, "e2_quad_elastic"}}) {
      const auto kinematics = make_kinematics(parameters, model);
      int compared = 0;
      for (const auto& r : table["bed"]) {
        const auto& e = r[key];
        expect_round_trip(*kinematics, r, {number(e["L"]), number(e["R"])}, kBedTolerance);
        EXPECT_NEAR(kinematics->inverse(point_of(r))->sled_rotation_rad, number(e["psi"]),
                    1e-12);  // 1e-10 mm at 100 mm
        ++compared;
      }
      EXPECT_EQ(compared, 117);
    }
  }
}

TEST(Reference, ThreeDimensionalSag) {
  for (const char* name : {"table_3d_over_top.json", "table_3d_off_bottom.json"}) {
    const nlohmann::json table = reference_table(name);
    const auto kinematics = make_kinematics(parameters_of(table["params"]), Model::elastic_3d);
    const auto plane = make_kinematics(parameters_of(table["params"]));
    double most = 0.0;
    ASSERT_EQ(table["bed"].size(), 117u);
    for (const auto& r : table["bed"]) {
      expect_round_trip(*kinematics, r, {number(r["h_3d"][0]), number(r["h_3d"][1])},
                        kBedTolerance);
      const PoseResult pose = kinematics->inverse(point_of(r));
      most = std::max(most, pose->lengths.right_mm - plane->inverse(point_of(r))->lengths.right_mm);
      EXPECT_NEAR(pose->chains.left.out_of_sheet_n, number(r["NL"]), 1e-12);
      EXPECT_NEAR(pose->chains.right.out_of_sheet_n, number(r["NR"]), 1e-12);
    }
    // The part that the plane model leaves out, at the lower corners; less off the bottom, where
    // chains hang flatter.
    EXPECT_NEAR(most, std::string(name) == "table_3d_over_top.json" ? 0.48 : 0.42, 0.005);
  }
}

TEST(Reference, StressMachines) {
  const nlohmann::json table = reference_table("table_stress.json");
  ASSERT_EQ(table["records"].size(), 200u);
  for (const auto& r : table["records"]) {
    const auto kinematics = make_kinematics(parameters_of(r["params"]));
    expect_round_trip(*kinematics, r, {number(r["L"]), number(r["R"])}, kEdgeTolerance);
    const PoseResult pose = kinematics->inverse(point_of(r));
    ASSERT_TRUE(pose);
    expect_jacobian(kinematics->jacobian(*pose), r["jac"]);
  }
}

}  // namespace
}  // namespace chaintrue::model
