// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/whole_file.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "grid/files/input_error.hpp"
#include "grid/files/pending_file.hpp"
#include "tests/support/files.hpp"

namespace chaintrue::grid::files {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class WholeFile : public ::testing::Test {
 protected:
  std::size_t files_in_folder() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  testing_support::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

template <class Action>
std::string refusal_of(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(WholeFile, RoundTrips) {
  std::string text("a\0b\r\n\xFF", 6);
  text += std::string(200000, 'x');
  write_whole_file(folder_ / "file", text);
  EXPECT_EQ(read_whole_file(folder_ / "file"), text);
  write_whole_file(folder_ / "file", "");
  EXPECT_EQ(read_whole_file(folder_ / "file"), "");
  EXPECT_EQ(files_in_folder(), 1U);
}

TEST_F(WholeFile, UnreadableIsNamed) {
  EXPECT_THAT(refusal_of([&] { (void)read_whole_file(folder_ / "none"); }),
              HasSubstr("There is no file "));
  EXPECT_THAT(refusal_of([&] { (void)read_whole_file(folder_); }),
              HasSubstr("found a directory, expected a file"));
}

TEST_F(WholeFile, UnwritableLeavesNothingBehind) {
  EXPECT_THAT(refusal_of([&] { write_whole_file(folder_, "x"); }),
              HasSubstr("found a directory, expected the name of a file"));
  EXPECT_THAT(refusal_of([&] { write_whole_file(folder_ / "none" / "file", "x"); }),
              HasSubstr("found No such file or directory, expected a directory that exists"));
  EXPECT_THAT(refusal_of([&] { write_whole_file("", "x"); }), HasSubstr("found an empty name"));
  EXPECT_EQ(files_in_folder(), 0U);
}

TEST_F(WholeFile, ProtectedIsKept) {
  const fs::path file = folder_ / "file";
  write_whole_file(file, "old");
  fs::permissions(file, fs::perms::owner_read);
  EXPECT_THAT(refusal_of([&] { write_whole_file(file, "new"); }),
              HasSubstr("found a protected file, expected a file that may be overwritten"));
  EXPECT_EQ(read_whole_file(file), "old");
}

TEST_F(WholeFile, KeepsPermissionsAndLink) {
  const fs::path file = folder_ / "file";
  const fs::path link = folder_ / "link";
  write_whole_file(file, "old");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
  fs::create_symlink("file", link);
  write_whole_file(link, "new");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_whole_file(file), "new");
  EXPECT_EQ(fs::status(file).permissions(),
            fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
}

TEST_F(WholeFile, NewOnesUseTheUmask) {
  const mode_t mask = ::umask(027);
  write_whole_file(folder_ / "file", "x");
  ::umask(mask);
  EXPECT_EQ(static_cast<unsigned>(fs::status(folder_ / "file").permissions()), 0640U);
}

/// The second cannot be renamed, because a folder has its name in the meantime.
TEST_F(WholeFile, AFailureLeavesTheOthersUnchanged) {
  write_whole_file(folder_ / "old", "old");
  for (const char* first : {"old", "new"}) {
    const std::size_t before = files_in_folder();
    {
      PendingFile one(folder_ / first);
      PendingFile two(folder_ / "two");
      one.write("one");
      two.write("two");
      fs::create_directory(folder_ / "two");
      EXPECT_THAT(refusal_of([&] { take_places({&one, &two}); }), HasSubstr("two: found "));
      fs::remove(folder_ / "two");
    }
    EXPECT_EQ(files_in_folder(), before) << first;
    EXPECT_EQ(read_whole_file(folder_ / "old"), "old") << first;
  }
}

TEST_F(WholeFile, TooLongIsRefused) {
  const fs::path file = folder_ / "file";
  std::ofstream(file) << "1";
  fs::resize_file(file, std::uintmax_t{17} << 20U);
  EXPECT_THAT(refusal_of([&] { (void)read_whole_file(file); }), HasSubstr("at most 16 MB"));
}

TEST_F(WholeFile, WritesToDevices) {
  EXPECT_EQ(refusal_of([] { write_whole_file("/dev/null", "x"); }), "no error");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  if (fs::exists("/dev/full")) {
    EXPECT_THAT(refusal_of([] { write_whole_file("/dev/full", "x"); }),
                HasSubstr("/dev/full: found No space left on device"));
  }
}

}  // namespace
}  // namespace chaintrue::grid::files
