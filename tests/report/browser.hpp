// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Opens pages in a real browser and reports problems.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace chaintrue::report::testing {

struct Window {
  int width_px = 1280;
  int height_px = 1000;
};

struct Visit {
  /// Of any page: lines on the console, charts that failed, charts with fewer marks than the rows of their largest
  /// table, marks without a position. Empty for a good page.
  std::vector<std::string> problems;
  /// How many items a mark has: "specification mark", all charts of that specification together.
  std::map<std::string, int> marks;
  /// What the page and its probe left in document.documentElement.dataset.
  std::map<std::string, std::string> found;
};

bool has_browser();

struct Opened {
  std::string html;
  Window window = {};
  /// A script that runs after the charts are drawn.
  std::string probe = {};
};

/// Opens the pages together, each in its own frame, in one browser without network and with a new
/// profile. Console messages of the browser count for every page.
std::vector<Visit> visit_all(const std::vector<Opened>& pages);

/// A4 (ISO 216) and Letter (ANSI Y14.1 size A). What fits on a sheet as narrow as the one and as short as
/// the other fits on both.
inline constexpr double kA4WidthMm = 210.0, kLetterWidthMm = 215.9, kLetterHeightMm = 279.4;

/// How many of these smallest sheets the page takes, as the browser prints it; 0 where it prints nothing.
int printed_sheets(const std::string& html);

/// A probe: how many texts of charts end in an ellipsis, and which.
inline constexpr std::string_view kCutLabels = R"(
    for (const folded of document.querySelectorAll("details")) folded.open = true;
    await new Promise((done) => setTimeout(done, 300));
    const ends = [...document.querySelectorAll("figure.chart text")].filter((label) => label.textContent.includes("\u2026"));
    document.documentElement.dataset.cutLabels = ends.length + ": " + ends.slice(0, 5).map((label) => label.textContent).join("; ");
)";

/// A probe: how many words of charts' legends lie on other words of the same chart, and which.
inline constexpr std::string_view kOverlappingLegends = R"(
    const lies_on = [];
    for (const figure of document.querySelectorAll("figure.chart")) {
      const words = [...figure.querySelectorAll("svg text")].filter((word) => word.textContent);
      for (const word of words.filter((one) => one.closest(".role-legend, .key"))) {
        const a = word.getBoundingClientRect();
        for (const other of words) {
          const b = other.getBoundingClientRect();
          if (other === word || Math.min(a.right, b.right) - Math.max(a.left, b.left) < 1 ||
              Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) < 1) continue;
          lies_on.push(figure.dataset.spec + ": " + word.textContent + " on " + other.textContent);
        }
      }
    }
    document.documentElement.dataset.overlaps = lies_on.length + ": " + lies_on.slice(0, 5).join("; ");
)";

}  // namespace chaintrue::report::testing
