// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/check_file.hpp"

#include "grid/containers.hpp"
#include "grid/files/formats.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/records.hpp"
#include "grid/map/controller_error.hpp"

namespace chaintrue::grid::files {

namespace {

/// The part common to checks of maps and anchors.
Json verdict_of(const Check& check) {
  Json json = headed(kCheckFormat);
  json["verdict"] = name(check.verdict);
  json["decided"] = check.decided;
  json["sentence"] = check.sentence;
  json["not_told_apart"] = check.not_separable;
  for (const CheckVerdict verdict :
       {CheckVerdict::valid, CheckVerdict::valid_after_rezeroing, CheckVerdict::measure_again}) {
    json["probability"][std::string(name(verdict))] = check.probability[as_size(verdict)];
  }
  return json;
}

Json per_side(const QuantityFound& left, const QuantityFound& right) {
  return Json{{"left", {{"value", left.value}, {"sigma", left.sigma}}},
              {"right", {{"value", right.value}, {"sigma", right.sigma}}}};
}

Json hypothesis_of(const CheckHypothesis& hypothesis) {
  Json json;
  json["what"] = name(hypothesis.what);
  json["side"] = hypothesis.side.empty() ? Json(nullptr) : Json(hypothesis.side);
  json["verdict"] = name(hypothesis.verdict);
  json["probability"] = hypothesis.probability;
  if (hypothesis.what == Change::tooth) json["teeth"] = hypothesis.count;
  if (hypothesis.what == Change::bad_point) json["point"] = hypothesis.count;
  return json;
}

Json hypothesis_of_map(const CheckHypothesis& hypothesis) {
  Json json = hypothesis_of(hypothesis);
  if (hypothesis.what == Change::zero || hypothesis.what == Change::tooth ||
      hypothesis.what == Change::zeros_and_pitch)
    json["zero_shift_mm"] = per_side(hypothesis.added(0), hypothesis.added(1));
  if (hypothesis.what == Change::pitch || hypothesis.what == Change::zeros_and_pitch)
    json["elongation"] = per_side(hypothesis.elongation(0), hypothesis.elongation(1));
  return json;
}

Json hypothesis_of_anchors(const CheckHypothesis& hypothesis) {
  Json json = hypothesis_of(hypothesis);
  if (hypothesis.what == Change::zero || hypothesis.what == Change::anchor)
    json["size_mm"] = hypothesis.size();
  return json;
}

}  // namespace

std::string write_map_check(const Check& check) {
  Json json = verdict_of(check);
  if (check.settings_have_changed) json["settings_have_changed"] = true;
  if (!check.notes.empty()) json["notes"] = check.notes;
  json["new_zero"] = {{"left_mm", check.new_zero_mm.at(0)}, {"right_mm", check.new_zero_mm.at(1)}};
  json["hypotheses"] = json_list(check.hypotheses, hypothesis_of_map);
  json["residuals"] = json_list(check.residuals, [](const CheckResidual& residual) {
    return Json{{"what", residual.name},
                {"residual_mm", residual.residual_mm},
                {"sigma_mm", residual.sigma_mm}};
  });
  return print_json(json);
}

std::string write_anchors_check(const Check& check) {
  Json json = verdict_of(check);
  json["hypotheses"] = json_list(check.hypotheses, hypothesis_of_anchors);
  json["places"] = json_list(check.units, [&](const CheckUnit& place) {
    return Json{{"rms_mm", place.rms_mm(check.residuals)},
                {"sigma_mm", place.sigma_mm(check.residuals)}};
  });
  return print_json(json);
}

namespace {

Json summary_of(const ErrorSummary& error) { return record_of(Of<ErrorSummary>()).write(error); }

Json held_out(const HeldOutError& error) {
  return {{"chain", summary_of(error.chain)}, {"tool", summary_of(error.tool)}};
}

}  // namespace

std::string write_fit(const CompensationMap& map, std::string_view sentence,
                      std::optional<double> wish_mm) {
  const MapContents& contents = map.contents();
  Json json = headed(kFitFormat);
  json["sentence"] = sentence;
  json["points"] = contents.points.size();
  json["set_aside"] = count_where(contents.points, &MapPoint::bad);
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
  json["settings"] = list(setting_record()).write(contents.settings);
  json["mirror"] = contents.mirror ? Json(contents.mirror->sentence) : Json(nullptr);
  json["notes"] = contents.notes;
  return print_json(json);
}

}  // namespace chaintrue::grid::files
