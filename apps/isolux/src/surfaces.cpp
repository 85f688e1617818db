#include "surfaces.h"

#include <fmt/format.h>

#include <map>
#include <regex>
#include <utility>

namespace isolux {
namespace {

constexpr const char* kPlaceholders = "{iso} for the isovalue, or %d or %03d for its number from 0 on";

/// A name's placeholder, if it has one, and what stands around it.
struct OutputName {
  std::string before;
  std::string placeholder;
  std::string behind;

  [[nodiscard]] std::string filled(std::size_t number, const std::string& isovalue) const {
    if (placeholder.empty()) return before;
    if (placeholder == "{iso}") return before + isovalue + behind;
    return before + fmt::format("{:0{}}", number, placeholder == "%d" ? 1 : placeholder[2] - '0') + behind;
  }
};

/// \throw UsageError for several placeholders
OutputName parts_of(const std::string& output) {
  static const std::regex marks(R"(%%|\{iso\}|%(0[1-9])?d)");
  OutputName name;
  std::string* text = &name.before;
  auto at = output.begin();
  for (std::sregex_iterator it(output.begin(), output.end(), marks), end; it != end; ++it) {
    const std::ssub_match mark = (*it)[0];
    text->append(at, mark.first);
    at = mark.second;
    if (mark == "%%") {
      *text += '%';
      continue;
    }
    if (!name.placeholder.empty())
      throw UsageError(fmt::format("--output = '{}': allowed is one placeholder: {}", output, kPlaceholders));
    name.placeholder = mark;
    text = &name.behind;
  }
  text->append(at, output.end());
  return name;
}

}  // namespace

std::vector<std::string> output_names(const std::string& output, const IsovalueOption& isovalues) {
  const std::vector<std::string> texts = isovalues.texts();
  const OutputName name = parts_of(output);
  if (name.placeholder.empty() && texts.size() > 1)
    throw UsageError(
        fmt::format("--output = '{}': {} isovalues need a placeholder in it: {}", output, texts.size(), kPlaceholders));
  std::vector<std::string> names;
  std::map<std::string, std::size_t> taken;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    names.push_back(name.filled(i, texts[i]));
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
