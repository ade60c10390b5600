// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/json_value.hpp"

#include <algorithm>
#include <cmath>

namespace chaintrue::grid::files {
namespace {

const Json kNull;

/// What a text in a number's place was probably meant to be.
std::string_view hint_for_text(std::string_view text) {
  if (looks_like_decimal_comma(text)) return ", with a decimal point and without quotes";
  return number_of(text) ? ", without quotes" : "";
}

/// NaN, Infinity and 1e999 are passed to the fields as texts (json_text.hpp); they are printed as
/// in the file.
std::string shown(const Json& value) {
  const bool as_it_stands =
      value.is_string() && is_beyond_double(value.get_ref<const std::string&>());
  return as_it_stands ? value.get<std::string>() : compact_json(value);
}

}  // namespace

std::string Cursor::pointer() const {
  if (parent_ == nullptr) return {};
  const std::string token =
      parent_->json().is_array() ? fmt::format("{}", index_) : pointer_token(key_);
  return parent_->pointer() + "/" + token;
}

Cursor Cursor::child(std::string_view key) const {
  if (!json_->is_object()) return {kNull, this, key, 0};
  const auto& members = json_->get_ref<const Json::object_t&>();
  const auto found = std::find_if(
      members.begin(), members.end(), [key](const auto& member) { return member.first == key; });
  return {found == members.end() ? kNull : found->second, this, key, 0};
}

Cursor Cursor::element(std::size_t index) const { return {(*json_)[index], this, {}, index}; }

bool Cursor::has(std::string_view key) const { return &child(key).json() != &kNull; }

void Cursor::expect(std::string expected, ProblemKind kind) const {
  problems_->add(pointer(), shown(*json_), std::move(expected), kind);
}

void Cursor::missing(std::string expected) const {
  problems_->add(pointer(), "", std::move(expected));
}

std::optional<double> Cursor::number(const Range& range) const {
  if (json_->is_number() && range.holds(json_->get<double>())) return json_->get<double>();
  std::string expected = range.expected();
  ProblemKind kind = json_->is_number() ? ProblemKind::out_of_range : ProblemKind::not_a_number;
  if (json_->is_string()) {
    const auto& text = json_->get_ref<const std::string&>();
    expected += hint_for_text(text);
    if (looks_like_decimal_comma(text)) kind = ProblemKind::decimal_comma;
  }
  expect(std::move(expected), kind);
  return std::nullopt;
}

std::optional<int> Cursor::integer(int least, int most) const {
  if (json_->is_number()) {
    const double value = json_->get<double>();
    if (value >= least && value <= most && value == std::floor(value))
      return static_cast<int>(value);
  }
  expect(fmt::format("a whole number from {} to {}", least, most),
         json_->is_number() ? ProblemKind::out_of_range : ProblemKind::not_a_number);
  return std::nullopt;
}

std::optional<std::string> Cursor::text() const {
  if (json_->is_string()) return json_->get<std::string>();
  expect("a text");
  return std::nullopt;
}

std::optional<bool> Cursor::boolean() const {
  if (json_->is_boolean()) return json_->get<bool>();
  expect("true or false");
  return std::nullopt;
}

Value<double> number(Range range) {
  return {[range](const Cursor& at) { return at.number(range); },
          // A negative zero would be read back as a zero: the same number, other bytes.
          [](const double& value) { return Json(value + 0.0); },
          {range.expected(), [range] { return number_schema(range); }}};
}

Value<int> integer(int least, int most) {
  return {[least, most](const Cursor& at) { return at.integer(least, most); },
          [](const int& value) { return Json(value); },
          {fmt::format("a whole number from {} to {}", least, most), [least, most] {
             return Json{{"type", "integer"}, {"minimum", least}, {"maximum", most}};
           }}};
}

Value<bool> boolean() {
  return {[](const Cursor& at) { return at.boolean(); },
          [](const bool& value) { return Json(value); },
          {"true or false", [] {
             return Json{{"type", "boolean"}};
           }}};
}

Value<std::string> text() {
  return {[](const Cursor& at) { return at.text(); },
          [](const std::string& value) { return Json(value); },
          {"a text", [] {
             return Json{{"type", "string"}};
           }}};
}

Value<std::string> one_of(std::vector<std::string> names) {
  std::vector<std::string> quoted;
  for (const std::string& name : names) quoted.push_back(fmt::format("\"{}\"", name));
  const std::string expected = quoted.size() == 1 ? quoted[0] : "one of " + joined(quoted);
  return {[names, expected](const Cursor& at) -> std::optional<std::string> {
            if (at.json().is_string()) {
              const auto& word = at.json().get_ref<const std::string&>();
              if (std::find(names.begin(), names.end(), word) != names.end()) return word;
              const std::string meant = nearest(word, names);
              at.expect(meant.empty() ? expected
                                      : fmt::format("{}; \"{}\" is the nearest", expected, meant),
                        ProblemKind::unknown_word);
            } else {
              at.expect(expected);
            }
            return std::nullopt;
          },
          [](const std::string& value) { return Json(value); },
          {expected, [names] {
             return Json{{"enum", names}};
           }}};
}

Json with_default(Json schema, const Json& value) {
  const bool says_something = schema.contains("enum") || value.is_number() || value.is_boolean() ||
                              (value.is_array() && !value.empty());
  if (says_something) schema["default"] = value;
  return schema;
}

Json number_schema(const Range& range) {
  // Only excludes numbers that have no meaning.
  constexpr double kWiderThanAnyMeaning = 1e9;
  Json schema = {{"type", "number"}};
  if (!range.unit.empty()) schema["unit"] = std::string(range.unit);
  if (range.least > -kWiderThanAnyMeaning) schema["minimum"] = range.least;
  if (range.most < kWiderThanAnyMeaning) schema["maximum"] = range.most;
  return schema;
}

Json list_schema(const Json& element, std::size_t fewest) {
  Json schema = {{"type", "array"}, {"items", element}};
  if (fewest > 0) schema["minItems"] = fewest;
  return schema;
}

Json dictionary_schema(const Json& element) {
  return {{"type", "object"},
          {"properties", {{"comment", {{"description", "Anything; not read."}}}}},
          {"additionalProperties", element}};
}

}  // namespace chaintrue::grid::files
