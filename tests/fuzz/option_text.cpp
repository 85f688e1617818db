// Texts that options of the commands take. The input's first letter says what for; each further line is a text.
#include <isolux/bake/bake.h>
#include <isolux/render/camera.h>
#include <isolux/volume_io/analytic_fields.h>
#include <isolux/volume_io/scalar_type.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "bake_command.h"
#include "fuzz.h"
#include "isovalue_option.h"
#include "parse.h"
#include "render_options.h"
#include "usage.h"
#include "value_moments.h"

namespace {

using namespace isolux;
using fuzz::require;

/// As the programs do with what a command line cannot be.
template <class Work>
bool is_usage_error(const Work& work) {
  try {
    return fuzz::refused(work);
  } catch (const UsageError& error) {
    require(*error.what() != '\0', "an error says something");
    return true;
  }
}

const Stages& stages() {
  static const Stages all = builtin_stages();
  return all;
}

const Volume& volume() {
  static const Volume field = sample_analytic_field("gyroid", 4);
  return field;
}

void numbers(const std::string& text) {
  for (const std::size_t count : {1u, 2u, 3u}) {
    std::vector<double> found;
    if (is_usage_error([&] { found = parse_numbers("--x", text, count); })) continue;
    for (const double number : found) require(std::isfinite(number), "numbers are finite");
  }
  Index3 size(1);
  (void)is_usage_error([&] { size = parse_size3("--dims", text); });
  require(size.x >= 1 && size.y >= 1 && size.z >= 1, "sizes are at least 1");
  (void)is_usage_error([&] { (void)parse_size2("--size", text); });
  int bounces = 0;
  (void)is_usage_error([&] { bounces = parse_bounces(text); });
  require(bounces >= 0 || bounces == kAllBounces, "bounces are a number or all");
  (void)is_usage_error([&] { (void)parse_scalar_type(text); });
}

template <class Stage>
void settings_of(const Registry<Stage>& registry, const std::vector<std::string>& texts) {
  Settings settings;
  const std::string stage(Stage::kStage);
  if (is_usage_error([&] { apply_settings("--set", texts, {{stage, &settings}}); })) return;
  for (const BackendInfo& info : registry.backends())
    (void)is_usage_error([&] { (void)registry.create(info.name, settings); });
}

void isovalues(const std::string& text) {
  CLI::App command;
  IsovalueOption option;
  option.add_to(command);
  try {
    command.parse(std::vector<std::string>{text, "--iso"});  // CLI11 takes them from the end
  } catch (const CLI::ParseError& error) {
    require(!explain(error, command).empty(), "an error says something");
    return;
  }
  if (!option.given()) return;
  std::vector<float> found;
  if (is_usage_error([&] { found = option.in(volume()); })) return;
  require(!found.empty() && option.texts().size() == found.size(), "a list holds isovalues");
  for (const float isovalue : found) require(std::isfinite(isovalue), "isovalues are finite");
  const ValueMoments moments = value_moments(volume().values.values());
  (void)is_usage_error([&] {
    const ValueRange range = isovalue_range(text, moments);
    require(range.low <= range.high, "ranges rise");
  });
}

void take(const std::vector<std::string>& texts, std::size_t i, std::string& option) {
  if (i < texts.size()) option = texts[i];
}

void picture(const std::vector<std::string>& texts) {
  RenderOptions options;
  CLI::App command;
  options.iso.add_to(command);
  command.parse(std::vector<std::string>{"0.5", "--iso"});
  options.output = "a.png";
  take(texts, 0, options.view);
  take(texts, 1, options.up);
  take(texts, 2, options.background);
  take(texts, 3, options.size);
  take(texts, 4, options.eye);
  if (is_usage_error([&] {
        (void)options.looking();
        (void)options.background_colour();
        options.require_pictures();
      }))
    return;
  (void)is_usage_error([&] { (void)orbit_camera(volume().lattice(), options.looking(), 1.5); });
}

void light(const std::vector<std::string>& texts) {
  BakeOptions options;
  options.output = "a.nrrd";
  take(texts, 0, options.iso_range);
  take(texts, 1, options.texels);
  take(texts, 2, options.resampler);
  take(texts, 3, options.sampler);
  take(texts, 4, options.sites);
  if (texts.size() > 5) options.set.assign(texts.begin() + 5, texts.end());
  BakeSettings settings;
  if (is_usage_error([&] { settings = bake_settings(options, stages()); })) return;
  (void)is_usage_error(
      [&] { (void)texel_lattice(volume().lattice(), with_defaults(settings, volume().lattice(), stages())); });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const std::string text = fuzz::text_of(data + 1, size - 1);
  const std::vector<std::string> texts = split(text, '\n');
  switch (char(data[0])) {
    case 'n':
      numbers(text);
      break;
    case 's':
      settings_of(stages().readers, texts);
      settings_of(stages().extractors, texts);
      settings_of(stages().samplers, texts);
      settings_of(stages().tracers, texts);
      settings_of(stages().resamplers, texts);
      break;
    case 'i':
      isovalues(text);
      break;
    case 'p':
      picture(texts);
      break;
    case 'l':
      light(texts);
      break;
    default:
      break;
  }
  return 0;
}
