#include <isolux/core/sample_set.h>

namespace isolux {

Sites some_of(const Sites& sites, std::span<const std::size_t> numbers) {
  Sites some;
  for (const std::size_t i : numbers) {
    some.positions.push_back(sites.positions[i]);
    some.isovalues.push_back(sites.isovalues[i]);
    some.normals.push_back(sites.normals[i]);
  }
  return some;
}

}  // namespace isolux
