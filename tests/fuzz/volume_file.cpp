// Files told by their content: NRRD, NIfTI, MRC, VTK, NumPy. A header may name `data.raw` beside it, of 24 bytes.
#include "volume_laws.h"

namespace {
constexpr std::size_t kDataBytes = 24;

isolux::ReadOptions second_volume() {
  isolux::ReadOptions options;
  for (const char* reader : {"nrrd", "nifti", "npy", "mrc"}) options.settings[reader]["frame"] = "1";
  return options;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace isolux::fuzz;
  static const std::string beside = folder().write("data.raw", std::string(kDataBytes, '\1'));
  const std::string path = folder().write("volume", text_of(data, size));
  check_volume(path, size + kDataBytes, {});
  check_volume(path, size + kDataBytes, second_volume());
  return 0;
}
