// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A compensation map's figures, in words and numbers.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/belts/belts_and_holes.hpp"
#include "grid/belts/belts_error.hpp"
#include "grid/belts/measured_belts.hpp"
#include "grid/map/compensation_map.hpp"
#include "model/calibration/setting.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"
#include "tools/report/map_pictures.hpp"

namespace chaintrue::cli {

using report::number_column;
using report::text_column;

// The machine's settings in words, stated and calibrated.

/// "left motor, x" for motor_left_x_mm; a value in `unit` is `factor` times the setting's.
struct SettingWords {
  std::string_view words;
  std::string_view unit = "mm";
  double factor = 1.0;
};
const SettingWords& setting_words(Setting setting);

/// In the setting's own unit.
struct SettingRow {
  Setting setting;
  double stated = 0.0;
  std::optional<double> stated_sigma;
  double calibrated = 0.0;
  double sigma = 0.0;
  /// Farther from the stated value than its uncertainty allows.
  bool is_off = false;
};
Table settings_table(const std::vector<SettingRow>& settings);

/// A length for a headline: one digit below a millimetre ("0.3 mm", "0.04 mm"), two above ("5.1 mm",
/// "11 mm").
std::string about_mm(double mm);

/// The label of error_in_use(), which is "before" in every verb and page.
inline constexpr const char* kToolTodayLabel =
    "error of the tool today, rms over the measured part";

/// The words in a headline for the map or the anchors.
struct Remedy {
  std::string_view with;    ///< "this map"
  std::string_view needed;  ///< "map": "Your machine needs no map"
};
/// "Your machine misses by about 4.9 mm. With this map it misses by about 0.2 mm." `today` is
/// empty if the settings in force are unknown.
std::string misses_sentence(const std::optional<ErrorSummary>& today, double expected_mm,
                            const Remedy& remedy);
/// "At worst it misses by about 0.7 mm, in 95 of 100 sessions. The error is largest near (1118, 508)."
std::string worst_sentence(double x_mm, double y_mm, double worst_mm);

/// The headline: by how much the tool misses today, and by how much with the map. Both are errors
/// of the tool over the measured part, not residuals at the points.
std::string fit_sentence(const CompensationMap& map);

/// The statistics of the points: rms with the settings in force, with the map, and of points left out.
std::string points_sentence(const CompensationMap& map);

/// Whether the map meets the wish and, if not, how many marks would be expected to.
std::string wish_sentence(const CompensationMap& map, double wish_mm);

/// The usual error of uncalibrated machines, apart from the sheet's placement.
inline constexpr double kMostToCutWithMm = 3.0;
/// Why this map is unfit for cutting: its held-out error exceeds that, rms. Otherwise empty. gcode
/// compensate and export accept such a map only with --force.
std::string not_to_cut_with(const CompensationMap& map);

/// Refuses a result for the reason `why` and explains how to use it anyway; does nothing if `why` is
/// empty or the user forces it. \throws Failed
void require_fit_for_cutting(const std::string& why, bool is_forced);

/// Rms and maximum of `size_of` over all that are not bad.
template <class Readings, class Size>
ErrorSummary summary_of_good(const Readings& readings, Size size_of) {
  std::vector<double> sizes;
  for (const auto& reading : readings) {
    if (!reading.bad) sizes.push_back(size_of(reading));
  }
  return grid::summary_of(sizes);
}

using Residual = Eigen::Vector2d MapPoint::*;
/// Over the good points.
ErrorSummary summary_of(const MapContents& contents, Residual residual);
/// Whether the sheet was placed by hand, and its placement estimated.
bool has_placed_sheet(const MapContents& contents);
/// The reference for the map, and its name: the machine as stated, on the fitted sheet.
Residual residual_before(const MapContents& contents);
std::string_view machine_before(const MapContents& contents);
/// For the machine and for the sheet.
std::vector<SettingRow> settings_rows(const CompensationMap& map);

// A compensation map as a document for the terminal and for a browser.
/// `source` is the name of the map's file, for the page's last line. Pictures are made if `detail`
/// is page. The map is compared with `wish_mm`, an error of the tool, if given.
Document map_document(const CompensationMap& map, std::string_view source,
                      Detail detail = Detail::page, std::optional<double> wish_mm = std::nullopt);

/// The data of the pictures.
report::MapPictures map_pictures(const CompensationMap& map);

/// Caution if a point was rejected or a setting is off.
Tone tone_of(const MapContents& contents);
/// "Made from map.json by chaintrue 1.0."
std::string provenance_of(std::string_view source);

// A fit of four belts as a document for the terminal and for a browser.
/// The input of the fit; null if not available.
struct FittedBelts {
  const BeltsFit& fit;
  const HolesWithBelts* holes = nullptr;
  /// The anchors' file has neither the taped distances nor the machine's message.
  const MeasuredBelts* belts = nullptr;
  grid::PointIndices indices{};  ///< of the points in their file
};

/// The agreement of the belts, the frame, the anchors, errors at left-out readings, the scale and
/// the tape. `name` is the belts', `source` the file's.
Document anchors_document(const FittedBelts& fitted, std::string_view name,
                          std::string_view source);

/// The machine's error, today and with these anchors.
std::string headline_of(const BeltsFit& fit, const std::optional<BeltsError>& error);
/// Why these anchors must not be pasted: their error exceeds kMostToCutWithMm or, if it is unknown,
/// their uncertainty does. Otherwise empty.
std::string not_to_paste(const BeltsFit& fit, const std::optional<BeltsError>& error);

/// The least certain anchors, the causes, the error of one belt's reading, and the machine's figure
/// for it.
Section agreement_section(const FittedBelts& fitted, const std::optional<BeltsError>& error);
/// Errors at left-out readings, rejected readings, the scale and the holes.
Section tests_section(const FittedBelts& fitted);

}  // namespace chaintrue::cli
