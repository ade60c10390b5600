// SPDX-License-Identifier: GPL-3.0-or-later
// Where a result comes from: the hash against published digests, which files count as read, and what
// has changed since.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

#include "grid/files/diagnosis_file.hpp"
#include "grid/files/sha256.hpp"
#include "grid/files/sources.hpp"
#include "grid/files/whole_file.hpp"
#include "tests/support/files.hpp"

namespace chaintrue::grid::files {
namespace provenance_test {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// NIST, Cryptographic Standards and Guidelines, examples with intermediate values: SHA-256; the empty
// message and a million letters a are those of the NESSIE test vectors, sets 1 and 8.
TEST(Sha256, GivesThePublishedDigests) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, TakesAFileToItsEnd) {
  for (std::size_t size = 0; size < 200; ++size) {
    const std::string text(size, 'a');
    std::istringstream file("b" + text);
    file.get();
    EXPECT_EQ(sha256(file), sha256(text)) << size;
  }
}

class Sources : public testing::Test {
 protected:
  Sources() { forget_sources(); }
  std::string path(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

 private:
  testing_support::TemporaryFolder folder_;
};

TEST_F(Sources, HaveBareNamesAndHashesOfTheirBytes) {
  // UTF-16 is read as UTF-8; the hash is of the bytes on disk.
  const std::string bytes(
      "\xFF\xFE"
      "a\0",
      4);
  (void)read_whole_file(path("wide.csv", bytes));
  EXPECT_THAT(sources_read(), ElementsAre(SourceFile{"wide.csv", sha256(bytes)}));
}

TEST_F(Sources, AreOrderedWithoutDuplicates) {
  const std::string second = path("b.csv", "second");
  (void)read_whole_file(second);
  (void)read_whole_file(path("a.csv", "first"));
  (void)read_whole_file(second);
  (void)read_whole_file(path("b.csv", "changed"));
  EXPECT_THAT(sources_read(), ElementsAre(SourceFile{"b.csv", sha256("second")},
                                          SourceFile{"a.csv", sha256("first")},
                                          SourceFile{"b.csv", sha256("changed")}));
  forget_sources();
  EXPECT_THAT(sources_read(), IsEmpty());
}

TEST_F(Sources, BelongToTheThread) {
  const std::string file = path("a.csv", "text");
  std::thread([&] { (void)read_whole_file(file); }).join();
  EXPECT_THAT(sources_read(), IsEmpty());
}

TEST(ChangedSince, NamesOnlyFilesWithChangedContent) {
  const Provenance then{"1.0", "fit", {}, {{"a.csv", "1"}, {"b.csv", "2"}}};
  EXPECT_THAT(changed_since(then, {{"a.csv", "1"}, {"b.csv", "3"}, {"c.csv", "4"}}),
              ElementsAre("b.csv"));
  EXPECT_THAT(changed_since(then, then.inputs), IsEmpty());
}

TEST(MadeBy, IsHeldToItsFormatWithTheRestOfTheFile) {
  const std::string text =
      read_whole_file(std::filesystem::path(CHAINTRUE_FIXTURES) / "good/diagnosis_every_key.json");
  ASSERT_TRUE(made_by_of(text, "d.json"));
  EXPECT_EQ(made_by_of(text, "d.json")->options, std::vector<std::string>{"--seed 7"});
  EXPECT_FALSE(made_by_of("{\"file_type\": \"chaintrue_map\"}", "map.json"));
  std::string wrong = text;
  wrong.replace(wrong.find("\"sha256\": \""), 11, "\"sha265\": \"");
  try {
    (void)parse_diagnosis(wrong, "d.json");
    FAIL() << "an unknown key was taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("/made_by/inputs/0/sha265"));
  }
}

TEST(MadeBy, RoundTrips) {
  const Provenance made_by{"1.2.3", "fit", {"--surface direct"}, {{"a \"b\".csv", sha256("")}}};
  const diagnosis::Diagnosis found = parse_diagnosis(
      read_whole_file(std::filesystem::path(CHAINTRUE_FIXTURES) / "good/diagnosis_every_key.json"),
      "d.json");
  EXPECT_EQ(made_by_of(write_diagnosis(found, made_by), "d.json"), made_by);
  EXPECT_EQ(made_by_of(write_diagnosis(found), "d.json"), std::nullopt);
}

TEST(Version, HasThreeNumbers) {
  EXPECT_EQ(std::count(version().begin(), version().end(), '.'), 2) << version();
}

}  // namespace provenance_test
}  // namespace chaintrue::grid::files
