// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Every file format with its version. Private to grid/files.
///
/// A file of another version is refused: its additional content would be lost silently.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "grid/files/json_text.hpp"

namespace chaintrue::grid::files {

struct Format {
  std::string_view file_type;
  /// How to make a file of this version; empty for formats that only other programs read.
  std::string_view anew = "";
  std::string_view version = "1.0";
};

inline constexpr Format kMachineFormat{"chaintrue_machine", "make it anew with chaintrue import or start"};
inline constexpr Format kGridFormat{"chaintrue_grid", "copy its readings into a file of chaintrue plan"};
inline constexpr Format kHolesFormat{"chaintrue_holes", "copy its readings into a file of chaintrue plan"};
inline constexpr Format kBeltsFormat{"chaintrue_belts", "make it anew with chaintrue import maslow4"};
inline constexpr Format kAnchorsFormat{"chaintrue_anchors", "make it anew with chaintrue fit"};
inline constexpr Format kMapFormat{"chaintrue_map", "make it anew with chaintrue fit"};
inline constexpr Format kDiagnosisFormat{"chaintrue_diagnosis", "make it anew with chaintrue diagnose"};
inline constexpr Format kSweepFormat{"chaintrue_sweep", "write it by docs/formats/sweep.md"};
inline constexpr Format kSweepSummaryFormat{"chaintrue_sweep_summary"};
inline constexpr Format kAnswerFormat{"chaintrue_answer"};
inline constexpr Format kCheckFormat{"chaintrue_check"};
inline constexpr Format kFitFormat{"chaintrue_fit"};
inline constexpr Format kEffectFormat{"chaintrue_effect", "write it by docs/formats/effect.md"};
inline constexpr Format kPlotterFormat{"chaintrue_plotter",
                                       "make it anew with chaintrue import plotter, or of a drawing with fit"};
inline constexpr Format kDrawingFormat{"chaintrue_drawing",
                                       "copy its measures into a sheet of chaintrue start"};
inline constexpr Format kEffectsFormat{"chaintrue_effects"};
inline constexpr Format kEffectPictureFormat{"chaintrue_effect_picture"};

inline constexpr std::array<const Format*, 17> kFormats = {&kMachineFormat,
                                                           &kGridFormat,
                                                           &kHolesFormat,
                                                           &kBeltsFormat,
                                                           &kAnchorsFormat,
                                                           &kMapFormat,
                                                           &kDiagnosisFormat,
                                                           &kSweepFormat,
                                                           &kSweepSummaryFormat,
                                                           &kAnswerFormat,
                                                           &kCheckFormat,
                                                           &kFitFormat,
                                                           &kEffectFormat,
                                                           &kPlotterFormat,
                                                           &kDrawingFormat,
                                                           &kEffectsFormat,
                                                           &kEffectPictureFormat};

/// The name without chaintrue_: "machine".
[[nodiscard]] std::string name_of(const Format& format);

/// An object with the type and version of such a file.
[[nodiscard]] Json headed(const Format& format);

}  // namespace chaintrue::grid::files
