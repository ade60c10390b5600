// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Every file format with its version and the older versions that are still read. Private to
/// grid/files.
///
/// Versions are "major.minor". A file of a listed older version is read, with a warning for what is
/// assumed in place of the missing keys. A newer version is rejected with both versions in the
/// message: its additional content would be lost silently.
///
/// To extend a format: give it the next minor version here, add the previous one to the older
/// versions with the sentence of what is then assumed, and add a sample of it to
/// tests/contracts/formats_contract_test.cpp.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "grid/files/json_text.hpp"

namespace chaintrue::grid::files {

/// A version that is still read.
struct OlderVersion {
  std::string_view version;
  std::string_view assumed;  ///< sentence of what is then assumed
};

struct Format {
  std::string_view file_type;
  std::string_view version;  ///< the version that is written, the newest that is read
  std::span<const OlderVersion> older = {};
  bool is_read = true;  ///< false for formats that only other programs read
};

inline constexpr std::string_view kBeforeProvenance =
    "written before a file said what it was made from; that is not known";

inline constexpr std::array kOlderMaps = {
    OlderVersion{"1.0",
                 "written before maps carried a hash of their content; taken to be undamaged"},
    OlderVersion{
        "1.1", "written before a map could be built on causes that were found; taken to be plain"},
    OlderVersion{"1.2", kBeforeProvenance}};

inline constexpr std::array kOlderDiagnoses = {
    OlderVersion{"1.0",
                 "written before a diagnosis said what remains besides its causes and what the "
                 "error is made of; "
                 "taken to leave nothing unexplained"},
    OlderVersion{"1.1", "written before belts were diagnosed; taken to be of chains"},
    OlderVersion{
        "1.2",
        "written before it was said what to measure next of belts; what it proposes is taken as "
        "it stands"},
    OlderVersion{
        "1.3",
        "written before probabilities were averaged over parts of the bed; its own are taken "
        "as they stand"},
    OlderVersion{"1.4",
                 "written before each part of the error was said by what is left without it"},
    OlderVersion{"1.5",
                 "written before a file said what it was made from and how far the machine misses as it is used; the "
                 "first is not known, the second taken from its points"},
    OlderVersion{"1.6", "written before the order of the visits was found from the readings; taken not to be"},
    OlderVersion{"1.7", "written before laws of what no cause explains were weighed, and test drawings diagnosed; taken to have found no law"},
    OlderVersion{"1.8", "written before the points next to a law's curve were kept and effects of one's own were answered; its laws are said without their pictures"},
    OlderVersion{"1.9", "written before a wave with its second harmonic was weighed as a law"},
    OlderVersion{"1.10", "written before laws of holes' distances and of belts were weighed, and it was said how well a law predicts readings that were left out"},
    OlderVersion{"1.11", "written before causes were compared once more given a law; what these readings name then is not known"}};

inline constexpr std::array kOlderHoles = {OlderVersion{
    "1.0",
    "written before a machine on four belts could cut holes; taken to be of the machine "
    "that it names"}};

inline constexpr std::array kOlderBelts = {OlderVersion{
    "1.0", "written before a file said how hard belts were pulled; taken to be of one pull"}};

inline constexpr std::array kOlderAnchors = {
    OlderVersion{"1.0", "written before holes were fitted with belts; taken to be of belts alone"},
    OlderVersion{"1.1",
                 "written before anchors carried a hash of their content; taken to be undamaged"},
    OlderVersion{"1.2",
                 "written before the stretch of pulled belts was fitted with the anchors and before a file said what it was "
                 "made from; its anchors and sigmas are of belts that do not stretch"},
    OlderVersion{"1.3",
                 "written before the belts that hold were taken to give as those that are pulled; what it says of stretch is of "
                 "pulled belts alone: fit its belts again"}};

inline constexpr std::array kOlderPlotters = {
    OlderVersion{"1.0",
     "written before what a drawing found was kept with its correlations; where it has found settings, their expected error is "
     "not known: fit the drawing again"}};
inline constexpr std::array kOlderDrawings = {
    OlderVersion{"1.0", "written before Marlin's pieces a second were kept; 5 are taken, as its firmware has them unless they were changed"}};

inline constexpr Format kMachineFormat{"chaintrue_machine", "1.0"};
inline constexpr Format kGridFormat{"chaintrue_grid", "1.0"};
inline constexpr Format kHolesFormat{"chaintrue_holes", "1.1", kOlderHoles};
inline constexpr Format kBeltsFormat{"chaintrue_belts", "1.1", kOlderBelts};
inline constexpr Format kAnchorsFormat{"chaintrue_anchors", "1.4", kOlderAnchors};
inline constexpr Format kMapFormat{"chaintrue_map", "1.3", kOlderMaps};
inline constexpr Format kDiagnosisFormat{"chaintrue_diagnosis", "1.12", kOlderDiagnoses};
inline constexpr Format kSweepFormat{"chaintrue_sweep", "1.0"};
inline constexpr Format kSweepSummaryFormat{"chaintrue_sweep_summary", "1.0", {}, false};
inline constexpr Format kAnswerFormat{"chaintrue_answer", "1.0", {}, false};
inline constexpr Format kCheckFormat{"chaintrue_check", "1.0", {}, false};
inline constexpr Format kFitFormat{"chaintrue_fit", "1.1", {}, false};
inline constexpr Format kEffectFormat{"chaintrue_effect", "1.0"};
inline constexpr Format kPlotterFormat{"chaintrue_plotter", "1.1", kOlderPlotters};
inline constexpr Format kDrawingFormat{"chaintrue_drawing", "1.1", kOlderDrawings};
inline constexpr Format kEffectsFormat{"chaintrue_effects", "1.0", {}, false};
inline constexpr Format kEffectPictureFormat{"chaintrue_effect_picture", "1.0", {}, false};

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

/// The assumption for a file of that older version; null if that version is not read.
[[nodiscard]] const OlderVersion* find_older(const Format& format, const Json& version);

/// The versions expected in place of one that is not read; for a newer one, a sentence with both
/// versions.
[[nodiscard]] std::string expected_version(const Format& format, const Json& found);

}  // namespace chaintrue::grid::files
