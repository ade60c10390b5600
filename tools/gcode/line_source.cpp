// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reading lines through a window of fixed size.
#include "tools/gcode/line_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>

namespace chaintrue::gcode {
namespace {

constexpr std::size_t kWindow = 256 * 1024;

bool is_blank(char c) { return c == ' ' || c == '\t'; }

std::string printable(char c) {
  const auto byte = static_cast<unsigned char>(c);
  if (byte >= 0x20 && byte < 0x7F) return fmt::format("'{}'", c);
  return fmt::format("byte {:#04x}", static_cast<unsigned>(byte));
}

class Cleaner {
 public:
  Cleaner(std::string_view raw, CleanLine& line) : raw_(raw), line_(line) {}

  void run() {
    while (at_ < raw_.size()) {
      const char c = raw_[at_];
      if (c == '(') {
        parenthesis();
      } else if (c == ';') {
        line_.comments.push_back({std::string(raw_.substr(at_ + 1)), true});
        break;
      } else if (c == '*' && depth_ == 0) {
        checksum();
      } else {
        character(c);
      }
    }
    line_.columns.push_back(static_cast<std::uint32_t>(at_ + 1));
  }

 private:
  Place here() const { return {line_.number, at_ + 1}; }

  void parenthesis() {
    const std::size_t open = at_;
    const std::size_t close = raw_.find_first_of("()", open + 1);
    if (close == std::string_view::npos) {
      refuse(bad_comment, here(), "the comment that opens here is not closed on this line");
    }
    if (raw_[close] == '(') {
      refuse(bad_comment, {line_.number, close + 1}, "a comment opens inside a comment");
    }
    line_.comments.push_back({std::string(raw_.substr(open + 1, close - open - 1)), false});
    at_ = close + 1;
  }

  void character(char c) {
    const auto byte = static_cast<unsigned char>(c);
    if (!is_blank(c) && (byte < 0x20 || byte >= 0x7F)) {
      refuse(bad_character, here(), "{} is not allowed in G-code outside a comment", printable(c));
    }
    if (c == ')') refuse(bad_character, here(), "')' has no matching '('");
    if (c == '[') ++depth_;
    if (c == ']' && depth_ > 0) --depth_;
    if (!is_blank(c)) {
      line_.text.push_back(lower(c));
      line_.columns.push_back(static_cast<std::uint32_t>(at_ + 1));
    }
    ++at_;
  }

  /// RepRap: the exclusive or of all bytes before the asterisk.
  void checksum() {
    const Place place = here();
    unsigned char sum = 0;
    for (const char c : raw_.substr(0, at_))
      sum = static_cast<unsigned char>(sum ^ static_cast<unsigned char>(c));
    const std::size_t digits = at_ + 1;
    const std::size_t end = past_digits(raw_, digits);
    unsigned stated = 0;
    const auto [stop, error] = std::from_chars(raw_.data() + digits, raw_.data() + end, stated);
    if (error != std::errc{} || stop != raw_.data() + end) {
      refuse(bad_checksum, place, "'*' outside brackets starts a checksum, but no number follows");
    }
    std::size_t rest = end;
    while (rest < raw_.size() && is_blank(raw_[rest])) ++rest;
    if (rest < raw_.size() && raw_[rest] != ';' && raw_[rest] != '(') {
      refuse(bad_checksum, place, "there is text after the checksum");
    }
    if (stated != sum) {
      refuse(bad_checksum, place, "the checksum is {}, but that of the line is {}", stated, sum);
    }
    at_ = rest;
  }

  std::string_view raw_;
  CleanLine& line_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

char upper(char letter) {
  return letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
}

char lower(char letter) {
  return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

std::size_t past_digits(std::string_view text, std::size_t at) {
  return std::min(text.find_first_not_of("0123456789", at), text.size());
}

Result<LineSource> LineSource::from_file(const std::string& path) {
  auto file = std::make_unique<std::ifstream>(path, std::ios::binary);
  // A folder can be opened but not read.
  if (!*file || (file->peek(), file->bad())) {
    return tl::unexpected(
        Problem{unreadable_file, {}, fmt::format("the file '{}' cannot be read", path)});
  }
  file->clear();
  return LineSource(std::move(file));
}

LineSource LineSource::from_text(std::string text) {
  return LineSource(std::make_unique<std::istringstream>(std::move(text), std::ios::binary));
}

/// Drops what was read, and reads on.
void LineSource::refill() {
  buffer_.erase(0, begin_);
  buffer_offset_ += begin_;
  begin_ = 0;
  const std::size_t kept = buffer_.size();
  buffer_.resize(kept + kWindow);
  stream_->read(buffer_.data() + kept, static_cast<std::streamsize>(kWindow));
  const auto got = static_cast<std::size_t>(stream_->gcount());
  buffer_.resize(kept + got);
  exhausted_ = got < kWindow;
}

bool LineSource::next(SourceLine& line) {
  // The longest line that is allowed, and its end, are in the buffer as a whole.
  if (buffer_.size() - begin_ < 2 * kMaxLineLength && !exhausted_) refill();
  if (begin_ == buffer_.size()) return false;
  const auto first = buffer_.begin() + static_cast<std::ptrdiff_t>(begin_);
  const auto last =
      std::find_if(first, buffer_.end(), [](char c) { return c == '\n' || c == '\r'; });
  line.text = std::string_view(buffer_).substr(begin_, static_cast<std::size_t>(last - first));
  line.number = ++lines_before_;
  if (const std::size_t zero = line.text.find('\0'); zero != std::string_view::npos) {
    refuse(not_text, {line.number, zero + 1},
           "there is a zero byte, so the file is not plain text (UTF-16, or not G-code)");
  }
  if (line.text.size() > kMaxLineLength) {
    refuse(line_too_long, {line.number},
           "the line is longer than {} characters: the line ends are lost, or this is "
           "not a program",
           kMaxLineLength);
  }
  begin_ += line.text.size();
  // Some editors write CR CR LF: a run of CRs before an LF is one end of line.
  const std::size_t after = std::min(buffer_.find_first_not_of('\r', begin_), buffer_.size());
  const bool has_line_feed = after < buffer_.size() && buffer_[after] == '\n';
  begin_ = has_line_feed ? after + 1 : std::min(begin_ + 1, buffer_.size());
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (line.number == 1 && line.text.starts_with(kByteOrderMark)) line.text.remove_prefix(3);
  if (listener_) listener_(position().offset);
  return true;
}

LineSource::Position LineSource::position() const {
  return {buffer_offset_ + begin_, lines_before_};
}

void LineSource::seek(Position position) {
  lines_before_ = position.lines_before;
  if (position.offset < buffer_offset_ || position.offset > buffer_offset_ + buffer_.size()) {
    stream_->clear();
    stream_->seekg(static_cast<std::streamoff>(position.offset));
    buffer_.clear();
    buffer_offset_ = position.offset;
    exhausted_ = false;
  }
  begin_ = static_cast<std::size_t>(position.offset - buffer_offset_);
}

void clean(std::string_view raw, std::size_t number, CleanLine& line) {
  line.text.clear();
  line.columns.clear();
  line.comments.clear();
  line.number = number;
  return Cleaner(raw, line).run();
}

}  // namespace chaintrue::gcode
