#include "itk_fixture.h"

#include <gmock/gmock.h>

namespace isolux {
namespace {
using test::Itk;
using test::kSpaced;
using testing::HasSubstr;

// What no content tells is judged by its name.
TEST_F(Itk, SaysOfABrokenFileWhatItsNamePromises) {
  EXPECT_THAT(refused("a.mha", "a\nb"), HasSubstr("MetaImage"));
  EXPECT_THAT(refused("a.tif", "a\nb", kSpaced), HasSubstr("TIFF"));
  EXPECT_THAT(refused("a.dcm", "a\nb"), HasSubstr("DICOM"));
}

TEST_F(Itk, SaysWhatAFolderLacks) {
  EXPECT_THAT(test::reading_error(folder_.file(".")), HasSubstr("without DICOM slices"));
}

}  // namespace
}  // namespace isolux
