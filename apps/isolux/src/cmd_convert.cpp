#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/read.h>
#include <isolux/volume_io/scalar_type.h>
#include <isolux/volume_io/write.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "commands.h"
#include "rounding.h"
#include "volume_options.h"

namespace isolux {
namespace {

/// Volumes are kept in floats, which do not hold all numbers of the wider types.
void warn_of_rounding(const StoredVolume& volume, const Session& session) {
  if (rounded_to_few(volume)) return;   // reading has said so
  constexpr float kAllWhole = 0x1p24f;  // every whole number up to it is a float
  const std::string type(scalar_type_name(volume.stored_type));
  if (volume.stored_type == ScalarType::kFloat64)
    return session.warn(
        fmt::format("{}: its values are {}; written are the nearest of float32, about 7 digits", volume.name, type));
  if (volume.stored_type == ScalarType::kFloat32 || bytes_per_scalar(volume.stored_type) < sizeof(float)) return;
  const ValueRange range = value_range(volume);
  if (std::max(-range.low, range.high) >= kAllWhole)
    session.warn(fmt::format("{}: its values are {}; of those beyond 2^24 the nearest of float32 are written",
                             volume.name, type));
}

/// Where --nodata or --replace-nonfinite left what no whole number is, floats are written.
void choose_type(StoredVolume& volume) {
  const auto* floats = std::get_if<Grid<float>>(&volume.values);
  if (floats == nullptr || volume.stored_type == ScalarType::kFloat64) return;
  const auto values = floats->values();
  const auto is_whole = [](float value) { return std::isfinite(value) && std::floor(value) == value; };
  if (!std::all_of(values.begin(), values.end(), is_whole)) volume.stored_type = ScalarType::kFloat32;
}

/// \throw UsageError for a name that says no format that can be written
std::vector<std::string> files_to_write(const std::string& output, const WriteOptions& options) {
  try {
    return files_written(output, options);
  } catch (const InvalidInput& error) {
    throw UsageError(fmt::format("OUT: {}", error.what()));
  }
}

/// \throw UsageError for a headerless file whose name does not say the volume's size
void require_own_name(const StoredVolume& volume, const std::string& output) {
  try {
    require_name_of(volume, output);
  } catch (const InvalidInput& error) {
    throw UsageError(fmt::format("OUT: {}", error.what()));
  }
}

/// Where OUT is a header that is replaced, its data files: they may have other names than the new ones.
std::vector<std::string> data_before(const std::string& output, const Session& session) {
  std::error_code error;
  if (!std::filesystem::exists(output, error) || std::filesystem::path(output).extension() != ".nhdr") return {};
  return volume_files(output, {}, session.stages.readers);
}

/// They may be another header's, too: nothing is removed.
void say_what_is_left(const std::vector<std::string>& before, const std::vector<std::string>& written,
                      const Session& session) {
  for (const std::string& file : before) {
    const auto is_it = [&](const std::string& path) {
      std::error_code error;
      return std::filesystem::equivalent(path, file, error);
    };
    if (std::any_of(written.begin(), written.end(), is_it)) continue;
    session.say(fmt::format("{}: the data of the header that was replaced; it is still there", file));
  }
}

}  // namespace

void add_convert_command(CLI::App& program, Session& session) {
  CLI::App& command = *program.add_subcommand("convert", "Between the volume formats that can be written");
  struct Options {
    VolumeOptions volume;
    std::string output;
    WriteOptions write;
  };
  const auto options = std::make_shared<Options>();
  options->volume.add_to(command, session);
  command.add_option("OUT", options->output, "the file to write; its extension names the format")->required();
  // A volume may be written over itself: it has been read by then.
  const auto files = [given = options.get()] {
    return given->output.empty() ? std::vector<std::string>() : files_to_write(given->output, given->write);
  };
  session.writes({.name = "OUT", .paths = files, .in_place = InPlace::kAllowed});
  command.add_flag("--compress", options->write.compress, "gzip, where the format has it");
  session.add_common_options(command);
  command.callback([options, &session] {
    session.on_run([options, &session] {
      StoredVolume volume = options->volume.read_as_is(session);
      warn_of_rounding(volume, session);
      choose_type(volume);
      require_own_name(volume, options->output);
      const std::vector<std::string> before = data_before(options->output, session);
      session.timed("write", [&] { write_volume(volume, options->output, options->write); });
      say_what_is_left(before, files_written(options->output, options->write), session);
    });
  });
}

}  // namespace isolux
