// SPDX-License-Identifier: GPL-3.0-or-later
// For a test program under node: files are created with the permissions that a shell would give
// them.
#include <gmock/gmock.h>
#include <sys/stat.h>

int main(int argc, char** argv) {
  ::umask(022);
  testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
