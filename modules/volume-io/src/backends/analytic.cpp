#include "../make_volume.h"
#include "../scalars.h"

#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/analytic_fields.h>
#include <isolux/volume_io/volume_reader.h>

#include <charconv>

namespace isolux {
namespace {

constexpr std::string_view kPrefix = "gen:";
constexpr int kDefaultSize = 64;

/// Whether one of the values was ReadOptions::nodata. \throw InvalidInput for a value that does not fit a float
bool take_as_wanted(Volume& volume, const ReadOptions& options) {
  detail::AsWanted as_wanted(options, true);
  for (float& value : volume.values.values()) {
    const double wanted = as_wanted(double(value));
    if (!detail::fits_float(wanted))
      throw InvalidInput(fmt::format("{}: {} less {} is beyond what float32 holds, in which volumes are kept",
                                     volume.name, value, options.subtract));
    value = float(wanted);
  }
  return as_wanted.found_nodata();
}

/// `gen:NAME[:N]`: built-in functions sampled on the unit cube. Immutable, callable from many threads.
class AnalyticReader final : public VolumeReader {
 public:
  using Options = NoOptions;
  explicit AnalyticReader(const Options& /*options*/) {}

  [[nodiscard]] int claims(const std::string& source, const ReadOptions& /*options*/) const override {
    return source.starts_with(kPrefix) ? 3 : 0;
  }

  [[nodiscard]] StoredVolume read(const std::string& source, const ReadOptions& options,
                                  const Run& run) const override {
    if (!source.starts_with(kPrefix)) throw InvalidInput(fmt::format("'{}' is not of the form gen:NAME[:N]", source));
    const std::string_view text = std::string_view(source).substr(kPrefix.size());
    const auto colon = text.find(':');
    int n = kDefaultSize;
    if (colon != std::string_view::npos) {
      const std::string_view digits = text.substr(colon + 1);
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), n);
      if (error != std::errc() || end != digits.data() + digits.size())
        throw InvalidInput(
            fmt::format("{}: '{}' is no number of points an axis; allowed is 2 to 2048", source, digits));
    }
    Volume volume = sample_analytic_field(text.substr(0, colon), n, run);
    const bool found_nodata = (options.subtract != 0.0 || options.nodata) && take_as_wanted(volume, options);
    if (!options.spacing && !options.nodata) return keep_floats(std::move(volume));
    const auto values = volume.values.values();
    return detail::make_volume(volume.name, volume.lattice(),
                               {std::vector<float>(values.begin(), values.end()), false, found_nodata},
                               volume.stored_type, volume.space, options);
  }

  [[nodiscard]] std::vector<std::string> files(const std::string& /*source*/,
                                               const ReadOptions& /*options*/) const override {
    return {};
  }
};

}  // namespace

namespace backends {
void analytic(Registry<VolumeReader>& registry) {
  registry.add<AnalyticReader>("analytic", "gen:NAME[:N], built-in fields on N^3 points of the unit cube");
}
}  // namespace backends

}  // namespace isolux
