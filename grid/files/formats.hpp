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
  bool is_read = true;  ///< false for formats that only other programs read
  std::string_view version = "1.0";
};

inline constexpr Format kMachineFormat{"chaintrue_machine"};
inline constexpr Format kGridFormat{"chaintrue_grid"};
inline constexpr Format kHolesFormat{"chaintrue_holes"};
inline constexpr Format kBeltsFormat{"chaintrue_belts"};
inline constexpr Format kAnchorsFormat{"chaintrue_anchors"};
inline constexpr Format kMapFormat{"chaintrue_map"};
inline constexpr Format kDiagnosisFormat{"chaintrue_diagnosis"};
inline constexpr Format kSweepFormat{"chaintrue_sweep"};
inline constexpr Format kSweepSummaryFormat{"chaintrue_sweep_summary", false};
inline constexpr Format kAnswerFormat{"chaintrue_answer", false};
inline constexpr Format kCheckFormat{"chaintrue_check", false};
inline constexpr Format kFitFormat{"chaintrue_fit", false};
inline constexpr Format kEffectFormat{"chaintrue_effect"};
inline constexpr Format kPlotterFormat{"chaintrue_plotter"};
inline constexpr Format kDrawingFormat{"chaintrue_drawing"};
inline constexpr Format kEffectsFormat{"chaintrue_effects", false};
inline constexpr Format kEffectPictureFormat{"chaintrue_effect_picture", false};

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
