// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/json_text.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

#include "grid/files/json_reader.hpp"

namespace chaintrue::grid::files {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Json parse(const std::string& text) {
  Problems problems("file");
  Json document = parse_json(text, problems);
  problems.throw_if_any();
  return document;
}

template <class Action>
std::vector<std::string> messages_of(const Action& action) {
  std::vector<std::string> messages;
  try {
    action();
  } catch (const InputError& error) {
    for (const InputProblem& problem : error.problems()) messages.push_back(problem.message());
  }
  return messages;
}

std::vector<std::string> problems_of_text(const std::string& text) {
  return messages_of([&] { (void)parse(text); });
}

TEST(JsonText, EveryDoubleReadsBackAsItself) {
  constexpr std::uint64_t kSeed = 20260101;
  SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
  std::mt19937_64 bits(kSeed);
  for (int i = 0; i < 200000; ++i) {
    const std::uint64_t drawn = bits();
    double value = 0.0;
    std::memcpy(&value, &drawn, sizeof value);
    if (!std::isfinite(value)) continue;
    const std::string text = print_json(Json(value));
    const auto read = parse(text).get<double>();
    ASSERT_EQ(0, std::memcmp(&read, &value, sizeof value)) << text;
  }
}

TEST(JsonText, NumbersTakeTheFewestDigits) {
  EXPECT_EQ(print_json(Json(0.1)), "0.1\n");
  EXPECT_EQ(print_json(Json(1489.2)), "1489.2\n");
  EXPECT_EQ(print_json(Json(0.1 + 0.2)), "0.30000000000000004\n");
  EXPECT_EQ(print_json(Json(5e-324)), "5e-324\n");
  EXPECT_EQ(print_json(Json(12.0)), "12\n");
}

TEST(JsonText, WritersRefuseNonFiniteNumbers) {
  EXPECT_THROW((void)print_json(Json(std::nan(""))), std::logic_error);
  EXPECT_THROW((void)print_json(Json({{"a", {1.0, std::numeric_limits<double>::infinity()}}})),
               std::logic_error);
}

TEST(JsonText, LayoutDependsOnTheValuesOnly) {
  Json numbers = Json::array();
  for (int i = 0; i < 40; ++i) numbers.push_back(i + 0.25);
  const Json document = {{"short", {1, 2, 3}},
                         {"numbers", numbers},
                         {"points", {{{"x", 1}}, {{"x", 2}}}},
                         {"none", Json::array()}};
  const std::string text = print_json(document);
  EXPECT_EQ(print_json(parse(text)), text);
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    EXPECT_LE(end - begin, 100U);
    begin = end + 1;
  }
}

TEST(JsonText, KeepsTheOrderOfKeysAndNamesDuplicates) {
  EXPECT_EQ(compact_json(parse(R"({"z": 1, "a": 2})")), R"({"z": 1, "a": 2})");
  EXPECT_THAT(problems_of_text(R"({"a": [0, {"b/c": 1, "b/c": 2}], "d": 3, "d": [4]})"),
              ElementsAre("file: /a/1/b~1c: found 2, expected this key only once",
                          "file: /d: found a list, expected this key only once"));
}

struct Broken {
  const char* text;
  const char* message;
};

void PrintTo(const Broken& broken, std::ostream* out) { *out << broken.text; }

class BrokenJson : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenJson, IsNamedByLineAndColumn) {
  EXPECT_THAT(problems_of_text(GetParam().text), ElementsAre(HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    Texts, BrokenJson,
    ::testing::Values(
        Broken{"", "file: found an empty file, expected JSON text"},
        Broken{" \n\t", "file: found an empty file"},
        Broken{"{\"a\": 1",
               "file: line 1, column 8: found the end of the text, expected JSON: '}' here"},
        Broken{"{\"a\": 1,\n \"b\" 2}", "file: line 2, column 6: found 2, expected JSON: ':' here"},
        Broken{"{\"a\": 1} x", "line 1, column 10: found x, expected JSON"},
        Broken{"{'a': 1}",
               "line 1, column 2: found ', expected JSON: string literal here; put text"},
        Broken{"[1, 2,]",
               "line 1, column 7: found ], expected JSON: '[', '{', or a literal here; the comma "
               "before it is superfluous"},
        Broken{"{\"a\": \"b\nc\"}",
               "line 1, column 9: found  , expected JSON: in a text, control character"},
        Broken{"{\"a\": \"\xFF\"}", "expected JSON: in a text, ill-formed UTF-8 byte"},
        Broken{"{\"a\": +1}", "line 1, column 7: found +1, expected JSON"},
        Broken{"{\"a\": 01}", "line 1, column 7: found 01, expected JSON: '}' here"},
        // The quotes inserted around NaN must not shift the places after it.
        Broken{"{\"a\": NaN, \"b\": x}", "line 1, column 17: found x, expected JSON"}));

TEST(JsonText, NonFiniteNumbersReachTheirFieldAsText) {
  EXPECT_EQ(parse("[NaN, -Infinity, 1e999, inf, -1E+400]"),
            Json({"NaN", "-Infinity", "1e999", "inf", "-1E+400"}));
  EXPECT_EQ(parse(R"(["NaN \" 1e999", 1e-999, 1e308])"), Json({"NaN \" 1e999", 0.0, 1e308}));
}

TEST(JsonText, RefusesDeepNesting) {
  EXPECT_THAT(problems_of_text(std::string(64, '[') + std::string(64, ']')), IsEmpty());
  const auto problems = problems_of_text(std::string(1000000, '['));
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_THAT(problems[0], HasSubstr("found deeper nesting, expected at most 64 levels"));
}

TEST(Problems, ValuesAreShortenedAndPrintable) {
  EXPECT_EQ(shortened("a\x01\n\tb\x7F"), "a   b ");
  EXPECT_EQ(shortened(std::string(60, 'x')), std::string(60, 'x'));
  EXPECT_EQ(shortened(std::string(61, 'x')), std::string(57, 'x') + "...");
  std::string umlauts;
  for (int i = 0; i < 61; ++i) umlauts += "\xC3\xA4";
  EXPECT_EQ(shortened(umlauts), umlauts.substr(0, 2 * 57) + "...");
}

TEST(Problems, ListTheFirstHundredAndCountTheRest) {
  Problems problems("file");
  for (int i = 0; i < 140; ++i)
    problems.add("/x", "1", ProblemKind::out_of_range, std::to_string(i));
  const auto messages = messages_of([&] { problems.throw_if_any(); });
  ASSERT_EQ(messages.size(), 101U);
  EXPECT_EQ(messages.back(),
            "file: found 40 more problems, expected the problems above to be corrected first");
}

TEST(Problems, ListFiveOfAKindAndCountTheRest) {
  Problems problems("file");
  for (int i = 0; i < 101; ++i)
    problems.add("/x", "1", ProblemKind::not_a_number, "a whole number");
  for (int i = 0; i < 6; ++i) problems.add("/y", "1", ProblemKind::unknown_word, "a word");
  const auto messages = messages_of([&] { problems.throw_if_any(); });
  // A sixth line is no longer than its count.
  ASSERT_EQ(messages.size(), 6U + 6U);
  EXPECT_EQ(messages[5], "file: found 96 more like these, expected a whole number");
  EXPECT_EQ(messages.back(), "file: /y: found 1, expected a word");
}

TEST(Problems, SuggestTheNearestWord) {
  const std::vector<std::string> keys = {"x_mm", "y_mm", "left_mm", "right_mm", "order"};
  EXPECT_EQ(nearest("left", keys), "left_mm");
  EXPECT_EQ(nearest("X", keys), "x_mm");
  EXPECT_EQ(nearest("rigth_mm", keys), "right_mm");
  EXPECT_EQ(nearest("Order", keys), "order");
  EXPECT_EQ(nearest("colour", keys), "");
  EXPECT_EQ(nearest("", keys), "");
}

TEST(NumberText, ReadsNumbersWithoutTheLocale) {
  EXPECT_EQ(number_of("+5"), 5.0);
  EXPECT_EQ(number_of("-1e3"), -1000.0);
  EXPECT_EQ(number_of(".5"), 0.5);
  EXPECT_EQ(number_of("1e-999"), 0.0);
  EXPECT_EQ(number_of("0.0000e-999"), 0.0);
  for (const char* text :
       {"", "+", "-", "+-5", "1,5", "1 5", "0x10", "NaN", "inf", "1e999", "-1e999", "5mm", "e5"}) {
    EXPECT_EQ(number_of(text), std::nullopt) << text;
  }
  for (const char* text : {"NaN", "nan", "-inf", "Infinity", "1e999", "-1e999"})
    EXPECT_TRUE(is_beyond_double(text)) << text;
  for (const char* text : {"1e-999", "1", "n", "information", ""})
    EXPECT_FALSE(is_beyond_double(text)) << text;
}

// A format as in the header's example.
struct Hole {
  std::string name;
  double x_mm = 0.0;
  std::optional<double> sigma_mm;
};
struct Holes {
  std::string name;
  std::vector<Hole> holes;
  std::map<std::string, double> weights;
  std::vector<std::vector<double>> matrix;
};

const Record<Hole>& hole_record() {
  static const auto record =
      Record<Hole>("a hole")
          .required("name", "Its name.", &Hole::name, text())
          .required("x_mm", "Commanded x.", &Hole::x_mm, number({"mm", -20000, 20000}))
          .optional("sigma_mm", "1 sigma on each axis.", &Hole::sigma_mm, number({"mm", 0, 50}));
  return record;
}

const Record<Holes>& holes_record() {
  static const auto record =
      Record<Holes>("a holes file", kHolesFormat)
          .sparse("name", "Its name.", &Holes::name, text())
          .required("holes", "The holes.", &Holes::holes, list(object(hole_record()), 2))
          .sparse("weights", "By name.", &Holes::weights, dictionary(number({"", 0, 1})))
          .sparse("matrix", "Of numbers.", &Holes::matrix, list(list(number({"mm", -1, 1}))))
          .check([](const Cursor& at, Holes& holes) {
            if (at.clean() && holes.holes[0].name == holes.holes[1].name) {
              at.child("holes").expect("names that differ");
            }
          });
  return record;
}

std::string holes_message(const std::string& text) {
  try {
    return write_document(holes_record(), read_document(holes_record(), text, "holes.json"));
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(JsonReader, AFormatIsATableOfItsFields) {
  const std::string head = R"({"file_type": "chaintrue_holes", "format_version": "1.0", )";
  const std::string good =
      head +
      R"("holes": [{"name": "a", "x_mm": 1}, {"name": "b", "x_mm": 2, "sigma_mm": 0.5}], )"
      R"("weights": {"a": 0.5, "comment": "by hand"}, "matrix": [[0, 1], []], "comment": 1})";
  EXPECT_EQ(holes_message(holes_message(good)), holes_message(good));
  EXPECT_THAT(holes_message(good), HasSubstr(R"("weights": {"a": 0.5})"));
  EXPECT_EQ(
      holes_message(head + R"("holes": [{"name": "a", "x_mm": 1}, {"name": "a", "x_mm": 2}]})"),
      R"(holes.json: /holes: found [{"name": "a", "x_mm": 1}, {"name": "a", "x_mm": 2}], )"
      R"(expected names that differ)");
  const std::string bad = holes_message(
      head + R"("holes": [{"name": 1, "x": 1}], "weights": {"b": 2}, "matrix": [[0, "1"]]})");
  EXPECT_THAT(bad, HasSubstr("/holes/0/x: found 1, expected \"x_mm\"? This key is unknown"));
  EXPECT_THAT(bad, HasSubstr("/holes/0/name: found 1, expected a text"));
  EXPECT_THAT(
      bad,
      HasSubstr("/holes: found 1 of them, expected a list of at least 2, each element a hole"));
  EXPECT_THAT(bad, HasSubstr("/weights/b: found 2, expected a number from 0 to 1"));
  EXPECT_THAT(
      bad,
      HasSubstr("/matrix/0/1: found \"1\", expected a number in mm from -1 to 1, without quotes"));
  EXPECT_THAT(bad, ::testing::Not(HasSubstr("/holes/0/x_mm: missing")));
}

TEST(JsonText, RefusesTooManyValues) {
  std::string text = "[0";
  for (int i = 0; i < 1'000'000; ++i) text += ",0";
  Problems problems("t.json");
  EXPECT_THROW((void)parse_json(text + "]", problems), InputError);
  EXPECT_THAT(problems.list().back().message(), HasSubstr("at most 1000000 values"));
}

}  // namespace
}  // namespace chaintrue::grid::files
