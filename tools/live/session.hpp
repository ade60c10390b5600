// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A Maslow 4 that is listened to: bytes in, lines to show out. No sockets, no clock, no terminal: the
/// same bytes give the same lines, and the last answer is that of `import maslow4` and `diagnose` on
/// the file that was saved.
///
/// \code
///   Session session("maslow4.log", {});
///   session.take(bytes);
///   for (const std::string& line : session.news()) show(line);
/// \endcode
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/maslow4_log.hpp"
#include "model/coordinates.hpp"
#include "tools/live/received_text.hpp"

namespace chaintrue::live {

class Session {
 public:
  /// `file` is the name used in messages, of the file that all of it is saved to.
  Session(std::string file, grid::files::Maslow4Options options);

  void take(std::string_view bytes) { text_.take(bytes); }
  /// What is new since the last call, in the order in which it is to be shown: the machine's own
  /// messages; places, anchors with sigmas; the place that would tell most next, or that none would.
  [[nodiscard]] std::vector<std::string> news();
  /// For the end: what a last line without an end adds, and what is wrong with the log as a whole.
  [[nodiscard]] std::vector<std::string> last_words();

  [[nodiscard]] const ReceivedText& text() const { return text_; }
  /// Places that can be read, of the run that `import maslow4` takes.
  [[nodiscard]] std::size_t places() const { return places_.size(); }
  /// Where the machine is to be sent next, as it is commanded; empty where no place would tell more, or
  /// too few are known.
  [[nodiscard]] const std::optional<model::BedPoint>& tells_most() const { return tells_most_; }

 private:
  void read(const std::string& log, std::vector<std::string>& lines);
  void answer(const grid::MeasuredBelts& belts, std::vector<std::string>& lines);

  std::string file_;
  grid::files::Maslow4Options options_;
  ReceivedText text_;
  std::size_t seen_ = 0;  ///< telling lines when the text was read last
  std::vector<model::PerBelt<double>> places_;
  std::optional<model::BedPoint> tells_most_;
  std::optional<double> worst_sigma_mm_;
  std::string said_wrong_;
  std::vector<std::string> warnings_;
  std::optional<std::string> stopped_;
};

}  // namespace chaintrue::live
