// SPDX-License-Identifier: GPL-3.0-or-later
// No answer depends on the order in which a file lists its readings, for every kind of file and every
// verb that reads it, nor on which end of a tape is named first.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tests/inputs/input_folder.hpp"

namespace chaintrue::inputs {
namespace {

using Document = nlohmann::json;

/// Sums in another order: rounding, amplified by the condition number of the fit.
constexpr double kNear = 1e-6;

void expect_near(double one, double other, const std::string& where) {
  EXPECT_NEAR(one, other, kNear * std::max(1.0, std::abs(one))) << where;
}

/// For a list with an entry for each reading: the values of each key, in ascending order.
std::map<std::string, std::vector<double>> sorted_values(const Document& list) {
  std::map<std::string, std::vector<double>> values;
  for (const Document& entry : list) {
    const Document flat = entry.flatten();
    for (const auto& [key, value] : flat.items()) {
      if (value.is_number()) values[key].push_back(value.get<double>());
    }
  }
  for (auto& [key, all] : values) std::sort(all.begin(), all.end());
  return values;
}

void expect_same(const Document& one, const Document& other, const std::string& where) {
  static const std::set<std::string> by_reading = {"points",    "removals", "residuals", "holes",
                                                   "distances", "places",   "measures"};
  static const std::set<std::string> by_number = {"made_by", "content_hash", "point"};
  if (one.is_number() && other.is_number()) {
    expect_near(one, other, where);
  } else if (one.is_object() && other.is_object()) {
    for (const auto& [key, value] : one.items()) {
      if (by_number.contains(key)) continue;
      const std::string place = where + "/" + key;
      const Document& same = other.value(key, Document());
      if (!by_reading.contains(key)) {
        expect_same(value, same, place);
        continue;
      }
      const auto values = sorted_values(value), others = sorted_values(same);
      ASSERT_EQ(values.size(), others.size()) << place;
      for (const auto& [pointer, all] : values) {
        ASSERT_EQ(all.size(), others.at(pointer).size()) << place << pointer;
        for (std::size_t i = 0; i < all.size(); ++i)
          expect_near(all[i], others.at(pointer)[i], place + pointer);
      }
    }
  } else if (one.is_array() && other.is_array()) {
    ASSERT_EQ(one.size(), other.size()) << where;
    for (std::size_t i = 0; i < one.size(); ++i)
      expect_same(one[i], other[i], where + "/" + std::to_string(i));
  } else {
    EXPECT_EQ(one, other) << where;
  }
}

constexpr unsigned kSeed = 20261128;

Document shuffled(Document file) {
  std::mt19937_64 random(kSeed);
  for (const char* key : {"points", "holes", "distances", "crosses", "measures"}) {
    if (file.contains(key)) std::shuffle(file[key].begin(), file[key].end(), random);
  }
  if (!file.contains("distances")) return file;
  for (std::size_t k = 0; k < file["distances"].size(); k += 2) {
    Document& distance = file["distances"][k];
    if (distance.contains("to")) std::swap(distance["from"], distance["to"]);
  }
  return file;
}

/// The document of JSON; other text as a whole.
Document answer_of(const Ran& ran, const std::string& line) {
  EXPECT_LT(ran.code, 2) << line << "\n" << ran.err;
  const Document document = Document::parse(ran.out, nullptr, false);
  return document.is_discarded() ? Document(ran.out) : document;
}

struct Reader {
  const char* file;
  const char* line;  ///< FILE is the file
};

constexpr const char* kFitAndQuery = "fit FILE -o map.json; query map.json 0 0 700 300 --json";
constexpr const char* kDiagnose = "diagnose FILE --json";

constexpr Reader kReaders[] = {
    {"placed.json", kFitAndQuery},
    {"placed.json", kDiagnose},
    {"few.json", "check @map.json FILE --json"},
    {"holes.json", kFitAndQuery},
    {"holes.json", kDiagnose},
    {"holes.json", "diagnose @grid.json --with FILE --json"},
    {"belts.json", kFitAndQuery},
    {"belts.json", kDiagnose},
    {"belts.json", "check @anchors.json FILE --json"},
    {"belt_holes.json", "fit @belts.json --with FILE -o map.json; query map.json 0 0 --json"},
    {"drawing.json", "fit FILE -o found.json; export plotter found.json"},
    {"drawing.json", kDiagnose}};

TEST(FileOrder, ChangesNoAnswer) {
  InputFolder folder;
  for (const Reader& reader : kReaders) {
    std::string line = reader.line;
    line.replace(line.find("FILE"), 4, "@file.json");
    SCOPED_TRACE(std::string(reader.file) + ": " + line + ", seed " + std::to_string(kSeed));
    const Document file = Document::parse(folder.text_of(reader.file));
    folder.write("file.json", file.dump(1));
    const Document one = answer_of(folder.run(line), line);
    folder.write("file.json", shuffled(file).dump(1));
    const Document other = answer_of(folder.run(line), line);
    EXPECT_GT(one.size(), 0U);
    expect_same(one, other, "");
  }
}

TEST(FileOrder, ChangesNoCauseOfADiagnosis) {
  const InputFolder folder;
  const auto diagnosed = [&](const std::string& line) { return answer_of(folder.run(line), line); };
  const Document one = diagnosed("diagnose @worn.json --with @holes.json --json");
  const Document other = diagnosed("diagnose @holes.json --with @worn.json --json");
  for (const char* key : {"sentence", "hypotheses"}) expect_same(one.at(key), other.at(key), key);
}

}  // namespace
}  // namespace chaintrue::inputs
