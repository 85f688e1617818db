#include "vtk_extent.h"

#include "number_text.h"
#include "plain_text.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <type_traits>

namespace isolux::detail {

bool VtkExtent::holds(const VtkExtent& part) const {
  for (std::size_t a = 0; a < 3; ++a)
    if (part.first.at(a) < first.at(a) || part.last.at(a) > last.at(a)) return false;
  return true;
}

void parse_numbers(const std::string& path, std::string_view attribute, std::string_view text,
                   std::span<double> numbers) {
  const auto words = plain_words(text);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = i < words.size() ? parse_real(words[i]) : std::nullopt;
    if (!number || words.size() != numbers.size())
      throw InvalidInput(
          fmt::format("{}: {} is '{}': {} numbers are needed", path, attribute, excerpt(text), numbers.size()));
    numbers[i] = *number;
  }
}

VtkExtent parse_extent(const std::string& path, std::string_view attribute, std::string_view text) {
  std::array<double, 6> ends{};
  parse_numbers(path, attribute, text, ends);
  for (const auto& word : plain_words(text))
    if (!reads_as(ScalarType::kInt32, word))
      throw InvalidInput(
          fmt::format("{}: {} is '{}': whole numbers of 32 bits are needed", path, attribute, excerpt(text)));
  VtkExtent extent;
  for (std::size_t a = 0; a < 3; ++a) {
    extent.first.at(a) = std::int64_t(ends.at(2 * a));
    extent.last.at(a) = std::int64_t(ends.at(2 * a + 1));
  }
  return extent;
}

VtkExtent cells_of(VtkExtent points) {
  for (std::size_t a = 0; a < 3; ++a)
    if (points.last.at(a) > points.first.at(a)) --points.last.at(a);
  return points;
}

Lattice lattice_of(const VtkExtent& points, const VtkExtent& voxels, const std::array<double, 3>& origin,
                   const std::array<double, 3>& spacing, const std::array<double, 9>& direction) {
  const auto sizes = voxels.sizes();
  Lattice lattice;
  lattice.size = {int(sizes[0]), int(sizes[1]), int(sizes[2])};
  lattice.frame.origin = Vec3(origin[0], origin[1], origin[2]);
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3 axis = Vec3(direction.at(a), direction.at(3 + a), direction.at(6 + a)) * spacing.at(a);
    lattice.frame.axes[int(a)] = axis;
    // Cells end before their points do.
    const double to_centre = voxels.last.at(a) < points.last.at(a) ? 0.5 : 0.0;
    lattice.frame.origin += axis * (double(points.first.at(a)) + to_centre);
  }
  return lattice;
}

void require_covered(const std::string& path, std::uint64_t in_pieces, std::uint64_t in_whole) {
  if (in_pieces < in_whole)
    throw IoError(fmt::format("{}: VTK XML: its pieces leave out {} of {} values of the WholeExtent", path,
                              in_whole - in_pieces, in_whole));
}

void VtkPieces::put(const VtkExtent& piece, const DecodedValues& values) {
  values_.rounded |= values.rounded;
  values_.found_nodata |= values.found_nodata;
  const auto size = piece.sizes();
  const auto whole_size = whole_.sizes();
  std::visit(
      [&](const auto& from) {
        using List = std::decay_t<decltype(from)>;
        if (!std::holds_alternative<List>(values_.list)) values_.list = List();
        auto& into = std::get<List>(values_.list);
        into.resize(is_there_.size());
        for (std::int64_t z = 0; z < size[2]; ++z) {
          for (std::int64_t y = 0; y < size[1]; ++y) {
            const std::int64_t row = z + piece.first[2] - whole_.first[2];
            const std::int64_t line = row * whole_size[1] + y + piece.first[1] - whole_.first[1];
            const std::int64_t at = line * whole_size[0] + piece.first[0] - whole_.first[0];
            std::copy_n(from.begin() + (z * size[1] + y) * size[0], size[0], into.begin() + at);
            std::fill_n(is_there_.begin() + at, size[0], true);
          }
        }
      },
      values.list);
}

DecodedValues VtkPieces::take(const std::string& path) {
  const auto there = std::uint64_t(std::count(is_there_.begin(), is_there_.end(), true));
  require_covered(path, there, is_there_.size());
  return std::move(values_);
}

}  // namespace isolux::detail
