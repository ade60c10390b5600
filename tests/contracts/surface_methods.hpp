// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Every way to interpolate a full grid, for the laws that hold for all of them; ALGLIB's spline2d is
/// an outside opinion.
#pragma once

#include <array>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "interp/quintic_spline.hpp"
#include "interp/tensor_spline.hpp"
#ifdef CHAINTRUE_HAS_ALGLIB
#include <libalglib/interpolation.h>
#endif

namespace chaintrue::interp {

using Nodes = std::vector<double>;

/// `build` throws std::invalid_argument as TensorSpline does.
struct SurfaceMethod {
  std::string_view id;
  int exact_degree;  ///< polynomials of this degree in x times the same in y are reproduced
  std::unique_ptr<Surface> (*build)(const Nodes& x, const Nodes& y, const Eigen::MatrixXd& values);
};

template <EndCondition kEnd>
std::unique_ptr<Surface> bicubic(const Nodes& x, const Nodes& y, const Eigen::MatrixXd& values) {
  return std::make_unique<TensorSpline>(x, y, values, TensorEnds{{kEnd, kEnd}, {kEnd, kEnd}});
}

inline std::unique_ptr<Surface> quintic(const Nodes& x,
                                        const Nodes& y,
                                        const Eigen::MatrixXd& values) {
  return std::make_unique<QuinticSpline>(x, y, values);
}

#ifdef CHAINTRUE_HAS_ALGLIB
/// Bicubic, parabolic ends.
class AlglibSpline final : public Surface {
 public:
  AlglibSpline(const Nodes& x, const Nodes& y, const Eigen::MatrixXd& values)
      : domain_(TensorSpline(x, y, values).domain()) {  // throws where this is no grid
    const auto array = [](const double* data, std::size_t size) {
      alglib::real_1d_array result;
      result.setcontent(static_cast<alglib::ae_int_t>(size), data);
      return result;
    };
    alglib::spline2dbuildbicubicv(array(x.data(), x.size()),
                                  static_cast<alglib::ae_int_t>(x.size()),
                                  array(y.data(), y.size()),
                                  static_cast<alglib::ae_int_t>(y.size()),
                                  array(values.data(), x.size() * y.size()),  // x fastest
                                  1,
                                  spline_);
  }
  [[nodiscard]] ValueGradient at(double x, double y) const override {
    ValueGradient result;
    double twist = 0.0;
    alglib::spline2ddiff(spline_, x, y, result.value, result.dx, result.dy, twist);
    return result;
  }
  [[nodiscard]] Rectangle domain() const override { return domain_; }

 private:
  Rectangle domain_;
  alglib::spline2dinterpolant spline_;
};

inline std::unique_ptr<Surface> alglib_spline(const Nodes& x,
                                              const Nodes& y,
                                              const Eigen::MatrixXd& values) {
  return std::make_unique<AlglibSpline>(x, y, values);
}
#endif

inline constexpr std::array kSurfaceMethods = {
    SurfaceMethod{"not_a_knot", 3, bicubic<EndCondition::not_a_knot>},
    SurfaceMethod{"natural", 1, bicubic<EndCondition::natural>},
    SurfaceMethod{"parabolic", 2, bicubic<EndCondition::parabolic>},
    SurfaceMethod{"clamped", 0, bicubic<EndCondition::clamped>},
    SurfaceMethod{"quintic", 5, quintic},
#ifdef CHAINTRUE_HAS_ALGLIB
    SurfaceMethod{"alglib", 2, alglib_spline},
#endif
};

}  // namespace chaintrue::interp
