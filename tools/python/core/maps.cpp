// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Maps of two chains and anchors of four belts, asked with arrays.
#include <pybind11/eigen.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "grid/belts/belt_map.hpp"
#include "grid/files/anchors_file.hpp"
#include "grid/files/file_type.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/map_file.hpp"
#include "grid/map/map_in_frame.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/cli/talk.hpp"
#include "tools/python/core/bind.hpp"

namespace chaintrue::python {
namespace {

namespace files = grid::files;
using files::FittedAnchors;

/// A row for each place; NaN where there is no answer.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

py::dict query(const grid::LengthMap& map, const Rows& points) {
  const auto names = map.length_names();
  const Eigen::Index count = points.rows(), wide = static_cast<Eigen::Index>(names.size());
  Rows lengths = Rows::Constant(count, wide, kNone), sigma = Rows::Constant(count, 2, kNone);
  Eigen::VectorXd tool = Eigen::VectorXd::Constant(count, kNone);
  std::vector<std::string> status, why;
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto answer = map.query({points(i, 0), points(i, 1)});
    status.emplace_back(grid::name(answer ? answer->status : grid::MapStatus::outside));
    why.push_back(answer ? std::string() : answer.error().sentence());
    if (!answer) continue;
    lengths.row(i) = answer->lengths_mm.transpose();
    sigma.row(i) << answer->sigma.left_mm, answer->sigma.right_mm;
    tool[i] = answer->tool_sigma_mm.value_or(kNone);
  }
  return py::dict("names"_a = std::vector<std::string>(names.begin(), names.end()),
                  "lengths"_a = lengths, "sigma"_a = sigma, "tool_sigma"_a = tool,
                  "status"_a = status, "why"_a = why);
}

Rows inverse(const grid::LengthMap& map, const Rows& lengths) {
  Rows points = Rows::Constant(lengths.rows(), 2, kNone);
  for (Eigen::Index i = 0; i < lengths.rows(); ++i) {
    if (const auto tool = map.tool({lengths(i, 0), lengths(i, 1)}))
      points.row(i) << tool->x_mm, tool->y_mm;
  }
  return points;
}

grid::BeltMap belt_map(const FittedAnchors& anchors) {
  if (!anchors.holes && !anchors.fit.coordinates.front().stated_mm) {
    throw cli::Failed(
        "the anchors", "no_anchors_in_force",
        "These anchors were fitted to belts without the anchors in force, which define "
        "the origin of commands.");
  }
  return grid::BeltMap(anchors.fit, anchors.holes ? &*anchors.holes : nullptr);
}

/// A map or anchors, prepared for many queries.
class Answering {
 public:
  explicit Answering(const std::string& text) {
    if (files::kind_of(text, "") == files::FileKind::anchors) {
      belts_.emplace(belt_map(files::parse_anchors(text, "")));
    } else {
      map_.emplace(files::parse_map(text, ""));
    }
  }

  template <class Ask>
  auto ask(Ask asked, const Rows& pairs, bool bed) const {
    if (belts_) return asked(*belts_, pairs);
    if (bed && map_->machine() == nullptr)
      throw cli::Failed("the map", "no_machine",
                        "A map without a machine knows only the frame of its marks.");
    return asked(grid::MapInFrame(*map_, bed ? grid::MapFrame::bed : grid::MapFrame::marks), pairs);
  }

  /// For a map.
  std::string sentence() const { return cli::fit_sentence(*map_); }
  /// For a map: with its fitted settings; empty for a direct surface.
  std::string machine() const {
    return map_->machine() == nullptr ? "" : files::write_machine(*map_->machine());
  }

 private:
  std::optional<grid::CompensationMap> map_;
  std::optional<grid::BeltMap> belts_;
};

}  // namespace

void add_maps(py::module_& module) {
  module.def("maslow4_settings", [](const std::string& anchors) {
    return files::write_maslow4_settings(files::parse_anchors(anchors, "").fit).text;
  });
  py::class_<Answering>(module, "Answering")
      .def(py::init<const std::string&>())
      .def("sentence", &Answering::sentence)
      .def("machine", &Answering::machine)
      .def("query", [](const Answering& map, const Rows& points,
                       bool bed) { return map.ask(query, points, bed); })
      .def("inverse", [](const Answering& map, const Rows& lengths, bool bed) {
        return map.ask(inverse, lengths, bed);
      });
}

}  // namespace chaintrue::python
