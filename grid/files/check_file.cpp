// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/check_file.hpp"

#include "grid/files/formats.hpp"

namespace chaintrue::grid::files {
namespace {

/// The common part of a check of a map and one of anchors.
template <class Check>
Json verdict_of(const Check& check) {
  Json json = headed(kCheckFormat);
  json["verdict"] = std::string(name(check.verdict));
  json["decided"] = check.decided;
  json["sentence"] = check.sentence;
  json["not_told_apart"] = check.not_told_apart;
  for (const CheckVerdict verdict :
       {CheckVerdict::valid, CheckVerdict::valid_after_rezeroing, CheckVerdict::measure_again}) {
    json["probability"][std::string(name(verdict))] =
        check.probability[static_cast<std::size_t>(verdict)];
  }
  return json;
}

Json per_side(const model::PerSide<double>& value, const model::PerSide<double>& sigma) {
  return Json{{"left", {{"value", value.left}, {"sigma", sigma.left}}},
              {"right", {{"value", value.right}, {"sigma", sigma.right}}}};
}

Json hypothesis_of(const CheckHypothesis& hypothesis) {
  Json json;
  json["what"] = hypothesis.what;
  json["side"] = hypothesis.side.empty() ? Json(nullptr) : Json(hypothesis.side);
  json["verdict"] = std::string(name(hypothesis.verdict));
  json["probability"] = hypothesis.probability;
  if (hypothesis.what == "tooth") json["teeth"] = hypothesis.count;
  if (hypothesis.what == "bad_point") json["point"] = hypothesis.count;
  if (hypothesis.what == "zero" || hypothesis.what == "tooth" ||
      hypothesis.what == "zeros_and_pitch")
    json["zero_shift_mm"] = per_side(hypothesis.zero_mm, hypothesis.zero_sigma_mm);
  if (hypothesis.what == "pitch" || hypothesis.what == "zeros_and_pitch")
    json["elongation"] = per_side(hypothesis.elongation, hypothesis.elongation_sigma);
  return json;
}

}  // namespace

std::string write_check(const MapCheck& check) {
  Json json = verdict_of(check);
  if (!check.notes.empty()) json["notes"] = check.notes;
  json["new_zero"] = {{"left_mm", check.new_zero.left_mm}, {"right_mm", check.new_zero.right_mm}};
  json["hypotheses"] = Json::array();
  for (const CheckHypothesis& hypothesis : check.hypotheses)
    json["hypotheses"].push_back(hypothesis_of(hypothesis));
  json["residuals"] = Json::array();
  for (const CheckResidual& residual : check.residuals) {
    json["residuals"].push_back({{"what", residual.what},
                                 {"residual_mm", residual.residual_mm},
                                 {"sigma_mm", residual.sigma_mm}});
  }
  return print_json(json);
}

std::string write_check(const AnchorsCheck& check) {
  Json json = verdict_of(check);
  json["hypotheses"] = Json::array();
  for (const AnchorsHypothesis& h : check.hypotheses) {
    Json one;
    one["what"] = h.what;
    one["side"] = h.belt ? Json(std::string(model::name(*h.belt))) : Json(nullptr);
    one["verdict"] = std::string(name(h.verdict));
    one["probability"] = h.probability;
    if (h.what == "bad_point") one["point"] = h.point;
    if (h.what == "zero" || h.what == "anchor") one["size_mm"] = h.size_mm;
    json["hypotheses"].push_back(std::move(one));
  }
  json["places"] = Json::array();
  for (const CheckedPlace& place : check.places)
    json["places"].push_back({{"rms_mm", place.rms_mm}, {"sigma_mm", place.sigma_mm}});
  return print_json(json);
}

}  // namespace chaintrue::grid::files
