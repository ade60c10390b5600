// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/answer_file.hpp"

#include "grid/files/json_text.hpp"
#include "grid/files/records.hpp"
#include "interp/eigen.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::files {

namespace {

template <class Place>
Json points_of(const std::vector<Place>& places, const std::vector<ChainLengths>& lengths) {
  Json points = Json::array();
  for (const auto i : each_index(places)) {
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
  const std::vector<AppliedEffect>& effects;
  const std::vector<synthetic::SettingOffset>& offsets;
  SheetPlacement sheet;
  const char* bad;
  const Indices& indices;
  Json points;
  const Machine& machine;
};

std::string written(Hidden hidden) {
  Json file = headed(kAnswerFormat);
  file["seed"] = hidden.seed;
  file["effects"] = list(record_of(Of<AppliedEffect>())).write(hidden.effects);
  file["settings"] = json_list(hidden.offsets, [](const synthetic::SettingOffset& offset) {
    return Json{{"setting", name(offset.setting)}, {"offset", offset.offset}};
  });
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
  for (const Setting setting : kMachineSettings) {
    const double offset =
        stated_value(made.truth, setting) - stated_value(*made.set.machine, setting);
    if (offset != 0.0) offsets.push_back({setting, offset});
  }
  return offsets;
}

}  // namespace

std::string write_answer(const synthetic::SyntheticAnswer& answer) {
  return written({answer.seed, answer.hidden, answer.offsets, answer.sheet, "bad_points",
                  answer.bad_points, points_of(answer.places, answer.lengths), answer.machine});
}

std::string write_answer(const synthetic::SyntheticHoles& made, const synthetic::HolesSpec& spec) {
  return written({spec.seed, spec.hidden, offsets_of(made), spec.sheet, "bad_distances",
                  made.bad_readings, points_of(made.places, made.lengths), made.truth});
}

namespace {

Json side_json(EffectSide side) {
  return side == EffectSide::none ? Json(nullptr) : Json(name(side));
}

Json parameter_json(const EffectParameter& parameter) {
  return {{"name", parameter.name},
          {"symbol", parameter.symbol},
          {"meaning", parameter.meaning},
          {"role", parameter.role == ParameterRole::size ? "size" : "place"},
          {"null", parameter.null},
          {"usual", parameter.nominal},
          {"lower", parameter.lower},
          {"upper", parameter.upper},
          {"prior_sigma", parameter.prior_sigma},
          {"whole", parameter.integer}};
}

Json effect_json(const Effect* given) {
  const Effect& effect = *given;
  return {{"effect", effect.id},
          {"station", name(effect.station)},
          {"sides", json_list(effect.sides, side_json)},
          {"parameters", json_list(effect.parameters, parameter_json)},
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
  return {{"points", at.columns * at.rows},
          {"delta_at_usual_size", s.signal_to_noise},
          {"share_left_by_calibration", s.share_left},
          {"seen_from", s.detectable_size},
          {"named_from", s.named_size ? Json(*s.named_size) : Json(nullptr)},
          {"nearest_rival", s.nearest ? rival_json(*s.nearest) : Json(nullptr)},
          {"same_as", json_list(s.inseparable, rival_json)}};
}

Json vector_json(const Vector2d& shift) { return Json::array({shift.x(), shift.y()}); }

Json mark_json(const synthetic::ShiftedMark& mark) {
  return {{"x_mm", mark.mark.x_mm},
          {"y_mm", mark.mark.y_mm},
          {"as_stated_mm", vector_json(mark.as_stated_mm)},
          {"calibrated_mm", vector_json(mark.calibrated_mm)}};
}

Json square_json(const synthetic::ShiftedSquare& square) {
  return {{"centre_x_mm", square.centre.x_mm},
          {"centre_y_mm", square.centre.y_mm},
          {"size_mm", square.size_mm},
          {"corner_shift_mm", json_list(square.corner_shift_mm, vector_json)},
          {"side_mm", square.side_mm},
          {"diagonal_mm", square.diagonal_mm}};
}

}  // namespace

std::string write_catalogue(const std::vector<const Effect*>& effects) {
  Json file = headed(kEffectsFormat);
  file["effects"] = json_list(effects, effect_json);
  return print_json(file);
}

std::string write_effect_picture(const synthetic::EffectPicture& picture) {
  Json file = headed(kEffectPictureFormat);
  file["effect"] = record_of(Of<AppliedEffect>()).write(picture.applied);
  file["noise"] = {{"length_mm", picture.noise.length_mm},
                   {"position_mm", picture.noise.position_mm}};
  file["marks"] = json_list(picture.marks, mark_json);
  file["squares"] = json_list(picture.squares, square_json);
  file["strength"] = json_list(picture.strengths, strength_json);
  return print_json(file);
}

}  // namespace chaintrue::grid::files
