// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/json_value.hpp"

#include <fmt/format.h>

#include <cmath>

namespace chaintrue::grid::files {
namespace {

const Json kNull;

/// The probable meaning of a text in place of a number.
std::string_view hint_for_text(std::string_view text) {
  if (looks_like_decimal_comma(text)) return ", with a decimal point and without quotes";
  return number_of(text) ? ", without quotes" : "";
}

/// NaN, Infinity and 1e999 reach the fields as texts (json_text.hpp).
std::string shown(const Json& value) {
  const auto* text = value.get_ptr<const std::string*>();
  return text != nullptr && is_beyond_double(*text) ? *text : compact_json(value);
}

std::string quoted_choice(const Words& names) {
  const auto quoted =
      mapped(names, [](const std::string& name) { return fmt::format("\"{}\"", name); });
  return quoted.size() == 1 ? quoted[0] : "one of " + joined(quoted);
}

/// The word if it is one of `names`; otherwise reports the nearest one.
std::optional<std::string> word_among(const Cursor& at, const Words& names,
                                      const std::string& expected) {
  if (!at.json().is_string()) return at.expect(expected);
  const auto& word = at.json().get_ref<const std::string&>();
  if (contains(names, word)) return word;
  const std::string meant = nearest(word, names);
  return at.expect(
      meant.empty() ? expected : fmt::format("{}; \"{}\" is the nearest", expected, meant),
      ProblemKind::unknown_word);
}

Expected expected_word(const Words& names) { return {quoted_choice(names), {{"enum", names}}}; }

Json number_schema(const Range& range) {
  // Excludes only meaningless numbers.
  constexpr double kWiderThanAnyMeaning = 1e9;
  Json schema = {{"type", "number"}};
  if (!range.unit.empty()) schema["unit"] = std::string(range.unit);
  if (range.least > -kWiderThanAnyMeaning) schema["minimum"] = range.least;
  if (range.most < kWiderThanAnyMeaning) schema["maximum"] = range.most;
  return schema;
}

std::string expected_list(const Codec& element, std::size_t fewest) {
  const std::string& each = element.expected.words;
  if (fewest == 0) return fmt::format("a list, each element {}", each);
  return fmt::format("a list of at least {}, each element {}", fewest, each);
}

}  // namespace

std::string Cursor::pointer() const {
  if (parent_ == nullptr) return {};
  const std::string parent = parent_->pointer();
  return parent_->json().is_array() ? pointer_below(parent, index_)
                                    : pointer_below(parent, std::string(key_));
}

Cursor Cursor::child(std::string_view key) const {
  if (!json_->is_object()) return {kNull, this, key, 0};
  const auto& members = json_->get_ref<const Json::object_t&>();
  const auto* found = find_where(members, having(&Json::object_t::value_type::first, key));
  return {found == nullptr ? kNull : found->second, this, key, 0};
}

Cursor Cursor::element(std::size_t index) const { return {(*json_)[index], this, {}, index}; }

bool Cursor::has(std::string_view key) const { return &child(key).json() != &kNull; }

std::nullopt_t Cursor::expect(std::string expected, ProblemKind kind) const {
  report(shown(*json_), kind, std::move(expected));
  return std::nullopt;
}

void Cursor::missing(std::string expected) const {
  report("", ProblemKind::missing, std::move(expected));
}

Value<double> number(Range range) {
  return {[range](const Cursor& at) -> std::optional<double> {
            const Json& json = at.json();
            if (json.is_number() && range.holds(json.get<double>())) return json.get<double>();
            std::string expected = range.expected();
            ProblemKind kind =
                json.is_number() ? ProblemKind::out_of_range : ProblemKind::not_a_number;
            if (json.is_string()) {
              const auto& text = json.get_ref<const std::string&>();
              expected += hint_for_text(text);
              if (looks_like_decimal_comma(text)) kind = ProblemKind::decimal_comma;
            }
            return at.expect(std::move(expected), kind);
          },
          // A negative zero would be read back as a zero: the same number, other bytes.
          [](const double& value) { return value + 0.0; },
          {range.expected(), number_schema(range)}};
}

Value<int> integer(int least, int most) {
  const std::string expected = fmt::format("a whole number from {} to {}", least, most);
  return {[=](const Cursor& at) -> std::optional<int> {
            const bool is_number = at.json().is_number();
            const double value = is_number ? at.json().get<double>() : 0.0;
            if (is_number && value >= least && value <= most && value == std::floor(value))
              return static_cast<int>(value);
            return at.expect(expected,
                             is_number ? ProblemKind::out_of_range : ProblemKind::not_a_number);
          },
          [](const int& value) { return value; },
          {expected, {{"type", "integer"}, {"minimum", least}, {"maximum", most}}}};
}

namespace {

/// A value of the type that `is` tells.
template <class V>
Value<V> typed(const std::string& expected, const Json& schema, bool (Json::*is)() const noexcept) {
  return {[=](const Cursor& at) -> std::optional<V> {
            if ((at.json().*is)()) return at.json().get<V>();
            return at.expect(expected);
          },
          [](const V& value) { return value; },
          {expected, schema}};
}

}  // namespace

Value<bool> boolean() {
  return typed<bool>("true or false", {{"type", "boolean"}}, &Json::is_boolean);
}

Value<std::string> text() {
  return typed<std::string>("a text", {{"type", "string"}}, &Json::is_string);
}

Value<std::uint64_t> seed_number() {
  return typed<std::uint64_t>("a whole number of at least 0", {{"type", "integer"}, {"minimum", 0}},
                              &Json::is_number_unsigned);
}

Value<std::string> one_of(const Words& names) {
  const Expected expected = expected_word(names);
  return {[names, expected](const Cursor& at) { return word_among(at, names, expected.words); },
          [](const std::string& value) { return value; }, expected};
}

SharedCodec list_codec(const SharedCodec& element, const ListAccess& access, std::size_t fewest) {
  const std::string words = expected_list(*element, fewest);
  return shared_codec({{words, list_schema(element->expected.schema, fewest)},
                       [=](const Cursor& at, void* list) {
                         if (!at.json().is_array()) {
                           at.expect(words);
                           return false;
                         }
                         access.clear(list);
                         const std::size_t count = at.json().size();
                         // An element that was wrong and reported keeps its index, so that later indices are right.
                         for (std::size_t i = 0; i < count; ++i)
                           element->read(at.element(i), access.append(list));
                         if (count < fewest)
                           at.report(fmt::format("{} of them", count), ProblemKind::wrong_count,
                                     words);
                         return true;
                       },
                       [=](const void* list) {
                         Json array = Json::array();
                         for (std::size_t i = 0; i < access.size(list); ++i)
                           array.push_back(element->write(access.element(list, i)));
                         return array;
                       }});
}

Json dictionary_schema(const Json& element) {
  return {{"type", "object"},
          {"properties", {{"comment", {{"description", "Anything; not read."}}}}},
          {"additionalProperties", element}};
}

Value<std::map<std::string, double>> dictionary(const Value<double>& element) {
  using Numbers = std::map<std::string, double>;
  const std::string expected = fmt::format("an object, each value {}", element.expected.words);
  return {[element, expected](const Cursor& at) -> std::optional<Numbers> {
            if (!at.json().is_object()) return at.expect(expected);
            Numbers values;
            for (const auto& [key, unused] : at.json().items()) {
              if (key == "comment") continue;
              if (const auto value = element.read(at.child(key))) values.emplace(key, *value);
            }
            return values;
          },
          [element](const Numbers& values) {
            Json object = Json::object();
            for (const auto& [key, value] : values) object[key] = element.write(value);
            return object;
          },
          {expected, dictionary_schema(element.expected.schema)}};
}

Json schema_or_null(Json schema) {
  if (schema.contains("enum")) {
    schema["enum"].push_back(nullptr);
  } else if (schema.contains("type") && schema["type"].is_string()) {
    schema["type"] = {schema["type"], "null"};
  } else if (!schema.empty()) {
    schema = {{"anyOf", {schema, {{"type", "null"}}}}};
  }
  return schema;
}

Json list_schema(const Json& element, std::size_t fewest) {
  Json schema = {{"type", "array"}, {"items", element}};
  if (fewest > 0) schema["minItems"] = fewest;
  return schema;
}

}  // namespace chaintrue::grid::files
