// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The entry point: prepares the process and turns errors into messages and exit codes.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cstdio>
#include <functional>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <exception>
#include <system_error>

#include "grid/printing.hpp"
#include "tools/cli/run_command.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

int report_bad_input(const InputError& error) {
  std::fflush(stdout);
  for (const auto& problem : error.problems())
    say("{}", in_red(with_name(problem.message(), problem.name())));
  return kBadInput;
}

/// The next opened file would get the number of a closed stream; occupy it with a descriptor that
/// can be neither read nor written.
void open_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
    const int taken = ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    if (taken != stream && taken >= 0) ::close(taken);
  }
}

/// Output that could not be written is an error, except to a pipe whose reader has closed it.
int finish_standard_output(int code, int error_number) {
  const bool was_broken = std::ferror(stdout) != 0;
  errno = 0;
  const bool is_broken = std::fflush(stdout) != 0 || was_broken;
  if (!is_broken) return code;
  if (errno != 0) error_number = errno;
  if (error_number == EPIPE) return code;
  return report_bad_input(InputError(
      {{"standard output",
        "",
        std::error_code(error_number == 0 ? EIO : error_number, std::generic_category()).message(),
        "something that can be written to",
        {},
        ProblemKind::output_place}}));
}

int with_exit_code(const std::function<int()>& work) {
  try {
    return finish_standard_output(work(), 0);
  } catch (const InputError& error) {
    return report_bad_input(error);
  } catch (const Failed& failed) {
    if (!failed.about.empty()) say("{}: {}", failed.about, failed.what());
    return failed.code;
  } catch (const files::ReaderGone&) {
    return kDone;
  } catch (const std::system_error& error) {
    if (std::ferror(stdout) != 0) return finish_standard_output(kDone, error.code().value());
    say("chaintrue: internal error, please report it: {}", error.what());
    return kInternal;
  } catch (const std::bad_alloc&) {
    say("chaintrue: not enough memory");
    return kNotSupportedOrOutside;
  } catch (const std::exception& error) {
    say("chaintrue: internal error, please report it: {}", error.what());
    return kInternal;
  }
}

}  // namespace
}  // namespace chaintrue::cli

int main(int argc, char** argv) {
  using namespace chaintrue;  // NOLINT(google-build-using-namespace)
#ifdef __EMSCRIPTEN__
  ::umask(022);  // emscripten begins with 0777: nobody could read what is written
#endif
  if (argc > 0) cli::set_called_as(argv[0]);
  cli::open_closed_streams();
  cli::write_whole_lines();
  grid::files::remove_pending_files_on_signals();
  // A limit on file sizes is then an error of writing, reported like any other.
  std::signal(SIGXFSZ, SIG_IGN);
  return cli::run_command({argv + std::min(argc, 1), argv + argc}, cli::with_exit_code);
}
