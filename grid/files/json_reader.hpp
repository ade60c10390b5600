// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A file format as a table. Private to grid/files; a format states its fields once and gets
/// reading, checking and writing from that: missing and unknown keys (with the nearest known one),
/// wrong types, values out of range, keys that stand twice, all in one go and each by its JSON
/// pointer; and the same bytes for the same object.
///
/// \code
///   struct Hole {
///     std::string name;
///     double x_mm = 0, y_mm = 0;
///     std::optional<double> sigma_mm;
///   };
///   struct Holes {
///     std::string name;
///     std::vector<Hole> holes;
///   };
///
///   const Record<Hole>& hole_record() {
///     static const auto record = Record<Hole>("a hole")
///         .required("name", &Hole::name, text())
///         .required("x_mm", &Hole::x_mm, number({"mm", -20000, 20000}))
///         .required("y_mm", &Hole::y_mm, number({"mm", -20000, 20000}))
///         .optional("sigma_mm", &Hole::sigma_mm, number({"mm", 0, 50}));
///     return record;
///   }
///   const Record<Holes>& holes_record() {
///     static const auto record = Record<Holes>("a chaintrue_holes file", kHolesFormat)
///         .sparse("name", &Holes::name, text())
///         .required("holes", &Holes::holes, list(object(hole_record()), 2))
///         .check([](const Cursor& at, Holes& holes) {  // even where fields were wrong
///           if (at.clean() && names_repeat(holes)) at.child("holes").expect("names that differ");
///         });
///     return record;
///   }
///   Holes parse_holes(const std::string& text, const std::string& file) {
///     return read_document(holes_record(), text, file);
///   }
///   std::string write_holes(const Holes& holes) { return write_document(holes_record(), holes); }
/// \endcode
///
/// How a field stands in the file:
///   required   must be there; always written
///   optional   may be absent or null. A plain member keeps its default and is always written; a
///              std::optional member is empty, and written only when it holds a value
///   sparse     may be absent or null; written only when it is not empty (texts, lists,
///              dictionaries)
///
/// Values: number, integer, boolean, text, choice (an enum by its names), one_of (a text from a
/// list), object, list, dictionary. `Record::custom` takes a pair of functions for whatever does
/// not fit (a variant, a path to another file). Keys are written in the order they are declared.
/// "comment" is allowed in every object and not kept.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grid/files/formats.hpp"
#include "grid/files/json_text.hpp"
#include "grid/files/number_text.hpp"

namespace chaintrue::grid::files {

/// A place in the document: the value, the way to it, and where to say what is wrong. Lives on the
/// stack while its parents do.
class Cursor {
 public:
  Cursor(const Json& root, Problems& problems) : json_(&root), problems_(&problems) {}

  [[nodiscard]] const Json& json() const { return *json_; }
  [[nodiscard]] std::string pointer() const;
  [[nodiscard]] Problems& problems() const { return *problems_; }
  /// A key that is absent reads as null.
  [[nodiscard]] Cursor child(std::string_view key) const;
  [[nodiscard]] Cursor element(std::size_t index) const;
  [[nodiscard]] bool has(std::string_view key) const;
  /// Nothing was wrong here or below so far.
  [[nodiscard]] bool clean() const {
    return !problems_->any() || !problems_->at_or_below(pointer());
  }

  /// Reports this value as not the expected one; `missing` reports that nothing is there.
  void expect(std::string expected) const;
  void missing(std::string expected) const;
  /// A whole sentence about something odd here that does not stop the reading.
  void warn(std::string sentence) const { problems_->warn(pointer(), std::move(sentence)); }

  /// The value where it has the type and range; otherwise reports and gives nothing.
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

/// What is expected of a value: in words for messages, and as a JSON Schema for editors and for the
/// reference pages (schema.hpp). A schema is made when it is asked for; words without one allow
/// anything.
struct Expected {
  Expected(const char* in_words) : words(in_words) {}  // NOLINT: words are the usual case
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

/// `schema` with that default where it is a number, a word, a truth or a list of such that is not
/// empty. Texts have none: an empty one says nothing.
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
/// Schema of an object whose keys are not known beforehand.
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
              // A value that was wrong and reported keeps its place, so that later places still
              // count right.
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

/// Keys that are not known beforehand.
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

/// The part of a record that does not depend on its type: which keys there are.
class KnownKeys {
 public:
  KnownKeys(std::string noun, const Format* format) : noun_(std::move(noun)), format_(format) {}
  [[nodiscard]] const std::string& noun() const { return noun_; }

 protected:
  /// A key with the schema of its value.
  struct KeySchema {
    std::string key;
    bool is_required;
    Json schema;
  };
  /// Of an object with these keys; where this is a file's record, a reference to that file's schema.
  [[nodiscard]] Json schema_of_part(const std::vector<KeySchema>& keys) const;
  /// Of the object itself, written out.
  [[nodiscard]] Json schema_of_keys(const std::vector<KeySchema>& keys) const;

  void add_key(std::string key) { keys_.push_back(std::move(key)); }
  /// False, and reported, where this is no object or a file of another type or version. Warns of
  /// what is assumed of an older version.
  [[nodiscard]] bool open(const Cursor& at, bool is_root) const;
  /// Reports keys that nobody knows; gives those known keys that one of them was probably meant to
  /// be.
  [[nodiscard]] std::vector<std::string> report_unknown_keys(const Cursor& at) const;
  [[nodiscard]] Json head() const { return format_ != nullptr ? headed(*format_) : Json::object(); }

 private:
  std::string noun_;
  const Format* format_;
  std::vector<std::string> keys_;
};

template <class T>
class Record : public KnownKeys {
 public:
  /// `noun` with its article, as in "expected a sprocket".
  explicit Record(std::string noun) : KnownKeys(std::move(noun), nullptr) {}
  /// A file's record begins with its type and version; as part of another file both may be left
  /// out. The format must outlive the record.
  Record(std::string noun, const Format& format) : KnownKeys(std::move(noun), &format) {}

  template <class V>
  Record& required(const std::string& key, V T::*member, Value<V> value) {
    return add(key, true, value.expected, plain_reader(member, value), [member, value](const T& t) {
      return std::optional<Json>(value.write(t.*member));
    });
  }

  template <class V>
  Record& optional(const std::string& key, V T::*member, Value<V> value) {
    const Expected expected{value.expected.words, [member, value] {
                              return with_default(value.expected.schema(),
                                                  value.write(T{}.*member));
                            }};
    return add(key, false, expected, plain_reader(member, value), [member, value](const T& t) {
      return std::optional<Json>(value.write(t.*member));
    });
  }

  template <class V>
  Record& optional(const std::string& key, std::optional<V> T::*member, Value<V> value) {
    return add(
        key,
        false,
        value.expected,
        [member, value](const Cursor& at, T& t) { t.*member = value.read(at); },
        [member, value](const T& t) {
          return t.*member ? std::optional<Json>(value.write(*(t.*member))) : std::nullopt;
        });
  }

  template <class V>
  Record& sparse(const std::string& key, V T::*member, Value<V> value) {
    return add(
        key, false, value.expected, plain_reader(member, value), [member, value](const T& t) {
          return (t.*member).empty() ? std::nullopt : std::optional<Json>(value.write(t.*member));
        });
  }

  /// `write` gives nothing where the key is to be left out.
  Record& custom(const std::string& key,
                 bool is_required,
                 Expected expected,
                 std::function<void(const Cursor&, T&)> read,
                 std::function<std::optional<Json>(const T&)> write) {
    return add(key, is_required, std::move(expected), std::move(read), std::move(write));
  }

  /// A key that always holds the same word, such as the kind in a variant.
  Record& constant(const std::string& key, const std::string& word) {
    return add(
        key,
        true,
        one_of({word}).expected,
        [read = one_of({word}).read](const Cursor& at, T&) { (void)read(at); },
        [word](const T&) { return std::optional<Json>(word); });
  }

  /// Runs after the fields, also where some were wrong; see Cursor::clean.
  Record& check(std::function<void(const Cursor&, T&)> check) {
    checks_.push_back(std::move(check));
    return *this;
  }

  /// What a schema says beside the keys: `{"not": {"required": ["machine", "machine_file"]}}`.
  Record& schema_also(Json rule) {
    rules_.push_back(std::move(rule));
    return *this;
  }
  [[nodiscard]] Expected expected() const {
    return {noun(), [this] { return schema_of_part(key_schemas()); }};
  }
  /// Of the object itself, also where it is a file's.
  [[nodiscard]] Json schema() const {
    Json schema = schema_of_keys(key_schemas());
    for (const Json& rule : rules_) schema.update(rule);
    return schema;
  }

  /// Nothing where this is no object at all; otherwise the object, with what could be read.
  [[nodiscard]] std::optional<T> read(const Cursor& at, bool is_root = false) const {
    T object{};
    if (!read_into(at, object, is_root)) return std::nullopt;
    return object;
  }

  /// The same into an object that other records fill as well; false where this is no object at all.
  bool read_into(const Cursor& at, T& object, bool is_root = false) const {
    if (!open(at, is_root)) return false;
    const std::vector<std::string> probably_meant = report_unknown_keys(at);
    for (const Field& field : fields_) {
      const Cursor child = at.child(field.key);
      if (!at.has(field.key) || (!field.is_required && child.json().is_null())) {
        const bool misspelt = std::find(probably_meant.begin(), probably_meant.end(), field.key) !=
                              probably_meant.end();
        if (field.is_required && !misspelt) child.missing(field.expected);
        continue;
      }
      field.read(child, object);
    }
    for (const auto& check : checks_) check(at, object);
    return true;
  }

  [[nodiscard]] Json write(const T& object) const {
    Json json = head();
    for (const Field& field : fields_) {
      if (auto value = field.write(object)) json[field.key] = std::move(*value);
    }
    return json;
  }

 private:
  struct Field {
    std::string key;
    bool is_required;
    Expected expected;
    std::function<void(const Cursor&, T&)> read;
    std::function<std::optional<Json>(const T&)> write;
  };

  template <class V>
  static std::function<void(const Cursor&, T&)> plain_reader(V T::*member, const Value<V>& value) {
    return [member, read = value.read](const Cursor& at, T& t) {
      if (auto found = read(at)) t.*member = std::move(*found);
    };
  }

  [[nodiscard]] std::vector<KeySchema> key_schemas() const {
    std::vector<KeySchema> keys;
    for (const Field& field : fields_)
      keys.push_back({field.key, field.is_required, field.expected.schema()});
    return keys;
  }

  Record& add(const std::string& key,
              bool is_required,
              Expected expected,
              std::function<void(const Cursor&, T&)> read,
              std::function<std::optional<Json>(const T&)> write) {
    add_key(key);
    fields_.push_back({key, is_required, std::move(expected), std::move(read), std::move(write)});
    return *this;
  }

  std::vector<Field> fields_;
  std::vector<std::function<void(const Cursor&, T&)>> checks_;
  std::vector<Json> rules_;
};

/// The record must outlive the value: records are static.
template <class T>
[[nodiscard]] Value<T> object(const Record<T>& record) {
  return {[&record](const Cursor& at) { return record.read(at); },
          [&record](const T& value) { return record.write(value); },
          record.expected()};
}

/// `problems` knows the file's name and receives the warnings.
/// \throws InputError with every problem of the text.
template <class T>
[[nodiscard]] T read_document(const Record<T>& record,
                              const std::string& text,
                              Problems& problems) {
  const Json json = parse_json(text, problems);
  std::optional<T> object = record.read(Cursor(json, problems), true);
  problems.throw_if_any();
  return std::move(object.value());
}
template <class T>
[[nodiscard]] T read_document(const Record<T>& record,
                              const std::string& text,
                              const std::string& file) {
  Problems problems(file);
  return read_document(record, text, problems);
}

template <class T>
[[nodiscard]] std::string write_document(const Record<T>& record, const T& object) {
  return print_json(record.write(object));
}

}  // namespace chaintrue::grid::files
