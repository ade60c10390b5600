// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A compensated program's report: whether it is safe to run, its cuts before and after, coloured
/// by the correction, and what was done.
///
/// \code
///   PathReport report{.name = "part.nc", .verdict = "192 commands; corrections up to 4.5 mm."};
///   report.add({.line = 14, .x0_mm = -120, .y0_mm = -160, ...});
///   write_file("part.html", render_html(page_of(report)));
/// \endcode
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/report/bed_chart.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::report {

/// A straight command: start and end on the sheet, and the commanded ends less these.
struct PathPiece {
  std::size_t line = 0;  ///< of the program
  bool is_rapid = false;
  double x0_mm = 0.0;
  double y0_mm = 0.0;
  double x1_mm = 0.0;
  double y1_mm = 0.0;
  ToolVector correction0{};
  ToolVector correction1{};
};

struct PathReport {
  std::string name{};
  std::string verdict{};
  Outline sheet{};
  std::vector<Figure> figures{};

  /// Keeps at most kMostPieces: beyond that, every second one, every fourth, ... so that memory is
  /// bounded.
  void add(const PathPiece& piece);
  const std::vector<PathPiece>& pieces() const { return pieces_; }
  /// One in this number of pieces is drawn.
  std::uint64_t stride() const { return stride_; }

  static constexpr std::size_t kMostPieces = 20000;

 private:
  std::vector<PathPiece> pieces_;
  std::uint64_t stride_ = 1;
  std::uint64_t seen_ = 0;
};

/// \throws std::invalid_argument for a sheet without an extent.
Document page_of(const PathReport& report);

}  // namespace chaintrue::report
