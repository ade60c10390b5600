// SPDX-License-Identifier: GPL-3.0-or-later
// The cost of writing a file completely or not at all (a new file, synced, renamed), compared with a
// plain stream that may leave half a file.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "grid/files/whole_file.hpp"

namespace {

using namespace chaintrue;

/// A temporary folder, removed afterwards.
class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / "chaintrue_write_bench") {
    std::filesystem::create_directories(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] std::filesystem::path file() const { return path_ / "out.txt"; }

 private:
  std::filesystem::path path_;
};

std::string text_of(const benchmark::State& state) {
  return std::string(static_cast<std::size_t>(state.range(0)), 'x');
}

void write_whole(benchmark::State& state) {
  const Folder folder;
  const std::string text = text_of(state);
  for (auto _ : state) grid::files::write_whole_file(folder.file(), text);
  state.SetBytesProcessed(state.iterations() * state.range(0));
}
BENCHMARK(write_whole)
    ->Name("write/whole_or_not_at_all")
    ->Arg(10'000)
    ->Arg(1'000'000)
    ->Arg(100'000'000)
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

void write_stream(benchmark::State& state) {
  const Folder folder;
  const std::string text = text_of(state);
  for (auto _ : state) {
    std::ofstream stream(folder.file(), std::ios::binary | std::ios::trunc);
    stream << text;
    stream.close();
    if (!stream) state.SkipWithError("the stream could not be written");
  }
  state.SetBytesProcessed(state.iterations() * state.range(0));
}
BENCHMARK(write_stream)
    ->Name("write/plain_stream")
    ->Arg(10'000)
    ->Arg(1'000'000)
    ->Arg(100'000'000)
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace
