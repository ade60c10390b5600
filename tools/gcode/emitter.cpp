// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Lines of output.
#include "tools/gcode/emitter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "grid/precondition.hpp"

namespace chaintrue::gcode {
namespace {

/// Behind the ( or ; that opens it.
constexpr std::string_view kHashHead = "sha256 begins ";

bool is_harmless(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view(" ._,+=:-").find(c) != std::string_view::npos;
}

std::string comment(std::string text) {
  for (char& c : text) {
    if (!is_harmless(c)) c = '_';
  }
  return "(" + text.substr(0, kMaxOutputLine - 2) + ")";
}

bool is_marked(std::string_view comment) {
  std::size_t found = 0;
  for (const char wanted : kMarker) {
    if (wanted == ' ') continue;
    while (found < comment.size() && (comment[found] == ' ' || comment[found] == '\t')) ++found;
    if (found == comment.size() || lower(comment[found]) != wanted) return false;
    ++found;
  }
  return true;
}

/// Marlin's MAX_CMD_SIZE, with its end.
constexpr std::size_t kMaxPlotterLine = 95;

/// Without zeros at the end of a decimal fraction.
std::string without_zeros(std::string fraction) {
  fraction.erase(fraction.find_last_not_of('0') + 1);
  if (fraction.ends_with('.')) fraction.pop_back();
  return fraction;
}

/// Three decimals; more only if a slow feed needs them for six digits.
std::string feed_text(double feed) {
  const int digits_before = static_cast<int>(std::floor(std::log10(feed))) + 1;
  return without_zeros(fmt::format("{:.{}f}", feed, std::clamp(6 - digits_before, 3, 20)));
}

/// Truncates without splitting a UTF-8 character.
std::size_t cut(std::string_view text, std::size_t most) {
  if (text.size() <= most) return text.size();
  const std::size_t blank = text.rfind(' ', most - 1);
  if (blank != std::string_view::npos && blank > most / 2) return blank + 1;
  std::size_t end = most;
  while (end > most - 4 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return end;
}

}  // namespace

std::vector<std::string> comments_of(const grid::Provenance& made_by) {
  std::vector<std::string> lines = {
      comment(fmt::format("chaintrue {}, {}", made_by.version, made_by.verb))};
  for (const std::string& option : made_by.options) lines.push_back(comment("option " + option));
  for (const grid::SourceFile& file : made_by.inputs) {
    lines.push_back(comment("from " + file.name));
    lines.push_back("(" + std::string(kHashHead) + file.sha256.substr(0, kHashDigits) + ")");
  }
  return lines;
}

std::vector<std::string> hashes_in_head(LineSource program) {
  std::vector<std::string> hashes;
  SourceLine line;
  const auto more = [&] { return program.next(line); };
  while (attempt(more).value_or(false)) {
    std::string_view text = line.text;
    if (!text.starts_with('(') && !text.starts_with(';')) break;
    text.remove_prefix(1);
    if (text.starts_with(kHashHead))
      hashes.emplace_back(text.substr(kHashHead.size(), kHashDigits));
  }
  return hashes;
}

void refuse_compensated(const Comment& comment) {
  if (!is_marked(comment.text)) return;
  refuse(already_compensated, {comment.line},
         "this file has already been compensated, as this line shows; use the original");
}

Emitter::Emitter(ByteSink out, int decimals, bool semicolons)
    : out_(std::move(out)),
      decimals_(decimals),
      semicolons_(semicolons),
      per_mm_(std::pow(10.0, decimals)) {
  if (decimals < 1 || decimals > 6) {
    throw grid::precondition("an output has 1 to 6 decimals, not {}", decimals);
  }
}

std::int64_t Emitter::rounded(double value_mm) const { return std::llround(value_mm * per_mm_); }

/// Formats a count of units of the last decimal.
std::string Emitter::number(std::int64_t count) const {
  std::string digits = fmt::format("{:0{}}", std::abs(count), decimals_ + 1);
  digits.insert(digits.size() - static_cast<std::size_t>(decimals_), 1, '.');
  return (count < 0 ? "-" : "") + without_zeros(std::move(digits));
}

void Emitter::put_line(std::string_view text) {
  if (semicolons_ && text.starts_with('(') && text.ends_with(')')) {
    out_(";");
    text = text.substr(1, text.size() - 2);
  }
  out_(text);
  out_("\n");
}

void Emitter::put_mark() { put_line(fmt::format("({})", kMarker)); }

void Emitter::flush_word() {
  if (waiting_word_.empty()) return;
  put_line(waiting_word_);
  waiting_word_.clear();
}

void Emitter::header(const std::vector<std::string>& comments) {
  put_line(fmt::format("({}; run with home at 0, 0)", kMarker));
  for (const std::string& line : comments) put_line(line);
  if (semicolons_) put_line("G21");
  put_line(semicolons_ ? "G90" : "G21 G90");
}

void Emitter::command(const Move& move, Point place, double feed_mm_per_min, bool has_xy) {
  const bool rapid = move.kind == MoveKind::rapid;
  constexpr double kLargestMm = 1e8;
  constexpr double kSlowest = 1e-12;
  const auto is_usable = [](double value) { return std::fabs(value) < kLargestMm; };
  if (!is_usable(place.x_mm) || !is_usable(place.y_mm) || !is_usable(place.z_mm) ||
      (!rapid && !(feed_mm_per_min > kSlowest && feed_mm_per_min < 1e12))) {
    refuse(not_emittable, {move.line},
           "a coordinate or feed rate of this move is not a usable number");
  }
  text_ = rapid ? "G0" : "G1";
  const std::size_t bare = text_.size();
  const auto to = std::back_inserter(text_);
  const std::int64_t x = rounded(place.x_mm);
  const std::int64_t y = rounded(place.y_mm);
  const std::int64_t z = rounded(place.z_mm);
  if (has_xy && (x != x_ || y != y_)) {
    fmt::format_to(to, " X{} Y{}", number(x), number(y));
    x_ = x;
    y_ = y;
  }
  if (move.names_z && z != z_) {
    fmt::format_to(to, " Z{}", number(z));
    z_ = z;
  }
  if (text_.size() == bare) return;
  if (!rapid) {
    std::string feed = feed_text(feed_mm_per_min);
    if (feed != feed_) {
      fmt::format_to(to, " F{}", feed);
      feed_ = std::move(feed);
    }
  }
  flush_word();
  put_line(text_);
  ++commands_;
}

/// S is on the line of the M3 that follows and T on that of its M6, as some controllers require;
/// every other word has its own line.
void Emitter::word(const PassedWord& word) {
  std::string_view text = word.text;
  if (word.code && word.code->letter == 'G' && word.code->tenths % 10 != 0) {
    refuse(not_emittable, {word.line},
           "{} cannot be written, because some controllers read only the part before the "
           "decimal point",
           name(*word.code));
  }
  if (text.size() > (semicolons_ ? kMaxPlotterLine : kMaxOutputLine)) {
    refuse(not_emittable, {word.line}, "this line has more characters than a controller accepts");
  }
  const bool joins = waiting_line_ == word.line && !waiting_word_.empty() &&
                     ((waiting_word_.front() == 'T' && text == "M6") ||
                      (waiting_word_.front() == 'S' && (text == "M3" || text == "M4")));
  if (joins) {
    waiting_word_ += ' ';
    waiting_word_ += text;
    flush_word();
    if (text == "M6") put_mark();
    return;
  }
  flush_word();
  if (text.front() == 'S' || text.front() == 'T') {
    waiting_word_ = text;
    waiting_line_ = word.line;
    return;
  }
  constexpr std::string_view kRelative = "G91 ";
  const bool relative = text.starts_with(kRelative);
  if (relative) {
    put_line("G91");
    text.remove_prefix(kRelative.size());
  }
  put_line(text);
  if (relative) put_line("G90");
  if (text == "M6") put_mark();
  // In the machine's own frame: what follows is written whatever it is.
  if (word.moves_itself) {
    z_.reset();
    feed_.clear();
  }
  if (word.leaves_xy) {
    x_.reset();
    y_.reset();
  }
}

void Emitter::comment(const Comment& comment) {
  flush_word();
  std::string text = comment.text;
  for (char& c : text) {
    if (c == '(') c = '[';
    if (c == ')') c = ']';
    // A control character inside a comment ends the line for some readers.
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  const std::string_view open = comment.message ? "(MSG," : "(";
  std::string_view rest = text;
  do {
    const std::size_t length = cut(rest, kMaxOutputLine - open.size() - 1);
    put_line(fmt::format("{}{})", open, rest.substr(0, length)));
    rest.remove_prefix(length);
  } while (!rest.empty());
}

void Emitter::end(std::string_view word) {
  flush_word();
  put_mark();
  if (!word.empty() && word != "%") put_line(word);
}

}  // namespace chaintrue::gcode
