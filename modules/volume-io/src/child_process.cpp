#include "child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <isolux/core/error.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <mutex>
#include <new>

namespace isolux::detail {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kPollMilliseconds = 50;
constexpr std::chrono::seconds kLastWords{2};
constexpr int kPipeBytes = 1 << 20;
constexpr std::size_t kLongestMessage = 2000;

// How a child ends: its exit status, telling the parent what the message on the second pipe is.
enum ChildStatus : int { kDone = 0, kInvalidInput = 10, kIoError = 11 };

void write_all(int file, const void* data, std::size_t bytes) {
  const auto* at = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t wrote = write(file, at, bytes);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) _exit(kIoError);
    at += wrote;
    bytes -= std::size_t(wrote);
  }
}

[[noreturn]] void be_the_child(const std::string& what, int data, int messages, std::chrono::seconds time_limit,
                               const std::function<void(const SendBytes& send)>& work) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, SIG_DFL);
  std::signal(SIGPIPE, SIG_IGN);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  const auto seconds = rlim_t(time_limit.count()) + 1;
  const rlimit cpu{seconds, seconds};
  setrlimit(RLIMIT_CPU, &cpu);
  // Libraries print warnings; isolux does not.
  const int null = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(null, stream);
  int status = kDone;
  std::string message;
  try {
    work([data](std::span<const std::byte> bytes) { write_all(data, bytes.data(), bytes.size()); });
  } catch (const InvalidInput& problem) {
    status = kInvalidInput;
    message = problem.what();
  } catch (const std::bad_alloc&) {
    status = kIoError;
    message = fmt::format("{}: the memory does not suffice for so many voxels", what);
  } catch (const std::exception& problem) {
    status = kIoError;
    message = problem.what();
  } catch (...) {
    status = kIoError;
    message = "unknown failure";
  }
  write_all(messages, message.data(), std::min(message.size(), kLongestMessage));
  // No destructors, no atexit: they belong to the parent.
  _exit(status);
}

struct Pipe {
  std::array<int, 2> ends{-1, -1};
  Pipe() = default;
  void open(const std::string& what) {
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw IoError(fmt::format("{}: no pipe: {}", what, std::strerror(errno)));
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  void close_end(std::size_t which) {
    if (ends.at(which) >= 0) close(ends.at(which));
    ends.at(which) = -1;
  }
};

// The child, killed and waited for unless that has been done.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (id_ <= 0) return;
    kill(id_, SIGKILL);
    (void)wait();
  }
  // Its status as waitpid gives it; -1 if somebody else reaped it.
  int wait() {
    int status = 0;
    pid_t got = 0;
    do {
      got = waitpid(id_, &status, 0);
    } while (got < 0 && errno == EINTR);
    id_ = -1;
    return got < 0 ? -1 : status;
  }

 private:
  pid_t id_;
};

class PipeSource final : public ByteSource {
 public:
  PipeSource(int file, std::string what, Clock::time_point deadline, const Run& run)
      : file_(file), what_(std::move(what)), deadline_(deadline), run_(run) {}

  std::size_t read(std::span<std::byte> into) override {
    std::size_t done = 0;
    while (done < into.size()) {
      throw_if_stopped(run_);
      if (Clock::now() > deadline_) throw IoError(fmt::format("{}: reading took too long and was given up", what_));
      pollfd wait_for{file_, POLLIN, 0};
      if (poll(&wait_for, 1, kPollMilliseconds) <= 0) continue;
      const ssize_t got = ::read(file_, into.data() + done, into.size() - done);
      if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
      if (got <= 0) break;
      done += std::size_t(got);
    }
    return done;
  }

 private:
  int file_;
  std::string what_;
  Clock::time_point deadline_;
  const Run& run_;
};

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 32 || c > 126; }, ' ');
  return text;
}

// Turns the way the child ended into an exception, if it failed.
void require_success(const std::string& what, int status, const std::string& message) {
  if (status == -1 || (WIFEXITED(status) && WEXITSTATUS(status) == kDone)) return;
  if (WIFSIGNALED(status))
    throw IoError(fmt::format("{}: the library that reads it crashed ({})", what, strsignal(WTERMSIG(status))));
  if (WEXITSTATUS(status) == kInvalidInput) throw InvalidInput(message);
  throw IoError(message.empty() ? fmt::format("{}: the library that reads it failed", what) : message);
}

// Forks. One at a time: a child must not inherit the writing ends of another's pipes, or those would never end.
pid_t start(const std::string& what, Pipe& data, Pipe& messages, std::chrono::seconds time_limit,
            const std::function<void(const SendBytes& send)>& work) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  data.open(what);
  messages.open(what);
  fcntl(data.ends[1], F_SETPIPE_SZ, kPipeBytes);
  const pid_t id = fork();
  if (id < 0) throw IoError(fmt::format("{}: no process to read it in: {}", what, std::strerror(errno)));
  if (id == 0) be_the_child(what, data.ends[1], messages.ends[1], time_limit, work);
  data.close_end(1);
  messages.close_end(1);
  return id;
}

}  // namespace

void run_in_child(const std::string& what, std::chrono::seconds time_limit, const Run& run,
                  const std::function<void(const SendBytes& send)>& work,
                  const std::function<void(ByteSource& received)>& take) {
  Pipe data;
  Pipe messages;
  Child child(start(what, data, messages, time_limit, work));
  const auto deadline = Clock::now() + time_limit;
  std::exception_ptr problem;
  try {
    PipeSource received(data.ends[0], what, deadline, run);
    take(received);
  } catch (const IoError&) {
    // Most likely a consequence of what the child has to say; a child that says nothing soon is killed.
    problem = std::current_exception();
    data.close_end(0);
  }
  const auto last_words = problem == nullptr ? deadline : Clock::now() + kLastWords;
  std::string message(kLongestMessage, '\0');
  try {
    PipeSource words(messages.ends[0], what, last_words, run);
    message.resize(words.read(std::as_writable_bytes(std::span(message))));
  } catch (const IoError&) {
    if (problem != nullptr) std::rethrow_exception(problem);
    throw;
  }
  const int status = child.wait();
  const bool crashed = status != -1 && WIFSIGNALED(status);
  if (problem == nullptr || crashed || !message.empty()) require_success(what, status, one_line(message));
  if (problem != nullptr) std::rethrow_exception(problem);
}

}  // namespace isolux::detail
