// SPDX-License-Identifier: GPL-3.0-or-later
// Tables as written by people and spreadsheets: the same readings in every notation.
#include "grid/files/csv_table.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "grid/files/input_error.hpp"
#include "grid/files/number_text.hpp"

namespace chaintrue::grid::files {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::vector<CsvColumn> kColumns = {{"x_mm", {"mm", -5000.0, 5000.0}},
                                         {"y_mm", {"mm", -5000.0, 5000.0}, true, true},
                                         {"order", {"", 0.0, 1e9}, false}};

struct Read {
  std::vector<std::vector<std::optional<double>>> rows;
  std::vector<std::string> warnings;
  std::vector<std::string> refusals;
};

Read read(const std::string& text) {
  Problems problems("t.csv");
  Read result;
  for (const CsvLine& line : read_csv(text, kColumns, problems)) result.rows.push_back(line.values);
  for (const Warning& warning : problems.warnings()) result.warnings.push_back(warning.message());
  for (const InputProblem& problem : problems.list()) result.refusals.push_back(problem.message());
  return result;
}

class SameTable : public testing::TestWithParam<const char*> {};

TEST_P(SameTable, ReadsEqually) {
  const Read found = read(GetParam());
  EXPECT_THAT(found.refusals, IsEmpty());
  ASSERT_EQ(found.rows.size(), 2U);
  for (std::size_t row = 0; row < 2; ++row) {
    ASSERT_TRUE(found.rows[row][0] && found.rows[row][1]);
    // An inch rule's sixteenths are exact in binary; 25.4 is not.
    EXPECT_NEAR(*found.rows[row][0], row == 0 ? -1112.8375 : 635.0, 1e-9);
    EXPECT_NEAR(*found.rows[row][1], row == 0 ? 508.0 : -12.7, 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Ways, SameTable,
    testing::Values(
        "x_mm,y_mm\n-1112.8375,508\n635,-12.7\n",
        "\xEF\xBB\xBFx_mm;y_mm\r\n-1112,8375;508\r\n635;-12,7\r\n;\r\n;;;;\r\n,,\r\n",
        "sep=;\nx_mm;y_mm\n-1112.8375;508\n635;-12.7\n",
        "Y (mm)\tX [mm]\n508\t-1112.8375\n-12.7\t635\n",
        "note,x_mm,y_mm\nfirst,-1112.8375,508\nsecond,635,-12.7\n",
        "x_mm,y_mm\n-1112.8375,508\n635,-12.7\n\"read by two people, on Sunday\"\n",
        "x_mm,y_mm\n-1112.8375 mm,50.8 cm\n0.635 m,-12.7mm\n",
        "x_mm,y_mm\n\"-43 13/16\"\"\",20 in\n25 inches,-1/2\n",
        "x_in,y_in\n-43 13/16,20\n25,-1/2\n",
        "x_mm,y_mm\n\xE2\x88\x92"
        "1112.8375,508\n635,\xE2\x88\x92"
        "12.7\n",
        // From a spreadsheet with decimal commas, saved with commas between cells.
        "x_mm,y_mm\n\"-1112,8375\",508\n635,\"-12,7\"\n",
        "x_mm,y_mm\n\"-1,112.8375\",508\n635,-12.7\n", "x_mm;y_mm\n-1.112,8375;508\n635;-12,7\n",
        // A French one: a narrow space between thousands, a long minus, a unit behind a
        // space that does not break.
        "x_mm;y_mm\n\xE2\x88\x92"
        "1\xE2\x80\xAF"
        "112,8375;508\xC2\xA0mm\n635;\xE2\x88\x92"
        "12,7\n",
        "\"My machine, on Sunday\";\n;\nx_mm;y_mm\n-1112,8375;508\n635;-12,7\nMean;\n"));

TEST(CsvTable, SkipsNotesAboveTheHeader) {
  EXPECT_THAT(
      read("My machine\n\nx_mm,y_mm\n1,2\n3,4\n").warnings,
      ElementsAre("t.csv: line 1, column 1: a note without a reading: left out (My machine)"));
  // A line of units below the header is a line of the table.
  EXPECT_THAT(read("x_mm,y_mm\nmm,mm\n1,2\n").refusals,
              ElementsAre(HasSubstr("found mm"), HasSubstr("found mm")));
}

TEST(CsvTable, TreatsADashAsMissing) {
  const Read found = read("x_mm,y_mm\n1,-\n2,n/a\n3,?\n4,\xE2\x80\x94\n5,6\n");
  EXPECT_THAT(found.refusals, IsEmpty());
  ASSERT_EQ(found.rows.size(), 5U);
  for (std::size_t row = 0; row < 4; ++row) EXPECT_FALSE(found.rows[row][1]) << row;
}

// 1,113 may be a metre or a millimetre: it is rejected if nothing else shows which.
TEST(CsvTable, RefusesAnAmbiguousComma) {
  EXPECT_THAT(read("x_mm,y_mm\n\"1,113\",508\n").refusals, ElementsAre(HasSubstr("found 1,113")));
  EXPECT_THAT(read("x_mm,y_mm\n\"1,113\",508.5\n").refusals, ElementsAre(HasSubstr("found 1,113")));
  EXPECT_THAT(read("x_mm;y_mm\n555,5;1.113\n").refusals, ElementsAre(HasSubstr("found 555,5")));
  EXPECT_THAT(read("x_mm;y_mm\n555,5;1.5\n").refusals, ElementsAre(HasSubstr("found 555,5")));
}

// 0.125 is not a group of thousands, whatever other cells contain.
TEST(CsvTable, ANumberBelowOneIsNotMultipliedByAThousand) {
  EXPECT_THAT(read("x_mm;y_mm\n1.113,5;0.125\n").refusals, Not(IsEmpty()));
  EXPECT_THAT(read("x_mm;y_mm\n1,113.5;0,125\n").refusals, Not(IsEmpty()));
}

TEST(CsvTable, ReportsUnusedColumns) {
  EXPECT_THAT(read("x_mm,y_mm,note\n1,2,ok\n").warnings,
              ElementsAre("t.csv: line 1, column 11: the column \"note\" is not used"));
  EXPECT_THAT(read("x_mm,y_mm\n1,2\nmeasured with the steel rule,\n").warnings,
              ElementsAre(HasSubstr("line 3, column 1: a note without a reading: left out")));
}

// A column with nearly a known name is a slip, not an additional column.
TEST(CsvTable, RefusesTextThatMayBeAReading) {
  EXPECT_THAT(read("x_mm,y_mm,ordr\n1,2,1\n").refusals,
              ElementsAre(HasSubstr("\"ordr\" is probably order")));
  EXPECT_THAT(read("x_mm,note\n1,ok\n").refusals, ElementsAre(HasSubstr("\"note\" is unknown")));
  EXPECT_THAT(read("x_mm,y_mm\n1,2\nabout 12,3\n").refusals,
              ElementsAre(HasSubstr("found about 12")));
  EXPECT_THAT(read("x_mm,y_mm\na note above,\n1,2\n").refusals,
              ElementsAre(HasSubstr("found a note above")));
}

TEST(LengthText, AcceptsOtherUnitsAndInchFractions) {
  EXPECT_DOUBLE_EQ(length_with_unit_mm("43 13/16").value(), 43.8125 * 25.4);
  EXPECT_DOUBLE_EQ(length_with_unit_mm("-43-13/16\"").value(), -43.8125 * 25.4);
  EXPECT_DOUBLE_EQ(length_with_unit_mm("5/8 in").value(), 0.625 * 25.4);
  EXPECT_DOUBLE_EQ(length_with_unit_mm("1.5 m").value(), 1500.0);
  EXPECT_DOUBLE_EQ(length_with_unit_mm("3' 8 5/16\"").value(), 44.3125 * 25.4);
  EXPECT_DOUBLE_EQ(length_with_unit_mm("-3'-8.5''").value(), -44.5 * 25.4);
  EXPECT_DOUBLE_EQ(length_with_unit_mm("3 ft").value(), 914.4);
  for (const char* none :
       {"", "12", "mm", "13/8", "1/0", "1/2 mm", "--1 mm", "1e999 mm", "a/b", "1 2/3/4",
        "12 parsecs", "nan mm", "3' 12\"", "3' 8 mm", "' 8\"", "3' -8 -5", "-"}) {
    EXPECT_FALSE(length_with_unit_mm(none)) << none;
  }
}

/// Oversized tables are refused while they are read, not after.
TEST(CsvTable, RefusesTooManyRows) {
  std::string rows = "x_mm,y_mm\n";
  for (int i = 0; i < 400'001; ++i) rows += "1,2\n";
  Problems problems("t.csv");
  EXPECT_THROW((void)read_csv(rows, kColumns, problems), InputError);
  EXPECT_THAT(problems.list().back().message(), HasSubstr("800000 cells"));
  std::string wide = "x_mm,y_mm\n";
  for (int i = 0; i < 40'000; ++i) wide += "1,";
  Problems of_wide("t.csv");
  EXPECT_THROW((void)read_csv(wide, kColumns, of_wide), InputError);
  EXPECT_THAT(of_wide.list().back().message(), HasSubstr("line 2"));
}

TEST(LengthText, KnowsTheFractionThatASpreadsheetMadeADateOf) {
  EXPECT_EQ(fraction_of_date("Jan-32"), "1/32");
  EXPECT_EQ(fraction_of_date("16-Mar"), "3/16");
  for (const char* none :
       {"", "-", "12-", "Jan-", "an-32", "nFe-1", "2026-01-32", "Jan-320", "1-Marz", "5-8"})
    EXPECT_FALSE(fraction_of_date(none)) << none;
}

}  // namespace
}  // namespace chaintrue::grid::files
