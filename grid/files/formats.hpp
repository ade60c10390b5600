// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Every file format: a row for each. Private to grid/files.
///
/// A file of another version is refused: its additional content would be lost silently.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "grid/files/file_type.hpp"
#include "grid/files/json_text.hpp"
#include "grid/files/origin.hpp"

namespace chaintrue::grid::files {

struct Format {
  std::string_view file_type;
  std::string_view noun = "";  ///< "a map"
  /// The verbs that read such a file or, if none does, the one that wrote it.
  std::string_view verbs = "";
  /// How to make a file of this version; empty for results, which only other programs read.
  std::string_view anew = "";
  Origin origin = Origin::foreign;
  FileKind kind = FileKind::other;
  std::string_view version = "1.0";
};

inline constexpr Format kMachineFormat{"chaintrue_machine",
                                       "a machine",
                                       "plan, simulate or export",
                                       "make it again with chaintrue import or start",
                                       Origin::machine,
                                       FileKind::machine};
inline constexpr Format kGridFormat{
    "chaintrue_grid",         "a grid of measured points",
    "fit, diagnose or check", "copy its readings into a file from chaintrue plan",
    Origin::measured,         FileKind::grid};
inline constexpr Format kHolesFormat{
    "chaintrue_holes",        "a set of holes",
    "fit, diagnose or check", "copy its readings into a file from chaintrue plan",
    Origin::measured,         FileKind::holes};
inline constexpr Format kBeltsFormat{
    "chaintrue_belts",        "a set of belt lengths",
    "fit, diagnose or check", "make it again with chaintrue import maslow4",
    Origin::measured,         FileKind::belts};
inline constexpr Format kAnchorsFormat{"chaintrue_anchors",
                                       "a set of fitted anchors",
                                       "report, query, gcode or export maslow4",
                                       "make it again with chaintrue fit",
                                       Origin::anchors,
                                       FileKind::anchors};
inline constexpr Format kMapFormat{"chaintrue_map",
                                   "a map",
                                   "report, query, gcode or export",
                                   "make it again with chaintrue fit",
                                   Origin::map,
                                   FileKind::map};
inline constexpr Format kDiagnosisFormat{
    "chaintrue_diagnosis",    "a diagnosis",
    "report or plan --after", "make it again with chaintrue diagnose",
    Origin::diagnosis,        FileKind::diagnosis};
inline constexpr Format kPlotterFormat{
    "chaintrue_plotter",
    "a V-plotter",
    "start or export plotter",
    "make it again with chaintrue import plotter, or from a drawing with fit",
    Origin::machine,
    FileKind::plotter};
inline constexpr Format kDrawingFormat{"chaintrue_drawing",
                                       "a test drawing of a V-plotter",
                                       "fit",
                                       "copy its measures into a sheet from chaintrue start",
                                       Origin::measured,
                                       FileKind::drawing};
inline constexpr Format kEffectFormat{"chaintrue_effect", "a declared effect",
                                      "effects --effects, diagnose --effects or simulate --effects",
                                      "write it as docs/formats/effect.md describes"};
inline constexpr Format kSweepFormat{"chaintrue_sweep", "a sweep", "sweep",
                                     "write it as docs/formats/sweep.md describes"};
inline constexpr Format kFitFormat{"chaintrue_fit", "the result of a fit", "fit"};
inline constexpr Format kCheckFormat{"chaintrue_check", "the result of a check", "check", "",
                                     Origin::check};
inline constexpr Format kAnswerFormat{"chaintrue_answer", "what a simulation hid", "simulate", "",
                                      Origin::answer};
inline constexpr Format kSweepSummaryFormat{"chaintrue_sweep_summary", "", "", "", Origin::table};
inline constexpr Format kEffectsFormat{"chaintrue_effects"};
inline constexpr Format kEffectPictureFormat{"chaintrue_effect_picture"};

inline constexpr std::array<const Format*, 17> kFormats = {
    &kMachineFormat, &kGridFormat,         &kHolesFormat,  &kBeltsFormat,        &kAnchorsFormat,
    &kMapFormat,     &kDiagnosisFormat,    &kSweepFormat,  &kSweepSummaryFormat, &kAnswerFormat,
    &kCheckFormat,   &kFitFormat,          &kEffectFormat, &kPlotterFormat,      &kDrawingFormat,
    &kEffectsFormat, &kEffectPictureFormat};

/// Null for a type that there is none of.
const Format* format_of(std::string_view file_type);

/// The name without chaintrue_: "machine".
std::string name_of(const Format& format);

/// An object with the type and version of such a file.
Json headed(const Format& format);

}  // namespace chaintrue::grid::files
