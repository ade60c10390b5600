// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/surface_methods.hpp"

#include <algorithm>
#include <array>

#include "interp/quintic_spline.hpp"
#include "interp/tensor_spline.hpp"
#ifdef CHAINTRUE_HAS_ALGLIB
#include "interp/alglib_spline.hpp"
#endif

namespace chaintrue::interp {
namespace {

using Nodes = std::vector<double>;

template <EndCondition kEnd>
std::unique_ptr<Surface> bicubic(const Nodes& x, const Nodes& y, const Eigen::MatrixXd& values) {
  return std::make_unique<TensorSpline>(x, y, values, TensorEnds{{kEnd, kEnd}, {kEnd, kEnd}});
}

constexpr auto build_not_a_knot = bicubic<EndCondition::not_a_knot>;
constexpr auto build_natural = bicubic<EndCondition::natural>;
constexpr auto build_parabolic = bicubic<EndCondition::parabolic>;
constexpr auto build_clamped = bicubic<EndCondition::clamped>;

std::unique_ptr<Surface> build_quintic(const Nodes& x,
                                       const Nodes& y,
                                       const Eigen::MatrixXd& values) {
  return std::make_unique<QuinticSpline>(x, y, values);
}

#ifdef CHAINTRUE_HAS_ALGLIB
std::unique_ptr<Surface> build_alglib(const Nodes& x,
                                      const Nodes& y,
                                      const Eigen::MatrixXd& values) {
  return std::make_unique<AlglibSpline>(x, y, values);
}
#endif

constexpr std::array kMethods = {
#define CHAINTRUE_SURFACE_METHOD(id, degree, description) \
  SurfaceMethod{#id, degree, description, build_##id},
#include "interp/surface_methods.def"
#undef CHAINTRUE_SURFACE_METHOD
};

}  // namespace

std::span<const SurfaceMethod> surface_methods() { return kMethods; }

const SurfaceMethod* find_surface_method(std::string_view id) {
  const auto* found = std::find_if(kMethods.begin(),
                                   kMethods.end(),
                                   [id](const SurfaceMethod& method) { return method.id == id; });
  return found == kMethods.end() ? nullptr : found;
}

}  // namespace chaintrue::interp
