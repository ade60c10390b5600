// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <vector>

#include "grid/containers.hpp"
#include "grid/files/blanks.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/parse_double.hpp"
#include "grid/precondition.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr std::size_t kDeepest = 64;
/// Five times those of the largest map.
constexpr std::size_t kMostValues = 1'000'000;
/// Largest number of members of an object; no format has a hundred.
constexpr std::size_t kMostMembers = 10'000;
constexpr std::size_t kLineWidth = 100;

bool is_word_character(char c) {
  return is_letter(c) || is_digit(c) || c == '+' || c == '-' || c == '.';
}

/// The text with NaN, Infinity, 1e999 and the like in quotes, and the places of these quotes.
struct QuotedText {
  explicit QuotedText(std::string_view source) {
    bool in_string = false;
    for (std::size_t begin = 0, end = 0; begin < source.size(); begin = end) {
      const char c = source[begin];
      end = begin + (in_string && c == '\\' ? 2 : 1);
      if (c == '"') in_string = !in_string;
      const bool is_word = !in_string && is_word_character(c);
      while (is_word && end < source.size() && is_word_character(source[end])) ++end;
      const std::string_view part = source.substr(begin, end - begin);
      const bool is_quoted = is_word && is_beyond_double(part);
      if (is_quoted) append_all(quotes, std::array{text.size(), text.size() + part.size() + 1});
      text += is_quoted ? fmt::format("\"{}\"", part) : part;
    }
  }

  std::size_t offset_in_source(std::size_t offset) const {
    return offset -
           as_size(std::lower_bound(quotes.begin(), quotes.end(), offset) - quotes.begin());
  }

  std::string text;
  Indices quotes;
};

/// The likely reason why the text is not JSON, from the characters around the place; empty if none
/// is recognised.
std::string likely_error(std::string_view text, std::size_t offset) {
  const std::string_view rest = text.substr(offset);
  const std::size_t before = text.substr(0, offset).find_last_not_of(" \r\n");
  if (before != npos && text[before] == ',') {
    if (before > 0 && is_word_character(text[before - 1]) && is_digit(rest.front()))
      return "; a decimal comma? Decimals are written with a point";
    if (rest.front() == '}' || rest.front() == ']') return "; the comma before it is superfluous";
  }
  if (rest.starts_with("//") || rest.starts_with("/*") || rest.starts_with("#"))
    return R"(; JSON has no comments, use the key "comment")";
  if (rest.starts_with("'")) return "; put text between double quotes";
  return {};
}

/// What the parser expected, from its message.
std::string expected_by_parser(std::string_view what) {
  constexpr std::string_view kExpected = "; expected ";
  constexpr std::string_view kInvalid = "invalid string: ";
  const auto words_from = [what](std::size_t begin) {
    return what.substr(begin, what.find("; last read", begin) - begin);
  };
  if (const std::size_t at = what.rfind(kExpected); at != npos)
    return fmt::format("JSON: {} here", words_from(at + kExpected.size()));
  if (const std::size_t at = what.find(kInvalid); at != npos)
    return fmt::format("JSON: in a text, {}", words_from(at + kInvalid.size()));
  return "JSON";
}

/// Builds the value from the parser's events; the parser itself loses the first of two equal keys.
class Builder : public nlohmann::json_sax<Json> {
 public:
  Builder(std::string_view text, const QuotedText& quoted, Problems& problems)
      : text_(text), quoted_(quoted), problems_(problems) {}

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& value) override {
    key_ = std::move(value);
    return true;
  }

  bool parse_error(std::size_t position, const std::string& last_token,
                   const nlohmann::detail::exception& error) override {
    // The parser counts the characters it has read: the last one did not fit, or ended a token that
    // did not.
    std::size_t begin = quoted_.offset_in_source(std::max<std::size_t>(position, 1) - 1);
    if (begin >= text_.size()) {
      refuse(text_.size(), "the end of the text", expected_by_parser(error.what()));
      return false;
    }
    std::size_t end = begin + 1;
    if (is_word_character(text_[begin])) {
      while (begin > 0 && is_word_character(text_[begin - 1])) --begin;
      while (end < text_.size() && is_word_character(text_[end])) ++end;
    } else if (text_[begin] == '"' && text_.substr(0, end).ends_with(last_token)) {
      begin = end - last_token.size();
    }
    refuse(begin, text_.substr(begin, end - begin),
           expected_by_parser(error.what()) + likely_error(text_, begin));
    return false;
  }

  Json take() { return std::move(root_); }

 private:
  void refuse(std::size_t offset, std::string_view found, std::string expected) {
    problems_.add(line_and_column_of(text_, offset), found, ProblemKind::bad_syntax,
                  std::move(expected));
  }

  /// The place of the last value.
  std::string pointer() const {
    std::string text;
    for (const Json* level : open_)
      text = level->is_array() ? pointer_below(text, level->size() - 1)
                               : pointer_below(text, std::prev(level->end()).key());
    return text;
  }

  bool may_have(std::size_t count, std::size_t most, std::string_view what,
                std::string_view found = "more values") {
    if (count <= most) return true;
    problems_.add(pointer(), found, ProblemKind::too_many, "at most {} {}", most, what);
    return false;
  }

  bool add(Json&& value) {
    std::size_t members = 0;
    if (open_.empty()) {
      added_ = &(root_ = std::move(value));
    } else if (open_.back()->is_array()) {
      added_ = &open_.back()->emplace_back(std::move(value));
    } else {
      auto& object = open_.back()->get_ref<Json::object_t&>();
      // Appends without a search for the key, which would be slow for long objects.
      object.Container::emplace_back(std::move(key_), std::move(value));
      added_ = &object.back().second;
      members = object.size();
    }
    return may_have(members, kMostMembers, "members") && may_have(++values_, kMostValues, "values");
  }

  bool open(Json&& value) {
    if (!add(std::move(value)) || !may_have(open_.size() + 1, kDeepest, "levels", "deeper nesting"))
      return false;
    open_.push_back(added_);
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  std::string_view text_;
  const QuotedText& quoted_;
  Problems& problems_;
  Json root_;
  Json* added_ = nullptr;
  std::vector<Json*> open_;
  std::string key_;
  std::size_t values_ = 0;
};

/// Reports keys that stand twice in an object at this place or below it.
void report_repeated_keys(const Json& value, const std::string& place, Problems& problems) {
  std::set<std::string> keys;
  for (const auto& [key, element] : value.items()) {
    const bool is_repeated = value.is_object() && !keys.insert(key).second;
    if (!is_repeated && !element.is_structured()) continue;
    const std::string own = pointer_below(place, key);
    if (is_repeated)
      problems.add(own,
                   element.is_object()  ? "an object"
                   : element.is_array() ? "a list"
                                        : compact_json(element),
                   ProblemKind::repeated_key, "this key only once");
    report_repeated_keys(element, own, problems);
  }
}

std::string quoted_text(const std::string& text) {
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string scalar(const Json& value) {
  if (value.is_number_float()) {
    const double number = value.get<double>();
    if (!std::isfinite(number)) {
      throw precondition("a JSON writer was given the number {}", number);
    }
    return fmt::format("{}", number);
  }
  if (value.is_string()) return quoted_text(value.get_ref<const std::string&>());
  return value.dump();
}

std::string label_in(const Json& parent, const std::string& key) {
  return parent.is_object() ? quoted_text(key) + ": " : "";
}

std::string in_brackets(const Json& value, const std::string& text) {
  return value.is_object() ? "{" + text + "}" : "[" + text + "]";
}

/// Numbers fill their lines; everything else is one value a line.
std::string wrapped_numbers(const Json& numbers, std::size_t indent) {
  const std::string margin = "\n" + std::string(indent, ' ');
  std::string out;
  std::size_t column = kLineWidth;
  for (const auto i : each_index(numbers)) {
    const std::string text = scalar(numbers[i]) + (i + 1 < numbers.size() ? "," : "");
    if (column + 1 + text.size() > kLineWidth) {
      out += margin + "  ";
      column = indent + 2;
    } else {
      out += ' ';
      ++column;
    }
    out += text;
    column += text.size();
  }
  return in_brackets(numbers, out + margin);
}

bool holds_scalars_only(const Json& value) { return none_of(value, &Json::is_structured); }

/// A record in a list is written on one line, however long: one point, one line.
bool is_a_line(const Json& value, bool in_list, std::size_t used, std::size_t length) {
  return !value.is_structured() || value.empty() || used + length <= kLineWidth ||
         (in_list && value.is_object() && holds_scalars_only(value));
}

std::string pretty(const Json& value, bool in_list, std::size_t indent, std::size_t used) {
  std::string compact = compact_json(value);
  if (is_a_line(value, in_list, used, compact.size())) return compact;
  if (value.is_array() && all_of(value, &Json::is_number)) return wrapped_numbers(value, indent);
  const std::string margin = "\n" + std::string(indent, ' ');
  Words parts;
  for (const auto& [key, element] : value.items()) {
    const std::string label = label_in(value, key);
    parts.push_back(margin + "  " + label +
                    pretty(element, value.is_array(), indent + 2, indent + 3 + label.size()));
  }
  return in_brackets(value, fmt::format("{}{}", fmt::join(parts, ","), margin));
}

}  // namespace

Json parse_head(const std::string& text, Problems& problems) {
  if (all_of(text, [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }))
    problems.add("", "an empty file", ProblemKind::empty_file, "JSON text");
  const QuotedText quoted(text);
  Builder builder(text, quoted, problems);
  if (!problems.any()) Json::sax_parse(quoted.text, &builder);
  return builder.take();
}

Json parse_json(const std::string& text, const std::string& file) {
  Problems problems(file);
  Json root = parse_head(text, problems);
  problems.throw_if_any();
  return root;
}

Json parse_json(const std::string& text, Problems& problems) {
  Json root = parse_head(text, problems);
  problems.throw_if_any();
  report_repeated_keys(root, "", problems);
  return root;
}

std::string print_json(const Json& value) { return pretty(value, false, 0, 0) + "\n"; }

std::string compact_json(const Json& value) {
  if (!value.is_structured()) return scalar(value);
  Words parts;
  for (const auto& [key, element] : value.items())
    parts.push_back(label_in(value, key) + compact_json(element));
  return in_brackets(value, joined(parts));
}

}  // namespace chaintrue::grid::files
