// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A residual surface as a correction of an observation's machine, in the frame of that
/// observation's marks. Private to grid/estimation.
#pragma once

#include <optional>

#include "grid/estimation/residual_surface.hpp"
#include "grid/observation/observation.hpp"
#include "interp/eigen.hpp"
#include "model/calibration/sheet_placement.hpp"

namespace chaintrue::grid::estimation {

/// The surface must outlive this.
class SurfaceCorrection final : public observation::LengthCorrection {
 public:
  /// For marks in the surface's frame.
  explicit SurfaceCorrection(const ResidualSurface& surface) : surface_(surface) {}
  /// For marks on a sheet other than the surface's.
  SurfaceCorrection(const ResidualSurface& surface, SheetPlacement surface_sheet,
                    SheetPlacement own_sheet)
      : surface_(surface), sheets_(Sheets{surface_sheet, own_sheet}) {}

  At at(MarkPoint mark, ChainLengths lengths, const Matrix2d& by_mark) const override {
    const auto corrected = surface_.apply(to_surface(mark), lengths, Matrix2d::Zero());
    const Vector2d by_length(1.0 + surface_.scale.left, 1.0 + surface_.scale.right);
    Matrix2d gradient = corrected.mark_jacobian;
    if (sheets_) gradient *= sheets_->surface.rotation().transpose() * sheets_->own.rotation();
    return {corrected.lengths, by_length.asDiagonal() * by_mark + gradient, by_length};
  }
  /// The same place in the surface's frame.
  MarkPoint to_surface(MarkPoint mark) const {
    return sheets_ ? sheets_->surface.to_mark(sheets_->own.to_bed(mark)) : mark;
  }

 private:
  struct Sheets {
    SheetPlacement surface;
    SheetPlacement own;
  };
  const ResidualSurface& surface_;
  std::optional<Sheets> sheets_;
};

}  // namespace chaintrue::grid::estimation
