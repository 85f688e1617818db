// A stage, a backend with an option, and a registry to choose from.
#include <isolux/core.h>

#include <cstdio>

struct Greeter {
  static constexpr std::string_view kStage = "greeter";
  virtual ~Greeter() = default;
  [[nodiscard]] virtual int times() const = 0;
};

struct Patient : Greeter {
  struct Options {
    int times = 1;
    void describe(isolux::OptionVisitor& option) {
      option("times", times, {.min = 1, .max = 9, .help = "how often to greet"});
    }
  };
  explicit Patient(const Options& given) : options(given) {}
  [[nodiscard]] int times() const override { return options.times; }
  Options options;
};

int main() {
  isolux::Registry<Greeter> greeters;
  greeters.add<Patient>("patient", "greets as often as you like");
  const auto greeter = greeters.create("patient", {{"times", "3"}});
  for (int i = 0; i < greeter->times(); ++i) std::puts("hello");
}
