#pragma once

#include <isolux/bake/bake.h>

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "session.h"

namespace isolux {

/// What decides how light is traced: the scene, bounces, rays and the tracer. Shared by `bake` and `extract
/// --exact-light`.
class TraceOptions {
 public:
  /// `origins`: from what each so many rays start, "a site" or the like. `first`: what scene and bounces are taken from
  /// before their defaults, "X, else ".
  void add_to(CLI::App& command, Session& session, const std::string& origins, const std::string& first = "");
  /// --scene alone.
  void add_scene_to(CLI::App& command, Session& session, const std::string& help);
  /// \throw UsageError, IoError, InvalidInput
  [[nodiscard]] Scene scene() const;
  [[nodiscard]] bool scene_given() const { return !scene_.empty(); }
  [[nodiscard]] bool bounces_given() const { return !bounces_.empty(); }
  /// Whether --bounces, --quality, --rays or --tracer were given.
  [[nodiscard]] bool says_how_to_trace() const {
    return bounces_given() || !quality_.empty() || rays_ > 0 || !tracer_.empty();
  }
  [[nodiscard]] TraceSettings settings() const;
  [[nodiscard]] const std::string& tracer() const { return tracer_; }

 private:
  std::string scene_;
  std::string bounces_;
  std::string quality_;
  int rays_ = 0;
  std::string tracer_;
};

/// \throw UsageError if the registry does not know the backend or its settings.
template <class Stage>
void require_choice(const Registry<Stage>& registry, const BackendChoice& choice) {
  try {
    static_cast<void>(registry.create(choice.name, choice.settings));
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

}  // namespace isolux
