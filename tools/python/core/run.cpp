// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A verb of the command, run in this process: what goes wrong arrives as an exception, what it prints
/// as text.
#include "tools/cli/run_command.hpp"

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <new>

#include "tools/python/core/bind.hpp"

namespace chaintrue::python {
namespace {

/// Takes what this process prints through C's streams, which glibc lets a program exchange.
class Printed {
 public:
  Printed() {
    if (stream_ == nullptr) throw std::bad_alloc();
    stdout = stderr = stream_;
  }
  ~Printed() {
    stdout = out_;
    stderr = err_;
    std::fclose(stream_);
    std::free(text_);
  }
  Printed(const Printed&) = delete;
  Printed& operator=(const Printed&) = delete;

  [[nodiscard]] std::string text() const {
    std::fflush(stream_);
    return {text_, size_};
  }

 private:
  char* text_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* stream_ = ::open_memstream(&text_, &size_);
  std::FILE* out_ = stdout;
  std::FILE* err_ = stderr;
};

/// The exit code, and what was printed.
std::pair<int, std::string> run(const std::vector<std::string>& words) {
  const py::gil_scoped_release others_may_work;
  static std::mutex one_at_a_time;
  const std::scoped_lock lock(one_at_a_time);
  const Printed printed;
  const int code =
      cli::run_command(words, [](const std::function<int()>& work) { return work(); });
  return {code, printed.text()};
}

}  // namespace

void add_run(py::module_& module) { module.def("run", run); }

}  // namespace chaintrue::python
