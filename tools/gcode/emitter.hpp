// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Writes G-code that all controllers of such machines read in the same way: G21 G90, G0 and G1
/// only, X and Y always together, no codes with a decimal point, no exponents, no moves of zero length, at
/// most 60 characters per line.
///
/// The head of the file says where it comes from, in comments:
///
///     (chaintrue 0.1.0, gcode compensate)
///     (option --tolerance-mm 0.1)
///     (from map.json)
///     (sha256 begins 0f343b0931126a20f133d67c2b018a3b)
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/provenance.hpp"
#include "tools/gcode/events.hpp"
#include "tools/gcode/line_source.hpp"

namespace chaintrue::gcode {

/// The whole hash does not fit into a line.
inline constexpr std::size_t kHashDigits = 32;

/// At most kMaxOutputLine characters a line. Characters that a controller might act on in a comment
/// are replaced by _.
std::vector<std::string> comments_of(const grid::Provenance& made_by);

/// The beginnings of the hashes in the comments at the beginning of a program; none if it has no
/// such comments or cannot be read.
std::vector<std::string> hashes_in_head(LineSource program);

/// Takes the next bytes of the output.
using ByteSink = std::function<void(std::string_view)>;

inline constexpr std::size_t kMaxOutputLine = 60;
/// The first words of the first comment of every file written here. The same comment is at every
/// change of the tool and at the end, so that a file without its head, or the part of one tool alone,
/// is still known.
inline constexpr std::string_view kMarker = "compensated by chaintrue";
/// Refuses a comment that begins with these words, regardless of capitals and blanks that a sender
/// has changed (already_compensated).
void refuse_compensated(const Comment& comment);

class Emitter {
 public:
  /// \param decimals 1 to 6.
  /// \param semicolons comments follow semicolons, and each line has one code.
  Emitter(ByteSink out, int decimals, bool semicolons = false);

  /// Comments of the head, one per line; then the modes.
  void header(const std::vector<std::string>& comments);
  /// One straight command, with Z if the move names it. A command that changes nothing after
  /// rounding is left out.
  /// \param has_xy false for a move in Z alone.
  void command(const Move& move, Point place, double feed_mm_per_min, bool has_xy = true);
  void word(const PassedWord& word);
  void comment(const Comment& comment);
  void end(std::string_view word);
  std::uint64_t commands() const { return commands_; }

 private:
  void put_line(std::string_view text);
  void put_mark();
  void flush_word();
  std::int64_t rounded(double value_mm) const;
  std::string number(std::int64_t count) const;

  ByteSink out_;
  int decimals_;
  bool semicolons_;
  double per_mm_;
  std::optional<std::int64_t> x_;
  std::optional<std::int64_t> y_;
  std::optional<std::int64_t> z_;
  std::string feed_;
  std::string text_;
  std::string waiting_word_;  // S or T, written on the line of the M word that follows
  std::size_t waiting_line_ = 0;
  std::uint64_t commands_ = 0;
};

}  // namespace chaintrue::gcode
