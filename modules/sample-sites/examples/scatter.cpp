#include <isolux/sample_sites.h>

int main() {
  isolux::Volume volume{.values = isolux::Grid<float>(isolux::Lattice{.size = {32, 32, 32}, .frame = {}}),
                        .name = "ramp"};
  for (int i = 0; i < 32; ++i) {
    for (int j = 0; j < 32 * 32; ++j) volume.values(i, j % 32, j / 32) = float(i);
  }
  isolux::SiteRequest request{.texels = isolux::cell_lattice(volume.lattice()), .count = 1000};
  request.isovalues = isolux::ValueRange{.low = 10.0f, .high = 12.0f};
  const isolux::Sites sites = isolux::samplers().create("low_discrepancy")->sample(volume, request, isolux::Run{});
  return sites.size() == 1000 && sites.isovalues[0] >= 10.0f ? 0 : 1;
}
