// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The drawing of a four-belt frame: anchors with their ellipses, and at each place a stroke for
/// each belt as long as its residual.
#pragma once

#include <string>

#include "grid/diagnosis/belts_findings.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

inline constexpr const char* kFrameCaption =
    "Each stroke follows its belt, in that anchor's colour: towards the anchor if the belt reads "
    "long, away from it if it reads short. Circled: left out.";

inline constexpr const char* kAnchorsCaption =
    "From the bottom left anchor, x to the bottom right one: tl is the top left anchor. Sigma: one "
    "standard deviation.";
/// "tl x" of tl_x_mm
[[nodiscard]] inline std::string coordinate_title(const std::string& name) {
  return name.substr(0, 2) + " " + name.substr(3, 1);
}

/// All strokes of the same findings have one scale.
[[nodiscard]] Chart frame_chart(const diagnosis::BeltsFindings& found,
                                std::string title,
                                model::PerBelt<double> diagnosis::BeltPlacePicture::*which);

}  // namespace chaintrue::cli
