#include "program.h"

#include <isolux/core/error.h>
#include <isolux/volume_io/atomic_file.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <exception>
#include <new>
#include <sstream>
#include <stdexcept>

#include "memory.h"
#include "session.h"
#include "signals.h"
#include "terminal.h"
#include "usage.h"

namespace isolux {

int run_program(std::string what, const std::function<int(Session& session, std::string& what)>& work) {
  reuse_arrays();
  open_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);
  std::atomic_flag told{};  // one line says that the program was interrupted, whoever is first
  const auto end_at_once = [&told] {
    const auto no_more = remove_temporary_files();
    if (!told.test_and_set()) complain("signal", "interrupted a second time and ended at once");
    _exit(kInterrupted);
  };
  const auto fail = [&what](const std::string& why, ExitStatus status) -> int {
    complain(what, why);
    return status;
  };
  try {
    const SignalWatcher signals(end_at_once);
    Session session;
    session.run.stop = signals.token();
    const int status = work(session, what);
    flush_output();
    return status;
  } catch (const UsageError& error) {
    return fail(error.what(), kUsage);
  } catch (const Cancelled& error) {
    return told.test_and_set() ? kInterrupted : fail(error.what(), kInterrupted);
  } catch (const std::bad_alloc&) {
    return fail("not enough memory", kFailed);
  } catch (const std::length_error&) {
    return fail("not enough memory", kFailed);
  } catch (const std::exception& error) {
    return fail(error.what(), kFailed);
  }
}

int print_help(const CLI::App& program, const CLI::Success& help) {
  std::ostringstream text;
  const int status = program.exit(help, text, text);
  put_out(text.str());
  flush_output();
  return status;
}

}  // namespace isolux
