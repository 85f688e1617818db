#include "surfaces.h"

#include <fmt/format.h>

#include <map>
#include <regex>
#include <utility>

namespace isolux {
namespace {

constexpr const char* kPlaceholders = "{iso} for the isovalue, or %d or %03d for its number from 0 on";

std::string filled(const std::smatch& name, std::size_t number, const std::string& isovalue) {
  std::string value = isovalue;
  if (name.str() != "{iso}") value = fmt::format("{:0{}}", number, name[1].matched ? name[1].str()[1] - '0' : 1);
  return name.prefix().str() + value + name.suffix().str();
}

}  // namespace

std::vector<std::string> output_names(const std::string& output, const IsovalueOption& isovalues) {
  if (!isovalues.is_list()) return {output};
  const std::vector<std::string> texts = isovalues.texts();
  static const std::regex placeholder(R"(\{iso\}|%(0[1-9])?d)");
  std::smatch first;
  const bool has_place = std::regex_search(output, first, placeholder);
  if (!has_place && texts.size() == 1) return {output};
  if (!has_place)
    throw UsageError(
        fmt::format("--output = '{}': {} isovalues need a placeholder in it: {}", output, texts.size(), kPlaceholders));
  if (const std::string rest = first.suffix(); std::regex_search(rest, placeholder))
    throw UsageError(fmt::format("--output = '{}': allowed is one placeholder: {}", output, kPlaceholders));
  std::vector<std::string> names;
  std::map<std::string, std::size_t> taken;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    names.push_back(filled(first, i, texts[i]));
    const auto [before, is_new] = taken.try_emplace(names.back(), i);
    if (!is_new)
      throw UsageError(
          fmt::format("--output = '{}': {} would be written for isovalues number {} and {}; %03d keeps "
                      "them apart",
                      output, names.back(), before->second, i));
  }
  return names;
}

FileOption outputs_of(const std::string& output, const IsovalueOption& isovalues) {
  const auto names = [&output, &isovalues] {
    return output.empty() ? std::vector<std::string>() : output_names(output, isovalues);
  };
  return {.name = "--output", .paths = names};
}

void for_each_surface(const std::vector<std::string>& outputs, Session& session,
                      const std::function<void(std::size_t number)>& make) {
  if (outputs.size() == 1) return make(0);
  nlohmann::json surfaces = nlohmann::json::array();
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    nlohmann::json whole = std::move(session.report);
    session.report = nlohmann::json::object();
    session.report["seconds"] = nlohmann::json::object();
    make(i);
    session.report["output"] = outputs[i];
    surfaces.push_back(std::exchange(session.report, std::move(whole)));
    for (const auto& [stage, seconds] : surfaces.back()["seconds"].items())
      session.add_seconds(stage, seconds.get<double>());
  }
  for (const char* counted : {"triangles", "vertices", "rays"}) {
    for (const auto& surface : surfaces)
      if (surface.contains(counted))
        session.report[counted] =
            session.report.value(counted, std::uint64_t(0)) + surface[counted].get<std::uint64_t>();
  }
  session.report["surfaces"] = std::move(surfaces);
}

}  // namespace isolux
