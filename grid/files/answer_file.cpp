// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/answer_file.hpp"

#include "grid/files/json_text.hpp"
#include "grid/files/machine_record.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::files {
namespace {

Json points_of(const synthetic::SyntheticAnswer& answer) {
  Json points = Json::array();
  for (std::size_t i = 0; i < answer.places.size(); ++i) {
    points.push_back({{"x_mm", answer.places[i].x_mm},
                      {"y_mm", answer.places[i].y_mm},
                      {"left_mm", answer.lengths[i].left_mm},
                      {"right_mm", answer.lengths[i].right_mm}});
  }
  return points;
}

}  // namespace

std::string write_answer(const synthetic::SyntheticAnswer& answer) {
  Json effects = Json::array();
  for (const model::AppliedEffect& effect : answer.hidden) {
    effects.push_back(effect_record().write(effect));
  }
  Json settings = Json::array();
  for (const synthetic::SettingOffset& offset : answer.offsets) {
    settings.push_back(
        {{"setting", std::string(model::name(offset.setting))}, {"offset", offset.offset}});
  }
  Json file = headed(kAnswerFormat);
  file["seed"] = answer.seed;
  file["effects"] = std::move(effects);
  file["settings"] = std::move(settings);
  file["sheet"] = {{"x_mm", answer.sheet.x_mm},
                   {"y_mm", answer.sheet.y_mm},
                   {"rotation_rad", answer.sheet.rotation_rad}};
  file["bad_points"] = answer.bad_points;
  file["points"] = points_of(answer);
  file["machine"] = machine_record().write(answer.machine);
  return print_json(file);
}

}  // namespace chaintrue::grid::files
