// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/fit_file.hpp"

#include <algorithm>

#include "grid/files/formats.hpp"
#include "grid/files/record_values.hpp"
#include "grid/map/controller_error.hpp"

namespace chaintrue::grid::files {
namespace {

Json summary_of(const ErrorSummary& error) { return error_summary_record().write(error); }

Json held_out(const HeldOutError& error) {
  return {{"chain", summary_of(error.chain)}, {"tool", summary_of(error.tool)}};
}

}  // namespace

std::string write_fit(const CompensationMap& map,
                      std::string_view sentence,
                      std::optional<double> wish_mm) {
  const MapContents& contents = map.contents();
  Json json = headed(kFitFormat);
  json["sentence"] = std::string(sentence);
  json["points"] = contents.points.size();
  json["set_aside"] = std::count_if(
      contents.points.begin(), contents.points.end(), [](const MapPoint& p) { return p.bad; });
  json["one_at_a_time"] = held_out(contents.accuracy.leave_one_out);
  json["a_block_at_a_time"] = held_out(contents.accuracy.blocked);
  json["expected_tool"] = summary_of(contents.accuracy.expected_tool);
  json["expected_tool"]["worst_at"] = {{"x_mm", contents.accuracy.expected_worst_at.x_mm},
                                       {"y_mm", contents.accuracy.expected_worst_at.y_mm}};
  if (const auto before = error_in_use(map)) json["tool_today"] = summary_of(*before);
  if (wish_mm) {
    json["wish"] = {{"wish_mm", *wish_mm},
                    {"reached", contents.accuracy.expected_tool.rms_mm <= *wish_mm}};
  }
  if (contents.distances) {
    json["distances"] = {{"used", contents.distances->used},
                         {"set_aside", contents.distances->rejected},
                         {"left_out", summary_of(contents.distances->left_out_good)}};
  }
  json["settings"] = Json::array();
  for (const SettingResult& setting : contents.settings) {
    json["settings"].push_back({{"setting", std::string(model::name(setting.setting))},
                                {"stated", setting.stated},
                                {"calibrated", setting.calibrated},
                                {"sigma", setting.sigma},
                                {"off", setting.off}});
  }
  json["mirror"] = contents.mirror ? Json(contents.mirror->sentence) : Json(nullptr);
  json["notes"] = contents.notes;
  return print_json(json);
}

}  // namespace chaintrue::grid::files
