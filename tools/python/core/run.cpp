// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A verb of the command, run in this process: errors become exceptions, printed text is returned.
#include "tools/cli/run_command.hpp"

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <new>
#include <optional>

#include "grid/files/sources.hpp"
#include "tools/python/core/bind.hpp"

namespace chaintrue::python {
namespace {

/// Takes what this process prints to one of C's streams, which glibc lets a program exchange.
class Printed {
 public:
  explicit Printed(std::FILE*& stream) : stream_(stream), own_(stream) {
    taken_ = ::open_memstream(&text_, &size_);
    if (taken_ == nullptr) throw std::bad_alloc();
    stream_ = taken_;
  }
  ~Printed() {
    stream_ = own_;
    std::fclose(taken_);
    std::free(text_);
  }
  Printed(const Printed&) = delete;
  Printed& operator=(const Printed&) = delete;

  std::string text() const {
    std::fflush(taken_);
    return {text_, size_};
  }

 private:
  std::FILE*& stream_;
  std::FILE* own_;
  std::FILE* taken_ = nullptr;
  char* text_ = nullptr;
  std::size_t size_ = 0;
};

using Sources = std::vector<std::pair<std::string, std::string>>;

/// The exit code, standard output and standard error.
/// \param sources by name and SHA-256, what a result is made from in place of the files of the run
std::tuple<int, std::string, std::string> run(const std::vector<std::string>& words,
                                              const std::optional<Sources>& sources) {
  const py::gil_scoped_release others_may_work;
  static std::mutex one_at_a_time;
  const std::scoped_lock lock(one_at_a_time);
  const Printed out(stdout);
  const Printed err(stderr);
  const int code = cli::run_command(words, [&](const std::function<int()>& work) {
    if (sources) {
      std::vector<grid::SourceFile> stated;
      for (const auto& [name, sha256] : *sources) stated.push_back({name, sha256});
      grid::files::state_sources(std::move(stated));
    }
    return work();
  });
  return {code, out.text(), err.text()};
}

}  // namespace

void add_run(py::module_& module) { module.def("run", run); }

}  // namespace chaintrue::python
