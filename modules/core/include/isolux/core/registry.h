#pragma once

#include <isolux/core/options.h>

#include <concepts>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace isolux {

/// What a registry tells of one backend.
struct BackendInfo {
  std::string name;
  std::string help;
  std::vector<OptionInfo> options;
  std::string unavailable;  ///< why it is not in this build; empty if it is
  bool is_default = false;
};

namespace detail {
/// Index of `name` ("" for the default) among `infos`. \throw InvalidInput naming what is allowed.
[[nodiscard]] std::size_t find_backend(std::string_view stage, std::string_view name,
                                       std::span<const BackendInfo> infos);
/// Index of `name`, even if this build lacks it. \throw InvalidInput naming those that are listed.
[[nodiscard]] std::size_t find_listed(std::string_view stage, std::string_view name,
                                      std::span<const BackendInfo> infos);
/// \throw InvalidInput for a name that is there, or names that cannot be written as NAME.key=value.
void require_new_backend(std::string_view stage, const BackendInfo& info, std::span<const BackendInfo> infos);
}  // namespace detail

/// The backends of one stage by name. A value: fill one from the module's catalogue, add your own, pass it on. `Stage`
/// is an abstract class with `static constexpr std::string_view kStage`, the stage's name in messages and in `--set
/// stage.key=value`.
template <class Stage>
class Registry {
 public:
  /// Adds a backend: a class derived from Stage with a nested `Options` (see options.h) and a constructor taking it.
  /// \throw InvalidInput if the name is taken, two options have one, or a name is not of letters, digits, _ and -.
  template <std::derived_from<Stage> Backend>
  void add(std::string name, std::string help) {
    std::string owner = std::string(Stage::kStage) + " " + name;
    insert({.name = std::move(name),
            .help = std::move(help),
            .options = describe_options<typename Backend::Options>(),
            .unavailable = {},
            .is_default = false},
           [owner](const Settings& settings) -> std::unique_ptr<Stage> {
             return std::make_unique<Backend>(parse_options<typename Backend::Options>(owner, settings));
           });
  }

  /// Lists a backend that this build lacks.
  void add_unavailable(std::string name, std::string why) {
    insert({.name = std::move(name), .help = {}, .options = {}, .unavailable = std::move(why), .is_default = false},
           {});
  }

  /// The backend that create("") makes; it may be one that this build lacks. \throw InvalidInput if none has the name
  void set_default(std::string_view name) {
    const std::size_t chosen = detail::find_listed(Stage::kStage, name, infos_);
    for (std::size_t i = 0; i < infos_.size(); ++i) infos_[i].is_default = i == chosen;
  }

  /// The backend called `name` ("" for the default) with these settings.
  /// \throw InvalidInput for an unknown or unavailable name, an unknown option, a wrong type or a value out of range.
  [[nodiscard]] std::unique_ptr<Stage> create(std::string_view name = {}, const Settings& settings = {}) const {
    return makers_[find(name)](settings);
  }

  /// A view, until the registry changes or goes.
  [[nodiscard]] std::span<const BackendInfo> backends() const& { return infos_; }
  std::span<const BackendInfo> backends() const&& = delete;
  /// What is known of the backend called `name` ("" for the default). \throw InvalidInput as create does.
  [[nodiscard]] const BackendInfo& info(std::string_view name) const& { return infos_[find(name)]; }
  const BackendInfo& info(std::string_view name) const&& = delete;

 private:
  using Maker = std::function<std::unique_ptr<Stage>(const Settings&)>;

  void insert(BackendInfo info, Maker maker) {
    detail::require_new_backend(Stage::kStage, info, infos_);
    makers_.reserve(makers_.size() + 1);  // or a name could stay without a maker
    infos_.push_back(std::move(info));
    makers_.push_back(std::move(maker));
  }
  [[nodiscard]] std::size_t find(std::string_view name) const {
    return detail::find_backend(Stage::kStage, name, infos_);
  }

  std::vector<BackendInfo> infos_;
  std::vector<Maker> makers_;
};

}  // namespace isolux
