// SPDX-License-Identifier: GPL-3.0-or-later
// The kind of a file is determined by its file_type alone.
#include <gtest/gtest.h>

#include <string>

#include "grid/files/file_type.hpp"
#include "grid/files/input_error.hpp"

namespace chaintrue::grid::files {
namespace {

FileKind kind(const std::string& text) { return kind_of(text, "file"); }

TEST(FileKind, JsonIsRecognisedByItsType) {
  EXPECT_EQ(kind(R"({"file_type": "chaintrue_map"})"), FileKind::map);
  EXPECT_EQ(kind(R"({"name": "chaintrue_map", "file_type": "chaintrue_grid"})"), FileKind::grid);
  EXPECT_EQ(
      kind(R"({"machine": {"file_type": "chaintrue_machine"}, "file_type": "chaintrue_belts"})"),
      FileKind::belts);
  EXPECT_EQ(kind("\xEF\xBB\xBF \n {\"file_type\": \"chaintrue_anchors\"}"), FileKind::anchors);
  EXPECT_EQ(kind(R"({"x": NaN, "file_type": "chaintrue_diagnosis"})"), FileKind::diagnosis);
  EXPECT_EQ(kind(R"({"file_type": "chaintrue_gird"})"), FileKind::other);
  EXPECT_EQ(kind(R"({"name": "\"chaintrue_grid\""})"), FileKind::other);
  EXPECT_EQ(kind("[1, 2]"), FileKind::other);
}

TEST(FileKind, HolesAreRecognisedByTheirMachine) {
  const std::string begin = R"({"file_type": "chaintrue_holes", )";
  EXPECT_EQ(kind(begin + R"("machine": {"anchors": {}}})"), FileKind::belt_holes);
  EXPECT_EQ(kind(begin + R"("holes": [{"name": "anchors"}]})"), FileKind::holes);
  EXPECT_EQ(kind(begin + R"("comment": "\"anchors\"", "machine": {"name": "anchors"}})"),
            FileKind::holes);
}

TEST(FileKind, DefaultsToCsv) {
  EXPECT_EQ(kind("x_mm,y_mm,left_mm,right_mm\n0,0,1700,1700\n"), FileKind::grid);
  EXPECT_EQ(kind("hole,x_mm,y_mm\nA,0,0\n"), FileKind::holes);
  EXPECT_EQ(kind("from,to,distance_mm\nA,B,100\n"), FileKind::holes);
  EXPECT_EQ(kind(""), FileKind::grid);
}

TEST(FileKind, IsKnownForTruncatedJsonWithAType) {
  EXPECT_EQ(kind(R"({"file_type": "chaintrue_map", "points": [)"), FileKind::map);
  EXPECT_THROW((void)kind(R"({"points": [)"), InputError);
}

TEST(FileKind, HasANameForMessages) {
  EXPECT_EQ(expected_kinds({FileKind::grid, FileKind::holes, FileKind::belts}),
            R"("chaintrue_grid", "chaintrue_holes" or "chaintrue_belts")");
  EXPECT_EQ(found_kind("hole,x_mm,y_mm\n", "holes.csv"), "a CSV of holes");
  EXPECT_EQ(found_kind(R"({"file_type": "chaintrue_map"})", "map.json"), R"("chaintrue_map")");
}

}  // namespace
}  // namespace chaintrue::grid::files
