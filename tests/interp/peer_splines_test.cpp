// SPDX-License-Identifier: GPL-3.0-or-later
// Bicubic splines on uneven axes compared with stored values of FITPACK's regrid (not-a-knot) and
// of SciPy's CubicSpline in tensor products (natural, like GSL's bicubic).
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "interp/tensor_spline.hpp"

namespace chaintrue::interp {
namespace {

using nlohmann::json;

json peer_cases() {
  std::ifstream file(CHAINTRUE_FIXTURES "/accuracy/peer_splines.json");
  return json::parse(file).at("cases");
}

Eigen::MatrixXd values_of(const json& rows) {
  Eigen::MatrixXd z(static_cast<Eigen::Index>(rows.size()),
                    static_cast<Eigen::Index>(rows.at(0).size()));
  for (Eigen::Index ix = 0; ix < z.rows(); ++ix) {
    for (Eigen::Index iy = 0; iy < z.cols(); ++iy) {
      z(ix, iy) = rows.at(static_cast<std::size_t>(ix)).at(static_cast<std::size_t>(iy));
    }
  }
  return z;
}

TEST(TensorSpline, EqualsFitpacksRegridAndNaturalSplinesOnUnevenLines) {
  const json cases = peer_cases();
  ASSERT_EQ(cases.size(), 6U);
  constexpr double kAskedFor = 1e-9;
  for (const json& one : cases) {
    SCOPED_TRACE(one.at("name").get<std::string>());
    const auto x = one.at("x").get<std::vector<double>>();
    const auto y = one.at("y").get<std::vector<double>>();
    const Eigen::MatrixXd z = values_of(one.at("z"));
    for (const auto& [name, end] :
         {std::pair{"not_a_knot", EndCondition::not_a_knot}, {"natural", EndCondition::natural}}) {
      SCOPED_TRACE(name);
      const TensorSpline surface(x, y, z, {{end, end}, {end, end}});
      for (const json& place : one.at("at")) {
        const ValueGradient here = surface.at(place.at("x"), place.at("y"));
        const json& theirs = place.at(name);
        EXPECT_NEAR(here.value, theirs.at(0).get<double>(), kAskedFor);
        EXPECT_NEAR(here.dx, theirs.at(1).get<double>(), kAskedFor);
        EXPECT_NEAR(here.dy, theirs.at(2).get<double>(), kAskedFor);
      }
    }
  }
}

}  // namespace
}  // namespace chaintrue::interp
