// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Comments, blanks, capitals and checksums.
#include "tools/gcode/clean_line.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>

namespace chaintrue::gcode {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::string printable(char c) {
  const auto byte = static_cast<unsigned char>(c);
  if (byte >= 0x20 && byte < 0x7F) return fmt::format("'{}'", c);
  return fmt::format("byte {:#04x}", static_cast<unsigned>(byte));
}

class Cleaner {
 public:
  Cleaner(std::string_view raw, CleanLine& line) : raw_(raw), line_(line) {}

  Result<void> run() {
    while (at_ < raw_.size()) {
      const char c = raw_[at_];
      if (c == '(') {
        CHAINTRUE_GCODE_TRY(parenthesis());
      } else if (c == ';') {
        line_.comments.push_back({std::string(raw_.substr(at_ + 1)), at_ + 1, true});
        break;
      } else if (c == '*' && depth_ == 0) {
        CHAINTRUE_GCODE_TRY(checksum());
      } else {
        CHAINTRUE_GCODE_TRY(character(c));
      }
    }
    line_.columns.push_back(static_cast<std::uint32_t>(at_ + 1));
    return {};
  }

 private:
  Place here() const { return {line_.number, at_ + 1}; }

  Result<void> parenthesis() {
    const std::size_t open = at_;
    const std::size_t close = raw_.find_first_of("()", open + 1);
    if (close == std::string_view::npos) {
      return refuse(ProblemName::bad_comment,
                    here(),
                    "the comment that opens here is not closed on this line");
    }
    if (raw_[close] == '(') {
      return refuse(
          ProblemName::bad_comment, {line_.number, close + 1}, "a comment opens inside a comment");
    }
    line_.comments.push_back(
        {std::string(raw_.substr(open + 1, close - open - 1)), open + 1, false});
    at_ = close + 1;
    return {};
  }

  Result<void> character(char c) {
    const auto byte = static_cast<unsigned char>(c);
    if (!is_blank(c) && (byte < 0x20 || byte >= 0x7F)) {
      return refuse(ProblemName::bad_character,
                    here(),
                    fmt::format("{} does not belong into G-code outside a comment", printable(c)));
    }
    if (c == ')') return refuse(ProblemName::bad_character, here(), "')' closes no comment");
    if (c == '[') ++depth_;
    if (c == ']' && depth_ > 0) --depth_;
    if (!is_blank(c)) {
      line_.text.push_back(lower(c));
      line_.columns.push_back(static_cast<std::uint32_t>(at_ + 1));
    }
    ++at_;
    return {};
  }

  /// RepRap: the exclusive or of all bytes before the asterisk.
  Result<void> checksum() {
    const Place place = here();
    unsigned char sum = 0;
    for (const char c : raw_.substr(0, at_))
      sum = static_cast<unsigned char>(sum ^ static_cast<unsigned char>(c));
    const std::size_t digits = at_ + 1;
    std::size_t end = digits;
    while (end < raw_.size() && raw_[end] >= '0' && raw_[end] <= '9') ++end;
    unsigned stated = 0;
    const auto [stop, error] = std::from_chars(raw_.data() + digits, raw_.data() + end, stated);
    if (error != std::errc{} || stop != raw_.data() + end) {
      return refuse(ProblemName::bad_checksum,
                    place,
                    "'*' outside brackets begins a checksum, but no number follows");
    }
    std::size_t rest = end;
    while (rest < raw_.size() && is_blank(raw_[rest])) ++rest;
    if (rest < raw_.size() && raw_[rest] != ';' && raw_[rest] != '(') {
      return refuse(ProblemName::bad_checksum, place, "something follows the checksum");
    }
    if (stated != sum) {
      return refuse(ProblemName::bad_checksum,
                    place,
                    fmt::format("the checksum is {}, but the line's is {}", stated, sum));
    }
    at_ = rest;
    return {};
  }

  std::string_view raw_;
  CleanLine& line_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

Result<void> clean(std::string_view raw, std::size_t number, CleanLine& line) {
  line.text.clear();
  line.columns.clear();
  line.comments.clear();
  line.number = number;
  return Cleaner(raw, line).run();
}

}  // namespace chaintrue::gcode
