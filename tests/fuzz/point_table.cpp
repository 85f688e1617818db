// The tables of points that `isolux probe` reads.
#include "point_table.h"

#include <cmath>

#include "fuzz.h"
#include "support.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace isolux;
  static const test::TemporaryFolder folder;
  const std::string path = folder.write("points.csv", fuzz::text_of(data, size));
  PointTable table;
  if (fuzz::refused([&] { table = read_point_table(path); })) return 0;
  fuzz::require(table.points.size() == table.others.size(), "each point has its other columns");
  for (const auto& others : table.others) fuzz::require(others.size() == table.names.size(), "each name has a field");
  for (const Vec3& point : table.points)
    for (int a = 0; a < 3; ++a) fuzz::require(std::isfinite(point[a]), "coordinates are finite");
  return 0;
}
