// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reading lines through a window of fixed size.
#include "tools/gcode/line_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace chaintrue::gcode {
namespace {

constexpr std::size_t kWindow = 256 * 1024;

}  // namespace

LineSource::LineSource(std::unique_ptr<std::istream> stream) : stream_(std::move(stream)) {
  seek({});
}

Result<LineSource> LineSource::from_file(const std::string& path) {
  auto file = std::make_unique<std::ifstream>(path, std::ios::binary);
  // A folder can be opened but not read.
  if (!*file || (file->peek(), file->bad())) {
    return refuse(
        ProblemName::unreadable_file, {}, fmt::format("the file '{}' cannot be read", path));
  }
  file->clear();
  return LineSource(std::move(file));
}

LineSource LineSource::from_text(std::string text) {
  return LineSource(std::make_unique<std::istringstream>(std::move(text), std::ios::binary));
}

bool LineSource::refill() {
  if (exhausted_) return false;
  buffer_.erase(0, begin_);
  buffer_offset_ += begin_;
  begin_ = 0;
  const std::size_t kept = buffer_.size();
  buffer_.resize(kept + kWindow);
  stream_->read(buffer_.data() + kept, static_cast<std::streamsize>(kWindow));
  const auto got = static_cast<std::size_t>(stream_->gcount());
  buffer_.resize(kept + got);
  exhausted_ = got < kWindow;
  return got > 0;
}

Result<bool> LineSource::next(SourceLine& line) {
  std::size_t end = begin_;
  for (;;) {
    while (end < buffer_.size() && buffer_[end] != '\n' && buffer_[end] != '\r') {
      if (buffer_[end] == '\0') {
        return refuse(
            ProblemName::not_text,
            {lines_before_ + 1, end - begin_ + 1},
            "a zero byte stands here: the file is not plain text (UTF-16, or no G-code at all)");
      }
      ++end;
    }
    // Some editors write CR CR LF: a run of CRs before an LF is one end of line.
    const std::size_t after = std::min(buffer_.find_first_not_of('\r', end), buffer_.size());
    if (after < buffer_.size() || exhausted_) break;
    const std::size_t length = end - begin_;
    if (length > kMaxLineLength || after - end > kMaxLineLength) break;
    refill();
    end = begin_ + length;
  }
  if (end - begin_ > kMaxLineLength) {
    return refuse(ProblemName::line_too_long,
                  {lines_before_ + 1, 0},
                  fmt::format("the line is longer than {} characters: its line ends are lost, or "
                              "this is no program",
                              kMaxLineLength));
  }
  if (end == buffer_.size() && end == begin_) return false;
  line.text = std::string_view(buffer_).substr(begin_, end - begin_);
  line.number = ++lines_before_;
  if (end < buffer_.size()) {
    const std::size_t after = std::min(buffer_.find_first_not_of('\r', end), buffer_.size());
    end = after < buffer_.size() && buffer_[after] == '\n' ? after + 1 : end + 1;
  }
  begin_ = end;
  if (listener_) listener_(buffer_offset_ + begin_);
  return true;
}

LineSource::Position LineSource::position() const {
  return {buffer_offset_ + begin_, lines_before_};
}

void LineSource::seek(Position position) {
  lines_before_ = position.lines_before;
  if (position.offset >= buffer_offset_ && position.offset <= buffer_offset_ + buffer_.size() &&
      !buffer_.empty()) {
    begin_ = static_cast<std::size_t>(position.offset - buffer_offset_);
    return;
  }
  stream_->clear();
  stream_->seekg(static_cast<std::streamoff>(position.offset));
  buffer_.clear();
  begin_ = 0;
  buffer_offset_ = position.offset;
  exhausted_ = false;
  refill();
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (position.offset == 0 && std::string_view(buffer_).substr(0, 3) == kByteOrderMark) begin_ = 3;
}

}  // namespace chaintrue::gcode
