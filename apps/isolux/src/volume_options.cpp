#include "volume_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/read.h>
#include <isolux/volume_io/scalar_type.h>

#include <cmath>
#include <limits>
#include <optional>
#include <variant>

#include "bake_options.h"
#include "memory.h"
#include "parse.h"
#include "rounding.h"
#include "usage.h"

namespace isolux {
namespace {

void replace_nonfinite(StoredVolume& volume, float replacement) {
  auto* floats = std::get_if<Grid<float>>(&volume.values);
  if (floats == nullptr) return;
  for (float& voxel : floats->values())
    if (!std::isfinite(voxel)) voxel = replacement;
}

}  // namespace

void VolumeOptions::add_to(CLI::App& command, Session& session) {
  const auto files = [this, &session] {
    const std::vector<std::string> none;
    return source_.empty() ? none : volume_files(source_, read_options(session), session.stages.readers);
  };
  session.reads({.name = "VOLUME", .paths = files});
  CLI::Option* source =
      command.add_option("VOLUME", source_, "a file, a folder of DICOM slices, or gen:NAME[:N]")->required();
  const std::size_t others = command.get_options().size();
  command.add_option("--dims", dims_, "grid points of a headerless file")->type_name("NXxNYxNZ");
  command.add_option("--type", type_, "scalar type of a headerless file, such as uint8 or float32")->type_name("TYPE");
  command.add_option("--spacing", spacing_, "distance of grid points, world units; replaces the file's")
      ->type_name("SX,SY,SZ");
  command.add_option("--endian", endian_, "byte order of a headerless file (default little)")
      ->check(CLI::IsMember({"little", "big"}))
      ->type_name("ORDER");
  command.add_option("--replace-nonfinite", replacement_, "value for voxels that are infinite or not a number")
      ->check(finite_number())
      ->type_name("VALUE");
  command.add_option("--nodata", nodata_, "value of the file that stands for none: such voxels are no numbers")
      ->check(number_within(-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()))
      ->type_name("VALUE");
  command
      .add_option("--subtract", subtract_,
                  "taken off every value of the file before it is rounded to float32: for large offsets in float64")
      ->check(number_within(-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()))
      ->type_name("VALUE");
  command.add_option("--set-reader", set_, "an option of a reader: NAME.key=value, such as itk.time_limit=3600")
      ->check(key_and_value())
      ->type_name("NAME.key=value");
  command.add_flag("--allow-external-data", allow_external_, "a header may name a data file outside its folder");
  const std::vector<CLI::Option*> options = command.get_options();
  for (std::size_t i = others; i < options.size(); ++i) options[i]->needs(source);  // isolux view may have none
}

ReadOptions VolumeOptions::read_options(const Session& session) const {
  ReadOptions options;
  std::vector<std::pair<std::string, Settings*>> targets;
  for (const auto& info : session.stages.readers.backends())
    targets.emplace_back(info.name, &options.settings[info.name]);
  apply_settings("--set-reader", set_, targets);
  for (const auto& [name, settings] : options.settings)
    if (!settings.empty()) require_choice(session.stages.readers, {name, settings});
  options.allow_external_data = allow_external_;
  options.big_endian = endian_ == "big";
  if (dims_.empty() != type_.empty()) throw UsageError("--dims and --type go together: a headerless file needs both");
  if (!dims_.empty()) {
    RawLayout layout;
    layout.size = parse_size3("--dims", dims_);
    try {
      layout.type = parse_scalar_type(type_);
    } catch (const InvalidInput& error) {
      throw UsageError(std::string("--type: ") + error.what());
    }
    layout.big_endian = options.big_endian;
    options.raw = layout;
  }
  if (!spacing_.empty()) {
    const auto s = parse_numbers("--spacing", spacing_, 3);
    if (!(s[0] > 0.0 && s[1] > 0.0 && s[2] > 0.0))
      throw UsageError("--spacing = '" + spacing_ + "': allowed are numbers above 0");
    options.spacing = Vec3(s[0], s[1], s[2]);
  }
  if (!subtract_.empty()) options.subtract = parse_numbers("--subtract", subtract_, 1)[0];
  if (!nodata_.empty()) options.nodata = parse_numbers("--nodata", nodata_, 1)[0];
  return options;
}

/// Words of headerless files alone.
void VolumeOptions::warn_of_no_effect(const ReadOptions& options, const Session& session) const {
  std::vector<std::string> words;
  if (!dims_.empty()) words = {"--dims", "--type"};
  if (!endian_.empty()) words.emplace_back("--endian");
  if (words.empty() || takes_layout(source_, options, session.stages.readers)) return;
  session.warn(fmt::format("{} {} no effect: {} is no headerless file", fmt::join(words, ", "),
                           words.size() == 1 ? "has" : "have", source_));
}

StoredVolume VolumeOptions::read_in(VoxelForm form, Session& session) const {
  const ReadOptions options = read_options(session);
  std::optional<float> replacement;
  if (!replacement_.empty()) replacement = float(parse_numbers("--replace-nonfinite", replacement_, 1)[0]);
  const auto read = [&] {
    try {
      if (form == VoxelForm::kStored) return read_stored_volume(source_, options, session.run, session.stages.readers);
      return keep_floats(read_volume(source_, options, session.run, session.stages.readers));
    } catch (const UnknownLayout& error) {  // what is missing belongs to the command line
      throw UsageError(error.what());
    }
  };
  StoredVolume volume = session.timed("read", [&] { return with_memory_for("the values of " + source_, read); });
  warn_of_no_effect(options, session);
  for (const std::string& remark : volume.remarks) session.warn(remark);
  warn_of_few_values(volume, options.subtract, session);
  if (replacement) replace_nonfinite(volume, *replacement);
  session.report["input"] = source_;
  return volume;
}

StoredVolume VolumeOptions::read_as_is(Session& session) const { return read_in(VoxelForm::kStored, session); }

StoredVolume VolumeOptions::read_stored(Session& session) const {
  StoredVolume volume = read_as_is(session);
  require_usable(volume);
  return volume;
}

Volume VolumeOptions::read(Session& session) const {
  Volume volume = to_floats(read_in(VoxelForm::kFloats, session));
  require_usable(volume);
  return volume;
}

}  // namespace isolux
