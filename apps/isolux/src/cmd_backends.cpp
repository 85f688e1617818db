#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "commands.h"
#include "companion.h"
#include "registry_json.h"
#include "terminal.h"

namespace isolux {
namespace {

void print(const nlohmann::json& stages) {
  for (const auto& stage : stages) {
    put_out(fmt::format("{}\n", stage["stage"].get<std::string>()));
    for (const auto& backend : stage["backends"]) {
      if (!backend["available"].get<bool>()) {
        put_out(fmt::format("  {:<22} not in this build: {}\n", backend["name"].get<std::string>(),
                            backend["why_unavailable"].get<std::string>()));
        continue;
      }
      put_out(fmt::format("  {:<22} {}{}\n", backend["name"].get<std::string>(), backend["help"].get<std::string>(),
                          backend["default"].get<bool>() ? " (default)" : ""));
      for (const auto& option : backend["options"]) {
        const auto value = option["default"].get<std::string>();
        put_out(fmt::format("    {:<20} {} [default {}; {}]\n", option["name"].get<std::string>(),
                            option["help"].get<std::string>(), value.empty() ? "none" : value,
                            option["allowed"].get<std::string>()));
      }
    }
  }
}

}  // namespace

void add_backends_command(CLI::App& program, Session& session) {
  CLI::App& command = *program.add_subcommand("backends", "Every stage, its backends and their options");
  const auto json = std::make_shared<bool>(false);
  command.add_flag("--json", *json, "as JSON");
  session.add_common_options(command);
  command.callback([json, &session] {
    session.on_run([json, &session] {
      const Stages& stages = session.stages;
      nlohmann::json all = nlohmann::json::array({stage_to_json(stages.readers), stage_to_json(stages.extractors),
                                                  stage_to_json(stages.samplers), stage_to_json(stages.tracers),
                                                  stage_to_json(stages.resamplers)});
      // The texture uploaders live in the viewer, the one program that links OpenGL.
      if (const auto uploaders = companion_json("isolux-view", "--uploaders")) all.push_back(*uploaders);
      if (*json) {
        put_out(all.dump(2) + "\n");
      } else {
        print(all);
      }
    });
  });
}

}  // namespace isolux
