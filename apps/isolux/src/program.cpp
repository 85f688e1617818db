#include "program.h"

#include <isolux/core/error.h>

#include <csignal>
#include <exception>
#include <iostream>
#include <new>
#include <stdexcept>

#include "session.h"
#include "signals.h"
#include "terminal.h"
#include "usage.h"

namespace isolux {

int run_program(std::string what, const std::function<int(Session& session, std::string& what)>& work) {
  open_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);
  const SignalWatcher signals;
  const auto fail = [&what](const std::string& why, ExitStatus status) -> int {
    complain(what, why);
    return status;
  };
  try {
    Session session;
    session.run.stop = signals.token();
    const int status = work(session, what);
    flush_output();
    return status;
  } catch (const UsageError& error) {
    return fail(error.what(), kUsage);
  } catch (const Cancelled& error) {
    return fail(error.what(), kInterrupted);
  } catch (const std::bad_alloc&) {
    return fail("not enough memory", kFailed);
  } catch (const std::length_error&) {
    return fail("not enough memory", kFailed);
  } catch (const std::exception& error) {
    return fail(error.what(), kFailed);
  }
}

int print_help(const CLI::App& program, const CLI::Success& help) {
  const int status = program.exit(help);
  std::cout.flush();
  flush_output();
  return status;
}

}  // namespace isolux
