// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/answer_file.hpp"

#include "grid/files/json_text.hpp"
#include "grid/files/machine_record.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::files {
namespace {

template <class Place>
Json points_of(const std::vector<Place>& places, const std::vector<model::ChainLengths>& lengths) {
  Json points = Json::array();
  for (std::size_t i = 0; i < places.size(); ++i) {
    points.push_back({{"x_mm", places[i].x_mm},
                      {"y_mm", places[i].y_mm},
                      {"left_mm", lengths[i].left_mm},
                      {"right_mm", lengths[i].right_mm}});
  }
  return points;
}

/// The common part of a set of holes and a grid, in their order; `bad` is the key of `indices`.
struct Hidden {
  std::uint64_t seed;
  const std::vector<model::AppliedEffect>& effects;
  const std::vector<synthetic::SettingOffset>& offsets;
  model::SheetPlacement sheet;
  const char* bad;
  const std::vector<std::size_t>& indices;
  Json points;
  const model::Machine& machine;
};

std::string written(Hidden hidden) {
  Json effects = Json::array();
  for (const model::AppliedEffect& effect : hidden.effects)
    effects.push_back(effect_record().write(effect));
  Json settings = Json::array();
  for (const synthetic::SettingOffset& offset : hidden.offsets) {
    settings.push_back(
        {{"setting", std::string(model::name(offset.setting))}, {"offset", offset.offset}});
  }
  Json file = headed(kAnswerFormat);
  file["seed"] = hidden.seed;
  file["effects"] = std::move(effects);
  file["settings"] = std::move(settings);
  file["sheet"] = {{"x_mm", hidden.sheet.x_mm},
                   {"y_mm", hidden.sheet.y_mm},
                   {"rotation_rad", hidden.sheet.rotation_rad}};
  file[hidden.bad] = hidden.indices;
  file["points"] = std::move(hidden.points);
  file["machine"] = machine_record().write(hidden.machine);
  return print_json(file);
}

/// True settings less stated ones.
std::vector<synthetic::SettingOffset> offsets_of(const synthetic::SyntheticHoles& made) {
  std::vector<synthetic::SettingOffset> offsets;
  for (const model::Setting setting : model::kMachineSettings) {
    const double offset = model::stated_value(made.truth, setting) -
                          model::stated_value(*made.set.machine, setting);
    if (offset != 0.0) offsets.push_back({setting, offset});
  }
  return offsets;
}

}  // namespace

std::string write_answer(const synthetic::SyntheticAnswer& answer) {
  return written({answer.seed,
                  answer.hidden,
                  answer.offsets,
                  answer.sheet,
                  "bad_points",
                  answer.bad_points,
                  points_of(answer.places, answer.lengths),
                  answer.machine});
}

std::string write_answer(const synthetic::SyntheticHoles& made,
                         const synthetic::HolesSpec& spec) {
  return written({spec.seed,
                  spec.hidden,
                  offsets_of(made),
                  spec.sheet,
                  "bad_distances",
                  made.bad_readings,
                  points_of(made.places, made.lengths),
                  made.truth});
}

}  // namespace chaintrue::grid::files
