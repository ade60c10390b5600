// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A compensation map as a document for the terminal and for a browser.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "grid/map/compensation_map.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/map_pictures.hpp"

namespace chaintrue::cli {

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

}  // namespace chaintrue::cli
