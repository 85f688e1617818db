#include "progress.h"

#include <fmt/format.h>
#include <isolux/core/stopwatch.h>
#include <unistd.h>

#include <memory>
#include <string>

#include "terminal.h"

namespace isolux {
namespace {

class ProgressPrinter {
 public:
  void operator()(std::string_view stage, double fraction) {
    if (stage != stage_) {
      stage_ = stage;
      watch_ = Stopwatch();
      tenths_ = 0;
      last_shown_ = 0.0;
    }
    const double seconds = watch_.seconds();
    if (terminal_) {
      show_bar(fraction, seconds);
    } else if (seconds - last_shown_ > kPause && int(fraction * 10.0) > tenths_) {
      last_shown_ = seconds;
      tenths_ = int(fraction * 10.0);
      tell(fmt::format("{}: {} %, {:.1f} s\n", stage_, tenths_ * 10, seconds));
    }
  }

 private:
  static constexpr double kPause = 2.0;  ///< seconds between lines, where each stays

  void show_bar(double fraction, double seconds) {
    constexpr int kWidth = 30;
    const bool done = fraction >= 1.0;
    if (seconds < 1.0 || (!done && seconds - last_shown_ < 0.1)) return;
    last_shown_ = seconds;
    const int filled = int(fraction * kWidth);
    const double left = fraction > 0.0 ? seconds * (1.0 - fraction) / fraction : 0.0;
    tell(fmt::format("\r{:<12} [{:<{}}] {:3.0f} %  {:.0f} s left \033[K{}", stage_,
                     std::string(std::size_t(filled), '#'), kWidth, 100.0 * fraction, left, done ? "\r\033[K" : ""));
  }

  bool terminal_ = isatty(STDERR_FILENO) != 0;
  std::string stage_;
  Stopwatch watch_;
  int tenths_ = 0;
  double last_shown_ = 0.0;
};

}  // namespace

std::function<void(std::string_view, double)> make_progress() {
  return [printer = std::make_shared<ProgressPrinter>()](std::string_view stage, double fraction) {
    (*printer)(stage, fraction);
  };
}

}  // namespace isolux
