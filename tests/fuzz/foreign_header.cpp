// What is looked at before a library reads the file: headers of TIFF, DICOM and MetaImage. ITK itself is no part of
// this build: its headers take GCC alone.
#include "format_checks.h"
#include "fuzz.h"
#include "support.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace isolux;
  static const test::TemporaryFolder folder;
  static const std::string beside = folder.write("data.raw", std::string(24, '\1'));
  const std::string path = folder.write("a", fuzz::text_of(data, size));
  detail::CheckedHeader header;
  const bool refused = fuzz::refused([&] {
    if (detail::is_tiff(path)) {
      header = detail::check_tiff(path);
    } else if (detail::is_dicom(path)) {
      header = detail::check_dicom(path, {});
    } else if (detail::is_meta_image(path)) {
      (void)detail::meta_image_data_file(path, {});
      header = detail::check_meta_image(path, {});
    } else {
      throw InvalidInput("none of them");
    }
  });
  if (refused) return 0;
  for (int a = 0; a < 3; ++a) fuzz::require(header.size[a] >= 1, "a header that is taken has a size");
  return 0;
}
