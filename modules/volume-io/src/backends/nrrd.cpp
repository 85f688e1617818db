#include "../files.h"
#include "../make_volume.h"
#include "../nrrd_header.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/volume_reader.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace isolux {
namespace {

// Of NRRD's kinds those along which no places lie; of matrices and tensors there are many. By their synonyms, too.
bool is_of_values(std::string_view kind) {
  static constexpr std::array<std::string_view, 29> kKinds = {"list",
                                                              "point",
                                                              "vector",
                                                              "contravariant-vector",
                                                              "covariant-vector",
                                                              "normal",
                                                              "stub",
                                                              "scalar",
                                                              "complex",
                                                              "2-vector",
                                                              "3-vector",
                                                              "4-vector",
                                                              "3-color",
                                                              "4-color",
                                                              "rgb-color",
                                                              "rgbcolor",
                                                              "rgb",
                                                              "rgba-color",
                                                              "rgbacolor",
                                                              "rgba",
                                                              "hsv-color",
                                                              "hsvcolor",
                                                              "hsv",
                                                              "xyz-color",
                                                              "xyzcolor",
                                                              "xyz",
                                                              "3-gradient",
                                                              "3-normal",
                                                              "quaternion"};
  return std::find(kKinds.begin(), kKinds.end(), kind) != kKinds.end() || kind.ends_with("-matrix") ||
         kind.ends_with("-tensor");
}
bool is_of_time(const detail::NrrdAxis& axis) { return axis.kind == "time"; }

/// The axis of several samples along which volumes lie, if there is one such axis and space besides.
std::optional<std::size_t> axis_of_volumes(const detail::NrrdHeader& header) {
  std::vector<std::size_t> found;
  int of_space = 0;
  for (std::size_t a = 0; a < header.axes.size(); ++a) {
    const detail::NrrdAxis& axis = header.axes[a];
    const bool is_space = !is_of_values(axis.kind) && !is_of_time(axis) && (!header.has_directions || axis.direction);
    if (is_space) ++of_space;
    if (axis.size > 1 && !is_space) found.push_back(a);
  }
  return found.size() == 1 && of_space >= 3 ? std::optional(found[0]) : std::nullopt;
}

/// Which of several volumes is read; of `header` the axis along which they lie then has one sample.
detail::Frames take_frame(detail::NrrdHeader& header, int frame) {
  const auto axis = axis_of_volumes(header);
  detail::Frames frames;
  std::string what;
  if (axis) {
    frames.together = 1;
    for (std::size_t a = 0; a < *axis; ++a) frames.together *= std::uint64_t(header.axes[a].size);
    frames.count = std::uint64_t(header.axes[*axis].size);
    what = fmt::format("axis {} of {} has {} samples of the kind '{}'", *axis + 1, header.axes.size(), frames.count,
                       header.axes[*axis].kind);
    header.axes[*axis].size = 1;
  }
  frames.wanted = detail::wanted_frame(header.path, "nrrd", frame, frames.count, what);
  return frames;
}

// Axes of several samples that are none of space would be taken for it.
void require_space(const detail::NrrdHeader& header) {
  const auto is_space = [](const detail::NrrdAxis& axis) { return !is_of_values(axis.kind) && !is_of_time(axis); };
  const auto is_series = [](const detail::NrrdAxis& axis) { return axis.size > 1 && is_of_time(axis); };
  // One of time beside two of space is how some programs write a stack of pictures.
  const bool is_stack = std::count_if(header.axes.begin(), header.axes.end(), is_space) == 2 &&
                        std::count_if(header.axes.begin(), header.axes.end(), is_series) == 1;
  for (std::size_t a = 0; a < header.axes.size(); ++a) {
    const detail::NrrdAxis& axis = header.axes[a];
    if (axis.size <= 1 || is_space(axis) || (is_of_time(axis) && is_stack)) continue;
    throw InvalidInput(
        fmt::format("{}: axis {} of {} has {} samples of the kind '{}': a volume has 3 axes of space (of the kinds "
                    "domain and space, or of none), one number a voxel; others may have 1 sample only",
                    header.path, a + 1, header.axes.size(), axis.size, axis.kind));
  }
}

// Which axes are space: axes of one sample are dropped until three are left, those that the header calls something
// else or no domain first.
std::vector<detail::NrrdAxis> spatial_axes(const detail::NrrdHeader& header) {
  require_space(header);
  std::vector<detail::NrrdAxis> axes = header.axes;
  const auto drop = [&](auto unwanted) {
    for (auto it = axes.begin(); axes.size() > 3 && it != axes.end();)
      it = it->size == 1 && unwanted(*it) ? axes.erase(it) : it + 1;
  };
  drop([&](const detail::NrrdAxis& axis) { return header.has_directions && !axis.direction; });
  drop([](const detail::NrrdAxis& axis) { return is_of_values(axis.kind) || is_of_time(axis); });
  drop(
      [](const detail::NrrdAxis& axis) { return axis.kind != "domain" && axis.kind != "space" && axis.kind != "???"; });
  std::reverse(axes.begin(), axes.end());
  drop([](const detail::NrrdAxis&) { return true; });
  std::reverse(axes.begin(), axes.end());
  if (axes.size() == 3) return axes;
  std::vector<std::string> shown;
  for (const auto& axis : header.axes) shown.push_back(fmt::format("{} ({})", axis.size, axis.kind));
  throw InvalidInput(
      fmt::format("{}: axes of sizes {}: a volume has 3, one number a voxel; further axes may have 1 "
                  "sample only",
                  header.path, fmt::join(shown, ", ")));
}

/// NRRD (Kindlmann, "Definition of NRRD File Format"), attached and detached headers. Immutable, callable from many
/// threads.
class NrrdReader final : public VolumeReader {
 public:
  using Options = detail::FrameOptions;
  explicit NrrdReader(const Options& options) : frame_(options.frame) {}

  [[nodiscard]] int claims(const std::string& source, const ReadOptions& /*options*/) const override {
    if (detail::first_bytes(source, 7) == "NRRD000") return 2;
    return detail::has_extension(source, ".nrrd") || detail::has_extension(source, ".nhdr") ? 1 : 0;
  }

  [[nodiscard]] StoredVolume read(const std::string& source, const ReadOptions& options,
                                  const Run& run) const override {
    const detail::NrrdHeader header = detail::read_nrrd_header(source, options);
    detail::NrrdHeader of_one = header;
    const detail::Frames frames = take_frame(of_one, frame_);
    const auto axes = spatial_axes(of_one);
    detail::NrrdFrame frame = detail::nrrd_frame(of_one, axes);
    StoredVolume volume =
        detail::make_volume(source, frame.lattice, detail::read_nrrd_values(header, frames, options, run),
                            header.layout.type, std::move(frame.space), options);
    if (const auto time = std::find_if(axes.begin(), axes.end(), is_of_time); time != axes.end() && time->size > 1)
      volume.remarks.push_back(fmt::format("{}: its axis of the kind 'time' is taken as one of space", source));
    return volume;
  }

  [[nodiscard]] std::vector<std::string> files(const std::string& source, const ReadOptions& options) const override {
    return {source, detail::read_nrrd_header(source, options).data_file};
  }

 private:
  int frame_;
};

}  // namespace

namespace backends {
void nrrd(Registry<VolumeReader>& registry) {
  registry.add<NrrdReader>("nrrd", "NRRD, attached (.nrrd) and detached (.nhdr); raw, gzip and text encodings");
}
}  // namespace backends

}  // namespace isolux
