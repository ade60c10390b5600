// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One value of a JSON document: its place, how it is read, checked and written, and what is
/// expected of it, in words and as a JSON Schema. json_reader.hpp builds formats from these.
/// Private to grid/files.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grid/files/json_text.hpp"
#include "grid/files/number_text.hpp"

namespace chaintrue::grid::files {

/// A place in the document: the value, its pointer, and the list for problems. Must not outlive its
/// parents.
class Cursor {
 public:
  Cursor(const Json& root, Problems& problems) : json_(&root), problems_(&problems) {}

  [[nodiscard]] const Json& json() const { return *json_; }
  [[nodiscard]] std::string pointer() const;
  [[nodiscard]] Problems& problems() const { return *problems_; }
  /// The whole document.
  [[nodiscard]] const Json& root() const { return parent_ == nullptr ? *json_ : parent_->root(); }
  /// A key that is absent reads as null.
  [[nodiscard]] Cursor child(std::string_view key) const;
  [[nodiscard]] Cursor element(std::size_t index) const;
  [[nodiscard]] bool has(std::string_view key) const;
  /// Nothing was reported here or below so far.
  [[nodiscard]] bool clean() const {
    return !problems_->any() || !problems_->at_or_below(pointer());
  }

  /// Reports that this value is not the expected one; `missing` reports that it is absent.
  void expect(std::string expected, ProblemKind kind = ProblemKind::unexpected) const;
  void missing(std::string expected) const;
  /// Adds a warning, a complete sentence, about this place; reading continues.
  void warn(std::string sentence) const { problems_->warn(pointer(), std::move(sentence)); }

  /// The value if it has the type and range; otherwise reports it and returns nothing.
  [[nodiscard]] std::optional<double> number(const Range& range) const;
  [[nodiscard]] std::optional<int> integer(int least, int most) const;
  [[nodiscard]] std::optional<std::string> text() const;
  [[nodiscard]] std::optional<bool> boolean() const;

 private:
  Cursor(const Json& json, const Cursor* parent, std::string_view key, std::size_t index)
      : json_(&json), problems_(parent->problems_), parent_(parent), key_(key), index_(index) {}

  const Json* json_;
  Problems* problems_;
  const Cursor* parent_ = nullptr;
  std::string_view key_;
  std::size_t index_ = 0;
};

/// What is expected of a value: in words for messages, and as a JSON Schema for editors and the
/// reference pages (schema.hpp). A schema is made on request; words without a schema allow
/// anything.
struct Expected {
  Expected(const char* in_words) : words(in_words) {}  // NOLINT: a text is the usual case
  Expected(std::string in_words) : words(std::move(in_words)) {}  // NOLINT
  Expected(std::string in_words, std::function<Json()> as_schema)
      : words(std::move(in_words)), schema(std::move(as_schema)) {}
  operator const std::string&() const { return words; }  // NOLINT: messages take the words

  std::string words;
  std::function<Json()> schema = [] { return Json::object(); };
};

/// How one value is read and written, and what is expected.
template <class V>
struct Value {
  std::function<std::optional<V>(const Cursor&)> read;
  std::function<Json(const V&)> write;
  Expected expected;
};

/// `schema` with that default if it is a number, a choice, a boolean or a non-empty list of these.
/// Texts have no default.
[[nodiscard]] Json with_default(Json schema, const Json& value);
/// Schema of a number in its range.
[[nodiscard]] Json number_schema(const Range& range);

[[nodiscard]] Value<double> number(Range range);
[[nodiscard]] Value<int> integer(int least, int most);
[[nodiscard]] Value<bool> boolean();
[[nodiscard]] Value<std::string> text();
[[nodiscard]] Value<std::string> one_of(std::vector<std::string> names);

/// An enum by its names in files.
template <class E>
[[nodiscard]] Value<E> choice(std::vector<std::pair<std::string, E>> names) {
  std::vector<std::string> words;
  for (const auto& [name, value] : names) words.push_back(name);
  const Value<std::string> word = one_of(words);
  return {[names, word](const Cursor& at) -> std::optional<E> {
            const auto found = word.read(at);
            for (const auto& [name, value] : names) {
              if (found == name) return value;
            }
            return std::nullopt;
          },
          [names](const E& wanted) -> Json {
            for (const auto& [name, value] : names) {
              if (value == wanted) return name;
            }
            throw std::logic_error("a JSON writer was given a value without a name");
          },
          word.expected};
}

/// Schema of a list of such elements.
[[nodiscard]] Json list_schema(const Json& element, std::size_t fewest);
/// Schema of an object whose keys are not known in advance.
[[nodiscard]] Json dictionary_schema(const Json& element);

/// `fewest` elements at least.
template <class V>
[[nodiscard]] Value<std::vector<V>> list(Value<V> element, std::size_t fewest = 0) {
  const std::string expected =
      fewest == 0
          ? fmt::format("a list, each element {}", element.expected.words)
          : fmt::format("a list of at least {}, each element {}", fewest, element.expected.words);
  return {[element, fewest, expected](const Cursor& at) -> std::optional<std::vector<V>> {
            if (!at.json().is_array()) {
              at.expect(expected);
              return std::nullopt;
            }
            std::vector<V> values;
            values.reserve(at.json().size());
            for (std::size_t i = 0; i < at.json().size(); ++i) {
              auto value = element.read(at.element(i));
              // A value that was wrong and reported keeps its index, so that later indices are
              // right.
              values.push_back(value ? std::move(*value) : V{});
            }
            if (values.size() < fewest) {
              at.problems().add(at.pointer(), fmt::format("{} of them", values.size()), expected);
            }
            return values;
          },
          [element](const std::vector<V>& values) {
            Json array = Json::array();
            for (const V& value : values) array.push_back(element.write(value));
            return array;
          },
          {expected, [element, fewest] { return list_schema(element.expected.schema(), fewest); }}};
}

/// Keys that are not known in advance.
template <class V>
[[nodiscard]] Value<std::map<std::string, V>> dictionary(Value<V> element) {
  const std::string expected = fmt::format("an object, each value {}", element.expected.words);
  return {[element, expected](const Cursor& at) -> std::optional<std::map<std::string, V>> {
            if (!at.json().is_object()) {
              at.expect(expected);
              return std::nullopt;
            }
            std::map<std::string, V> values;
            for (const auto& [key, unused] : at.json().items()) {
              if (key == "comment") continue;
              if (auto value = element.read(at.child(key))) values.emplace(key, std::move(*value));
            }
            return values;
          },
          [element](const std::map<std::string, V>& values) {
            Json object = Json::object();
            for (const auto& [key, value] : values) object[key] = element.write(value);
            return object;
          },
          {expected, [element] { return dictionary_schema(element.expected.schema()); }}};
}

}  // namespace chaintrue::grid::files
