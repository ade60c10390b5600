// SPDX-License-Identifier: GPL-3.0-or-later
// Logs cut at a line, and with a line deleted, doubled or garbled: most are still diagnosed, their
// anchors are those of the whole log, and no cause is certain that is unlikely in the whole log.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/maslow4_log.hpp"
#include "grid/files/whole_file.hpp"
#include "model/effects/catalogue.hpp"
#include "tests/lab/real_machines/damaged_logs.hpp"

namespace chaintrue::grid {
namespace {

using testing_support::Damage;
using testing_support::kDamageSeed;

/// Empty if the log is refused or does not determine its anchors.
std::optional<diagnosis::Diagnosis> diagnosed(const std::string& text) {
  try {
    const files::Maslow4Import read = files::parse_maslow4(text, "log.txt");
    diagnosis::DiagnosisOptions options;
    options.next_measurements = false;
    auto found = diagnosis::diagnose(read.belts, options);
    if (read.is_enough && found) return *std::move(found);
  } catch (const files::InputError&) {
  }
  return std::nullopt;
}

void expect_like_the_whole(const std::string& text) {
  constexpr double kSure = 0.9, kUnlikely = 0.5;
  const auto whole = diagnosed(text);
  ASSERT_TRUE(whole);
  std::map<std::string, double> probability;
  for (const auto& h : whole->hypotheses) probability[h.effect + ":" + h.side] = h.probability;
  int logs = 0, answered = 0;
  constexpr std::size_t kEveryFifth = 5;
  testing_support::damage_every(text, kEveryFifth, [&](Damage how, const std::string& damaged) {
    const auto found = diagnosed(damaged);
    if (how != Damage::cut) {
      ++logs;
      answered += found ? 1 : 0;
    }
    if (!found) return;
    SCOPED_TRACE(damaged);
    for (const auto& named : found->causes) {
      const std::string cause =
          fmt::format("{}:{}", named.cause.effect->id, name(named.cause.side));
      EXPECT_TRUE(named.probability < kSure || probability[cause] >= kUnlikely) << found->sentence;
    }
    for (std::size_t i = 0; i < found->belts->coordinates.size(); ++i) {
      const auto& own = found->belts->coordinates[i];
      // Six sigmas and a centimetre are a wrong answer.
      EXPECT_LT(std::abs(own.fitted_mm - whole->belts->coordinates[i].fitted_mm),
                std::max(10.0, 6.0 * own.sigma_mm))
          << own.name;
    }
  });
  // The required share.
  EXPECT_GE(answered, std::ceil(0.85 * logs)) << "seed " << kDamageSeed;
}

TEST(DamagedLogs, AreDiagnosedLikeTheWholeOrRefused) {
  expect_like_the_whole(files::read_whole_file(CHAINTRUE_FIXTURES "/good/maslow4_log.txt"));
  const std::filesystem::path folder = std::filesystem::path(CHAINTRUE_SHARED_DATA) / "maslow4";
  for (const char* file : {"concrete_anchors.txt", "frame_rebuilt.txt", "mini_frame.txt"}) {
    SCOPED_TRACE(file);
    if (std::filesystem::exists(folder / file))
      expect_like_the_whole(files::read_whole_file(folder / file));
  }
}

}  // namespace
}  // namespace chaintrue::grid
