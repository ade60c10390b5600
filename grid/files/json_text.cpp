// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_set>
#include <vector>

#include "grid/containers.hpp"
#include "grid/files/number_text.hpp"
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
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '+' ||
         c == '-' || c == '.';
}

/// The text with NaN, Infinity, 1e999 and the like in quotes, and the positions of the inserted
/// quotes.
struct QuotedText {
  std::string text;
  std::vector<std::size_t> quotes;

  std::size_t original_offset(std::size_t offset) const {
    return offset - static_cast<std::size_t>(
                        std::lower_bound(quotes.begin(), quotes.end(), offset) - quotes.begin());
  }
};

QuotedText quote_non_numbers(std::string_view source) {
  QuotedText quoted;
  quoted.text.reserve(source.size());
  bool in_string = false;
  const auto quote = [&quoted] {
    quoted.quotes.push_back(quoted.text.size());
    quoted.text += '"';
  };
  for (std::size_t i = 0; i < source.size();) {
    const char c = source[i];
    if (in_string || !is_word_character(c)) {
      const bool escape = in_string && c == '\\' && i + 1 < source.size();
      if (c == '"') in_string = !in_string;
      quoted.text += c;
      if (escape) quoted.text += source[i + 1];
      i += escape ? 2 : 1;
      continue;
    }
    std::size_t end = i;
    while (end < source.size() && is_word_character(source[end])) ++end;
    const std::string_view word = source.substr(i, end - i);
    const bool quotes_needed = is_beyond_double(word);
    if (quotes_needed) quote();
    quoted.text += word;
    if (quotes_needed) quote();
    i = end;
  }
  return quoted;
}

/// The likely reason why the text is not JSON, from the characters around the place; empty if none
/// is recognised.
std::string likely_error(std::string_view text, std::size_t offset) {
  const std::string_view rest = text.substr(std::min(offset, text.size()));
  std::string_view before = text.substr(0, std::min(offset, text.size()));
  while (!before.empty() &&
         (before.back() == ' ' || before.back() == '\n' || before.back() == '\r')) {
    before.remove_suffix(1);
  }
  const bool after_comma = !before.empty() && before.back() == ',';
  if (after_comma && before.size() >= 2 && is_word_character(before[before.size() - 2]) &&
      !rest.empty() && rest[0] >= '0' && rest[0] <= '9') {
    return "; a decimal comma? Decimals are written with a point";
  }
  if (after_comma && !rest.empty() && (rest[0] == '}' || rest[0] == ']')) {
    return "; the comma before it is superfluous";
  }
  if (rest.substr(0, 2) == "//" || rest.substr(0, 2) == "/*" || rest.substr(0, 1) == "#") {
    return R"(; JSON has no comments, use the key "comment")";
  }
  if (rest.substr(0, 1) == "'") return "; put text between double quotes";
  return {};
}

struct Token {
  std::size_t offset;
  std::string_view text;
};

/// The word, text or single character at `offset`.
Token token_at(std::string_view text, std::size_t offset) {
  if (offset >= text.size()) return {text.size(), "the end of the text"};
  std::size_t begin = offset;
  std::size_t end = offset + 1;
  if (text[offset] == '"') {
    const std::size_t opening = offset == 0 ? std::string_view::npos : text.rfind('"', offset - 1);
    const bool is_on_line =
        opening != std::string_view::npos &&
        text.substr(opening, offset - opening).find('\n') == std::string_view::npos;
    if (is_on_line) begin = opening;
  } else if (is_word_character(text[offset])) {
    while (begin > 0 && is_word_character(text[begin - 1])) --begin;
    while (end < text.size() && is_word_character(text[end])) ++end;
  }
  return {begin, text.substr(begin, end - begin)};
}

/// What the parser expected, from its message.
std::string expected_by_parser(std::string_view what) {
  constexpr std::string_view kExpected = "; expected ";
  constexpr std::string_view kInvalid = "invalid string: ";
  if (const std::size_t at = what.rfind(kExpected); at != std::string_view::npos) {
    return fmt::format("JSON: {} here", what.substr(at + kExpected.size()));
  }
  if (const std::size_t at = what.find(kInvalid); at != std::string_view::npos) {
    const std::string_view reason = what.substr(at + kInvalid.size());
    return fmt::format("JSON: in a text, {}", reason.substr(0, reason.find("; last read")));
  }
  return "JSON";
}

/// Builds the value from the parser's events; the parser itself does not report keys that occur
/// twice.
class Builder : public nlohmann::json_sax<Json> {
 public:
  Builder(const QuotedText& source, std::string_view original, Problems& problems)
      : source_(source), original_(original), problems_(problems) {}

  bool null() override { return add(Json(nullptr)); }
  bool boolean(bool value) override { return add(Json(value)); }
  bool number_integer(number_integer_t value) override { return add(Json(value)); }
  bool number_unsigned(number_unsigned_t value) override { return add(Json(value)); }
  bool number_float(number_float_t value, const string_t&) override { return add(Json(value)); }
  bool string(string_t& value) override { return add(Json(std::move(value))); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& value) override {
    Level& level = open_.back();
    level.key = value;
    level.key_stands_twice = !level.keys.insert(value).second;
    return true;
  }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception& error) override {
    // The parser counts the characters it has read: the last one did not fit, or ended a token that
    // did not.
    const bool at_end = position > source_.text.size();
    const Token token =
        at_end ? Token{original_.size(), "the end of the text"}
               : token_at(original_,
                          source_.original_offset(position - std::min<std::size_t>(position, 1)));
    problems_.add(line_and_column_of(original_, token.offset), token.text, ProblemKind::bad_syntax,
                  expected_by_parser(error.what()) + likely_error(original_, token.offset));
    return false;
  }

  Json take() { return std::move(root_); }

 private:
  struct Level {
    Json* value = nullptr;
    std::string key;
    bool key_stands_twice = false;
    std::unordered_set<std::string> keys;
  };

  /// The place of the value that comes next.
  std::string pointer() const {
    std::string text;
    for (const Level& level : open_) {
      text += '/';
      if (!level.value->is_array()) {
        text += pointer_token(level.key);
      } else {
        // An element that is still open is already in its array.
        const bool holds_next = &level == &open_.back();
        text += fmt::format("{}", level.value->size() - (holds_next ? 0 : 1));
      }
    }
    return text;
  }

  Json* place(Json&& value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    Level& level = open_.back();
    if (level.value->is_array()) {
      level.value->push_back(std::move(value));
      return &level.value->back();
    }
    if (level.key_stands_twice) {
      // An object or list is still empty here.
      problems_.add(pointer(),
                    value.is_object()  ? "an object"
                    : value.is_array() ? "a list"
                                       : compact_json(value),
                    ProblemKind::repeated_key, "this key only once");
    }
    auto& members = level.value->get_ref<Json::object_t&>();
    // Appends without a search for the key, which would be slow for long objects.
    members.Container::emplace_back(level.key, std::move(value));
    return &members.back().second;
  }

  bool has_room() {
    const bool is_full = !open_.empty() && open_.back().value->is_object() &&
                         open_.back().value->size() >= kMostMembers;
    if (++values_ <= kMostValues && !is_full) return true;
    problems_.add(pointer(), "more values", ProblemKind::too_many,
                  is_full ? fmt::format("at most {} members", kMostMembers)
                          : fmt::format("at most {} values", kMostValues));
    return false;
  }

  bool add(Json&& value) {
    if (!has_room()) return false;
    place(std::move(value));
    return true;
  }

  bool open(Json&& value) {
    if (!has_room()) return false;
    if (open_.size() == kDeepest) {
      problems_.add(pointer(), "deeper nesting", ProblemKind::too_many, "at most {} levels",
                    kDeepest);
      return false;
    }
    Level level;
    level.value = place(std::move(value));
    open_.push_back(std::move(level));
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  const QuotedText& source_;
  std::string_view original_;
  Problems& problems_;
  Json root_;
  std::vector<Level> open_;
  std::size_t values_ = 0;
};

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

void append_compact(const Json& value, std::string& out) {
  if (!value.is_structured()) {
    out += scalar(value);
    return;
  }
  const bool object = value.is_object();
  out += object ? '{' : '[';
  bool first = true;
  for (const auto& [key, element] : value.items()) {
    if (!first) out += ", ";
    first = false;
    if (object) out += quoted_text(key) + ": ";
    append_compact(element, out);
  }
  out += object ? '}' : ']';
}

/// Numbers fill their lines; everything else is one value a line.
void append_wrapped_numbers(const Json& numbers, std::size_t indent, std::string& out) {
  const std::string margin = "\n" + std::string(indent + 2, ' ');
  out += '[';
  std::size_t column = kLineWidth;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::string text = scalar(numbers[i]) + (i + 1 < numbers.size() ? "," : "");
    if (column + 1 + text.size() > kLineWidth) {
      out += margin;
      column = indent + 2;
    } else {
      out += ' ';
      ++column;
    }
    out += text;
    column += text.size();
  }
  out += "\n" + std::string(indent, ' ') + "]";
}

bool holds_scalars_only(const Json& value) {
  return none_of(value, [](const Json& v) { return v.is_structured(); });
}

/// A record in a list is written on one line, however long: one point, one line.
bool is_a_line(const Json& value, bool in_list, std::size_t used, std::size_t length) {
  return !value.is_structured() || value.empty() || used + length <= kLineWidth ||
         (in_list && value.is_object() && holds_scalars_only(value));
}

void append_pretty(const Json& value, bool in_list, std::size_t indent, std::size_t used,
                   std::string& out) {
  std::string compact;
  append_compact(value, compact);
  if (is_a_line(value, in_list, used, compact.size())) {
    out += compact;
    return;
  }
  if (value.is_array() && all_of(value, [](const Json& v) { return v.is_number(); })) {
    append_wrapped_numbers(value, indent, out);
    return;
  }
  const bool object = value.is_object();
  out += object ? '{' : '[';
  std::size_t left = value.size();
  for (const auto& [key, element] : value.items()) {
    const std::string label = object ? quoted_text(key) + ": " : "";
    out += "\n" + std::string(indent + 2, ' ') + label;
    append_pretty(element, !object, indent + 2, indent + 3 + label.size(), out);
    if (--left > 0) out += ',';
  }
  out += "\n" + std::string(indent, ' ') + (object ? "}" : "]");
}

}  // namespace

Json parse_json(const std::string& text, Problems& problems) {
  if (all_of(text, [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; })) {
    problems.add("", "an empty file", ProblemKind::empty_file, "JSON text");
    problems.throw_if_any();
  }
  const QuotedText source = quote_non_numbers(text);
  Builder builder(source, text, problems);
  if (!Json::sax_parse(source.text, &builder)) problems.throw_if_any();
  return builder.take();
}

std::string print_json(const Json& value) {
  std::string out;
  append_pretty(value, false, 0, 0, out);
  out += '\n';
  return out;
}

std::string compact_json(const Json& value) {
  std::string out;
  append_compact(value, out);
  return out;
}

std::string pointer_token(std::string_view key) {
  std::string token;
  for (const char c : key) {
    if (c == '~') {
      token += "~0";
    } else if (c == '/') {
      token += "~1";
    } else {
      token += c;
    }
  }
  return token;
}

}  // namespace chaintrue::grid::files
