// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/answer_file.hpp"

#include "grid/files/json_text.hpp"
#include "grid/files/records.hpp"
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
    const double offset =
        model::stated_value(made.truth, setting) - model::stated_value(*made.set.machine, setting);
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

std::string write_answer(const synthetic::SyntheticHoles& made, const synthetic::HolesSpec& spec) {
  return written({spec.seed,
                  spec.hidden,
                  offsets_of(made),
                  spec.sheet,
                  "bad_distances",
                  made.bad_readings,
                  points_of(made.places, made.lengths),
                  made.truth});
}

namespace {

using model::effects::Effect;
using model::effects::EffectParameter;
using model::effects::EffectSide;

Json side_json(EffectSide side) {
  return side == EffectSide::none ? Json(nullptr) : Json(std::string(name(side)));
}

Json parameter_json(const EffectParameter& parameter) {
  return {{"name", parameter.name},
          {"symbol", parameter.symbol},
          {"meaning", parameter.meaning},
          {"role", parameter.role == model::effects::ParameterRole::size ? "size" : "place"},
          {"null", parameter.null},
          {"usual", parameter.nominal},
          {"lower", parameter.lower},
          {"upper", parameter.upper},
          {"prior_sigma", parameter.prior_sigma},
          {"whole", parameter.integer}};
}

Json effect_json(const Effect& effect) {
  Json sides = Json::array();
  for (const EffectSide side : effect.sides) sides.push_back(side_json(side));
  Json parameters = Json::array();
  for (const EffectParameter& parameter : effect.parameters)
    parameters.push_back(parameter_json(parameter));
  return {{"effect", effect.id},
          {"station", name(effect.station)},
          {"sides", sides},
          {"parameters", parameters},
          {"cause", effect.cause},
          {"signature", effect.signature},
          {"equation", effect.equation},
          {"typical", effect.typical},
          {"needs", name(effect.needs)},
          {"remedy_kind", name(effect.remedy_kind)},
          {"remedy", effect.remedy},
          {"not_modelled", effect.not_modelled},
          {"source", effect.source}};
}

Json rival_json(const synthetic::Rival& rival) {
  return {
      {"effect", rival.effect->id}, {"side", side_json(rival.side)}, {"rho", rival.collinearity}};
}

Json strength_json(const synthetic::StrengthAt& at) {
  const synthetic::EffectStrength& s = at.strength;
  Json inseparable = Json::array();
  for (const synthetic::Rival& rival : s.inseparable) inseparable.push_back(rival_json(rival));
  return {{"points", at.columns * at.rows},
          {"delta_at_usual_size", s.signal_to_noise},
          {"share_left_by_calibration", s.share_left},
          {"seen_from", s.detectable_size},
          {"named_from", s.named_size ? Json(*s.named_size) : Json(nullptr)},
          {"nearest_rival", s.nearest ? rival_json(*s.nearest) : Json(nullptr)},
          {"same_as", inseparable}};
}

Json square_json(const synthetic::ShiftedSquare& square) {
  Json corners = Json::array();
  for (const Eigen::Vector2d& shift : square.corner_shift_mm)
    corners.push_back({shift.x(), shift.y()});
  return {{"centre_x_mm", square.centre.x_mm},
          {"centre_y_mm", square.centre.y_mm},
          {"size_mm", square.size_mm},
          {"corner_shift_mm", corners},
          {"side_mm", square.side_mm},
          {"diagonal_mm", square.diagonal_mm}};
}

}  // namespace

std::string write_catalogue(const std::vector<const Effect*>& effects) {
  Json file = headed(kEffectsFormat);
  file["effects"] = Json::array();
  for (const Effect* effect : effects) file["effects"].push_back(effect_json(*effect));
  return print_json(file);
}

std::string write_effect_picture(const synthetic::EffectPicture& picture) {
  Json file = headed(kEffectPictureFormat);
  file["effect"] = effect_record().write(picture.applied);
  file["noise"] = {{"length_mm", picture.noise.length_mm},
                   {"position_mm", picture.noise.position_mm}};
  file["marks"] = Json::array();
  for (const synthetic::ShiftedMark& mark : picture.marks) {
    file["marks"].push_back({{"x_mm", mark.mark.x_mm},
                             {"y_mm", mark.mark.y_mm},
                             {"as_stated_mm", {mark.as_stated_mm.x(), mark.as_stated_mm.y()}},
                             {"calibrated_mm", {mark.calibrated_mm.x(), mark.calibrated_mm.y()}}});
  }
  file["squares"] = Json::array();
  for (const synthetic::ShiftedSquare& square : picture.squares)
    file["squares"].push_back(square_json(square));
  file["strength"] = Json::array();
  for (const synthetic::StrengthAt& at : picture.strengths)
    file["strength"].push_back(strength_json(at));
  return print_json(file);
}

}  // namespace chaintrue::grid::files
